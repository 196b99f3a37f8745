// The whole editor without a window, under random mouse, keys, files and other programs: menus, commands, panels,
// handles in the picture, file dialogs and questions, in windows of all sizes and at several scales. Nothing breaks,
// every scene on the way can be saved, undo leads back to the very start by Ctrl+Z alone, and memory does not grow.
//
// FARFIELD_UI_EVENTS: how many events, where the usual number is not enough. FARFIELD_UI_SEED: the first seed.
#include "app/editor.h"
#include "sdf/scene_file.h"
#include "tests/editor_hand.h"
#include "tests/test_support.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <cmath>
#include <cstdlib>
#include <malloc.h>
#ifdef __SANITIZE_ADDRESS__
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();  // GCC comes without the header
#endif

namespace farfield {
namespace {

namespace fs = std::filesystem;

/// Bytes that the program holds.
std::size_t heap() {
#ifdef __SANITIZE_ADDRESS__
    return __sanitizer_get_current_allocated_bytes();
#else
    const struct mallinfo2 info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
#endif
}

/// But for what Dear ImGui keeps room for: the most vertices that each of its windows ever had.
std::size_t heap_without_drawings() {
    std::size_t drawings = 0;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        const ImDrawList& draw = *window->DrawList;
        drawings += draw.VtxBuffer.Capacity * sizeof(ImDrawVert) + draw.IdxBuffer.Capacity * sizeof(ImDrawIdx);
    }
    return heap() - drawings;
}

/// All folders of a user, and scenes of every sort, in a folder that nothing here leaves.
class Sandbox {
public:
    Sandbox() {
        for (const char* name : {"HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"})
            ::setenv(name, fs::path(folder_ / "home").c_str(), 1);
        fs::create_directories(scenes() / "more");
        fs::current_path(scenes());
        for (unsigned i = 0; i < 4; ++i) fs::copy(bundled_scenes()[i], scenes());
        restore();
    }
    ~Sandbox() { fs::current_path(folder_ / ".."); }
    fs::path scenes() const { return folder_ / "scenes"; }

    void restore() {
        for (unsigned i = 0; i < 3; ++i)
            write_text(scenes() / fmt::format("random {}.json", i), to_text(random_scene(i, 12)));
        write_text(scenes() / "broken.json", "{\"farfield\": 1, \"root\": {\"kind\": \"sphere\", \"radius\": -1}}");
        write_text(scenes() / "more" / "code.json",
                   R"({"farfield":1,"root":{"kind":"union","children":[{"kind":"custom","code":["float sdf(vec3 p) {)"
                   R"( return length(p) - 0.7; }"]}]}})");
    }
    fs::path any(Hand& hand) const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(scenes())) files.push_back(entry.path());
        files.push_back(scenes() / "gone.json");
        std::sort(files.begin(), files.end());
        return files[hand.number() % files.size()];
    }

private:
    TemporaryFolder folder_;
};

/// An editor from its start to its end.
class Life {
public:
    Life(Sandbox& sandbox, unsigned seed)
        : sandbox_(sandbox), hand_(seed), editor_(state_, theme(seed), Report(sandbox.scenes() / "unwritten")) {
        Headless::build_fonts();
        input_.size = {1280.0f, 720.0f};
        editor_.open(sandbox.scenes() / fmt::format("random {}.json", seed % 3), true);
    }

    const Document& document() const { return editor_.document(); }
    long steps() const { return steps_; }  ///< that were made, whatever became of them
    long events() const { return hand_.events() + others_; }
    void end() { editor_.end(); }

    /// Some random events and what they lead to.
    void act() {
        input_.close = hand_.chance(2000);
        if (hand_.chance(150)) resize(), ++others_;
        if (hand_.chance(400)) input_.dropped.push_back(sandbox_.any(hand_)), ++others_;
        if (hand_.chance(60)) ImGui::SetClipboardText(clipboard().c_str()), ++others_;
        if (hand_.chance(150)) other_program(), ++others_;
        input_.fly = glm::vec3(hand_.number() % 3, hand_.number() % 3, hand_.number() % 3) - 1.0f;
        hand_.act({input_.size.x, input_.size.y}, editor_.ui().report, editor_.keyboard_changes_hands());
        stay_in_sandbox();
        frame();
    }

