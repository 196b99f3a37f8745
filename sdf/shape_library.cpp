#include "sdf/shape_library.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>
#include <vector>

namespace farfield {

std::string_view embedded_shapes(std::string_view name);  // generated from the .glsl files by embed.cmake

namespace {

struct Function {
    std::string name;
    std::string text;  ///< with its comment
    std::set<std::string> identifiers;
};

std::set<std::string> identifiers(std::string_view code) {
    std::set<std::string> found;
    std::string word;
    for (const char c : code) {
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
            word += c;
        else if (!word.empty())
            found.insert(std::exchange(word, {}));
    }
    if (!word.empty()) found.insert(word);
    return found;
}

/// The files keep to one form: comment lines, the signature on a line that starts at its margin, "}" alone at the
/// margin to end the function, an empty line.
std::vector<Function> parse() {
    std::vector<Function> functions;
    const std::string text =
        std::string(embedded_shapes("shapes.glsl")) + std::string(embedded_shapes("operations.glsl"));
    std::string comment, body, name;
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = text.find('\n', start);
        const std::string line = text.substr(start, end - start);
        start = end + 1;
        if (name.empty() && line.starts_with("//")) {
            comment += line + "\n";
        } else if (name.empty() && line.ends_with("{")) {
            const std::size_t open = line.find('('), space = line.rfind(' ', open);
            name = line.substr(space + 1, open - space - 1);
            body = line + "\n";
        } else if (name.empty()) {
            comment.clear();
        } else {
            body += line + "\n";
            if (line != "}") continue;
            functions.push_back({name, comment + body, identifiers(body)});
            name.clear(), comment.clear();
        }
    }
    return functions;
}

const std::vector<Function>& library() {
    static const std::vector<Function> functions = parse();
    return functions;
}

}  // namespace

bool is_shape(std::string_view name) {
    return std::any_of(library().begin(), library().end(), [&](const Function& f) { return f.name == name; });
}

std::string used_shapes(std::string_view code) {
    const std::vector<Function>& functions = library();
    std::set<std::string> wanted = identifiers(code);
    // A function calls only those before it, so one pass from the end finds all. A name that is wanted later, by a
    // function before it, is a local variable's.
    std::string text;
    for (auto f = functions.rbegin(); f != functions.rend(); ++f) {
        if (!wanted.contains(f->name)) continue;
        wanted.insert(f->identifiers.begin(), f->identifiers.end());
        text = f->text + "\n" + text;
    }
    return text;
}

}  // namespace farfield
