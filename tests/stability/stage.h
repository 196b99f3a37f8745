// Where cases are measured: a headless context with a renderer, and what the cases' scenes are made of.
#pragma once

#include "renderer/context.h"
#include "renderer/renderer.h"
#include "sdf/edit.h"

#include <array>
#include <memory>
#include <optional>

namespace farfield::stability {

/// A scene that grows by edits, as a user's does.
struct Built : Scene {
    Id add(Node node, glm::vec3 at = glm::vec3(0.0f), Id parent = 0);
    Id add_material(glm::vec3 albedo, glm::vec3 emission = glm::vec3(0.0f));
    void add_point_light(glm::vec3 position, glm::vec3 intensity);
    void look(glm::vec3 from, glm::vec3 at, float field_of_view = 40.0f);
    void set_sky(float radiance) { sky = {glm::vec3(radiance), glm::vec3(radiance)}; }
};

Node shape(NodeKind kind, std::vector<glm::vec3> values = {});
Node sphere(float radius);
Node box(glm::vec3 half_size);
inline glm::vec3 number(double v) { return {static_cast<float>(v), 0.0f, 0.0f}; }

/// A box and a ball that lie off all axes and symmetries.
Node beam();
Node ball();

/// One picture by all methods, from the same samples.
struct Pictures {
    std::array<Image, 3> result;
    Image direct, depth;
    Image indirect(Method method) const;  ///< result - direct
};

class Stage {
public:
    explicit Stage(std::unique_ptr<Context> context = make_headless_context(ContextKind::automatic));
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    /// `frames` frames of `samples` from scratch.
    Pictures render(Scene scene, const FrameOptions& options, int samples, int frames = 1);
    /// One view of one method of what is accumulated.
    Image read(Scene scene, FrameOptions options, Method method, View view);
    void make_current() { context_->make_current(); }  ///< again, after another stage
    Renderer& renderer() { return *renderer_; }

private:
    std::unique_ptr<Context> context_;
    std::optional<Renderer> renderer_;
};

inline constexpr Method methods[] = {Method::paper, Method::farfield, Method::reference};
inline constexpr const char* method_names[] = {"paper", "farfield", "reference"};

}  // namespace farfield::stability
