#include "app/editor_state.h"

#include "sdf/atomic_file.h"
#include "sdf/user_folder.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace farfield {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_recent = 12;
constexpr std::uintmax_t largest_file = 1'000'000;
constexpr int least_width = 800, least_height = 500, most_pixels = 16384;

struct PanelName {
    const char* key;
    float PanelSizes::*size;
};
constexpr PanelName panels[] = {
    {"left", &PanelSizes::left},
    {"right", &PanelSizes::right},
    {"objects", &PanelSizes::objects},
    {"settings", &PanelSizes::settings},
    {"code_width", &PanelSizes::code_width},
    {"code_height", &PanelSizes::code_height},
};
struct SwitchName {
    const char* key;
    bool EditorState::*on;
};
constexpr SwitchName switches[] = {
    {"maximised", &EditorState::maximised}, {"statistics", &EditorState::statistics},     {"code", &EditorState::code},
    {"measure", &EditorState::measure},     {"newest_first", &EditorState::newest_first},
};

/// Null where there is no such thing.
const Json& member(const Json& json, const char* key) {
    static const Json nothing;
    const auto found = json.is_object() ? json.find(key) : json.end();
    return found == json.end() ? nothing : *found;
}

std::optional<double> number(const Json& json, double low, double high) {
    if (!json.is_number()) return std::nullopt;
    const double value = json.get<double>();
    return value >= low && value <= high ? std::optional(value) : std::nullopt;
}

std::optional<glm::ivec2> pair(const Json& json, glm::ivec2 low, int high) {
    if (!json.is_array() || json.size() != 2) return std::nullopt;
    const auto x = number(json[0], low.x, high), y = number(json[1], low.y, high);
    if (!x || !y) return std::nullopt;
    return glm::ivec2(*x, *y);
}

SplitView parse_split(const Json& json) {
    SplitView split;
    if (const Json& on = member(json, "on"); on.is_boolean()) split.on = on.get<bool>();
    if (const auto divider = number(member(json, "divider"), SplitView::least_part, 1.0 - SplitView::least_part))
        split.divider = static_cast<float>(*divider);
    const Json &method = member(json, "method"), &view = member(json, "view");
    if (method == "same") split.method.reset();
    for (std::size_t i = 0; i < std::size(method_keys); ++i)
        if (method == method_keys[i]) split.method = static_cast<Method>(i);
    if (view.is_string()) split.view = find_view(view.get<std::string>());
    if (const auto levels = number(member(json, "blur_levels"), 0.0, 8.0))
        split.blur_levels = static_cast<int>(*levels);
    return split;
}

Json split_json(const SplitView& split) {
    Json json{{"on", split.on}, {"divider", split.divider}};
    json["method"] = split.method ? method_keys[static_cast<std::size_t>(*split.method)] : "same";
    if (split.view) json["view"] = views()[static_cast<std::size_t>(*split.view)].key;
    if (split.blur_levels) json["blur_levels"] = *split.blur_levels;
    return json;
}

void put_first(std::vector<fs::path>& files, const fs::path& file) {
    std::erase(files, file);
    files.insert(files.begin(), file);
    if (files.size() > most_recent) files.resize(most_recent);
}

}  // namespace

fs::path editor_state_file() {
    const fs::path folder = user_folder("XDG_STATE_HOME", ".local/state");
    return folder.empty() ? folder : folder / "editor.json";
}

EditorState parse_editor_state(std::string_view text) {
    EditorState state;
    const Json json = Json::parse(text, nullptr, false);
    const Json& window = member(json, "window");
    state.size = pair(member(window, "size"), {least_width, least_height}, most_pixels);
    state.place = pair(member(window, "place"), glm::ivec2(-most_pixels), most_pixels);
    for (const PanelName& panel : panels)
        if (const auto size = number(member(member(json, "panels"), panel.key), 1.0, most_pixels))
            state.panels.*panel.size = static_cast<float>(*size);
    for (const SwitchName& name : switches)
        if (const Json& on = member(json, name.key); on.is_boolean()) state.*name.on = on.get<bool>();
    state.split = parse_split(member(json, "split"));
    for (const Json& file : member(json, "recent"))
        if (file.is_string() && state.recent.size() < most_recent)
            if (const fs::path path = file.get<std::string>(); path.is_absolute()) state.recent.push_back(path);
    return state;
}

std::string to_text(const EditorState& state) {
    Json json;
    json["window"] = Json::object();
    if (state.size) json["window"]["size"] = {state.size->x, state.size->y};
    if (state.place) json["window"]["place"] = {state.place->x, state.place->y};
    for (const PanelName& panel : panels) json["panels"][panel.key] = state.panels.*panel.size;
    for (const SwitchName& name : switches) json[name.key] = state.*name.on;
    json["split"] = split_json(state.split);
    json["recent"] = Json::array();
    for (const fs::path& file : state.recent) json["recent"].push_back(file.string());
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

EditorState load_editor_state(const fs::path& file) {
    std::error_code failed;
    if (!fs::is_regular_file(file, failed) || fs::file_size(file, failed) > largest_file) return {};
    std::ifstream in(file, std::ios::binary);
    EditorState state = parse_editor_state(std::string(std::istreambuf_iterator<char>(in), {}));
    std::erase_if(state.recent, [&](const fs::path& path) { return !fs::is_regular_file(path, failed); });
    return state;
}

void save_editor_state(const EditorState& state, const fs::path& file) {
    if (file.empty()) return;
    std::error_code failed;
    fs::create_directories(file.parent_path(), failed);
    try {
        write_atomically(file, to_text(state));
    } catch (const FileError&) {}
}

void remember_file(EditorState& state, const fs::path& opened, const fs::path& file) {
    state.recent = load_editor_state(file).recent;
    std::error_code failed;
    put_first(state.recent, fs::absolute(opened, failed).lexically_normal());
    save_editor_state(state, file);
}

}  // namespace farfield
