// What a scene file must not hold: each kind of mistake gives its own message, at the right line and path.
#include "sdf/scene_file.h"

#include "tests/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace farfield {
namespace {

/// A small scene that has one of each thing, its version on line 2 and its first child on line 15.
const std::string small = R"({
  "farfield": 1,
  "camera": {
    "position": [0, 1, 4]
  },
  "materials": {
    "white": {},
    "red": {
      "albedo": [0.6, 0.1, 0.1]
    }
  },
  "root": {
    "kind": "union",
    "children": [
      {
        "kind": "sphere",
        "name": "ball",
        "material": "red",
        "radius": 0.5
      },
      {
        "kind": "subtract",
        "name": "cut"
      }
    ]
  }
}
)";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

/// Reads `text`, which must fail, and checks the whole message.
void expect_error(const std::string& text, int line, const std::string& path, const std::string& problem) {
    try {
        parse_scene(text, "a.json");
        ADD_FAILURE() << "no error; expected: " << problem;
    } catch (const SceneFileError& error) {
        EXPECT_EQ(error.line, line) << error.what();
        EXPECT_EQ(error.path, path);
        EXPECT_EQ(error.problem, problem);
        EXPECT_EQ(error.file, "a.json");
        EXPECT_EQ(std::string(error.what()),
                  "a.json:" + std::to_string(line) + ": " + (path.empty() ? "" : path + ": ") + problem);
    }
}

/// As above, after an edit of the small scene.
void expect_error(std::string_view from, std::string_view to, int line, const std::string& path,
                  const std::string& problem) {
    SCOPED_TRACE(to);
    expect_error(replaced(small, from, to), line, path, problem);
}

TEST(SceneFile, SmallSceneIsReadCompletely) {
    const Scene scene = parse_scene(small, "a.json");
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.materials[1].name, "red");
    EXPECT_EQ(scene.materials[1].albedo, glm::vec3(0.6f, 0.1f, 0.1f));
    EXPECT_EQ(scene.camera.position, glm::vec3(0, 1, 4));
    EXPECT_EQ(scene.camera.target, Camera{}.target);
    ASSERT_EQ(scene.root.children.size(), 2u);
    const Node& ball = scene.root.children[0];
    EXPECT_EQ(ball.kind, NodeKind::sphere);
    EXPECT_EQ(ball.name, "ball");
    EXPECT_EQ(ball.material, scene.materials[1].id);
    EXPECT_EQ(scene.root.children[1].kind, NodeKind::subtract);
    EXPECT_EQ(to_text(scene), replaced(small, R"(,
        "radius": 0.5)",
                                       ""));  // the sphere's default
}

TEST(SceneFileError, Syntax) {
    expect_error("", 1, "", "not valid JSON: unexpected end of input, expected '[', '{', or a literal");
    expect_error("\n\n  hello", 3, "",
                 "not valid JSON: unknown word, expected a text, a finite number, true, false, an array or an object");
    expect_error("0.5\n", ",,\n", 19, "root/children[0] \"ball\"/radius",
                 "not valid JSON: unexpected ',', expected '[', '{', or a literal");
    expect_error("\"red\",\n", "\"red\"\n", 19, "root/children[0] \"ball\"/material",
                 "not valid JSON: unexpected string literal, expected '}'");
    expect_error(small + std::string("\0{}", 3), 28, "", "not valid JSON: a zero byte, expected text alone");
    expect_error(std::string("{\n\0}", 4), 2, "", "not valid JSON: a zero byte, expected text alone");
    expect_error(small + "{}", 28, "", "not valid JSON: unexpected '{', expected end of input");
    expect_error(small.substr(0, small.find("0.5") + 3), 19, "root/children[0] \"ball\"/radius",
                 "not valid JSON: unexpected end of input, expected '}'");
}

TEST(SceneFileError, LinesAreCountedAlikeWithAnyLineEnd) {
    std::string text = "\xef\xbb\xbf";  // byte-order mark
    for (char c : replaced(small, "0.5", "-1")) text += c == '\n' ? "\r\n" : std::string(1, c);
    expect_error(text, 19, "root/children[0] \"ball\"/radius",
                 "found -1, expected a number at least 0 (and at most 1e+06)");
}

