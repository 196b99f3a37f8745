// Custom code without a GPU: what it declares, what is refused and where, and its values.
#include "sdf/custom_code.h"

#include "sdf/slope_search.h"
#include "sdf/shape_library.h"
#include "tests/custom_code_samples.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace farfield {
namespace {

std::string all_messages(const CustomCode::Parsed& parsed) {
    std::string text;
    for (const CodeError& error : parsed.errors) text += fmt::format("{}: {}\n", error.line, error.message);
    return text;
}

std::shared_ptr<const CustomCode> parse(const std::string& text) {
    const auto parsed = CustomCode::parse(text);
    EXPECT_TRUE(parsed.code) << all_messages(parsed) << text;
    EXPECT_EQ(parsed.code == nullptr, !parsed.errors.empty());
    return parsed.code;
}

std::vector<glm::vec3> initial_values(const CustomCode& code) {
    std::vector<glm::vec3> values;
    for (const Parameter& parameter : code.parameters()) values.push_back(to_code_units(parameter, parameter.initial));
    return values;
}

/// sdf(1, 2, 3) of a whole text.
float run(const std::string& text) {
    const auto code = parse(text);
    return code ? code->evaluate({1.0f, 2.0f, 3.0f}, initial_values(*code)) : -999.0f;
}

/// What the statements return with p = (1, 2, 3), i = 2, u = 2, t = true, v = (1, 2, 3, 4): nothing that is constant.
float body(const std::string& statements) {
    return run(
        "float sdf(vec3 p) { int i = int(p.y); uint u = uint(i); bool t = p.x > 0.0; vec4 v = vec4(p, 4.0 * p.x);\n" +
        statements + "\n}");
}

float value(const std::string& expression) { return body("return " + expression + ";"); }

// ---- declarations --------------------------------------------------------------------------------------------------

TEST(CustomCode, UniformsAreParameters) {
    const auto code = parse(
        "uniform float radius = 0.5;   // [0, 2] m   Radius of the ball\n"
        "uniform   int folds = 2 * 2 ; /* [1, 12] Number of folds */\n"
        "uniform vec3 offset = vec3(0.1, 0.2, -0.3);\n"
        "uniform float turn = 90.0; // °\n"
        "uniform float twist_rate = 10.0; // [-90, 90] deg/m Twist\n"
        "uniform bool hollow = true; // Whether it is hollow\n"
        "uniform ivec3 count; // [0, 9]\n"
        "uniform bvec3 axes = bvec3(true, false, true);\n"
        "float sdf(vec3 p) { return length(p) - radius; }\n");
    ASSERT_TRUE(code);
    const auto p = code->parameters();
    ASSERT_EQ(p.size(), 8u);
    EXPECT_STREQ(p[0].key, "radius");
    EXPECT_STREQ(p[0].tip, "Radius of the ball");
    EXPECT_EQ(p[0].type, ParameterType::number);
    EXPECT_EQ(p[0].unit, Unit::metres);
    EXPECT_EQ(p[0].minimum, 0.0f);
    EXPECT_EQ(p[0].maximum, 2.0f);
    EXPECT_EQ(p[0].initial.x, 0.5f);
    EXPECT_EQ(p[1].type, ParameterType::integer);
    EXPECT_STREQ(p[1].tip, "Number of folds");
    EXPECT_EQ(p[1].unit, Unit::none);
    EXPECT_EQ(p[1].initial.x, 4.0f);
    EXPECT_EQ(p[1].maximum, 12.0f);
    EXPECT_EQ(p[2].type, ParameterType::vector);
    EXPECT_EQ(p[2].initial, glm::vec3(0.1f, 0.2f, -0.3f));
    EXPECT_EQ(p[2].minimum, -largest_value);
    EXPECT_STREQ(p[3].tip, "turn");
    EXPECT_EQ(p[3].unit, Unit::degrees);
    EXPECT_STREQ(p[4].tip, "Twist");
    EXPECT_EQ(p[4].unit, Unit::degrees_per_metre);
    EXPECT_EQ(p[5].type, ParameterType::flag);
    EXPECT_EQ(p[5].maximum, 1.0f);
    EXPECT_EQ(p[5].initial.x, 1.0f);
    EXPECT_EQ(p[6].type, ParameterType::count);
    EXPECT_EQ(p[7].type, ParameterType::flags);
    EXPECT_EQ(p[7].initial, glm::vec3(1.0f, 0.0f, 1.0f));
}

TEST(CustomCode, ParametersOutliveTheText) {
    std::shared_ptr<const CustomCode> code;
    {
        std::string text =
            "uniform float some_rather_long_name = 1.0; // and a tip of more than a few letters\n"
            "float sdf(vec3 p) { return some_rather_long_name; }";
        code = parse(text);
        text.assign(text.size(), 'x');
    }
    EXPECT_STREQ(code->parameters()[0].key, "some_rather_long_name");
    EXPECT_STREQ(code->parameters()[0].tip, "and a tip of more than a few letters");
}

TEST(CustomCode, ValuesReachTheCode) {
    const auto code = parse(
        "uniform float a = 1.0;\nuniform vec3 v = vec3(1);\nuniform int n = 1; // [0, 5]\nuniform bool b;\n"
        "uniform ivec3 k;\nuniform bvec3 f;\n"
        "float sdf(vec3 p) { return p.x + a + v.y * 10.0 + float(n) * 100.0 + (b ? 1000.0 : 0.0) + float(k.z) * 1e4 + "
        "(f.y ? 1e5 : 0.0); }");
    const std::vector<glm::vec3> values{{2, 0, 0}, {0, 3, 0}, {4, 0, 0}, {1, 0, 0}, {0, 0, 5}, {0, 1, 0}};
    EXPECT_EQ(code->evaluate({1, 0, 0}, values), 151433.0f);
}

TEST(CustomCode, WholeNumbersStayInTheirRange) {  // loops and indices rely on it
    const auto code = parse("uniform int n = 1; // [0, 5]\nfloat sdf(vec3 p) { return float(n); }");
    for (const float beyond : {6.0f, 1e30f, std::numeric_limits<float>::infinity()})
        EXPECT_EQ(code->evaluate({}, std::vector{glm::vec3(beyond)}), 5.0f);
    for (const float beyond : {-6.0f, -1e30f, std::numeric_limits<float>::quiet_NaN()})
        EXPECT_EQ(code->evaluate({}, std::vector{glm::vec3(beyond)}), 0.0f);
}

TEST(CustomCode, LipschitzIsOneUnlessDeclared) {
    EXPECT_EQ(parse("float sdf(vec3 p) { return p.x; }")->lipschitz(), 1.0f);
    EXPECT_EQ(parse("const float lipschitz = 3.0 / 2.0;\nfloat sdf(vec3 p) { return p.x; }")->lipschitz(), 1.5f);
}

// ---- what is refused -----------------------------------------------------------------------------------------------

struct Refusal {
    int line;
    const char* part;  ///< of the message
    std::string text;
};

TEST(CustomCode, RefusesWithLineAndReason) {
    const std::string ok = "float sdf(vec3 p) { return 1.0; }\n";
    const std::string many(3000, '-');
    const std::vector<Refusal> refusals{
        {1, "there is no code", ""},
        {1, "no float sdf(vec3 p)", "float other(vec3 p) { return 1.0; }"},
        {1, "no float sdf(vec3 p)", "// nothing\n"},
        {1, "no float sdf(vec3 p)", "float sdf(vec2 p) { return 1.0; }"},
        {1, "no float sdf(vec3 p)", "int sdf(vec3 p) { return 1; }"},
        {1, "must not be out", "float sdf(out vec3 p) { p = vec3(0); return 1.0; }"},
        {2, "undeclared", "float sdf(vec3 p) {\n return q; }"},
        {2, "undeclared", "float sdf(vec3 p) {\r\n return q; }"},
        {3, "syntax error", "float sdf(vec3 p) {\n return p.x\n }"},
        {2, "expected", ok + "float"},
        {2, "expected", ok + "+"},
        {1, "never closed", "float sdf(vec3 p) { return p.x;\n"},
        {2, "closes nothing", ok + "}"},
        {2, "meets the (", "float sdf(vec3 p) {\n return (p.x}; }"},
        {2, "preprocessor", ok + "#define X 1"},
        {1, "preprocessor", "# version 430\n" + ok},
        {2, "while loops", "float sdf(vec3 p) {\n while (true) {} return 1.0; }"},
        {2, "do loops", "float sdf(vec3 p) {\n do {} while (false); return 1.0; }"},
        {2, "expected a loop", "float sdf(vec3 p) {\n for (;p.x > 0.0;) {} return 1.0; }"},
        {2, "expected a loop", "float sdf(vec3 p) {\n for (;;) {} return 1.0; }"},
        {2, "not known", "float sdf(vec3 p) {\n for (int i = 0; i < int(p.x); ++i) {} return 1.0; }"},
        {2, "not known", "float sdf(vec3 p) {\n for (int i = 0; i < 4; i += int(p.x)) {} return 1.0; }"},
        {2, "only once", "float sdf(vec3 p) {\n for (int i = 0; i < 4; ++i) { i--; } return 1.0; }"},
        {2, "only once",
         "void f(out int k) { k = 1; } float sdf(vec3 p) {\n for (int i = 0; i < 4; ++i) { f(i); } return 1.0; }"},
        {2, "only once", "float sdf(vec3 p) {\n for (int i = 0; i < 4; ++i, --i) { } return 1.0; }"},
        {2, "leaves the range", "float sdf(vec3 p) {\n for (uint i = 3u; i >= 0u; --i) {} return 1.0; }"},
        {2, "leaves the range",
         "float sdf(vec3 p) {\n for (int i = 0; i < 2147483647; i += 2000000000) {} return 1.0; }"},
        {2, "more than 4096", "float sdf(vec3 p) {\n for (int i = 0; i < 4097; ++i) {} return 1.0; }"},
        {2, "more than 4096", "float sdf(vec3 p) {\n for (float t = 1e6; t < 1e7; t += 1e-3) {} return 1.0; }"},
        {2, "more than 4096", "float sdf(vec3 p) {\n for (int i = 0; i != 3; i += 2) {} return 1.0; }"},
        {2, "more than 4096",
         "uniform int n = 1; // [0, 5000]\nfloat sdf(vec3 p) { for (int i = 0; i < n; ++i) {} return 1.0; }"},
        {2, "10100 steps",
         "float f() { for (int i = 0; i < 100; ++i) {} return 1.0; }\nfloat sdf(vec3 p) { for (int i = 0; i < 100; "
         "++i) f(); return 1.0; }"},
        {1, "call itself", "float sdf(vec3 p) { return p.x > 0.0 ? 1.0 : sdf(p); }"},
        {1, "call itself",
         "float g(vec3 p); float f(vec3 p) { return g(p); } float g(vec3 p) { return f(p); } float sdf(vec3 p) { "
         "return f(p); }"},
        {2, "has no body", "float g(vec3 p);\nfloat sdf(vec3 p) { return g(p); }"},
        {2, "may be beyond 0 .. 2", "float sdf(vec3 p) { float a[3]; int i = int(p.x);\n return a[i]; }"},
        {2, "may be beyond 0 .. 2", "float sdf(vec3 p) {\n return p[int(p.x)]; }"},
        {2, "may be beyond 0 .. 3",
         "float sdf(vec3 p) { mat4 m; for (int i = 0; i <= 4; ++i)\n m[i] = vec4(0); return 1.0; }"},
        {1, "sampler2D", "uniform sampler2D t;\n" + ok},
        {1, "uimage3D", "uniform uimage3D t;\n" + ok},
        {1, "is a float, int", "uniform mat3 t;\n" + ok},
        {1, "is a float, int", "uniform uint t;\n" + ok},
        {1, "expected a parameter", "uniform float a, b;\n" + ok},
        {1, "expected a parameter", "uniform float a[3];\n" + ok},
        {1, "buffer", "buffer B { float b[]; };\n" + ok},
        {1, "shared", "shared float s;\n" + ok},
        {1, "layout", "layout(local_size_x = 4) in;\n" + ok},
        {1, "expected a function", "in vec3 v;\n" + ok},
        {1, "global variable", "float g = 1.0;\n" + ok},
        {1, "global variable", "float g;\n" + ok},
        {1, "main is taken", "void main() {}\n" + ok},
        {1, "function of GLSL", "float mod(float a) { return a; }\n" + ok},
        {1, "gl_GlobalInvocationID", "float sdf(vec3 p) { return float(gl_GlobalInvocationID.x); }"},
        {1, "discard", "float sdf(vec3 p) { discard; return 1.0; }"},
        {1, "barrier", "float sdf(vec3 p) { barrier(); return 1.0; }"},
        {1, "memoryBarrier", "float sdf(vec3 p) { memoryBarrier(); return 1.0; }"},
        {1, "dFdx", "float sdf(vec3 p) { return dFdx(p.x); }"},
        {1, "atomicAdd", "float sdf(vec3 p) { int i; atomicAdd(i, 1); return p.x; }"},
        {1, "double", "float sdf(vec3 p) { double d; return 1.0; }"},
        {2, "not available", "float sdf(vec3 p) {\n return float(1.0lf * p.x); }"},
        {2, "not available", "float sdf(vec3 p) {\n return float(bitCount(int(p.x))); }"},
        {2, "not available", "float sdf(vec3 p) { int e;\n return frexp(p.x, e); }"},
        {1, "two underscores", "float sdf(vec3 p) { float a__b; return 1.0; }"},
        {1, "letters", "float sdf(vec3 p) { float " + std::string(100, 'a') + "; return 1.0; }"},
        {1, "beyond ASCII", "float sdf(vec3 p) { float \xc3\xa4; return 1.0; }"},
        {1, "UTF-8", "// \xff\n" + ok},
        {2, "control character", ok + std::string(1, '\0')},
        {2, "control character", ok + "// a\rfloat b;"},
        {1, "backslash", "// a\\\n" + ok},
        {2, "unexpected character", ok + "$"},
        {2, "no end", ok + "/* a"},
        {1, "bytes", std::string(70'000, ' ')},
        {1, "inside one another",
         "float sdf(vec3 p) { return " + std::string(100, '(') + "1.0" + std::string(100, ')') + "; }"},
        {1, "words and signs", "float sdf(vec3 p) { return " + many + "1.0; }"},
        {1, "too large", "float sdf(vec3 p) { float a[1000000]; a[0] = p.x; return a[0]; }"},
        {1, "too large", "float sdf(vec3 p) { float a[65536][65536]; a[0][0] = p.x; return a[0][0]; }"},
        {1, "every node", "uniform float translate;\n" + ok},
        {1, "every node", "uniform float children;\n" + ok},
        {2, "used twice", "uniform float a;\nuniform float a;\n" + ok},
        {1, "out of range", "uniform float a = 3.0; // [0, 1]\n" + ok},
        {1, "out of range", "uniform float a; // [1, 2]\n" + ok},
        {1, "a range as", "uniform float a; // [1 2]\n" + ok},
        {1, "a range as", "uniform float a = 2; // [2, 1]\n" + ok},
        {1, "a range as", "uniform float a = 2; // [0, inf]\n" + ok},
        {1, "goes beyond", "uniform float a = 2; // [0, 1e9]\n" + ok},
        {1, "whole ends", "uniform int a = 2; // [0.5, 3]\n" + ok},
        {2, "constant", "uniform float b;\nuniform float a = b;\n" + ok},
        {1, "lipschitz", "const float lipschitz = -1.0;\n" + ok},
        {2, "belongs to the constant", "\nuniform float lipschitz = 1.0;\n" + ok},
        {3, "lipschitz", "\n\nconst float lipschitz = 0.0;\n" + ok},
        {1, "lipschitz", "const vec2 lipschitz = vec2(1.0);\n" + ok},
    };
    for (const Refusal& refusal : refusals) {
        const auto parsed = CustomCode::parse(refusal.text);
        EXPECT_FALSE(parsed.code) << refusal.text.substr(0, 200);
        if (parsed.errors.empty()) {
            ADD_FAILURE() << "nothing refused in " << refusal.text.substr(0, 200);
            continue;
        }
        EXPECT_EQ(parsed.errors[0].line, refusal.line) << all_messages(parsed) << refusal.text.substr(0, 200);
        EXPECT_NE(all_messages(parsed).find(refusal.part), std::string::npos)
            << all_messages(parsed) << refusal.text.substr(0, 200);
    }
}

TEST(CustomCode, ManyCallsOfCallsAreRefused) {  // drivers inline; this would be 2^30 operations
    std::string text = "float f0(float x) { return x + 1.0; }\n";
    for (int i = 1; i < 30; ++i)
        text += fmt::format("float f{0}(float x) {{ return f{1}(x) + f{1}(x + 1.0); }}\n", i, i - 1);
    const auto parsed = CustomCode::parse(text + "float sdf(vec3 p) { return f29(p.x); }");
    ASSERT_FALSE(parsed.code);
    EXPECT_EQ(parsed.errors[0].line, 31);
}

TEST(CustomCode, ReportsAllUnknownLoopsAtOnce) {
    const auto parsed = CustomCode::parse(
        "float f(float x) {\n for (int i = 0; i < int(x); ++i) {} return x; }\n"
        "float g(float x) {\n for (int i = 0; i < int(x); ++i) {} return x; }\nfloat sdf(vec3 p) { return f(p.x) + "
        "g(p.y); }");
    ASSERT_EQ(parsed.errors.size(), 2u);
    EXPECT_EQ(parsed.errors[0].line, 2);
    EXPECT_EQ(parsed.errors[1].line, 4);
}

// ---- the text for the GPU ------------------------------------------------------------------------------------------

TEST(CustomCode, GlslKeepsLinesAndComments) {
    const auto code = parse(
        "uniform float radius\n  = 0.5; // [0, 2] m\n// radius of all\nconst float two = 2.0;\nstruct S { float two; "
        "};\n"
        "float help(float x) { return x * two; }\r\n"
        "float sdf(vec3 p) { S s = S(two); float help_7 = s.two; /* two */ return help(help_7) - radius; }");
    const std::vector<std::string> arguments{"parameter(3)"};
    EXPECT_EQ(code->glsl("7", arguments),
              "float radius_7 = parameter(3);\n // [0, 2] m\n// radius of all\nconst float two_7 = 2.0;\nstruct S_7 { "
              "float two; };\n"
              "float help_7(float x) { return x * two_7; }\n"
              "float sdf_7(vec3 p) { S_7 s = S_7(two_7); float help_7_7 = s.two; /* two */ return help_7(help_7_7) - "
              "radius_7; }\n");
}

TEST(CustomCode, OwnFunctionsReplaceThoseOfTheLibrary) {
    // rounded_box of the library calls the library's box, not the one here.
    const std::string text =
        "float box(vec3 p, vec3 h) { return 100.0; }\nfloat sdf(vec3 p) { return box(p, p) + rounded_box(p, vec3(0.5), "
        "0.0); }";
    EXPECT_NEAR(run(text), 100.0f + std::sqrt(0.25f + 2.25f + 6.25f), 1e-4f);
    EXPECT_EQ(used_shapes(parse(text)->glsl("1", {})).find("box_1"), std::string::npos);
    EXPECT_NEAR(run("uniform float sphere = 2.0;\nfloat sdf(vec3 p) { return torus(p, 1.0, 0.5) * 0.0 + sphere; }"),
                2.0f, 0.0f);
}

TEST(CustomCode, MessagesNameWhatTheUserWrote) {
    const auto parsed =
        CustomCode::parse("float box(vec3 p) { return 1.0; }\nfloat sdf(vec3 p) {\nreturn box(1, 2, 3); }");
    ASSERT_EQ(parsed.errors.size(), 1u);
    EXPECT_EQ(parsed.errors[0].line, 3);
    EXPECT_NE(parsed.errors[0].message.find("'box'"), std::string::npos) << parsed.errors[0].message;
}

// ---- values --------------------------------------------------------------------------------------------------------

TEST(CustomCodeValues, Arithmetic) {
    EXPECT_EQ(value("p.x + p.y * p.z - p.z / p.y"), 5.5f);
    EXPECT_EQ(value("-p.x"), -1.0f);
    EXPECT_EQ(value("float(7 / i) + float(7 % i) + float(-7 / i)"), 1.0f);
    EXPECT_EQ(value("float(i / (i - 2)) + float(u / (u - 2u)) + float(i % (i - 2))"), 0.0f);  // by zero: harmless
    EXPECT_EQ(value("float((i - 2 - 2147483647 - 1) / (i - 3))"), -2147483648.0f);            // wraps
    EXPECT_EQ(value("float(u - 3u)"), 4294967296.0f);
    EXPECT_EQ(value("float((i << 3) >> 1) + float(u >> 1u) + float((-i) >> 1)"), 8.0f);
    EXPECT_EQ(value("float((i & 3) | 8) + float(i ^ 1) + float(~i)"), 10.0f);
    EXPECT_EQ(value("float(i) + float(u) + float(t) + float(int(p.z * 1.4)) + float(bool(p.x))"), 10.0f);
    EXPECT_EQ(value("float(uint(p.z)) + i * p.x + float(int(t)) + float(uint(i))"), 8.0f);
    EXPECT_EQ(value("float(int(p.x * 1e20)) + float(int(-p.x * 1e20))"), 0.0f);  // limited to the ends
}

TEST(CustomCodeValues, Logic) {
    EXPECT_EQ(value("(t && !(p.x > 1.0) || p.y < 0.0) ? 1.0 : 2.0"), 1.0f);
    EXPECT_EQ(value("(t ^^ t) ? 1.0 : 2.0"), 2.0f);
    EXPECT_EQ(value("(p.x >= 1.0 && p.x <= 1.0 && p.x == 1.0 && p.x != 2.0) ? 1.0 : 2.0"), 1.0f);
    EXPECT_EQ(body("float a = 0.0; bool b = t || (a += 1.0) > 0.0; b = !t && (a += 1.0) > 0.0; return a;"), 0.0f);
    EXPECT_EQ(body("float a = 0.0; float b = t ? (a += 1.0) : (a += 10.0); return a + b;"), 2.0f);
    EXPECT_EQ(value("(p == vec3(1, 2, 3) && p != p.yxz) ? 1.0 : 2.0"), 1.0f);
}

TEST(CustomCodeValues, Vectors) {
    EXPECT_EQ(value("dot(v, vec4(1, 10, 100, 1000))"), 4321.0f);
    EXPECT_EQ(value("dot(v.wzyx, vec4(1, 10, 100, 1000))"), 1234.0f);
    EXPECT_EQ(value("dot(vec3(v.yz, p.x) * 2.0 + 1.0, vec3(1, 10, 100))"), 375.0f);
    EXPECT_EQ(body("v.xz = v.zx; v.yw += 1.0; return dot(v, vec4(1, 10, 100, 1000));"), 5133.0f);
    EXPECT_EQ(body("v.zxy = v.xyz; return dot(v, vec4(1, 10, 100, 1000));"), 4132.0f);
    EXPECT_EQ(body("v.yzw = v.xyz; return dot(v, vec4(1, 10, 100, 1000));"), 3211.0f);
    EXPECT_EQ(body("vec2 w = (v.yz = v.xy); return dot(v, vec4(1, 10, 100, 1000)) + dot(w, vec2(1e4, 1e5));"),
              214211.0f);
    EXPECT_EQ(body("v.wzyx.xy *= 2.0; return dot(v, vec4(1, 10, 100, 1000));"), 8621.0f);
    EXPECT_EQ(body("for (int k = 0; k < 4; ++k) v[k] = v[3 - k] * float(k); return dot(v, vec4(1, 10, 100, 1000));"),
              630.0f);
    EXPECT_EQ(value("length(vec2(p.z, v.w)) + vec4(p.x).w + vec2(v).y + float(v)"), 9.0f);
    EXPECT_EQ(value("dot(cross(p, p.zxy), vec3(1, 10, 100))"),
              1.0f * (2 * 2 - 3 * 1) + 10.0f * (3 * 3 - 1 * 2) + 100.0f * (1 * 1 - 2 * 3));
    EXPECT_EQ(value("float(all(lessThan(p, vec3(1.5, 2.5, 3.5)))) + float(any(greaterThan(p, vec3(2.5)))) * 10.0"),
              11.0f);
    EXPECT_EQ(value("float(all(lessThanEqual(ivec2(i), ivec2(2)))) + float(any(equal(p, vec3(3)))) + "
                    "float(any(not(notEqual(p, p))))"),
              3.0f);
    EXPECT_EQ(value("dot(vec3(ivec3(p) / 2 + ivec3(bvec3(p.x, 0, 1))), vec3(1, 10, 100))"), 211.0f);
}

TEST(CustomCodeValues, Matrices) {
    const std::string m = "mat2 m = mat2(p.x, p.y, p.z, v.w); ";  // columns (1, 2), (3, 4)
    EXPECT_EQ(body(m + "return dot(m * vec2(1, 10), vec2(1, 100));"), 31.0f + 4200.0f);
    EXPECT_EQ(body(m + "return dot(vec2(1, 10) * m, vec2(1, 100));"), 21.0f + 4300.0f);
    EXPECT_EQ(body(m + "m = m * m; return m[0][0] + 10.0 * m[0].y + 100.0 * m[1].x + 1000.0 * m[1][1];"),
              7.0f + 100.0f + 1500.0f + 22000.0f);
    EXPECT_EQ(body(m + "return determinant(m) + determinant(transpose(m) * 2.0) + determinant(inverse(m));"),
              -2.0f - 8.0f - 0.5f);
    EXPECT_EQ(body(m + "mat2 n = inverse(m) * m; return n[0][0] + n[1][1] + 10.0 * (n[0][1] + n[1][0]);"), 2.0f);
    EXPECT_EQ(body(m + "return determinant(mat3(m)) + mat4(m)[3][3] + mat3(p.z)[2][2] + mat3(p.z)[2][1];"),
              -2.0f + 1.0f + 3.0f);
    EXPECT_EQ(body("return determinant(mat3(2, p.x, 0, 0, p.z, 1, p.x, 0, 4)) + determinant(mat4(v.w));"),
              25.0f + 256.0f);
    EXPECT_EQ(body("mat3 a = mat3(2, p.x, 0, 0, p.z, 1, p.x, 0, 4); vec3 q = a * (inverse(a) * p); return distance(q, "
                   "p) < 1e-5 ? 1.0 : 0.0;"),
              1.0f);
    EXPECT_NEAR(body("mat4 a = mat4(v, v.yxzw, v.zzxy, vec4(p.x, 0, 2, 5)); vec4 q = a * (inverse(a) * v); return "
                     "distance(q, v);"),
                0.0f, 1e-5f);
    EXPECT_EQ(body("mat2x3 o = outerProduct(p, vec2(1, 10)); return o[1].z + matrixCompMult(o, o)[0][1];"), 34.0f);
    EXPECT_EQ(body(m + "m[1] = vec2(9); m[0].y = 7.0; m *= 2.0; m += 1.0; --m; return m[0][0] + m[0][1] * 10.0 + "
                       "m[1][0] * 1000.0;"),
              2.0f + 140.0f + 18000.0f);
    EXPECT_EQ(body(m + "vec2 q = p.xy; q *= m; return q.x + 100.0 * q.y + (m == m ? 0.5 : 0.0);"),
              5.0f + 1100.0f + 0.5f);
}

TEST(CustomCodeValues, ArraysAndStructures) {
    EXPECT_EQ(body("float a[3] = float[3](p.x, p.y, p.z); float s = 0.0; for (int k = 0; k < a.length(); ++k) s += "
                   "a[k] * float(k); a[1] = s; return a[1] + a[0];"),
              9.0f);
    EXPECT_EQ(body("float a[2][3]; for (int k = 0; k < 6; ++k) a[k / 3][k % 3] = float(k) * p.x; return a[1][2] + "
                   "a[0][1] * 10.0;"),
              15.0f);
    EXPECT_EQ(
        body(
            "const float a[4] = float[](10.0, 20.0, 30.0, 40.0); return a[clamp(i, 0, 3)] + a[i & 1] + a[min(u, 3u)];"),
        70.0f);
    const std::string s =
        "struct A { float x; vec2 y[2]; }; struct B { A a; int n; };\nA make(float x) { return A(x, vec2[2](vec2(x), "
        "vec2(x + 1.0))); }\n";
    EXPECT_EQ(run(s + "float sdf(vec3 p) { B b = B(make(p.x), 3), c = b; c.a.y[1].x = 9.0; B d = c; return d.a.y[1].x "
                      "+ b.a.y[1].x + (b == c ? 100.0 : 0.0) + (c == d ? 1000.0 : 0.0) + float(d.n); }"),
              1014.0f);
    EXPECT_EQ(run(s + "float sdf(vec3 p) { A all[3]; for (int k = 0; k < 3; ++k) { all[k] = make(p.z); all[k].y[k & "
                      "1].y += float(k); } return all[2].y[0].y + make(p.x).y[1].x; }"),
              7.0f);
}

TEST(CustomCodeValues, FlowOfControl) {
    EXPECT_EQ(body("if (p.x > 2.0) return 1.0; else if (p.y > 2.0) return 2.0; else { p.x = 7.0; } return p.x;"), 7.0f);
    EXPECT_EQ(body("float s = 0.0; for (int k = 0; k < 10; ++k) { if (k == 2) continue; if (k == 5) break; s += "
                   "float(k); } return s;"),
              8.0f);
    EXPECT_EQ(body("float s = 0.0; for (int k = 3; k >= 0; k -= 2) for (float x = 0.0; x < 1.0; x += 0.25) s += x * "
                   "float(k); return s;"),
              6.0f);
    EXPECT_EQ(body("float s = 0.0; for (int k = 0; k < 8 && s < 10.0; ++k) s += float(k); return s;"), 10.0f);
    EXPECT_EQ(body("float s = 0.0; for (int k = 0; k != 6; k += 2, s += 100.0) s += 1.0; return s;"), 303.0f);
    EXPECT_EQ(run("uniform int n = 3; // [0, 9]\nfloat sdf(vec3 p) { float s = 0.0; for (int i = n; i > 0; --i) s += "
                  "1.0; for (int i = 0; i <= n * 2 + 1; ++i) s += 10.0; return s; }"),
              83.0f);
    const std::string cases =
        "switch (i + %) { case 0: return 1.0; case 2: p.x += 10.0; case 3: p.x += 100.0; break; default: p.x = -1.0; } "
        "return p.x;";
    const auto with = [&](const char* n) { return body(std::string(cases).replace(cases.find('%'), 1, n)); };
    EXPECT_EQ(with("0"), 111.0f);
    EXPECT_EQ(with("1"), 101.0f);
    EXPECT_EQ(with("7"), -1.0f);
    EXPECT_EQ(with("-2"), 1.0f);
    EXPECT_EQ(
        body("for (int k = 0; k < 3; ++k) { switch (k) { case 1: continue; case 0: break; } p.x += 1.0; } return p.x;"),
        3.0f);
    EXPECT_EQ(body("float x = p.x, y = x++ + ++x; return x + 10.0 * y + 100.0 * float(i-- - --i);"),
              3.0f + 40.0f + 200.0f);
    EXPECT_EQ(body("float x = p.x; float y = x + (x = 5.0) + x; return y;"), 11.0f);
}

TEST(CustomCodeValues, Functions) {
    EXPECT_EQ(run("void f(in float a, out float b, inout float c) { a = 50.0; b = c; c += a; }\nfloat sdf(vec3 p) { "
                  "f(p.x, p.y, p.z); return p.x + p.y * 10.0 + p.z * 100.0; }"),
              1.0f + 30.0f + 5300.0f);
    EXPECT_EQ(run("float f(float a) { return a * 2.0 + 1.0; } float f(vec2 a) { return f(a.x) + f(a.y); }\nfloat "
                  "sdf(vec3 p) { return f(f(f(p.x))) + f(p.xy); }"),
              15.0f + 8.0f);
    EXPECT_EQ(run("float g(float);\nfloat sdf(vec3 p) { return g(p.x) + g(p.y) * g(p.z); }\nfloat g(float x) { if (x > "
                  "2.0) return 10.0; return x; }"),
              21.0f);
    EXPECT_EQ(run("float f(float, mat2 m) { return m[1][1]; }\nfloat sdf(vec3 p) { return f(p.x, mat2(p.z)); }"), 3.0f);
    EXPECT_EQ(run("void swap(inout vec2 v) { v = v.yx; }\nfloat sdf(vec3 p) { swap(p.zx); vec2 a[2]; a[1] = p.xy; "
                  "swap(a[1]); return p.x + p.z * 10.0 + a[1].x * 100.0; }"),
              3.0f + 10.0f + 200.0f);
    EXPECT_EQ(run("float[2] two(float x) { return float[2](x, -x); }\nfloat sdf(vec3 p) { return two(p.z)[1]; }"),
              -3.0f);
    EXPECT_EQ(run("float sdf(vec3 p) { return smooth_union(sphere(p, 1.0), box(p, vec3(0.5)), 0.0); }"),
              std::min(std::sqrt(14.0f) - 1.0f, std::sqrt(0.25f + 2.25f + 6.25f)));
}

TEST(CustomCodeValues, BuiltInFunctions) {
    const std::pair<const char*, double> cases[] = {{"sin(p.x)", std::sin(1.0)},
                                                    {"cos(p.x)", std::cos(1.0)},
                                                    {"tan(p.x)", std::tan(1.0)},
                                                    {"asin(p.x * 0.5)", std::asin(0.5)},
                                                    {"acos(p.x * 0.5)", std::acos(0.5)},
                                                    {"atan(p.y)", std::atan(2.0)},
                                                    {"atan(p.y, -p.x)", std::atan2(2.0, -1.0)},
                                                    {"sinh(p.x)", std::sinh(1.0)},
                                                    {"cosh(p.x)", std::cosh(1.0)},
                                                    {"tanh(p.x)", std::tanh(1.0)},
                                                    {"asinh(p.x)", std::asinh(1.0)},
                                                    {"acosh(p.y)", std::acosh(2.0)},
                                                    {"atanh(p.x * 0.5)", std::atanh(0.5)},
                                                    {"pow(p.y, p.z)", 8.0},
                                                    {"exp(p.x)", std::exp(1.0)},
                                                    {"log(p.y)", std::log(2.0)},
                                                    {"exp2(p.z)", 8.0},
                                                    {"log2(p.y)", 1.0},
                                                    {"sqrt(p.y)", std::sqrt(2.0)},
                                                    {"inversesqrt(v.w)", 0.5},
                                                    {"abs(-p.y) + float(abs(-i))", 4.0},
                                                    {"sign(-p.y) + float(sign(i))", 0.0},
                                                    {"floor(-p.x * 1.5)", -2.0},
                                                    {"ceil(-p.x * 1.5)", -1.0},
                                                    {"trunc(-p.x * 1.5)", -1.0},
                                                    {"round(p.x * 1.6)", 2.0},
                                                    {"roundEven(p.x * 2.5)", 2.0},
                                                    {"fract(-p.x * 1.25)", 0.75},
                                                    {"mod(-p.x, p.z)", 2.0},
                                                    {"min(p.x, p.y) + float(min(i, 1)) + float(max(u, 9u))", 11.0},
                                                    {"clamp(p.z, p.x, p.y)", 2.0},
                                                    {"float(clamp(i, 3, 5)) + float(clamp(u, 0u, 1u))", 4.0},
                                                    {"mix(p.x, p.z, 0.25)", 1.5},
                                                    {"mix(p.x, p.z, t)", 3.0},
                                                    {"step(p.y, p.x) + step(p.x, p.x)", 1.0},
                                                    {"smoothstep(0.0, p.y, p.x)", 0.5},
                                                    {"radians(p.x * 180.0)", 3.14159265},
                                                    {"degrees(p.x)", 57.2957795},
                                                    {"length(p.x)", 1.0},
                                                    {"distance(p, p + vec3(0, 3, 4))", 5.0},
                                                    {"distance(p.x, p.z)", 2.0},
                                                    {"dot(p.x, p.z)", 3.0},
                                                    {"length(normalize(p))", 1.0},
                                                    {"normalize(-p.y)", -1.0},
                                                    {"reflect(vec2(p.x, -1), vec2(0, 1)).y", 1.0},
                                                    {"refract(vec2(0, -p.x), vec2(0, 1), 0.5).y", -1.0},
                                                    {"refract(normalize(vec2(p.z, -1)), vec2(0, 1), 2.0).x", 0.0},
                                                    {"faceforward(p, p, p).x", -1.0},
                                                    {"faceforward(p, p, -p).y", 2.0},
                                                    {"fma(p.x, p.y, p.z)", 5.0},
                                                    {"float(isnan(p.x / 0.0)) + float(isinf(p.x / (p.x - 1.0)))", 1.0},
                                                    {"intBitsToFloat(floatBitsToInt(p.z))", 3.0},
                                                    {"uintBitsToFloat(floatBitsToUint(p.z))", 3.0}};
    for (const auto& [expression, expected] : cases)
        EXPECT_NEAR(value(expression), expected, 2e-6 * std::max(1.0, std::abs(expected))) << expression;
    EXPECT_EQ(body("float whole; float part = modf(-p.z * 0.5, whole); return whole * 10.0 + part;"), -10.5f);
}

// ---- steepness -----------------------------------------------------------------------------------------------------

TEST(CustomCodeLipschitz, EstimateComesCloseFromBelow) {
    const std::pair<const char*, float> cases[] = {{"length(p) - 0.5", 1.0f},
                                                   {"2.0 * p.x - p.y", std::sqrt(5.0f)},
                                                   {"max(abs(p.x), p.y * 1.5)", 1.5f},
                                                   {"sin(p.x * 5.0) / 5.0 + 0.2 * sin(p.y * 5.0)", std::sqrt(2.0f)}};
    for (const auto& [expression, expected] : cases) {
        const auto code = parse(fmt::format("float sdf(vec3 p) {{ return {}; }}", expression));
        SlopeSearch search({glm::vec3(-2.0f), glm::vec3(2.0f)}, 1);
        search.run(
            20'000, nullptr, [&](glm::vec3 p) { return code->evaluate(p, {}); },
            [](glm::vec3, glm::vec3) { return true; });
        const float estimate = search.steepest().slope;
        EXPECT_LE(estimate, expected * 1.001f) << expression;
        EXPECT_GE(estimate, expected * 0.97f) << expression;
    }
}

// ---- robustness ----------------------------------------------------------------------------------------------------

/// Parses, and evaluates what is accepted; the outcome does not matter, that there is one does.
bool survives(const std::string& text) {
    const auto parsed = CustomCode::parse(text);
    EXPECT_EQ(parsed.code == nullptr, !parsed.errors.empty()) << text;
    for (const CodeError& error : parsed.errors) {
        EXPECT_GE(error.line, 1) << error.message;
        EXPECT_LE(error.line, 2 + std::count(text.begin(), text.end(), '\n')) << error.message;
        EXPECT_FALSE(error.message.empty());
    }
    if (!parsed.code) return false;
    const std::vector<std::string> arguments(parsed.code->parameters().size(), "0.0");
    const std::string glsl = parsed.code->glsl("1", arguments);
    EXPECT_EQ(std::count(glsl.begin(), glsl.end(), '\n'),
              std::count(text.begin(), text.end(), '\n') + (text.back() != '\n'))
        << text;
    for (const glm::vec3 p :
         {glm::vec3(0.0f), glm::vec3(1e30f, -1e30f, 3.0f), glm::vec3(std::numeric_limits<float>::quiet_NaN())})
        parsed.code->evaluate(p, {});
    return true;
}

TEST(CustomCodeFuzz, MutatedTextsEndWithCodeOrErrors) {
    int accepted = 0;
    const int count = 3000;
    for (unsigned seed = 0; seed < count; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        accepted += survives(mutated_code(seed));
    }
    EXPECT_GT(accepted, count / 50);
    EXPECT_LT(accepted, count / 2);
}

TEST(CustomCodeFuzz, EveryTruncationEnds) {
    const std::string text = custom_code_samples[0];
    for (std::size_t length = 1; length < text.size(); ++length) survives(text.substr(0, length));
}

TEST(CustomCodeFuzz, LargestTextsEndSoon) {
    const auto repeated = [](const std::string& part, int count) {
        std::string all;
        for (int i = 0; i < count; ++i) all += part;
        return all;
    };
    const std::string begin = "float sdf(vec3 p) { float d = p.x; int i = 1;", end = " return d; }";
    for (const char* part :
         {"d += sin(d) * 2.0;", "{ float d = 1.0; }", "for (int k = 0; k < 1; ++k)", "if (d > 1.0)",
          "if (d > 1.0) d = 1.0; else ", "d = d + 1.0, ", "-", "d + ", "(", "{", "p.xyz = p.zyx;", "i = i * 2 % 7;",
          "float[2](1.0, 2.0);", "case 1:", "switch (i) { case 1: d = 2.0; }", "[", "?:", "++"})
        survives(begin + repeated(part, static_cast<int>(60'000 / std::string_view(part).size())) + end);
    std::string functions, uniforms, names;
    for (int i = 0; i < 1000; ++i) functions += fmt::format("float f{}(float x) {{ return x; }}\n", i);
    EXPECT_TRUE(survives(functions + begin + end));
    for (int i = 0; i < 64; ++i) uniforms += fmt::format("uniform vec3 u{};\n", i);
    EXPECT_TRUE(survives(uniforms + begin + end));
    EXPECT_FALSE(survives(uniforms + "uniform float one_more;\n" + begin + end));
}

TEST(CustomCode, ParsesAndEvaluatesOnSeveralThreads) {
    const auto shared = parse(custom_code_samples[0]);
    const float expected = shared->evaluate({1, 2, 3}, {});
    std::atomic<int> wrong = 0;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 20; ++i) {
                const auto own = CustomCode::parse(custom_code_samples[0]);
                if (!own.code || own.code->evaluate({1, 2, 3}, {}) != expected) ++wrong;
                if (shared->evaluate({1, 2, 3}, {}) != expected) ++wrong;
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace farfield
