// Nodes with code of the user's own: files, edits, bounds, generated code, and what may run.
#include "sdf/code_trust.h"
#include "sdf/codegen.h"
#include "sdf/history.h"
#include "sdf/evaluate.h"
#include "sdf/scene_file.h"
#include "tests/custom_code_samples.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace farfield {
namespace {

constexpr const char* ball =
    "// A ball\nuniform float radius = 0.5;  // [0.1, 0.8] m  Radius\nuniform int folds = 2;  // [0, 4]\n"
    "float sdf(vec3 p) { return length(p) - radius; }";

struct Custom {
    explicit Custom(const std::string& text, const char* name = "blob") {
        Node node = make_node(NodeKind::custom);
        node.name = name;
        id = apply(scene, InsertNode{scene.root.id, -1, node});
        apply(scene, SetCode{id, text});
    }
    const Node& node() const { return *find_node(scene, id); }
    float value(const char* key) const { return farfield::value(scene, {ObjectType::node, id}, key).x; }
    void set(const char* key, glm::vec3 v) { set_value(scene, {ObjectType::node, id}, key, v); }
    Scene scene;
    Id id;
};

std::string with_code(const std::string& code, const std::string& more = "") {
    return "{\n \"farfield\": 1,\n \"root\": {\"kind\": \"union\", \"children\": [\n  {\"kind\": \"custom\", \"name\": "
           "\"blob\", " +
           more + "\"code\":\n" + code + "}\n ]}\n}\n";
}

std::string error_of(const std::string& text) {
    try {
        parse_scene(text, "a.json");
    } catch (const SceneFileError& error) {
        return error.what();
    }
    return "";
}

TEST(CustomNode, CodeAndValuesSurviveSavingAndLoading) {
    for (const std::string& text : {std::string(ball), std::string(ball) + "\n", "\n\n" + std::string(ball) + "\n\n",
                                    std::string("// \"quoted\" \t\\n \u00fc\r\n") + ball}) {
        Custom custom(text);
        custom.set("radius", {0.3f, 0.0f, 0.0f});
        custom.set("bounds", {1.0f, 0.0f, 2.0f});
        const std::string file = to_text(custom.scene);
        const Scene again = parse_scene(file, "a.json");
        const Node& node = again.root.children.at(0);
        EXPECT_EQ(node.code->text(), text);
        EXPECT_EQ(node.values, custom.node().values);
        EXPECT_EQ(to_text(again), file);
    }
}

TEST(CustomNode, ErrorsInAFileNameItsLineAndThatOfTheCode) {
    EXPECT_EQ(error_of(with_code("[\"// a\",\n\"float sdf(vec3 p) {\",\n\"    return radus;\",\n\"}\"]")),
              "a.json:7: root/children[0] \"blob\"/code[2]: line 3 of the code: 'radus': undeclared identifier");
    EXPECT_NE(error_of(with_code("[\"float sdf(vec3 p) { while (true) {} return 1.0; }\"]")).find("a.json:5: "),
              std::string::npos);
    EXPECT_NE(error_of(with_code("[]")).find("code: found an array of 0, expected an array of the lines"),
              std::string::npos);
    EXPECT_NE(error_of(with_code("\"float sdf(vec3 p) { return 1.0; }\"")).find("expected an array of the lines"),
              std::string::npos);
    EXPECT_NE(error_of(with_code("[\"\",\n3]")).find("a.json:6: root/children[0] \"blob\"/code[1]: found 3"),
              std::string::npos);
    EXPECT_NE(error_of(with_code("[\"a\\nb\"]")).find("line break"), std::string::npos);
    const std::string code = "[\"uniform float size = 0.5; // [0, 1]\",\"float sdf(vec3 p) { return size; }\"]";
    EXPECT_EQ(error_of(with_code(code, "\"size\": 0.75, ")), "");
    EXPECT_NE(error_of(with_code(code, "\"size\": 2, ")).find("found 2, expected a number between 0 and 1"),
              std::string::npos);
    EXPECT_NE(error_of(with_code(code, "\"sise\": 2, ")).find("(perhaps size)"), std::string::npos);
    EXPECT_NE(error_of("{\"farfield\": 1, \"root\": {\"kind\": \"union\", \"code\": [\"\"]}}").find("unknown key"),
              std::string::npos);
}

TEST(CustomNode, AFileHoldsALimitedNumberOfCodes) {
    const auto scene_of = [](int count) {
        std::string nodes;
        for (int i = 0; i < count; ++i)
            nodes += fmt::format("{}{{\"kind\": \"custom\", \"code\": [\"float sdf(vec3 p) {{ return {}.0; }}\"]}}",
                                 i > 0 ? ", " : "", i);
        return "{\"farfield\": 1, \"root\": {\"kind\": \"union\", \"children\": [" + nodes + "]}}";
    };
    EXPECT_EQ(error_of(scene_of(256)), "");
    EXPECT_NE(error_of(scene_of(257)).find("at most 256 different ones"), std::string::npos);
}

/// Careless hands at the code of a file: a scene that can be saved again, or an error within the code's lines.
TEST(CustomNode, BrokenCodeInAFileIsRefusedWithItsLine) {
    int read = 0, refused = 0;
    for (unsigned seed = 0; seed < 600; ++seed) {
        nlohmann::json lines = nlohmann::json::array();
        std::string text = mutated_code(seed);
        for (std::size_t start = 0; start <= text.size();) {
            const std::size_t end = std::min(text.find('\n', start), text.size());
            lines.push_back(text.substr(start, end - start));
            start = end + 1;
        }
        std::string file;
        try {
            file = with_code(lines.dump(0));
        } catch (const nlohmann::json::exception&) {
            continue;  // not UTF-8
        }
        try {
            const std::string again = to_text(parse_scene(file, "a.json"));
            EXPECT_EQ(to_text(parse_scene(again, "a.json")), again);
            ++read;
        } catch (const SceneFileError& error) {
            EXPECT_GT(error.line, 4);
            EXPECT_LE(error.line, static_cast<int>(lines.size()) + 6);
            EXPECT_NE(error.path.find("code"), std::string::npos) << error.what();
            ++refused;
        }
    }
    EXPECT_GT(read, 20);
    EXPECT_GT(refused, 200);
}

TEST(CustomNode, ValuesFollowTheCode) {
    Custom custom(ball);
    custom.set("radius", glm::vec3(0.7f));
    custom.set("folds", glm::vec3(3.0f));
    custom.set("bounds", glm::vec3(2.0f));
    apply(custom.scene, SetCode{custom.id,
                                "uniform vec3 folds = vec3(1.0);\nuniform float radius = 0.2; // [0, 0.4]\n"
                                "float sdf(vec3 p) { return 1.0; }"});
    EXPECT_EQ(custom.value("radius"), 0.4f);                 // brought into the new range
    EXPECT_EQ(custom.node().values.at(1), glm::vec3(1.0f));  // of another type: as new
    EXPECT_EQ(custom.node().values.at(0), glm::vec3(2.0f));  // bounds belong to every code
    apply(custom.scene, SetCode{custom.id, ball});
    EXPECT_EQ(custom.value("radius"), 0.4f);
    EXPECT_EQ(custom.value("folds"), 2.0f);
    apply(custom.scene, SetKind{custom.id, NodeKind::sphere});
    EXPECT_EQ(custom.value("radius"), 0.4f);
    EXPECT_EQ(custom.node().code, nullptr);
    EXPECT_THROW(apply(custom.scene, SetCode{custom.id, ball}), EditError);
}

TEST(CustomNode, BadCodeIsRefusedWithItsLinesAndUndoBringsTheOldOneBack) {
    History history{Custom(ball).scene};
    const Id id = history.scene().root.children.at(0).id;
    try {
        history.apply(SetCode{id, "float sdf(vec3 p) {\n    return foo\n         + bar;\n}"});
        FAIL() << "nothing refused";
    } catch (const EditError& error) {
        EXPECT_NE(std::string(error.what()).find("line 2: 'foo'"), std::string::npos) << error.what();
    }
    EXPECT_EQ(history.scene().root.children[0].code->text(), ball);
    EXPECT_FALSE(history.can_undo());
    const std::string before = to_text(history.scene());
    history.apply(SetCode{id, "float sdf(vec3 p) { return 1.0; }"});
    EXPECT_EQ(history.steps(), std::vector<std::string>{"code of blob"});
    history.undo();
    EXPECT_EQ(to_text(history.scene()), before);
    Node without = make_node(NodeKind::custom);
    without.code = nullptr;
    EXPECT_THROW(history.apply(InsertNode{history.scene().root.id, -1, without}), EditError);
}

/// Outside of its box a node shows nothing, whatever the code says; the declared constant divides.
TEST(CustomNode, IsCutOffAtItsBounds) {
    Custom custom("const float lipschitz = 4.0;\nfloat sdf(vec3 p) { return 4.0 * (length(p) - 10.0); }");
    custom.set("bounds", {1.0f, 2.0f, 0.0f});
    const FieldEvaluator field(custom.scene);
    EXPECT_NEAR(field.distance({3.0f, 0.0f, 0.0f}), 2.0f, 1e-6f);
    EXPECT_NEAR(field.distance({0.5f, 0.0f, 0.0f}), -0.5f, 1e-6f);
    EXPECT_NEAR(field.distance({0.0f, 0.0f, 11.0f}), 1.0f, 1e-5f);  // no end along z: the code's own
    const Box box = field.tree().bounds();
    EXPECT_NEAR(box.high.x, 1.0f, 1e-4f);
    EXPECT_NEAR(box.low.y, -2.0f, 1e-4f);
    EXPECT_FALSE(box.is_bounded(2));
    EXPECT_EQ(find(*field.tree().root, custom.id)->stretch(), 4.0f);
}

TEST(CustomNode, WhatIsNoNumberCountsAsEmpty) {
    for (const char* expression : {"p.x / 0.0", "sqrt(p.x - 9.0)", "1.0 / 0.0", "-1.0 / 0.0", "log(-abs(p.x))"}) {
        const Custom custom(fmt::format("float sdf(vec3 p) {{ return {}; }}", expression));
        const FieldEvaluator field(custom.scene);
        for (const glm::vec3 p : {glm::vec3(0.0f), glm::vec3(0.5f), glm::vec3(-3.0f), glm::vec3(1e6f)})
            EXPECT_TRUE(std::isfinite(field.distance(p))) << expression;
    }
    EXPECT_GT(FieldEvaluator(Custom("float sdf(vec3 p) { return sqrt(-1.0 - abs(p.x)); }").scene).distance({}), 1e6f);
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
    return found;
}

TEST(CustomNode, GeneratedCodeHasItOnceUnderTheNameOfItsNode) {
    const Custom custom(
        "// Any comment, also of a torus\nfloat half_of(float x) { return 0.5 * x; }\n"
        "float sdf(vec3 p) { return smooth_union(sphere(p, half_of(1.0)), p.y, 0.1); }",
        "my blob, 2nd");
    for (const Tier tier : {Tier::specialised, Tier::live}) {
        const GeneratedScene generated = generate(custom.scene, tier);
        EXPECT_EQ(count(generated.text, "float sdf_MyBlob2Nd(vec3 p) {"), 1u) << generated.text;
        EXPECT_EQ(count(generated.text, "// Any comment, also of a torus"), 1u);
        EXPECT_EQ(count(generated.text, "float sphere(vec3 p"), 1u);
        EXPECT_EQ(count(generated.text, "float smooth_union(float a"), 1u);
        EXPECT_EQ(count(generated.text, "float torus("), 0u);
        // Its lines belong to it, from the comment to the end of the function that bounds it.
        std::size_t line = static_cast<std::size_t>(std::count(
            generated.text.begin(),
            generated.text.begin() + static_cast<std::ptrdiff_t>(generated.text.find("// Any comment")), '\n'));
        for (int i = 0; i < 3; ++i) EXPECT_EQ(generated.line_nodes.at(line++), custom.id);
    }
}

TEST(CustomNode, NamesOfSeveralNodesNeverMeet) {
    Scene scene;
    for (const char* name : {"", "a b", "a  b", "\u00e4\u00f6", "custom 2", "1", "x", "distance", ""}) {
        Node node = make_node(NodeKind::custom);
        node.name = name;
        apply(scene, InsertNode{scene.root.id, -1, node});
    }
    const std::string text = generate(scene, Tier::specialised).text;
    for (const char* suffix : {"Custom1", "Ab", "AB", "AB2", "Custom2", "XCustom", "Distance"})
        EXPECT_LE(count(text, fmt::format("float sdf_{}(vec3 p) {{", suffix)), 1u) << suffix;
    EXPECT_EQ(count(text, "(vec3 p) {\n    float k"), scene.root.children.size());
    std::set<std::string> names;
    for (std::size_t at = text.find("float sdf_"); at != text.npos; at = text.find("float sdf_", at + 1))
        EXPECT_TRUE(names.insert(text.substr(at, text.find('(', at) - at)).second);
    EXPECT_EQ(names.size(), 2 * scene.root.children.size());
}

TEST(CustomNode, TheKeyFollowsTheCodeAndNotTheName) {
    for (const Tier tier : {Tier::specialised, Tier::live}) {
        Custom custom(ball);
        const GeneratedScene before = generate(custom.scene, tier);
        apply(custom.scene, SetName{{ObjectType::node, custom.id}, "another"});
        EXPECT_EQ(generate(custom.scene, tier).key, before.key);
        EXPECT_NE(generate(custom.scene, tier).text, before.text);
        custom.set("radius", glm::vec3(0.25f));
        custom.set("bounds", glm::vec3(0.5f));
        const GeneratedScene moved = generate(custom.scene, tier);
        EXPECT_EQ(moved.key == before.key, tier == Tier::live);
        EXPECT_EQ(moved.parameters == before.parameters, tier == Tier::specialised);
        EXPECT_EQ(generate(custom.scene, tier, custom.id).parameters.empty(), false);
        apply(custom.scene, SetCode{custom.id, std::string(ball) + "// more"});
        EXPECT_NE(generate(custom.scene, tier).key, moved.key);
    }
}

TEST(CodeTrust, KnowsWhatComesWithTheProgramAndNothingElse) {
    const CodeTrust trust;
    EXPECT_TRUE(trust.knows(*default_custom_code()));
    int codes = 0;
    for (const auto& file : bundled_scenes()) {
        const Scene scene = load_scene(file);
        EXPECT_TRUE(unknown_code(scene, trust).empty()) << file;
        const std::function<void(const Node&)> visit = [&](const Node& node) {
            if (node.code) ++codes;
            for (const Node& child : node.children) visit(child);
        };
        visit(scene.root);
    }
    EXPECT_GE(codes, 1);
    const Custom custom(ball);
    const auto unknown = unknown_code(custom.scene, trust);
    ASSERT_EQ(unknown.size(), 1u);
    EXPECT_EQ(unknown[0].path, "root \"scene\"/children[0] \"blob\"");
}

TEST(CodeTrust, IsRememberedInAFile) {
    const TemporaryFolder folder;
    const auto file = folder / "config/farfield/trusted";
    const Custom custom(ball), other("float sdf(vec3 p) { return 1.0; }");
    CodeTrust first(file), second(file);
    first.accept(*custom.node().code);
    second.accept(*other.node().code);  // neither loses what the other wrote
    const CodeTrust later(file);
    EXPECT_TRUE(later.knows(*custom.node().code));
    EXPECT_TRUE(later.knows(*other.node().code));
    write_text(file, "no hash\n" + std::string(100'000, 'a') + "\n" + custom.node().code->hash());
    EXPECT_FALSE(CodeTrust(file).knows(*other.node().code));
    // As many as anyone needs, the newest.
    std::string many;
    for (int i = 0; i < 6000; ++i) many += fmt::format("{:064x}\n", i);
    write_text(file, many);
    CodeTrust full(file);
    full.accept(*custom.node().code);
    EXPECT_LE(read_text(file).size(), 65u * 4096u);
    EXPECT_TRUE(CodeTrust(file).knows(*custom.node().code));
}

TEST(CodeTrust, NeedsNoFile) {
    const TemporaryFolder folder;
    write_text(folder / "file", "");
    const Custom custom(ball);
    for (const auto& file :
         {std::filesystem::path(), folder / "file/below", std::filesystem::path("/proc/no/trusted"), folder / ""}) {
        CodeTrust trust(file);
        trust.accept(*custom.node().code);
        EXPECT_TRUE(trust.knows(*custom.node().code)) << file;
    }
}

TEST(CodeTrust, UnknownCodeIsLeftOutOfWhatIsShown) {
    const Custom custom(ball);
    CodeTrust trust;
    const Scene shown = without_unknown_code(custom.scene, trust);
    EXPECT_EQ(generate(shown, Tier::specialised).text.find("sdf_"), std::string::npos);
    EXPECT_EQ(count_nodes(shown.root), count_nodes(custom.scene.root));
    trust.accept(*custom.node().code);
    EXPECT_NE(generate(without_unknown_code(custom.scene, trust), Tier::specialised).text.find("sdf_"),
              std::string::npos);
}

TEST(CodeTrust, AsksForCodeInDefinitionsToo) {
    Custom custom(ball);
    const Id instance = apply(custom.scene, MakeDefinition{custom.node().id});
    ASSERT_EQ(custom.scene.definitions.size(), 1u);
    EXPECT_NE(generate(custom.scene, Tier::specialised).text.find("sdf_"), std::string::npos);
    CodeTrust trust;
    const auto unknown = unknown_code(custom.scene, trust);
    ASSERT_EQ(unknown.size(), 1u);
    EXPECT_EQ(unknown[0].path, "definitions[0] \"blob\"");
    const Scene shown = without_unknown_code(custom.scene, trust);
    EXPECT_EQ(generate(shown, Tier::specialised).text.find("sdf_"), std::string::npos);
    EXPECT_TRUE(is_empty(shown, *find_node(shown, instance)));
}

}  // namespace
}  // namespace farfield
