// scenes/schema.json: it is the one that the program generates, and it accepts and refuses what the reader does. The
// schema is judged by Debian's python3-jsonschema.
#include "sdf/scene_schema.h"

#include "sdf/fields.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <set>

namespace farfield {
namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path shipped_schema() { return std::filesystem::path(FARFIELD_SCENES) / "schema.json"; }

/// For each text what the schema refuses; empty where it accepts.
std::vector<std::string> schema_problems(const std::vector<std::string>& texts) {
    const TemporaryFolder folder;
    std::string sequence;
    for (const std::string& text : texts) (sequence += '\x1e') += text;
    write_text(folder / "scenes", sequence);
    FILE* pipe = popen(fmt::format("/usr/bin/python3 '{}' '{}' '{}'", FARFIELD_VALIDATOR, shipped_schema().string(),
                                   (folder / "scenes").string())
                           .c_str(),
                       "r");
    if (!pipe) throw std::runtime_error("cannot start python3");
    std::vector<std::string> problems{""};
    std::array<char, 4096> buffer{};
    while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
        for (std::size_t i = 0; i < n; ++i)
            buffer[i] == '\n' ? problems.emplace_back() : problems.back() += buffer[i], void();
    problems.pop_back();
    if (pclose(pipe) != 0) throw std::runtime_error("the validator failed; is python3-jsonschema installed?");
    if (problems.size() != texts.size()) throw std::runtime_error("the validator skipped scenes");
    return problems;
}

std::string reader_problem(const std::string& text) {
    try {
        parse_scene(text, "a.json");
        return "";
    } catch (const SceneFileError& error) {
        return error.what();
    }
}

/// What no schema can say: names that are taken, materials and definitions that do not exist or have no end.
bool is_beyond_schemas(std::string_view problem) {
    return problem.find(" again, expected") != problem.npos || problem.find("there is no material") != problem.npos ||
           problem.find("there is no definition") != problem.npos ||
           problem.find("does not contain this instance") != problem.npos;
}

void expect_valid(const std::vector<std::string>& texts) {
    const std::vector<std::string> problems = schema_problems(texts);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        EXPECT_EQ(reader_problem(texts[i]), "") << texts[i];
        EXPECT_EQ(problems[i], "") << texts[i];
    }
}

void expect_refused(const std::vector<std::string>& texts) {
    const std::vector<std::string> problems = schema_problems(texts);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        EXPECT_NE(reader_problem(texts[i]), "") << texts[i];
        EXPECT_NE(problems[i], "") << texts[i];
    }
}

/// A scene with one node below the root, and with one object of each other type.
Json scene_with(Json node) {
    return {{"farfield", 1},
            {"camera", Json::object()},
            {"bookmarks", {{"b", Json::object()}}},
            {"settings", Json::object()},
            {"sky", Json::object()},
            {"materials", {{"m", Json::object()}}},
            {"lights", {{"p", {{"kind", "point"}}}, {"d", {{"kind", "directional"}}}}},
            {"root", {{"kind", "union"}, {"children", {std::move(node)}}}}};
}

/// Every value that a scene can have: a scene, the place of the object in it, and the parameter.
template <class Visitor>
void for_each_parameter(Visitor visit) {
    const Json with_sphere = scene_with({{"kind", "sphere"}});
    const auto visit_fields = [&]<class T>(const char* place, T object, auto applies) {
        for (const Field<T>& field : fields<T>())
            if (applies(object, field.parameter.key)) visit(with_sphere, Json::json_pointer(place), field.parameter);
    };
    const auto always = [](const auto&, std::string_view) { return true; };
    Light directional;
    directional.kind = LightKind::directional;
    visit_fields("/camera", Camera{}, always);
    visit_fields("/bookmarks/b", Camera{}, always);
    visit_fields("/settings", Settings{}, always);
    visit_fields("/sky", Sky{}, always);
    visit_fields("/materials/m", Material{}, always);
    visit_fields("/lights/p", Light{}, applies);
    visit_fields("/lights/d", directional, applies);
    visit_fields("/root/children/0", Transform{}, always);
    for (const KindInfo& kind : node_kinds())
        for (const Parameter& parameter : kind.parameters)
            visit(scene_with({{"kind", kind.key}}), Json::json_pointer("/root/children/0"), parameter);
}

/// `component` wherever the parameter takes a number or switch.
Json value_of(const Parameter& parameter, const Json& component) {
    if (parameter.components() == 1) return component;
    return {component, component, component};
}

