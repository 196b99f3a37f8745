// scenes/README.md documents the file format; here its tables are compared with the program's, and its examples are
// read.
#include "sdf/scene_format.h"

#include "sdf/fields.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace farfield {
namespace {

constexpr std::string_view begin_mark = "<!-- The program's tables; tests/scene_format_test compares. -->\n";
constexpr std::string_view end_mark = "<!-- End of the program's tables. -->\n";

std::filesystem::path readme() { return std::filesystem::path(FARFIELD_SCENES) / "README.md"; }

/// The default as a file would hold it.
std::string default_text(const Parameter& parameter) {
    const glm::vec3 v = parameter.initial;
    if (parameter.type == ParameterType::choice)
        return fmt::format("\"{}\"", parameter.choices[static_cast<size_t>(v.x)]);
    if (parameter.is_word(v.x)) return fmt::format("\"{}\"", parameter.word);
    if (parameter.components() == 1) return fmt::format("{}", v.x);
    if (parameter.type == ParameterType::flags) return fmt::format("[{}, {}, {}]", v.x != 0, v.y != 0, v.z != 0);
    return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}

void add_row(std::string& text, const Parameter& parameter) {
    const std::string_view unit = unit_symbol(parameter.unit);
    text += fmt::format("| `{}` | {} | {} | `{}` | {} |\n", parameter.key, expectation(parameter), unit,
                        default_text(parameter), parameter.tip);
}

const char* const table_head = "\n| key | takes | unit | default | meaning |\n|---|---|---|---|---|\n";

template <class T>
void add_fields(std::string& text, const char* title) {
    text += fmt::format("\n### {}\n{}", title, table_head);
    for (const Field<T>& field : fields<T>()) add_row(text, field.parameter);
}

void add_kinds(std::string& text, const char* title, bool (*belongs)(const KindInfo&)) {
    text += fmt::format("\n### {}\n", title);
    for (const KindInfo& kind : node_kinds()) {
        if (!belongs(kind)) continue;
        text += fmt::format("\n#### `{}`\n\n{}.{}\n", kind.key, kind.tip,
                            kind.exact ? "" : " Its distance is a lower bound, not exact.");
        if (kind.parameters.empty()) continue;
        text += table_head;
        for (const Parameter& parameter : kind.parameters) add_row(text, parameter);
    }
}

std::string documented_tables() {
    std::string text;
    add_fields<Camera>(text, "camera");
    add_fields<Settings>(text, "settings");
    add_fields<Sky>(text, "sky");
    add_fields<Material>(text, "materials");
    add_fields<Light>(text, "lights");
    add_fields<Transform>(text, "Transform of every node");
    add_kinds(text, "Primitives (no children)", [](const KindInfo& k) { return k.role == Role::primitive; });
    add_kinds(text, "Combinations of children", [](const KindInfo& k) { return k.role == Role::combine; });
    add_kinds(text, "Modifiers (of the union of their children)",
              [](const KindInfo& k) { return k.takes_children() && k.role != Role::combine; });
    add_kinds(text, "Instances of definitions (no children)",
              [](const KindInfo& k) { return k.role == Role::instance; });
    return text + "\n";
}

TEST(SceneFormat, ReadmeShowsTheProgramsTables) {
    const std::string text = read_text(readme());
    const size_t begin = text.find(begin_mark), end = text.find(end_mark);
    ASSERT_NE(begin, std::string::npos);
    ASSERT_NE(end, std::string::npos);
    const size_t first = begin + begin_mark.size();
    if (text.substr(first, end - first) == documented_tables()) return;
    const auto correct = std::filesystem::temp_directory_path() / "farfield-scenes-README.md";
    write_text(correct, text.substr(0, first) + documented_tables() + text.substr(end));
    ADD_FAILURE() << "the tables in scenes/README.md are out of date; " << correct << " has them right";
}

TEST(SceneFormat, ReadmeNamesEveryKey) {
    const std::string text = read_text(readme());
    for (const char* key : {format::schema, format::version_key, format::camera, format::bookmarks, format::settings,
                            format::sky, format::materials, format::lights, format::definitions, format::root,
                            format::kind, format::name, format::of, format::material, format::children})
        EXPECT_NE(text.find(fmt::format("`{}`", key)), std::string::npos) << key;
    for (const char* kind : light_kind_keys)
        EXPECT_NE(text.find(fmt::format("\"{}\"", kind)), std::string::npos) << kind;
}

TEST(SceneFormat, ReadmeExamplesAreScenes) {
    const std::string text = read_text(readme());
    const std::string_view fence = "```json\n";
    int examples = 0;
    for (size_t at = text.find(fence); at != std::string::npos; at = text.find(fence, at)) {
        at += fence.size();
        const std::string example = text.substr(at, text.find("```", at) - at);
        if (example.find("\"farfield\"") == std::string::npos) continue;  // a piece of one
        SCOPED_TRACE(example);
        EXPECT_EQ(to_text(parse_scene(example, "README.md")), example);
        ++examples;
    }
    EXPECT_GE(examples, 1);
}

/// The keys by which values are found must differ from one another and from the format's own.
TEST(SceneFormat, KeysOfANodeDiffer) {
    for (const KindInfo& kind : node_kinds()) {
        std::vector<std::string_view> keys{format::kind, format::name, format::of, format::material, format::children};
        for (const Parameter& parameter : kind.parameters) keys.push_back(parameter.key);
        for (const Field<Transform>& field : fields<Transform>()) keys.push_back(field.parameter.key);
        std::sort(keys.begin(), keys.end());
        EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end()) << kind.key;
        EXPECT_EQ(find_kind(kind.key), kind.kind);
    }
}

}  // namespace
}  // namespace farfield
