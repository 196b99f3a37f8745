#include "sdf/located_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace farfield {
namespace {

/// The line of the last character that is not white space. The lexer reads one character past a number, perhaps the
/// line's end: so the plain count of lines would be one too far there.
struct LineCounter {
    int current = 1;
    int token = 1;
};

/// Hands characters to the lexer and counts lines on the way.
class CountingIterator {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, LineCounter* lines) : at_(at), lines_(lines) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        if (*at_ == '\n')
            ++lines_->current;
        else if (*at_ != ' ' && *at_ != '\t' && *at_ != '\r')
            lines_->token = lines_->current;
        ++at_;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    friend bool operator==(const CountingIterator& a, const CountingIterator& b) { return a.at_ == b.at_; }

private:
    const char* at_;
    LineCounter* lines_;
};

std::string shortened(std::string_view text, size_t longest) {
    return text.size() <= longest ? std::string(text) : std::string(text.substr(0, longest)) + "...";
}

std::string printable(std::string_view text) {
    // The dump escapes control characters and replaces what is not UTF-8; its quotes are taken off again.
    std::string dumped = nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return dumped.substr(1, dumped.size() - 2);
}

/// nlohmann's message without what ours says anyway. "[json.exception.parse_error.101] parse error at line 3, column 5:
/// syntax error while parsing object - unexpected ','; expected '}'" becomes "not valid JSON: unexpected ',', expected
/// '}'".
std::string syntax_problem(std::string_view message) {
    if (message.find("number overflow") != std::string_view::npos)
        return "a number is too large, expected a finite number";
    if (size_t at = message.find(" - "); at != std::string_view::npos) message.remove_prefix(at + 3);
    if (message.starts_with("invalid literal"))
        return "not valid JSON: unknown word, expected a text, a finite number, true, false, an array or an object";
    std::string text(message);
    if (size_t at = text.find("; last read: "); at != std::string::npos)
        text.resize(at);  // often a lot, with line ends
    if (size_t at = text.find("; expected "); at != std::string::npos) text.replace(at, 1, ",");
    return "not valid JSON: " + text;
}

/// Builds the tree from nlohmann's events. Pointers to open containers stay valid: a parent does not grow meanwhile.
class Builder {
public:
    using number_integer_t = nlohmann::json::number_integer_t;
    using number_unsigned_t = nlohmann::json::number_unsigned_t;
    using number_float_t = nlohmann::json::number_float_t;
    using string_t = nlohmann::json::string_t;
    using binary_t = nlohmann::json::binary_t;

    explicit Builder(const LineCounter& lines) : lines_(lines) {}
    Json take() { return std::move(document_); }

    bool null() { return scalar(nullptr); }
    bool boolean(bool b) { return scalar(b); }
    bool number_integer(number_integer_t n) { return scalar(static_cast<double>(n)); }
    bool number_unsigned(number_unsigned_t n) { return scalar(static_cast<double>(n)); }
    bool number_float(number_float_t n, const string_t&) { return scalar(n); }
    bool string(string_t& s) { return scalar(std::move(s)); }
    bool binary(binary_t&) { return false; }  // JSON text has none
    bool start_object(std::size_t) { return open(Json::Object{}); }
    bool start_array(std::size_t) { return open(Json::Array{}); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(string_t& key) {
        Frame& frame = open_.back();
        std::get<Json::Object>(frame.container->value).push_back({key, lines_.token, {}});
        if (auto [first, fresh] = frame.keys.try_emplace(std::move(key), lines_.token); !fresh)
            fail(fmt::format("is given twice, expected once (the first is on line {})", first->second));
        return true;
    }

    bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
        fail(syntax_problem(error.what()));
    }

private:
    struct Frame {
        Json* container;
        std::unordered_map<std::string, int> keys;  ///< of an object, with their lines
    };

    [[noreturn]] void fail(const std::string& problem) const {
        std::vector<JsonPath> path(open_.size() + 1);
        for (size_t i = 0; i < open_.size(); ++i) {
            const Json& container = *open_[i].container;
            path[i].value = &container;
            JsonPath& inside = path[i + 1];
            inside.parent = &path[i];
            if (const auto* array = container.as<Json::Array>())
                inside.index =
                    i + 1 < open_.size() ? static_cast<int>(array->size()) - 1 : static_cast<int>(array->size());
            else if (const auto* object = container.as<Json::Object>(); object && !object->empty())
                inside.key = object->back().key;
        }
        throw JsonError(lines_.token, path.back().text(), problem);
    }

    Json& place() {
        if (open_.empty()) return document_;
        Json& container = *open_.back().container;
        if (auto* array = std::get_if<Json::Array>(&container.value)) return array->emplace_back();
        return std::get<Json::Object>(container.value).back().value;
    }
    template <class T>
    bool scalar(T value) {
        Json& json = place();
        json.value = std::move(value);
        json.line = lines_.token;
        return true;
    }
    template <class T>
    bool open(T container) {
        if (open_.size() >= deepest_json) {
            throw JsonError(lines_.token, "",
                            fmt::format("nested too deeply, expected at most {} levels", deepest_json));
        }
        Json& json = place();
        json.value = std::move(container);
        json.line = lines_.token;
        open_.push_back({&json, {}});
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    const LineCounter& lines_;
    Json document_;
    std::vector<Frame> open_;
};

}  // namespace

const Json* Json::find(std::string_view key) const {
    if (const Object* object = as<Object>())
        for (const JsonMember& member : *object)
            if (member.key == key) return &member.value;
    return nullptr;
}

std::string JsonPath::text() const {
    std::vector<const JsonPath*> chain;
    for (const JsonPath* p = this; p; p = p->parent) chain.push_back(p);
    std::string text;
    for (auto p = chain.rbegin(); p != chain.rend(); ++p) {
        if ((*p)->index >= 0)
            text += fmt::format("[{}]", (*p)->index);
        else if (!(*p)->key.empty())
            text += (text.empty() ? "" : "/") + shortened(printable((*p)->key), 100);
        const Json* name = (*p)->index >= 0 && (*p)->value ? (*p)->value->find("name") : nullptr;
        if (name && name->as<std::string>()) text += " " + in_quotes(*name->as<std::string>());
    }
    return text;
}

Json parse_json(std::string_view text) {
    // To the lexer it would be the end, and the rest would be lost without a word.
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
        const auto line_ends = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
        throw JsonError(static_cast<int>(line_ends) + 1, "", "not valid JSON: a zero byte, expected text alone");
    }
    LineCounter lines;
    Builder builder(lines);
    nlohmann::json::sax_parse(CountingIterator(text.data(), &lines),
                              CountingIterator(text.data() + text.size(), &lines), &builder);
    return builder.take();
}

std::string description(const Json& json) {
    struct Describe {
        std::string operator()(std::nullptr_t) const { return "null"; }
        std::string operator()(bool b) const { return b ? "true" : "false"; }
        std::string operator()(double d) const { return fmt::format("{}", d); }
        std::string operator()(const std::string& s) const { return in_quotes(s); }
        std::string operator()(const Json::Array& a) const { return fmt::format("an array of {}", a.size()); }
        std::string operator()(const Json::Object&) const { return "an object"; }
    };
    return std::visit(Describe{}, json.value);
}

std::string in_quotes(std::string_view text) { return '"' + printable(shortened(text, 60)) + '"'; }

}  // namespace farfield
