#include "app/chart_table.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>

namespace farfield {
namespace {

constexpr const char* clock_keys[] = {"cpu", "device"};

template <class Names, class T>
bool choose(const Names& names, const std::string& text, T& value) {
    for (std::size_t i = 0; i < std::size(names); ++i)
        if (text == names[i]) return value = static_cast<T>(i), true;
    return false;
}

std::string to_cell(const std::string& v) { return v; }
std::string to_cell(Method v) { return method_keys[static_cast<int>(v)]; }
std::string to_cell(Varied v) { return varied_keys[static_cast<int>(v)]; }
std::string to_cell(bool device_time) { return clock_keys[device_time]; }
template <class Number>
std::string to_cell(Number v) {
    return fmt::format("{}", v);
}

bool from_cell(const std::string& text, std::string& v) { return v = text, true; }
bool from_cell(const std::string& text, Method& v) { return choose(method_keys, text, v); }
bool from_cell(const std::string& text, Varied& v) { return choose(varied_keys, text, v); }
bool from_cell(const std::string& text, bool& v) { return choose(clock_keys, text, v); }
template <class Number>
bool from_cell(const std::string& text, Number& v) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(static_cast<double>(v));
}

struct Column {
    const char* name;
    bool in_key;
    std::function<std::string(const ChartLine&)> get;
    std::function<bool(ChartLine&, const std::string&)> set;
};

template <class Member>
Column column(const char* name, bool in_key, Member member) {
    return {name, in_key, [=](const ChartLine& line) { return to_cell(member(line)); },
            [=](ChartLine& line, const std::string& text) { return from_cell(text, member(line)); }};
}

#define FARFIELD_COLUMN(name, in_key, member) \
    column(                                   \
        name, in_key, [](auto& line) -> auto& { return line.member; })

const std::vector<Column>& columns() {
    static const std::vector<Column> table = {
        FARFIELD_COLUMN("scene", true, scene),
        FARFIELD_COLUMN("hash", true, hash),
        FARFIELD_COLUMN("width", true, size.x),
        FARFIELD_COLUMN("height", true, size.y),
        FARFIELD_COLUMN("device", true, device),
        FARFIELD_COLUMN("clock", false, measurement.device_time),
        FARFIELD_COLUMN("varied", true, measurement.varied),
        FARFIELD_COLUMN("method", true, measurement.setting.method),
        FARFIELD_COLUMN("samples", true, measurement.setting.samples),
        FARFIELD_COLUMN("frame_samples", true, measurement.frame_samples),
        FARFIELD_COLUMN("blur_levels", true, measurement.setting.blur_levels),
        FARFIELD_COLUMN("ao_radius_m", true, measurement.setting.ao_radius),
        FARFIELD_COLUMN("bounces", true, measurement.setting.bounces),
        FARFIELD_COLUMN("scale", true, measurement.setting.scale),
        FARFIELD_COLUMN("minimum_step", true, measurement.setting.minimum_step),
        FARFIELD_COLUMN("seed", true, measurement.seed),
        FARFIELD_COLUMN("seconds", false, measurement.seconds),
        FARFIELD_COLUMN("rmse_over_mean", false, measurement.rmse_over_mean),
        FARFIELD_COLUMN("relmse", false, measurement.relative_mse),
        FARFIELD_COLUMN("bias", false, measurement.bias),
        FARFIELD_COLUMN("flip", false, measurement.flip),
        FARFIELD_COLUMN("reference_bounces", true, measurement.reference_bounces),
        FARFIELD_COLUMN("reference_samples", false, measurement.reference_samples),
        FARFIELD_COLUMN("reference_noise_rmse_over_mean", false, measurement.noise_rmse_over_mean),
        FARFIELD_COLUMN("reference_noise_relmse", false, measurement.noise_relative_mse),
    };
    return table;
}

#undef FARFIELD_COLUMN

/// Quoted where it must be (RFC 4180); line breaks become blanks.
std::string quoted(std::string cell) {
    for (char& c : cell)
        if (c == '\n' || c == '\r') c = ' ';
    if (cell.find_first_of(",\"") == cell.npos) return cell;
    for (std::size_t i = 0; (i = cell.find('"', i)) != cell.npos; i += 2) cell.insert(i, 1, '"');
    return '"' + cell + '"';
}

std::vector<std::string> cells(std::string_view line) {
    std::vector<std::string> found(1);
    bool quote = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"' && quote && i + 1 < line.size() && line[i + 1] == '"')
            found.back() += line[i++];
        else if (line[i] == '"')
            quote = !quote;
        else if (line[i] == ',' && !quote)
            found.emplace_back();
        else
            found.back() += line[i];
    }
    return found;
}