TEST(SceneSchema, TheShippedFileIsTheGeneratedOne) {
    if (read_text(shipped_schema()) == scene_schema()) return;
    const auto correct = std::filesystem::temp_directory_path() / "farfield-scenes-schema.json";
    write_text(correct, scene_schema());
    ADD_FAILURE() << "scenes/schema.json is out of date; " << correct << " has it right";
}

TEST(SceneSchema, AcceptsBundledAndRandomScenes) {
    std::vector<std::string> texts;
    for (const auto& file : bundled_scenes()) texts.push_back(read_text(file));
    for (unsigned seed = 0; seed < 200; ++seed) texts.push_back(to_text(random_scene(seed, 12)));
    expect_valid(texts);
}

TEST(SceneSchema, AcceptsTheLimitsOfEveryParameter) {
    std::vector<std::string> texts;
    for_each_parameter([&](Json scene, const Json::json_pointer& place, const Parameter& parameter) {
        Json& object = scene[place];
        std::vector<Json> values;
        if (parameter.type == ParameterType::choice)
            values.assign(parameter.choices.begin(), parameter.choices.end());
        else if (parameter.type == ParameterType::flags)
            values = {{true, false, true}};
        else  // as the writer writes them: the shortest text that reads back the same
            for (const float v : {parameter.minimum, parameter.maximum})
                values.push_back(value_of(parameter, Json::parse(fmt::format("{}", v))));
        if (parameter.word) values.push_back(parameter.word);
        for (const Json& value : values) {
            object[parameter.key] = value;
            texts.push_back(scene.dump());
        }
    });
    EXPECT_GT(texts.size(), 200u);
    expect_valid(texts);
}

TEST(SceneSchema, RefusesWrongValuesOfEveryParameter) {
    std::vector<std::string> texts;
    for_each_parameter([&](Json scene, const Json::json_pointer& place, const Parameter& parameter) {
        Json& object = scene[place];
        const auto add = [&](const Json& value) {
            object[parameter.key] = value;
            texts.push_back(scene.dump());
        };
        for (const Json& wrong_type : {Json("text"), Json(nullptr), Json::object(), Json::array()}) add(wrong_type);
        if (parameter.type == ParameterType::choice || parameter.components() == 3) {
            add(0.5);
            add(true);
        }
        if (parameter.type == ParameterType::choice) return;
        if (parameter.components() == 3) {
            Json two = value_of(parameter, parameter.type == ParameterType::flags ? Json(true) : Json(1)), four = two;
            two.erase(2);
            four.push_back(four[0]);
            add(two);
            add(four);
            add(value_of(parameter, "1"));
        }
        if (parameter.type == ParameterType::flags) {
            add({1, 0, 0});
            return;
        }
        const float width = parameter.maximum - parameter.minimum;
        add(value_of(parameter, parameter.minimum - 0.01f * width));
        add(value_of(parameter, parameter.maximum + 0.01f * width));
        if (parameter.word) add(parameter.lowest());
        add(value_of(parameter, true));
        if (parameter.is_whole()) {
            add(value_of(parameter, 1.5));
            add(value_of(parameter, 1.00000001));  // which single precision cannot tell from 1
        }
    });
    EXPECT_GT(texts.size(), 500u);
    expect_refused(texts);
}

