// Undo as the picture shows it.
#include "renderer/context.h"
#include "renderer/renderer.h"
#include "sdf/history.h"
#include "sdf/scene_file.h"
#include "tests/test_support.h"

#include <gtest/gtest.h>

namespace farfield {
namespace {

TEST(Undo, ThePictureAtTheEndOfUndoIsTheStartsBitForBit) {
    const auto context = make_headless_context(ContextKind::automatic);
    context->make_current();
    {
        Renderer renderer;
        FrameOptions options;
        options.size = {64, 64};
        const auto picture = [&](const Scene& scene, int frames) {
            renderer.update(scene, options);
            for (int i = 0; i < frames; ++i) renderer.render_frame();
            return renderer.read(View::result).pixels;
        };
        std::mt19937 random(4);
        // A scene that is seen: random ones often stand beside the camera or in the dark.
        History history(load_scene(std::filesystem::path(FARFIELD_SCENES) / "csg_part.json"));
        const std::vector<float> start = picture(history.scene(), 2);
        int steps = 0, rendered = 0, different = 0;
        for (int i = 0; i < 200; ++i) {
            try {
                history.apply(random_edit(history.scene(), random));
            } catch (const EditError&) {
                continue;
            }
            // A program for each structure takes long to compile: some of the scenes on the way, not all.
            if (++steps % 10 != 0) continue;
            different += picture(history.scene(), 1) != start;
            ++rendered;
        }
        EXPECT_GT(rendered, 5);
        EXPECT_GT(different, 3);
        while (history.can_undo()) history.undo();
        EXPECT_EQ(picture(history.scene(), 2), start);
    }
    context->release();
}

}  // namespace
}  // namespace farfield
