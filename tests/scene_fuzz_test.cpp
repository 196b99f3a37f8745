// Scene files that are broken in every way: each gives an error or a valid scene, never a crash or a hang.
// Meant to run under the sanitizers as well (preset asan). All seeds are fixed.
#include "sdf/scene_file.h"

#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace farfield {
namespace {

/// Whether `text` is a scene. If so it must also be one after saving; if not, the error must name a line of the text.
bool is_scene(const std::string& text) {
    try {
        const Scene scene = parse_scene(text, "a.json");
        const std::string saved = to_text(scene);
        EXPECT_EQ(to_text(parse_scene(saved, "b.json")), saved);
        return true;
    } catch (const SceneFileError& error) {
        EXPECT_EQ(error.file, "a.json") << error.what();
        EXPECT_GE(error.line, 1);
        EXPECT_LE(error.line, 1 + std::count(text.begin(), text.end(), '\n'));
        EXPECT_FALSE(error.problem.empty());
        return false;
    }
}

class Mutator {
public:
    explicit Mutator(unsigned seed) : random_(seed) {}

    std::string operator()(std::string text) {
        for (size_t i = 1 + below(3); i > 0 && !text.empty(); --i) mutate(text);
        return text;
    }

private:
    size_t below(size_t n) { return random_() % n; }

    /// The bounds of a token near a random place: a maximal run of letters and digits, or one other character.
    std::pair<size_t, size_t> token(const std::string& text) {
        auto is_word = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.' || c == '-'; };
        size_t first = below(text.size()), last = first + 1;
        if (!is_word(text[first])) return {first, 1};
        while (first > 0 && is_word(text[first - 1])) --first;
        while (last < text.size() && is_word(text[last])) ++last;
        return {first, last - first};
    }

    void mutate(std::string& text) {
        switch (below(7)) {
            case 0:
                text[below(text.size())] ^= static_cast<char>(1 << below(8));
                break;
            case 1:
                text.resize(below(text.size()));
                break;
            case 2:
                text.erase(below(text.size()), 1 + below(20));
                break;
            case 3: {  // copy a piece to elsewhere
                const std::string piece = text.substr(below(text.size()), 1 + below(200));
                text.insert(below(text.size()), piece);
                break;
            }
            case 4: {  // swap two tokens
                const auto a = token(text), b = token(text);
                const std::string first = text.substr(a.first, a.second), second = text.substr(b.first, b.second);
                if (a.first + a.second <= b.first)
                    text.replace(b.first, b.second, first), text.replace(a.first, a.second, second);
                break;
            }
            case 5: {  // another token
                static const char* const tokens[] = {"NaN", "-1",     "1e999", "-1e30",    "1e38",
                                                     "0",   "null",   "true",  "{",        "}",
                                                     "[",   "]",      ",",     "\"\"",     "99999999999999999999",
                                                     "-0",  "1e-320", "0.5",   "\"kind\"", "\\u0000",
                                                     "\xff"};
                const auto [at, length] = token(text);
                text.replace(at, length, tokens[below(std::size(tokens))]);
                break;
            }
            case 6: {  // another number in place of a number
                static const char* const numbers[] = {"1e999", "-5", "1e38", "3.5e6", "-0", "1e-45", "NaN", "1000000"};
                for (int i = 0; i < 100; ++i) {
                    const auto [at, length] = token(text);
                    if (std::isdigit(static_cast<unsigned char>(text[at]))) {
                        text.replace(at, length, numbers[below(std::size(numbers))]);
                        break;
                    }
                }
                break;
            }
        }
    }

    std::mt19937 random_;
};

TEST(SceneFuzz, MutatedScenesGiveAnErrorOrAScene) {
    std::vector<std::string> originals;
    for (const auto& file : bundled_scenes()) originals.push_back(read_text(file));
    for (unsigned seed = 0; seed < 4; ++seed) originals.push_back(to_text(random_scene(seed)));
    int scenes = 0, errors = 0;
    for (unsigned seed = 0; seed < 1000; ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        (is_scene(Mutator(seed)(originals[seed % originals.size()])) ? scenes : errors)++;
    }
    // Both outcomes must be met often, or the mutations are too weak or too strong to test anything.
    EXPECT_GT(scenes, 50);
    EXPECT_GT(errors, 500);
}

TEST(SceneFuzz, EveryTruncationIsAnError) {
    const std::string text = to_text(random_scene(3, 12));
    for (size_t length = 0; length + 2 < text.size(); ++length)  // without the last brace, that is
        ASSERT_FALSE(is_scene(text.substr(0, length))) << length;
    EXPECT_TRUE(is_scene(text));
}

std::string repeated(std::string_view text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
}

TEST(SceneFuzz, DeepNestingIsAnError) {
    EXPECT_FALSE(is_scene(repeated("[", 100'000)));
    EXPECT_FALSE(is_scene(repeated("{\"a\":", 100'000)));
    const char* before = R"({"kind":"union","children":[)";
    auto nested = [&](int depth) {
        return R"({"farfield":1,"root":)" + repeated(before, depth) + repeated("]}", depth) + "}";
    };
    EXPECT_FALSE(is_scene(nested(100'000)));
    EXPECT_TRUE(is_scene(nested(499)));
    EXPECT_FALSE(is_scene(nested(500)));
}

TEST(SceneFuzz, LargeFilesEndSoon) {
    // Each as large as load_scene takes, shaped to strike a different part that might be slow.
    const std::string head = R"({"farfield":1,"root":{"kind":"union","children":[)";
    EXPECT_TRUE(is_scene(head + R"({"kind":"plane"})" + repeated(R"(,{"kind":"plane"})", 100'000) + "]}}"));
    EXPECT_FALSE(is_scene(repeated("[[],", 500) + repeated("[],", 1'000'000)));
    std::string keys = "{";
    for (int i = 0; i < 300'000; ++i) keys += fmt::format("\"key {}\":0,\n", i);
    EXPECT_FALSE(is_scene(keys + "\"farfield\":1}"));
    std::string materials = R"({"farfield":1,"root":{"kind":"union"},"materials":{"m":{})";
    for (int i = 0; i < 4'000; ++i) materials += fmt::format(",\"{}\":{{}}", i);
    EXPECT_TRUE(is_scene(materials + "}}"));
    std::string codes;
    for (int i = 0; i < 256; ++i)
        codes += fmt::format(
            ",{{\"kind\":\"custom\",\"code\":[\"float sdf(vec3 p) {{ float d = {}.0;\"{},\"return d; }}\"]}}", i,
            repeated(",\"d += length(2.0 * p) - sin(p.x) * cos(p.y);\"", 400));
    EXPECT_TRUE(is_scene(head + R"({"kind":"plane"})" + codes + "]}}"));
    EXPECT_FALSE(is_scene("{\"" + std::string(8'000'000, 'x')));
    EXPECT_FALSE(is_scene("{\"a\":" + std::string(1'000'000, '9') + "}"));
}

}  // namespace
}  // namespace farfield