TEST(SceneSchema, RefusesWrongStructure) {
    const Json good = scene_with({{"kind", "sphere"}});
    ASSERT_EQ(reader_problem(good.dump()), "");
    std::vector<std::string> texts{"[]", "1", "{}"};
    const auto add = [&](const char* place, const Json& value) {
        Json scene = good;
        scene[Json::json_pointer(place)] = value;
        texts.push_back(scene.dump());
    };
    for (const char* key : {"farfield", "root"}) {
        Json without = good;
        without.erase(key);
        texts.push_back(without.dump());
    }
    for (const char* object : {"", "/camera", "/bookmarks", "/bookmarks/b", "/settings", "/sky", "/materials/m",
                               "/lights/p", "/lights/d", "/root", "/root/children/0"}) {
        add(fmt::format("{}/unknown", object).c_str(), 1);
        if (*object)
            for (const Json& wrong_type : {Json("text"), Json(1), Json::array(), Json(nullptr)})
                add(object, wrong_type);
    }
    for (const Json& version : {Json(0), Json(2), Json(1.5), Json("1"), Json(true)}) add("/farfield", version);
    add("/$schema", 1);
    add("/materials", Json::object());
    for (const char* name : {"", "a\nb", "\n", "a\n", "\x7f"})
        for (const char* list : {"materials", "lights", "bookmarks"}) {
            Json scene = good;
            scene[list][name] = list == std::string("lights") ? Json{{"kind", "point"}} : Json::object();
            texts.push_back(scene.dump());
        }
    for (const Json& name : {Json(""), Json("a\tb"), Json("a\n"), Json(1), Json(nullptr)}) add("/root/name", name);
    add("/root/material", 1);
    for (const Json& kind : {Json("blob"), Json("Union"), Json(""), Json(1), Json(nullptr)}) {
        add("/root/kind", kind);
        add("/root/children/0/kind", kind);
        add("/lights/p/kind", kind);
    }
    for (const char* no_kind : {"/root", "/root/children/0", "/lights/p"}) add(no_kind, Json::object());
    add("/lights/p/direction", {0, -1, 0});
    add("/lights/d/position", {0, 1, 0});
    add("/lights/d/direction", {0, 0.0, 0});
    add("/root/children", Json::object());
    add("/root/children/0", 1);
    for (const KindInfo& kind : node_kinds()) {
        Json scene = scene_with({{"kind", kind.key}, {"not_its_own", 1}});
        if (kind.kind != NodeKind::custom) texts.push_back(scene.dump());  // what code declares no schema can know
        if (kind.kind != NodeKind::union_) add("/root/kind", kind.key);
        if (kind.takes_children()) continue;
        scene = scene_with({{"kind", kind.key}, {"children", Json::array()}});
        texts.push_back(scene.dump());
    }
    expect_refused(texts);
}

/// Whether a schema can know what the member takes: of a custom node not what its code declares.
bool can_be_known(const Json& object, const std::string& key) {
    static const std::set<std::string> own{"kind",   "name",      "material", "code",
                                           "bounds", "translate", "rotate",   "scale"};
    const bool custom = object.contains("kind") && object["kind"] == "custom";
    return !custom || own.contains(key);
}

/// The place of a random value below `json`.
Json* random_place(Json& json, std::mt19937& random) {
    Json* place = &json;
    while (place->is_structured() && !place->empty() && random() % 5) {
        auto member = place->begin();
        std::advance(member, random() % place->size());
        if (place->is_object() && !can_be_known(*place, member.key())) break;
        place = &*member;
    }
    return place;
}

TEST(SceneSchema, AgreesWithTheReaderAboutRandomMistakes) {
    std::mt19937 random(1);
    const Json replacements[] = {nullptr,
                                 true,
                                 0,
                                 1,
                                 -1,
                                 2.5,
                                 1e7,
                                 "",
                                 "sphere",
                                 "a\nb",
                                 "point",
                                 "union",
                                 Json::array(),
                                 Json::object(),
                                 {1, 2},
                                 {0, 0, 0},
                                 {1, 2, 3},
                                 {1, 2, 3, 4},
                                 {{"kind", "box"}}};
    const char* keys[] = {"kind", "name", "material", "children", "radius", "scale", "position", "direction", "blob"};
    std::vector<std::string> texts;
    for (int i = 0; i < 600; ++i) {
        Json scene = Json::parse(to_text(random_scene(static_cast<unsigned>(random() % 50), 6)));
        Json& place = *random_place(scene, random);
        const char* key = keys[random() % std::size(keys)];
        if (place.is_object() && can_be_known(place, key) && random() % 2)
            place[key] = replacements[random() % std::size(replacements)];
        else
            place = replacements[random() % std::size(replacements)];
        texts.push_back(scene.dump());
    }
    const std::vector<std::string> problems = schema_problems(texts);
    int refused = 0;
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const std::string problem = reader_problem(texts[i]);
        if (is_beyond_schemas(problem)) continue;
        EXPECT_EQ(problem.empty(), problems[i].empty())
            << texts[i] << "\nreader: " << problem << "\nschema: " << problems[i];
        refused += !problem.empty();
    }
    EXPECT_GT(refused, 300);
}

TEST(SceneSchema, FilesKeepTheirReferenceToIt) {
    const std::string text = R"({
  "$schema": "schema.json",
  "farfield": 1,
  "materials": {
    "default": {}
  },
  "root": {
    "kind": "union"
  }
}
)";
    EXPECT_EQ(to_text(parse_scene(text, "a.json")), text);
    expect_valid({text});
}

}  // namespace
}  // namespace farfield
