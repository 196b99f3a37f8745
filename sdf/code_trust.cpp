#include "sdf/code_trust.h"

#include "sdf/bundled_scenes.h"
#include "sdf/scene_file.h"
#include "sdf/user_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string_view>

#include <unistd.h>

namespace farfield {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_hashes = 4096;  // then the oldest are forgotten: a quarter of a megabyte
constexpr std::size_t hash_digits = 64;

bool is_hash(std::string_view line) {
    return line.size() == hash_digits && line.find_first_not_of("0123456789abcdef") == line.npos;
}

template <class Visit>
void visit_code(const Node& node, const std::string& path, Visit visit) {
    const std::string here = node.name.empty() ? path : fmt::format("{} \"{}\"", path, node.name);
    if (node.code) visit(node, here);
    for (std::size_t i = 0; i < node.children.size(); ++i)
        visit_code(node.children[i], fmt::format("{}/children[{}]", here, i), visit);
}

/// Of every node with code, in the tree and in the definitions.
template <class Visit>
void visit_code(const Scene& scene, Visit visit) {
    visit_code(scene.root, "root", visit);
    for (std::size_t i = 0; i < scene.definitions.size(); ++i)
        visit_code(scene.definitions[i], fmt::format("definitions[{}]", i), visit);
}

/// Of the code that comes with the program.
const std::unordered_set<std::string>& bundled() {
    static const auto hashes = [] {
        std::unordered_set<std::string> found{default_custom_code()->hash()};
        for (std::string_view names = FARFIELD_BUNDLED_SCENES; !names.empty();) {
            const std::string_view name = names.substr(0, names.find('|')), text = embedded_scenes(name);
            names.remove_prefix(std::min(name.size() + 1, names.size()));
            if (text.find("\"code\"") == text.npos) continue;
            visit_code(parse_scene(text, std::string(name)),
                       [&](const Node& node, const std::string&) { found.insert(node.code->hash()); });
        }
        return found;
    }();
    return hashes;
}

void forget_unknown(Node& node, const CodeTrust& trust) {
    if (node.code && !trust.knows(*node.code)) {
        node.code = nullptr;
        node.values.resize(info(node.kind).parameters.size());
    }
    for (Node& child : node.children) forget_unknown(child, trust);
}

}  // namespace

CodeTrust::CodeTrust(fs::path file) : file_(std::move(file)) { read(); }

fs::path CodeTrust::user_file() {
    const fs::path folder = user_folder("XDG_CONFIG_HOME", ".config");
    return folder.empty() ? folder : folder / "trusted";
}

bool CodeTrust::knows(const CustomCode& code) const {
    return accepted_.contains(code.hash()) || bundled().contains(code.hash());
}

void CodeTrust::accept(const CustomCode& code) {
    if (knows(code)) return;
    read();  // another Farfield may have added to it
    order_.push_back(code.hash());
    accepted_.insert(code.hash());
    write();
}

void CodeTrust::read() {
    std::error_code ignored;
    if (!fs::is_regular_file(file_, ignored)) return;
    std::ifstream in(file_, std::ios::binary);
    std::string line(hash_digits + 2, '\0');
    for (std::size_t i = 0; i < 2 * most_hashes; ++i) {
        in.getline(line.data(), static_cast<std::streamsize>(line.size()));
        if (!in) return;
        const std::string_view hash(line.data());
        if (is_hash(hash) && accepted_.insert(std::string(hash)).second) order_.emplace_back(hash);
    }
}

void CodeTrust::write() const {
    if (file_.empty()) return;
    std::error_code failed;
    fs::create_directories(file_.parent_path(), failed);
    const fs::path temporary = fs::path(file_) += fmt::format(".{}.tmp", ::getpid());
    {
        std::ofstream out(temporary, std::ios::binary);
        for (std::size_t i = order_.size() - std::min(order_.size(), most_hashes); i < order_.size(); ++i)
            out << order_[i] << '\n';
        if (!out.flush()) failed = std::make_error_code(std::errc::io_error);
    }
    if (!failed) fs::rename(temporary, file_, failed);
    if (failed) fs::remove(temporary, failed);
}

std::vector<UnknownCode> unknown_code(const Scene& scene, const CodeTrust& trust) {
    std::vector<UnknownCode> found;
    visit_code(scene, [&](const Node& node, const std::string& path) {
        if (!trust.knows(*node.code)) found.push_back({path, &node});
    });
    return found;
}

Scene without_unknown_code(const Scene& scene, const CodeTrust& trust) {
    Scene shown = scene;
    forget_unknown(shown.root, trust);
    for (Node& definition : shown.definitions) forget_unknown(definition, trust);
    return shown;
}

}  // namespace farfield