std::string to_text(const ChartLine& line) {
    std::string text;
    for (const Column& c : columns()) text += (text.empty() ? "" : ",") + quoted(c.get(line));
    return text + "\n";
}

bool parse(std::string_view text, ChartLine& line) {
    const std::vector<std::string> found = cells(text);
    if (found.size() != columns().size()) return false;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (!columns()[i].set(line, found[i])) return false;
    const Measurement& m = line.measurement;
    return m.seconds > 0.0 && m.rmse_over_mean >= 0.0 && m.relative_mse >= 0.0 && m.flip >= 0.0 &&
           m.noise_rmse_over_mean >= 0.0 && m.noise_relative_mse >= 0.0;
}

}  // namespace

std::string chart_columns() {
    std::string names;
    for (const Column& c : columns()) names += (names.empty() ? "" : ",") + std::string(c.name);
    return names;
}

std::string ChartLine::key() const {
    std::string text;
    for (const Column& c : columns())
        if (c.in_key) text += quoted(c.get(*this)) + ",";
    return text;
}

ChartTable::ChartTable(std::filesystem::path file) : file_(std::move(file)) {
    std::error_code ignored;
    if (!std::filesystem::exists(file_, ignored)) return;
    std::ifstream in(file_, std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    if (!in) throw ImageError(fmt::format("{}: cannot be read", file_.string()));
    int number = 0;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = text.find('\n', start);
        torn_ = end == text.npos;
        const std::string_view content = std::string_view(text).substr(start, end - start);
        start = torn_ ? text.size() : end + 1;
        if (++number == 1) {
            if (content != chart_columns())
                throw ImageError(fmt::format("{}: is another table than a chart's; it begins \"{}\"", file_.string(),
                                             content.substr(0, 60)));
            continue;
        }
        ChartLine line;
        if (torn_ || !parse(content, line))
            problems_.push_back(fmt::format("{}:{}: no measurement, left out", file_.string(), number));
        else
            lines_[line.key()] = line;
    }
}

const ChartLine* ChartTable::find(const ChartLine& line) const {
    const auto found = lines_.find(line.key());
    const bool enough =
        found != lines_.end() && found->second.measurement.reference_samples >= line.measurement.reference_samples;
    return enough ? &found->second : nullptr;
}

void ChartTable::add(const ChartLine& line) {
    std::error_code ignored;
    const bool empty = !std::filesystem::exists(file_, ignored) || std::filesystem::file_size(file_, ignored) == 0;
    const std::string text = (empty ? chart_columns() + "\n" : torn_ ? "\n" : "") + to_text(line);
    torn_ = false;
    const std::unique_ptr<FILE, int (*)(FILE*)> out(std::fopen(file_.c_str(), "ab"), std::fclose);
    if (!out || std::fwrite(text.data(), 1, text.size(), out.get()) != text.size() || std::fflush(out.get()) != 0)
        throw ImageError(fmt::format("{}: cannot be written: {}", file_.string(), std::strerror(errno)));
    lines_[line.key()] = line;
}

}  // namespace farfield
