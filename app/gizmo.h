// The handles on what is selected, over the picture: nodes and point lights are moved, nodes and directional lights
// turned, nodes scaled. What a drag comes to is returned as edits.
#pragma once

#include "app/gizmo_math.h"
#include "ui/ui.h"

#include <optional>
#include <string>

namespace farfield {

class Gizmo {
public:
    /// Finds what there is to handle and, where the mouse is over the picture and free, what is under it.
    void refresh(const Ui& ui, const Scene& scene, const PictureView& view, bool mouse_free);
    /// Whether the mouse is over a handle.
    bool hovered() const { return hovered_.has_value(); }
    /// Takes the handle under the mouse.
    void begin(const Ui& ui, const Scene& scene, const PictureView& view, glm::vec2 mouse);
    Edits drag(const Scene& scene, glm::vec2 mouse);
    void end() { drag_.reset(); }
    void draw(Ui& ui, const PictureView& view);

private:
    struct Target {
        ObjectRef object;
        Tool tool;
        Pose pose;
    };
    /// A node that a drag changes, as it was.
    struct HeldNode {
        Id id;
        Frame parent;
        Transform start;
        glm::vec3 last_rotate;  ///< what the next angles continue
    };
    static std::optional<Target> find_target(const Ui& ui, const Scene& scene);
    static std::vector<HeldNode> find_nodes(const Ui& ui, const Scene& scene);
    void draw_handle(const Ui& ui, const GizmoShape& shape, Handle handle) const;
    void draw_value(const Ui& ui, const PictureView& view) const;
    std::string value_text() const;

    std::optional<Target> target_;
    std::optional<Handle> hovered_;
    float length_ = 0.0f;
    // While one is held:
    std::optional<GizmoDrag> drag_;
    Target dragged_{};
    std::vector<HeldNode> nodes_;
    Light light_;  ///< as it was
    float metres_per_pixel_ = 0.0f;
    Motion motion_;
};

}  // namespace farfield