TEST(SceneFileError, NotANumber) {
    for (const char* text : {"NaN", "nan", "Infinity", "-Infinity"}) {
        SCOPED_TRACE(text);
        try {
            parse_scene(replaced(small, "0.5", text), "a.json");
            ADD_FAILURE();
        } catch (const SceneFileError& error) {
            EXPECT_EQ(error.line, 19);
            EXPECT_EQ(error.path, "root/children[0] \"ball\"/radius");
        }
    }
    expect_error("0.5", "1e999", 19, "root/children[0] \"ball\"/radius",
                 "a number is too large, expected a finite number");
    expect_error("0.5", "1e99", 19, "root/children[0] \"ball\"/radius",
                 "found 1e+99, expected a number at least 0 (and at most 1e+06)");
}

TEST(SceneFileError, DuplicateKey) {
    expect_error("\"radius\": 0.5", "\"radius\": 0.5,\n\"radius\": 1", 20, "root/children[0] \"ball\"/radius",
                 "is given twice, expected once (the first is on line 19)");
    expect_error("\"red\": {", "\"white\": {", 8, "materials/white",
                 "is given twice, expected once (the first is on line 7)");
}

TEST(SceneFileError, Version) {
    expect_error("  \"farfield\": 1,\n", "", 1, "", "has no \"farfield\", expected the format's version, which is 1");
    expect_error("\"farfield\": 1", "\"farfield\": 2", 2, "farfield",
                 "the file has version 2, expected at most 1: it needs a newer Farfield");
    expect_error("\"farfield\": 1", "\"farfield\": 0", 2, "farfield", "found 0, expected version 1");
    expect_error("\"farfield\": 1", "\"farfield\": \"1\"", 2, "farfield", "found \"1\", expected version 1");
    expect_error("[]", 1, "", "found an array of 0, expected an object that describes a scene");
}

TEST(SceneFileError, UnknownKey) {
    expect_error("\"radius\"", "\"raduis\"", 19, "root/children[0] \"ball\"/raduis",
                 "unknown key, expected one of kind, name, material, hidden, locked, radius, translate, rotate, scale "
                 "(perhaps radius)");
    expect_error("\"camera\"", "\"kamera\"", 3, "kamera",
                 "unknown key, expected one of $schema, farfield, camera, bookmarks, settings, sky, materials, lights, "
                 "definitions, root "
                 "(perhaps camera)");
    expect_error("\"materials\"", "\"bookmarks\": {\"door\": {\n\"zoom\": 1}},\n\"materials\"", 7,
                 "bookmarks/door/zoom", "unknown key, expected one of position, target, field_of_view");
    expect_error("\"position\"", "\"zoom\"", 4, "camera/zoom",
                 "unknown key, expected one of position, target, field_of_view");
    expect_error("\"albedo\"", "\"color\"", 9, "materials/red/color",
                 "unknown key, expected one of albedo, specular, exponent, emission");
    expect_error("\"materials\"",
                 "\"lights\": {\"a\": {\"kind\": \"point\",\n\"direction\": [0, 1, 0]}}, \"materials\"", 7,
                 "lights/a/direction", "unknown key, expected one of kind, position, intensity");
}

