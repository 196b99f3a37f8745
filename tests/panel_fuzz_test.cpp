// The panels without a window, under random mouse, keys and edits: nothing breaks, every scene on the way can be saved,
// and undo leads back to the very start.
//
// FARFIELD_UI_EVENTS: how many events, where the usual number is not enough.
#include "sdf/history.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"
#include "ui/code_panel.h"
#include "ui/inspector_panel.h"
#include "ui/objects_panel.h"
#include "ui/settings_panel.h"
#include "ui/tree_panel.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>

namespace farfield {
namespace {

/// Dear ImGui without a window or a device.
class Headless {
public:
    Headless() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280.0f, 720.0f};
        for (int key = 0; key < ImGuiKey_COUNT; ++key) io.KeyMap[key] = key;
    }
    ~Headless() { ImGui::DestroyContext(); }
    Headless(const Headless&) = delete;
    Headless& operator=(const Headless&) = delete;
    /// After the fonts are chosen.
    static void build_fonts() {
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }
};

/// What a hand does between two frames.
class Hand {
public:
    explicit Hand(unsigned seed) : random_(seed) {}

    bool chance(int one_in) { return random_() % static_cast<unsigned>(one_in) == 0; }
    unsigned number() { return static_cast<unsigned>(random_()); }
    std::mt19937& random() { return random_; }

    /// Returns how many events that were.
    int act() {
        ImGuiIO& io = ImGui::GetIO();
        int events = 0;
        const auto event = [&](int one_in, const std::function<void()>& what) {
            if (!chance(one_in)) return;
            what();
            ++events;
        };
        event(2, [&] {
            if (chance(3))
                io.MousePos = {static_cast<float>(number() % 1280), static_cast<float>(number() % 720)};
            else
                io.MousePos = {io.MousePos.x + static_cast<float>(number() % 21) - 10.0f,
                               io.MousePos.y + static_cast<float>(number() % 21) - 10.0f};
        });
        event(2, [&] { io.MouseDown[0] = !io.MouseDown[0]; });
        event(16, [&] { io.MouseDown[1] = !io.MouseDown[1]; });
        event(12, [&] { io.MouseWheel = chance(2) ? 1.0f : -3.0f; });
        event(24, [&] { io.KeyCtrl = !io.KeyCtrl; });
        event(24, [&] { io.KeyShift = !io.KeyShift; });
        event(4, [&] { io.KeysDown[number() % ImGuiKey_COUNT] ^= true; });
        event(3, [&] { io.AddInputCharacter(letters[number() % (sizeof letters - 1)]); });
        return events;
    }

private:
    static constexpr char letters[] = "0123456789.-+*/e() abcdefghij\"{};\n\t";
    std::mt19937 random_;
};

/// A window of an editor's panels, with a document.
class Session {
public:
    Session(Scene scene, unsigned seed) : hand_(seed), history_(std::move(scene)), ui_(make_theme(1.0f), Report()) {
        Headless::build_fonts();
        ui_.trust = &trust_;
        ui_.selection = ui_.inspected = ObjectRef{ObjectType::node, history_.scene().root.id};
    }

    const History& history() const { return history_; }
    History& history() { return history_; }

    int frame() {
        const int events = hand_.act();
        ImGuiIO& io = ImGui::GetIO();
        io.DeltaTime = 0.01f + 0.01f * static_cast<float>(hand_.number() % 40);
        ImGui::NewFrame();
        forget_text_undo();
        if (!ImGui::IsAnyItemActive()) ++gesture_;
        draw();
        ImGui::Render();
        io.MouseWheel = 0.0f;
        if (hand_.chance(8)) change({random_edit(history_.scene(), hand_.random())}, 0);
        if (hand_.chance(12)) history_.undo();
        if (hand_.chance(16)) history_.redo();
        if (hand_.chance(64)) ui_.open_add = true;
        if (hand_.chance(64)) ui_.focus_name = true;
        if (hand_.chance(64)) ui_.edit_code = !ui_.edit_code;
        if (hand_.chance(16)) {
            const std::vector<Id> ids = all_ids(history_.scene());
            ui_.selection = ObjectRef{ObjectType::node, ids[hand_.number() % ids.size()]};
            if (hand_.chance(2)) ui_.select(toggled(ui_.selected(), ids[hand_.number() % ids.size()]));
        }
        return events;
    }

private:
    void panel(const char* name, ImVec2 low, ImVec2 size, const std::function<void()>& draw_in) {
        ImGui::SetNextWindowPos(low);
        ImGui::SetNextWindowSize(size);
        ImGui::Begin(name, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings);
        draw_in();
        ImGui::End();
    }

    void draw() {
        const Scene& scene = history_.scene();
        std::vector<Edits> edits;
        panel("tree", {0, 0}, {250, 480}, [&] { edits.push_back(tree_panel(ui_, scene)); });
        panel("objects", {0, 480}, {250, 240}, [&] { edits.push_back(objects_panel(ui_, scene)); });
        panel("inspector", {944, 0}, {336, 446}, [&] { edits.push_back(inspector_panel(ui_, scene)); });
        panel("settings", {944, 446}, {336, 274}, [&] { edits.push_back(settings_panel(ui_, scene, statistics_)); });
        panel("code", {250, 0}, {694, 720}, [&] { edits.push_back(code_.draw(ui_, scene, history_.revision())); });
        for (const Edits& of_panel : edits) change(of_panel, gesture_);
    }

    void change(const Edits& edits, unsigned gesture) {
        try {
            history_.apply(edits, gesture);
        } catch (const EditError&) {  // what makes no sense is refused
        }
    }

    Hand hand_;
    History history_;
    CodeTrust trust_;
    Ui ui_;
    CodePanel code_;
    Statistics statistics_;
    unsigned gesture_ = 0;
};

/// Until the start is reached.
int undo_all(History& history) {
    int steps = 0;
    for (; history.can_undo(); ++steps) history.undo();
    return steps;
}

TEST(Panels, SurviveRandomEventsAndUndoLeadsBackToTheStart) {
    const char* wanted = std::getenv("FARFIELD_UI_EVENTS");
    const long all = wanted ? std::atol(wanted) : 20'000;
    constexpr int frames = 400;  // of one document; then another begins
    long events = 0, steps = 0;
    for (unsigned seed = 0; events < all; ++seed) {
        SCOPED_TRACE(seed);
        const Headless headless;
        const Scene start = random_scene(seed, 12);
        Session session(start, seed);
        for (int i = 0; i < frames; ++i) {
            events += session.frame();
            if (i % 100 != 99) continue;
            const std::string text = to_text(session.history().scene());
            ASSERT_EQ(to_text(parse_scene(text, "scene")), text);
        }
        const std::string end = to_text(session.history().scene());
        const int undone = undo_all(session.history());
        ASSERT_EQ(to_text(session.history().scene()), to_text(start));
        for (int i = 0; i < undone; ++i) session.history().redo();
        ASSERT_EQ(to_text(session.history().scene()), end);
        steps += undone;
    }
    EXPECT_GT(steps, events / 100) << "the hand changed something";
    RecordProperty("events", std::to_string(events));
}

}  // namespace
}  // namespace farfield
