// What the editor remembers between runs.
#include "app/editor_state.h"

#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

TEST(EditorState, IsReadAsItWasWritten) {
    EditorState state;
    state.size = glm::ivec2(1000, 700);
    state.place = glm::ivec2(-5, 30);
    state.panels.left = 312.5f;
    state.code = state.newest_first = true;
    state.statistics = false;
    state.split = {.on = true, .divider = 0.25f, .method = {}, .view = View::coarse, .blur_levels = 5};
    state.recent = {"/a/b.json", "/c.json"};
    const EditorState read = parse_editor_state(to_text(state));
    EXPECT_EQ(to_text(read), to_text(state));
    EXPECT_EQ(read.place, state.place);
    EXPECT_EQ(read.recent, state.recent);
    EXPECT_TRUE(read.code);
    EXPECT_EQ(read.split, state.split);
}

TEST(EditorState, WhatMakesNoSenseIsAsAtTheFirstRun) {
    const std::string first = to_text(EditorState());
    for (const char* text :
         {"", "{", "[]", "7", "null", R"({"window": []})", R"({"window": {"size": [1e99, 4]}})",
          R"({"window": {"size": [0, -1], "place": ["a", 1]}})", R"({"window": {"size": [1, 2, 3]}})",
          R"({"panels": {"left": -1, "right": 1e30, "objects": null, "settings": "x"}})",
          R"({"code": 1, "statistics": "no", "recent": {}})", R"({"split": 1})",
          R"({"split": {"on": 1, "divider": 0, "method": "x", "view": "y", "blur_levels": 1e9}})",
          R"({"recent": [1, null, "relative.json", ""]})", "\xff\xfe"})
        EXPECT_EQ(to_text(parse_editor_state(text)), first) << text;
    EXPECT_EQ(parse_editor_state(R"({"window": 3, "code": true})").code, true) << "the rest counts";
    EXPECT_EQ(to_text(load_editor_state("/nosuch")), first);
}

TEST(EditorState, RecentFilesAreFewAndThereAndShared) {
    TemporaryFolder folder;
    const fs::path file = folder / "state/editor.json";
    EditorState one, two;
    for (int i = 0; i < 20; ++i) {
        const fs::path scene = folder / fmt::format("{}.json", i);
        write_text(scene, "");
        remember_file(i % 2 ? one : two, scene, file);
    }
    remember_file(two, folder / "12.json", file);
    EXPECT_EQ(two.recent.size(), 12u);
    EXPECT_EQ(two.recent[0], folder / "12.json");
    EXPECT_EQ(two.recent[1], folder / "19.json");
    fs::remove(folder / "19.json");
    EXPECT_EQ(load_editor_state(file).recent.size(), 11u);
    EXPECT_EQ(load_editor_state(file).recent[1], folder / "18.json");
}

}  // namespace
}  // namespace farfield