TEST(SceneFileError, WrongType) {
    expect_error("0.5", "\"big\"", 19, "root/children[0] \"ball\"/radius",
                 "found \"big\", expected a number at least 0 (and at most 1e+06)");
    expect_error("0.5", "null", 19, "root/children[0] \"ball\"/radius",
                 "found null, expected a number at least 0 (and at most 1e+06)");
    expect_error("[0, 1, 4]", "[0, 1]", 4, "camera/position",
                 "found an array of 2, expected three numbers, each between -1e+06 and 1e+06");
    expect_error("[0, 1, 4]", "[0,\n true,\n 4]", 5, "camera/position[1]", "found true, expected a number");
    expect_error(
        "\"union\"", "{}", 13, "root/kind",
        "found an object, expected one of sphere, box, rounded_box, torus, capsule, capped_cylinder, cone, plane, "
        "...");
    expect_error("\"name\": \"ball\"", "\"name\": 1", 17, "root/children[0]/name", "found 1, expected a text");
    expect_error("\"red\",\n", "3,\n", 18, "root/children[0] \"ball\"/material",
                 "found 3, expected the name of a material");
    expect_error("\"white\": {}", "\"white\": []", 7, "materials/white",
                 "found an array of 0, expected an object that describes a material");
    expect_error("\"kind\": \"subtract\"", "\"kind\": \"subtract\",\n\"children\": {}", 23,
                 "root/children[1] \"cut\"/children", "found an object, expected an array of nodes");
    expect_error("\"name\": \"cut\"", "\"name\": \"cut\",\n\"children\": [3]", 24,
                 "root/children[1] \"cut\"/children[0]", "found 3, expected an object that describes a node");
}

TEST(SceneFileError, OutOfRange) {
    expect_error("0.5", "-1", 19, "root/children[0] \"ball\"/radius",
                 "found -1, expected a number at least 0 (and at most 1e+06)");
    expect_error("[0.6, 0.1, 0.1]", "[0.6, 0.1,\n1.5]", 10, "materials/red/albedo[2]",
                 "found 1.5, expected three numbers, each between 0 and 1");
    expect_error("\"camera\"", "\"settings\": {\"samples\": 2.5},\n\"camera\"", 3, "settings/samples",
                 "found 2.5, expected a whole number between 1 and 64");
    expect_error("\"camera\"", "\"settings\": {\"samples\": 2.00000001},\n\"camera\"", 3, "settings/samples",
                 "found 2.00000001, expected a whole number between 1 and 64");
    expect_error("\"farfield\"", "\"$schema\": 1,\n\"farfield\"", 2, "$schema",
                 "found 1, expected a text, where the format's JSON Schema is");
    expect_error("\"camera\"", "\"settings\": {\"bounces\": 0},\n\"camera\"", 3, "settings/bounces",
                 "found 0, expected a whole number between 1 and 8, or \"auto\"");
    expect_error("\"camera\"", "\"settings\": {\"method\": \"papr\"},\n\"camera\"", 3, "settings/method",
                 "found \"papr\", expected one of paper, farfield, reference (perhaps paper)");
    expect_error("\"root\"", "\"lights\": {\"sun\": {\"kind\": \"directional\",\n\"direction\": [0, 0, 0]}},\n\"root\"",
                 13, "lights/sun/direction", "found a vector of length 0, expected a direction");
}

TEST(SceneFileError, FlagsAreTrueOrFalse) {
    const std::string mirrored =
        replaced(small, "\"kind\": \"subtract\"", "\"kind\": \"mirror\", \"axes\": [true, false, true]");
    const Scene scene = parse_scene(mirrored, "a.json");
    EXPECT_EQ(scene.root.children[1].values[0], glm::vec3(1, 0, 1));
    EXPECT_NE(to_text(scene).find("\"axes\": [true, false, true]"), std::string::npos);
    expect_error(replaced(mirrored, "true]", "1]"), 22, "root/children[1] \"cut\"/axes[2]",
                 "found 1, expected true or false");
}

TEST(SceneFileError, MissingFields) {
    expect_error(
        "\"kind\": \"sphere\",", "", 15, "root/children[0] \"ball\"",
        "has no \"kind\", expected one of sphere, box, rounded_box, torus, capsule, capped_cylinder, cone, plane, "
        "...");
    expect_error("\"camera\"", "\"lights\": {\"lamp\": {}},\n\"camera\"", 3, "lights/lamp",
                 "has no \"kind\", expected one of point, directional");
    expect_error("{\"farfield\": 1}", 1, "", "has no \"root\", expected the union that holds the scene's nodes");
    expect_error(R"({"farfield": 1, "materials": {}, "root": {"kind": "union"}})", 1, "materials",
                 "is empty, expected at least one material");
}

