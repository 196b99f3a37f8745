// The editor without a window, by mouse and keyboard, where things go wrong: it says so, nothing is lost, and one can
// go on.
#include "app/editor.h"
#include "sdf/scene_file.h"
#include "tests/editor_hand.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <thread>

#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

namespace farfield {
namespace {

namespace fs = std::filesystem;

/// Someone at an editor whose folders are in `home`.
class Session {
public:
    explicit Session(const fs::path& home) {
        for (const char* name : {"HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"})
            ::setenv(name, home.c_str(), 1);
        editor_.emplace(state_, make_theme(1.0f), Report(home / "unwritten"));
        Headless::build_fonts();
        input_.size = {1280.0f, 720.0f};
        frames(4);
    }

    Editor& editor() { return *editor_; }
    const Document& document() const { return editor_->document(); }
    EditorInput& input() { return input_; }
    bool sees(const std::string& control) const { return editor_->ui().report.controls().contains(control); }

    void frame() {
        input_.now += 0.02;
        input_.keys = hand_.take_keys();
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {input_.size.x, input_.size.y};
        io.DeltaTime = 0.02f;
        editor_->refresh(input_.now);
        ImGui::NewFrame();
        editor_->frame(input_, {});
        ImGui::Render();
        input_.dropped.clear();
    }
    void frames(int count) {
        for (int i = 0; i < count; ++i) frame();
    }
    void press(int key, bool ctrl = false, bool shift = false) {
        hand_.press({key, ctrl, shift, false});
        frame();
        hand_.let_go();
        frames(3);
    }
    void mouse(const std::string& control, bool down) {
        const auto found = editor_->ui().report.controls().find(control);
        ASSERT_NE(found, editor_->ui().report.controls().end()) << control;
        hand_.click(found->second);
        ImGui::GetIO().MouseDown[0] = down;
        frame();
    }
    void click(const std::string& control) {
        mouse(control, false);
        mouse(control, true);
        hand_.let_go();
        frames(4);
    }
    void type(const std::string& text) {
        for (const char c : text) ImGui::GetIO().AddInputCharacter(static_cast<unsigned char>(c));
        frames(2);
    }
    void add(const std::string& kind) {
        press('A');
        type(kind);
        press(GLFW_KEY_ENTER);
    }
    void save_as(const fs::path& file) {
        press('S', true, true);
        press('A', true);
        type(file.string());
        press(GLFW_KEY_ENTER);
    }
    /// Whether the message comes to have `text` in it, while threads work.
    bool says(const std::string& text) {
        for (int i = 0; i < 1000 && editor_->error().find(text) == std::string::npos; ++i) {
            frame();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return editor_->error().find(text) != std::string::npos;
    }

private:
    Headless imgui_;
    Hand hand_{0};
    EditorState state_;
    std::optional<Editor> editor_;
    EditorInput input_;
};

std::string saved_text(const fs::path& file) { return to_text(load_scene(file)); }

/// `test` in a process of its own, which may change what it is and sees of the system; 77 where it may not.
int in_child(const std::function<int()>& test) {
    const pid_t child = ::fork();
    if (child == 0) {
        const int result = test();
        ::_exit(::testing::Test::HasFailure() ? 1 : result);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Editor, AFullDiskIsSaidAndTheWorkIsSavedOnceThereIsRoom) {
    TemporaryFolder folder;
    const int status = in_child([&] {
        const bool mounted = (::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0) &&
                             ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                             ::mount("none", (folder / "").c_str(), "tmpfs", 0, "size=64k") == 0;
        if (!mounted) return 77;
        Session session(folder / "");
        const fs::path file = folder / "mine.json";
        session.add("torus");
        session.save_as(file);
        EXPECT_TRUE(session.document().saved());
        const std::string old = saved_text(file);
        // The copy of unsaved work goes on a thread of its own, and would leave room.
        const auto is_copy = [](const fs::directory_entry& entry) { return entry.path().extension() == ".work"; };
        const fs::path unsaved = folder / "farfield/unsaved";
        while (std::any_of(fs::directory_iterator(unsaved), fs::directory_iterator(), is_copy)) session.frame();

        std::ofstream(folder / "filler") << std::string(100'000, 'x');
        session.add("box");
        EXPECT_TRUE(session.says("Unsaved work cannot be kept")) << session.editor().error();
        session.press('S', true);
        EXPECT_TRUE(session.says("No space left on device"));
        EXPECT_TRUE(session.says("your work is still here"));
        EXPECT_FALSE(session.document().saved());
        EXPECT_EQ(saved_text(file), old);
        session.add("cone");
        EXPECT_EQ(session.document().scene().root.children.size(), 3u);
        EXPECT_NE(session.editor().error(), "");  // still

        fs::remove(folder / "filler");
        session.press('S', true);
        EXPECT_TRUE(session.document().saved());
        EXPECT_EQ(session.editor().error(), "");
        EXPECT_EQ(saved_text(file), to_text(session.document().scene()));
        return 0;
    });
    if (status == 77) GTEST_SKIP() << "nothing can be mounted here";
    EXPECT_EQ(status, 0);
}

TEST(Editor, AFolderThatIsReadOnlyIsSaidAndAnotherServes) {
    TemporaryFolder folder;
    fs::create_directory(folder / "closed");
    fs::create_directory(folder / "open");
    fs::permissions(folder / "", fs::perms(0755));
    fs::permissions(folder / "closed", fs::perms(0555));
    fs::permissions(folder / "open", fs::perms(0777));
    const int status = in_child([&] {
        if (::geteuid() == 0 && ::setuid(65534) != 0) return 77;  // root may write anywhere
        Session session(folder / "closed");
        session.add("torus");
        EXPECT_TRUE(session.says("cannot be kept"));
        session.save_as(folder / "closed" / "mine.json");
        EXPECT_TRUE(session.says("its folder cannot be written to: Permission denied"));
        EXPECT_FALSE(session.document().saved());
        session.save_as(folder / "open" / "mine.json");
        EXPECT_TRUE(session.document().saved());
        EXPECT_EQ(session.editor().error(), "");
        EXPECT_EQ(saved_text(folder / "open" / "mine.json"), to_text(session.document().scene()));
        return 0;
    });
    fs::permissions(folder / "closed", fs::perms(0755));
    if (status == 77) GTEST_SKIP() << "another user cannot be had here";
    EXPECT_EQ(status, 0);
}

TEST(Editor, AFileOfAHundredMegabytesIsRefusedSoon) {
    TemporaryFolder folder;
    Session session(folder / "");
    session.add("torus");
    const std::string scene = to_text(session.document().scene());
    {
        std::ofstream file(folder / "large.json");
        file << R"({"farfield":1,"root":{"kind":"union","children":[{"kind":"plane"})";
        for (int i = 0; i < 5'600'000; ++i) file << R"(,{"kind":"plane"})";
        file << "]}}";
    }
    ASSERT_GT(fs::file_size(folder / "large.json"), 95'000'000u);
    session.input().dropped = {folder / "large.json"};
    const auto start = std::chrono::steady_clock::now();
    session.frames(6);
    session.click("unsaved/discard");
    // Only as much is read as a scene may have.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    EXPECT_TRUE(session.says("is too large"));
    EXPECT_EQ(to_text(session.document().scene()), scene);
    session.press('Z', true);
    EXPECT_TRUE(session.document().scene().root.children.empty());
}

TEST(Editor, AQuestionWaitsUntilWhatIsDraggedIsDropped) {
    TemporaryFolder folder;
    Session session(folder / "");
    session.add("torus");
    session.add("box");
    session.save_as(folder / "mine.json");
    session.add("cone");
    ASSERT_FALSE(session.document().saved());
    // A node is dragged out of the tree while another program writes the file.
    session.mouse("tree/Torus", false);
    session.mouse("tree/Torus", true);
    ImGui::GetIO().MousePos.y += 30.0f;
    session.frames(2);
    ASSERT_TRUE(ImGui::GetDragDropPayload());
    write_text(folder / "mine.json", to_text(random_scene(1)));
    ImGui::GetIO().MousePos = {-50.0f, -50.0f};
    session.frames(200);
    EXPECT_FALSE(session.sees("changed/mine"));
    ImGui::GetIO().MouseDown[0] = false;
    session.frames(4);
    EXPECT_TRUE(session.sees("changed/mine"));
}

TEST(Editor, KeysThatOpenAWindowAndAQuestionMayComeAtOnce) {
    TemporaryFolder folder;
    Session session(folder / "");
    session.add("torus");
    session.input().close = true;
    session.press(GLFW_KEY_F1);
    session.input().close = false;
    session.frames(4);
    EXPECT_TRUE(session.sees("unsaved/cancel"));
    session.click("unsaved/cancel");
    EXPECT_FALSE(session.sees("unsaved/cancel"));
}

}  // namespace
}  // namespace farfield