    /// Until no question is open and nothing is held or typed.
    void calm_down() {
        double quiet = 0.0;
        for (int i = 0; i < 400 && quiet < 4.0; ++i) {
            hand_.let_go();
            const auto& controls = editor_.ui().report.controls();
            if (const auto mine = controls.find("changed/mine"); mine != controls.end() && i % 4 == 0)
                hand_.click(mine->second);
            else if (busy() && i % 4 == 2)
                hand_.press({escape_key, false, false, false});
            const double passed = frame();
            quiet = busy() ? 0.0 : quiet + passed;
        }
        ASSERT_FALSE(busy()) << "a question without an answer";
    }

    /// By Ctrl+Z or Ctrl+Y, a step for each.
    void go_to(std::size_t step) {
        while (document().history().position() != step) {
            const std::size_t before = document().history().position();
            hand_.let_go();
            hand_.press({step < before ? 'Z' : 'Y', true, false, false});
            frame();
            hand_.let_go();
            frame();
            ASSERT_EQ(document().history().position(), step < before ? before - 1 : before + 1) << state();
        }
    }

    /// Another file is dropped on the window, and what is unsaved is not wanted.
    void begin_anew() {
        const std::uint64_t before = document().generation();
        sandbox_.restore();
        input_.dropped.push_back(sandbox_.scenes() / fmt::format("random {}.json", hand_.number() % 3));
        for (int i = 0; i < 40 && document().generation() == before; ++i) {
            hand_.let_go();
            const auto& controls = editor_.ui().report.controls();
            for (const char* answer : {"unsaved/discard", "foreign/run"})
                if (const auto found = controls.find(answer); found != controls.end() && i % 2 == 0)
                    hand_.click(found->second);
            frame();
        }
        hand_.let_go();
        frame();
        ASSERT_NE(document().generation(), before) << state();
    }

    /// What has the mouse and the keyboard.
    std::string state() const {
        const ImGuiContext& g = *ImGui::GetCurrentContext();
        std::string text = fmt::format("text {} active {:x} {}", g.IO.WantTextInput, g.ActiveId,
                                       g.ActiveIdWindow ? g.ActiveIdWindow->Name : "");
        for (const ImGuiPopupData& popup : g.OpenPopupStack)
            text += fmt::format(" popup {}", popup.Window ? popup.Window->Name : "");
        return text;
    }

