// What is known of each node of a scene before it is drawn, and what is found by trying: bounds, how steep the field is
// promised to be and why, how steep it is at points taken at random, and what is odd about the node.
#pragma once

#include "sdf/edit.h"
#include "sdf/field_tree.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace farfield {

/// Metres; rays stop about as far from a surface a metre away.
inline constexpr float thinnest_skin = 1e-4f;

struct AuditOptions {
    int samples = 2000;  ///< pairs of points for each node; 0: only what follows from the numbers
    /// Evaluations of single nodes in all, some 20 to 100 million a second: nodes with much below them get fewer pairs
    /// when that would be exceeded, and none rather than a few.
    double most_evaluations = 1e8;
    std::uint32_t seed = 1;
    const std::atomic<bool>* stop = nullptr;  ///< set by another thread: ends early, with what there is
};

/// Something that is likely to be a mistake.
struct Finding {
    Id node;
    std::string message;  ///< one sentence without a full stop
    std::string fix{};    ///< what would mend it, as a button says it; empty: nothing that is sure to
    Edits edits{};        ///< and does
};

struct NodeAudit {
    Id id;
    const KindInfo* kind;
    int depth;      ///< 0 for the root
    bool shows;     ///< adds a shape; otherwise nothing below counts
    Box region;     ///< what it fills in its own frame
    Box world;      ///< and in the world
    float stretch;  ///< Lipschitz constant of its field before it is made safe, where its content is; 1 where it needs
                    ///< no care
    std::string origin;                 ///< where that comes from
    int samples = 0;                    ///< pairs of points that were tried
    float slope = 0.0f;                 ///< steepest found, at most 1
    std::optional<float> unsafe_slope;  ///< of the field before it is made safe, at most `stretch`
};

struct Audit {
    std::vector<NodeAudit> nodes;   ///< of the tree and then of the definitions, parents first
    std::vector<Finding> findings;  ///< by node, in the same order

    const NodeAudit* find(Id node) const;
};

Audit audit(const Scene& scene, const AuditOptions& options = {});

/// Skins that are thinner than a pixel from the scene's camera, in a picture of so many pixels' height. `audit`: of the
/// same shapes.
std::vector<Finding> thin_from_camera(const Scene& scene, const Audit& audit, int picture_height);

/// "1.2 x 0.4 x 3 m"; "no end" along axes without one.
std::string size_text(const Box& box);

}  // namespace farfield
