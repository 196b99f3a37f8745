#include "app/world_frame.h"

#include <cmath>
#include <functional>
#include <vector>

namespace farfield {
namespace {

using Wanted = std::function<bool(const Node&)>;

bool is_finite(const Frame& frame) {
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(frame.origin[i])) return false;
    return std::isfinite(frame.scale) && frame.scale > 0.0f;
}

/// The nodes from `node` down to the first that is wanted; empty where none is.
bool find_path(const Node& node, const Wanted& is_wanted, std::vector<const Node*>& path) {
    path.push_back(&node);
    if (is_wanted(node)) return true;
    for (const Node& child : node.children)
        if (find_path(child, is_wanted, path)) return true;
    path.pop_back();
    return false;
}

Frame placed(Frame frame, const std::vector<const Node*>& path, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) frame = frame.placed(path[i]->transform);
    return frame;
}

/// The frame of the parent of the first node that is wanted, and with `within` that node's own.
std::optional<Frame> find_frame(const Scene& scene, const Wanted& is_wanted, bool within) {
    std::vector<const Node*> path;
    if (find_path(scene.root, is_wanted, path)) return placed({}, path, path.size() - !within);
    for (const Node& definition : scene.definitions) {
        if (!find_path(definition, is_wanted, path)) continue;
        // Ends because no definition contains itself.
        const auto shows = [&](const Node& node) { return node.definition == definition.id; };
        return placed(find_frame(scene, shows, true).value_or(Frame{}), path, path.size() - !within);
    }
    return std::nullopt;
}

}  // namespace

Frame Frame::placed(const Transform& transform) const {
    return {to_world(transform.translate), rotation * rotation_matrix(transform), scale * transform.scale};
}

std::optional<Frame> parent_frame(const Scene& scene, Id id) {
    const auto frame = find_frame(
        scene, [id](const Node& node) { return node.id == id; }, false);
    return frame && is_finite(*frame) ? frame : std::nullopt;
}

}  // namespace farfield