    /// How the document was before all steps.
    const std::string& start() const { return start_; }

private:
    static Theme theme(unsigned seed) {
        constexpr float scales[] = {1.0f, 2.0f, 1.5f};
        return make_theme(scales[seed % std::size(scales)]);
    }
    static bool busy() {
        return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel) ||
               ImGui::GetIO().WantTextInput || ImGui::IsAnyItemActive();
    }

    double frame() {
        const double step = 0.005 * (1 + hand_.number() % 60);
        input_.now += step;
        input_.keys = hand_.take_keys();
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {input_.size.x, input_.size.y};
        io.DeltaTime = static_cast<float>(step);
        editor_.refresh(input_.now);
        ImGui::NewFrame();
        forget_text_undo();
        const EditorOutput output = editor_.frame(input_, measured_);
        ImGui::Render();
        input_.dropped.clear();
        input_.close = false;
        render(output);
        steps_ += document().history().position() > std::exchange(position_, document().history().position());
        if (document().generation() != generation_) {
            generation_ = document().generation();
            History history = document().history();
            history.go_to(0);
            start_ = to_text(history.scene());
        }
        return step;
    }

    /// What a renderer might do.
    void render(const EditorOutput& output) {
        for (const PictureWish& wish : output.pictures)
            if (wish.room.x == 0) editor_.exported({wish.file, hand_.chance(2) ? "" : "there is no room"});
        if (output.measure != MeasureWish::none) measured_.running = output.measure == MeasureWish::start;
        if (measured_.running && hand_.chance(4)) {
            ChartPoint point;
            point.seconds = std::pow(10.0, hand_.number() % 5 - 3.0);
            point.error = 0.3 / (1 + hand_.number() % 50);
            point.setting.samples = 4;
            point.setting.blur_levels = 3;
            point.setting.ao_radius = 1.0f;
            measured_.points.push_back(point);
            if (measured_.points.size() > 40) measured_ = {};
        }
        if (!hand_.chance(3)) return;
        ++picture_.serial;
        picture_.texture = 1;
        picture_.size = editor_.picture_size();
        ++picture_.statistics.frames;
        picture_.error = hand_.chance(10) ? "sphere: cannot be compiled\n0:1: syntax error" : "";
        editor_.show(picture_);
    }

    void resize() {
        input_.size = {800 + hand_.number() % 1700, 500 + hand_.number() % 1000};
        input_.pixels_per_unit = hand_.chance(2) ? glm::vec2(1.0f) : glm::vec2(2.0f);
    }

    std::string clipboard() {
        if (hand_.chance(3)) return "float sdf(vec3 p) { return length(p) - 0.4; }";
        if (hand_.chance(3)) return "12.5";
        return to_text(random_scene(hand_.number() % 100, 6));
    }

    /// Another program writes the document's file, or spoils it.
    void other_program() {
        if (hand_.chance(8)) return sandbox_.restore();
        const fs::path file = document().file();
        if (file.empty()) return;
        if (hand_.chance(6)) return void(fs::remove(file));
        if (hand_.chance(6)) return write_text(file, "{ no scene");
        Scene scene = document().scene();
        for (int i = 0; i < 8; ++i) {
            try {
                farfield::apply(scene, random_edit(scene, hand_.random()));
            } catch (const EditError&) {  // what makes no sense is refused
            }
        }
        write_text(file, to_text(scene));
    }

    /// A file dialog that has left the sandbox is closed, and a path to elsewhere cannot be pasted.
    void stay_in_sandbox() {
        const ImGuiWindow* dialog = ImGui::GetTopMostPopupModal();
        if (!dialog || std::string_view(dialog->Name).find("###file_dialog") == std::string_view::npos) return;
        ImGui::SetClipboardText("pasted");
        if (editor_.ui().report.controls().contains("dialog/folder/" + sandbox_.scenes().string())) return;
        hand_.let_go();
        ImGui::GetIO().ClearInputCharacters();
        hand_.press({escape_key, false, false, false});
    }

    Headless imgui_;
    Sandbox& sandbox_;
    Hand hand_;
    EditorState state_ = load_editor_state(editor_state_file());
    Editor editor_;
    EditorInput input_;
    MeasureResults measured_;
    RenderedPicture picture_;
    std::uint64_t generation_ = 0;
    std::string start_;
    long others_ = 0, steps_ = 0;
    std::size_t position_ = 0;
};

long number_of(const char* variable, long usual) {
    const char* text = std::getenv(variable);
    return text ? std::atol(text) : usual;
}

TEST(EditorFuzz, SurvivesRandomEventsAndUndoLeadsBackToTheStart) {
    const long all = number_of("FARFIELD_UI_EVENTS", 20'000), of_a_life = std::max(all / 8, 2'000L);
    auto seed = static_cast<unsigned>(number_of("FARFIELD_UI_SEED", 0));
    Sandbox sandbox;
    long events = 0;
    long steps = 0;
    std::size_t first_heap = 0;
    for (int lives = 0; events < all; ++lives, ++seed) {
        SCOPED_TRACE(fmt::format("seed {}", seed));
        {
            Life life(sandbox, seed);
            std::size_t begun = 0;
            while (life.events() < of_a_life) {
                for (int i = 0; i < 400; ++i) life.act();
                const std::string text = to_text(life.document().scene());
                ASSERT_EQ(to_text(parse_scene(text, "scene")), text);
                life.calm_down();
                const std::string end = to_text(life.document().scene());
                const std::size_t step = life.document().history().position();
                life.go_to(0);
                ASSERT_EQ(to_text(life.document().scene()), life.start());
                life.go_to(step);
                ASSERT_EQ(to_text(life.document().scene()), end);
                life.begin_anew();
                if (::testing::Test::HasFatalFailure()) return;
                // Nothing but the window is left of a document that is gone.
                if (begun == 0) begun = heap_without_drawings();
                ASSERT_LT(heap_without_drawings(), begun + 3'000'000) << life.events() << " events, first " << begun;
            }
            events += life.events();
            steps += life.steps();
            if (seed % 2 == 0) life.end();  // otherwise it is killed, and its work is there to be recovered
        }
        // Nothing is left of an editor that is gone.
        if (lives == 2) first_heap = heap();
        if (lives > 2) {
            ASSERT_LT(heap(), first_heap + 300'000) << lives << " lives";
        }
    }
    EXPECT_GT(steps, events / 50) << "the hand changed something";
    RecordProperty("events", std::to_string(events));
}

}  // namespace
}  // namespace farfield