TEST(SceneFileError, Bookmarks) {
    const auto with = [](std::string_view bookmarks) {
        return replaced(small, "\"materials\"", "\"bookmarks\": " + std::string(bookmarks) + ",\n\"materials\"");
    };
    EXPECT_EQ(parse_scene(with("{\"a\": {}, \"b\": {\"field_of_view\": 20}}"), "a.json").bookmarks.size(), 2u);
    expect_error(with("[]"), 6, "bookmarks",
                 "found an array of 0, expected an object that describes the bookmarks by name");
    expect_error(with("{\"a\":\n[]}"), 7, "bookmarks/a",
                 "found an array of 0, expected an object that describes a camera");
    expect_error(with("{\"\": {}}"), 6, "bookmarks", "the name is empty, expected at least one character");
    expect_error(with("{\"a\": {},\n\"a\": {}}"), 7, "bookmarks/a",
                 "is given twice, expected once (the first is on line 6)");
    expect_error(with("{\"a\": {\n\"field_of_view\": 0}}"), 7, "bookmarks/a/field_of_view",
                 "found 0, expected a number between 1 and 170");
    expect_error(with("{\"a\": {\n\"position\": [0, 1e9, 0]}}"), 7, "bookmarks/a/position[1]",
                 "found 1000000000, expected three numbers, each between -1e+06 and 1e+06");
}

TEST(SceneFileError, UnknownKind) {
    expect_error(
        "\"sphere\"", "\"shpere\"", 16, "root/children[0] \"ball\"/kind",
        "found \"shpere\", expected one of sphere, box, rounded_box, torus, capsule, capped_cylinder, cone, plane, "
        "... (perhaps sphere)");
}

TEST(SceneFileError, Children) {
    expect_error("\"radius\": 0.5", "\"children\": []", 19, "root/children[0] \"ball\"/children",
                 "found an array of 0, expected none: a sphere has no children");
    expect_error(R"({"farfield": 1, "root": {"kind": "box"}})", 1, "root", "is a box, expected a union");
}

TEST(SceneFileError, DuplicateName) {
    expect_error("\"cut\"", "\"ball\"", 23, "root/children[1] \"ball\"/name",
                 "found \"ball\" again, expected a name of its own (the first is on line 17)");
}

TEST(SceneFileError, TooManyMaterials) {
    std::string materials = "{";
    for (size_t i = 0; i < largest_material_count; ++i) materials += '"' + std::to_string(i) + "\": {},\n";
    expect_error(R"({"farfield": 1, "root": {"kind": "union"}, "materials": )" + materials + "\"last\": {}}}", 4097,
                 "materials/last", "is one material too many, expected at most 4096");
}

TEST(SceneFileError, BadName) {
    expect_error("\"ball\"", "\"\"", 17, "root/children[0] \"\"/name",
                 "the name is empty, expected at least one character");
    expect_error("\"ball\"", "\"a\\nb\"", 17, "root/children[0] \"a\\nb\"/name",
                 "the name holds a control character, expected printable text");
    expect_error("\"white\"", "\"\"", 7, "materials", "the name is empty, expected at least one character");
}

TEST(SceneFileError, ReferenceToNothing) {
    expect_error("\"red\",\n", "\"rde\",\n", 18, "root/children[0] \"ball\"/material",
                 "there is no material \"rde\", expected one of white, red");
    expect_error("\"red\",\n", "\"whit\",\n", 18, "root/children[0] \"ball\"/material",
                 "there is no material \"whit\", expected one of white, red (perhaps white)");
}

TEST(SceneFileError, MessagesStayShortAndPrintable) {
    const std::string long_key(100'000, 'k');
    for (const std::string& text :
         {replaced(small, "radius", long_key), replaced(small, "\"sphere\"", '"' + long_key + '"'),
          replaced(small, "0.5", "\"\xff\xfe\x01\""), replaced(small, "0.5", "\"" + long_key)})
        try {
            parse_scene(text, "a.json");
            ADD_FAILURE();
        } catch (const SceneFileError& error) {
            const std::string message = error.what();
            EXPECT_LT(message.size(), 600u);
            EXPECT_TRUE(std::none_of(message.begin(), message.end(), [](unsigned char c) { return c < 0x20; }))
                << message;
        }
}

}  // namespace
}  // namespace farfield
