// Renders away from the user interface: a thread with its own OpenGL context that shares textures with the window's.
// The latest request wins: work on an older one is dropped between two bounded dispatches, and no sample of an
// old scene survives in a new picture. Compiling happens here too; meanwhile the last good picture stays.
#pragma once

#include "renderer/context.h"
#include "renderer/statistics.h"
#include "renderer/views.h"
#include "sdf/scene.h"

#include <glm/vec2.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace farfield {

struct RenderRequest {
    std::shared_ptr<const Scene> scene;  ///< null: nothing is rendered
    glm::ivec2 size{0};                  ///< pixels
    View view = View::result;
    std::optional<Look> other = {};  ///< shown beside it, off the same samples
    Id tuned = 0;                    ///< the node whose parameters are likely to be moved next: the selected one
    bool interacting = false;        ///< a hand is moving something: quick pictures, smaller if they must be
    int max_frames = 0;              ///< stop after so many accumulated frames; 0: go on for ever
};

/// The picture as a file, in full size, as soon as there is one.
struct PictureWish {
    std::filesystem::path file;  ///< as of write_picture
    /// Not zero: a small picture within so many pixels, of `scene` alone.
    glm::ivec2 room{0};
    std::shared_ptr<const Scene> scene = nullptr;
};
struct WrittenPicture {
    std::filesystem::path file;
    std::string error;  ///< empty: it was written
};

struct RenderedPicture {
    unsigned texture = 0;  ///< RGBA8, display-ready, row 0 at the top; 0 until the first picture is there
    unsigned other = 0;    ///< the same with the other look; 0 where none was asked for
    glm::ivec2 size{0};
    std::uint64_t serial = 0;    ///< counts pictures
    View view = View::result;    ///< what it shows
    std::optional<Look> beside;  ///< and what the other one
    Statistics statistics;
    int compiled = 0, to_compile = 0;  ///< programs that the latest scene still needed; equal when they are there
    std::string error;                 ///< why the latest scene is not the one in the picture; empty when it is
};

class RenderThread {
public:
    /// `context` is made current on the thread and nowhere else. It shares objects with the caller's context.
    explicit RenderThread(std::unique_ptr<Context> context);
    ~RenderThread();
    RenderThread(const RenderThread&) = delete;
    RenderThread& operator=(const RenderThread&) = delete;

    void submit(RenderRequest request);  ///< never waits
    /// The newest finished picture; never waits for rendering. Its texture stays valid and unchanged until the next
    /// call of acquire. Call with the sharing context current: the call makes that context wait for the picture's
    /// fence.
    RenderedPicture acquire();

    /// Between true and false no new step begins, so that a frame of the user interface that is drawn meanwhile does
    /// not share the processor, where that renders.
    void give_way(bool drawing);

    /// Never waits. A small picture is dropped when another scene comes before it.
    void write(PictureWish wish);
    /// What has become of the wishes, in turn. Nothing is said of small pictures.
    std::optional<WrittenPicture> written();

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace farfield
