#include "sdf/audit.h"

#include "sdf/evaluate.h"
#include "sdf/pick.h"
#include "sdf/placement.h"
#include "sdf/slope_search.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <regex>
#include <unordered_map>

namespace farfield {
namespace {

using glm::vec3;

constexpr int fewest_samples = 50;        // fewer pairs tell nothing
constexpr float furthest = 1e4f;          // metres; beyond, neighbouring floats are a millimetre apart
constexpr float most_relative = 1.0001f;  // of a slope, for what `rounding` below does not cover

std::string text(vec3 p) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z); }

bool stopped(const AuditOptions& options) { return options.stop && *options.stop; }

/// Evaluations of nodes that one of this one takes.
double cost(const FieldTree& tree, const FieldNode& node) {
    double below = 0.0;
    for (const FieldNode& child : node.children) below += cost(tree, child);
    if (node.kind->role == Role::instance) below += cost(tree, tree.definitions[node.definition]);
    return 1.0 + below * (node.kind->cells ? node.kind->cells(node.values) : 1);
}

std::string lower_case(std::string text) {
    if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    return text;
}

Finding with_thickness(Finding finding, float enough) {
    finding.fix = fmt::format("Make thickness {:.3g} m", enough);
    finding.edits = {SetValue{{ObjectType::node, finding.node}, "thickness", vec3(enough, 0.0f, 0.0f)}};
    return finding;
}

/// The code with another constant, which is written in front where there was none.
std::string with_lipschitz(const std::string& code, const std::string& value) {
    static const std::regex declared(R"(const\s+float\s+lipschitz\s*=[^;]*;)");
    const std::string line = fmt::format("const float lipschitz = {};", value);
    const std::string changed = std::regex_replace(code, declared, line, std::regex_constants::format_first_only);
    return changed != code ? changed : line + "\n" + code;
}

std::string origin(const FieldNode& node) {
    const KindInfo& kind = *node.kind;
    switch (kind.role) {
        case Role::instance:
            return "as its definition";
        case Role::primitive:
            if (node.code) return "as its code declares";
            return kind.exact ? "exact distance" : "a bound that is 1-Lipschitz";
        case Role::combine:
            return lower_case(kind.label) + " of 1-Lipschitz children";
        case Role::repeat:
            return "the nearest of 1-Lipschitz copies";
        default:
            if (kind.explain) return kind.explain(node.values);
            return kind.domain ? "moves points no further apart: as 1-Lipschitz as its content"
                               : "shifts the distance: as 1-Lipschitz as its content";
    }
}

/// The part of a box that has an end, around the origin along the other axes.
Box finite(const Box& box) {
    float half = 1.0f;
    for (int axis = 0; axis < 3; ++axis)
        if (box.is_bounded(axis)) half = std::max(half, 0.5f * box.size()[axis]);
    Box result = box;
    for (int axis = 0; axis < 3; ++axis) {
        if (box.is_bounded(axis)) continue;
        // A half-space ends on one side: around that.
        const bool low = !is_unbounded(box.low[axis]), high = !is_unbounded(box.high[axis]);
        const float middle = low ? box.low[axis] : high ? box.high[axis] : 0.0f;
        result.low[axis] = middle - half, result.high[axis] = middle + half;
    }
    return result;
}

class Auditor {
public:
    Auditor(const Scene& scene, const AuditOptions& options) : scene_(scene), field_(scene), options_(options) {
        if (tree_.root) remember(*tree_.root);
        for (const FieldNode& definition : tree_.definitions) remember(definition);
        const double nodes = std::max<double>(1.0, static_cast<double>(parts_.size()));
        share_ = options.most_evaluations / nodes;
        visit(scene.root, 0);
        for (const Node& definition : scene.definitions) visit(definition, 0);
        far_away();
        std::unordered_map<Id, std::size_t> order;
        for (const NodeAudit& node : audit_.nodes) order.emplace(node.id, order.size());
        std::stable_sort(audit_.findings.begin(), audit_.findings.end(),
                         [&](const Finding& a, const Finding& b) { return order[a.node] < order[b.node]; });
    }

    Audit result() && { return std::move(audit_); }

private:
    void remember(const FieldNode& node) {
        parts_.try_emplace(node.id, &node);
        for (const FieldNode& child : node.children) remember(child);
    }

    void find(Id node, std::string message, std::string fix = {}, Edits edits = {}) {
        audit_.findings.push_back({node, std::move(message), std::move(fix), std::move(edits)});
    }

    /// `hidden`: it is in a hidden node.
    void visit(const Node& node, int depth, bool hidden = false) {
        hidden = hidden || node.hidden;
        const auto found = parts_.find(node.id);
        const FieldNode* part = found == parts_.end() ? nullptr : found->second;
        const std::size_t place = audit_.nodes.size();
        NodeAudit& entry = audit_.nodes.emplace_back(NodeAudit{node.id,
                                                               &info(node.kind),
                                                               depth,
                                                               part != nullptr,
                                                               Box{vec3(0.0f), vec3(0.0f)},
                                                               Box{vec3(0.0f), vec3(0.0f)},
                                                               1.0f,
                                                               "",
                                                               0,
                                                               0.0f,
                                                               {}});
        if (part) {
            entry.region = part->region;
            entry.world = world_bounds(tree_, node.id).value_or(entry.region);
            entry.stretch = part->stretch();
            entry.origin = origin(*part);
            by_numbers(*part);
        } else {
            entry.origin = hidden ? "is hidden" : "adds no shape";
            if (!hidden) nothing_shows(node);
        }
        const int before = steep_;
        for (const Node& child : node.children) visit(child, depth + 1, hidden);
        if (part) by_trying(*part, audit_.nodes[place], steep_ > before);
    }

    /// Told of the nodes that are the reason, not of all that they are in.
    void nothing_shows(const Node& node) {
        const bool removable = find_parent(scene_, node.id) && !find_lock(scene_, node.id);
        if (node.children.empty())
            find(node.id, "nothing is in it, so that it never shows", removable ? "Delete it" : "",
                 removable ? Edits{RemoveNode{node.id}} : Edits{});
        else if (const Node* first = first_shown(node);
                 first && node.kind == NodeKind::subtract && is_empty(scene_, *first) && !is_empty_group(node))
            find(node.id, "its first child holds no shape to subtract from, so that nothing of it shows");
    }

    bool is_empty_group(const Node& node) const {
        return std::all_of(node.children.begin(), node.children.end(),
                           [&](const Node& child) { return is_empty(scene_, child); });
    }

    void by_numbers(const FieldNode& node) {
        const KindInfo& kind = *node.kind;
        if (kind.warnings)
            for (std::string& warning : kind.warnings(content_extent(node), node.children.size(), node.values)) {
                if (kind.kind == NodeKind::shell)
                    audit_.findings.push_back(with_thickness({node.id, std::move(warning)}, thinnest_skin));
                else
                    find(node.id, std::move(warning));
            }
        if (kind.gather == Gather::all && kind.role == Role::combine) empty_intersection(node);
    }

    /// Of two children that are apart along some axis nothing is left.
    void empty_intersection(const FieldNode& node) {
        const float reach = node.kind->reach ? node.kind->reach(node.values) : 0.0f;
        for (std::size_t i = 0; i < node.children.size(); ++i)
            for (std::size_t k = 0; k < i; ++k) {
                const Box a = node.children[k].extent.box.grown(reach), b = node.children[i].extent.box.grown(reach);
                for (int axis = 0; axis < 3; ++axis) {
                    const float gap = std::max(a.low[axis], b.low[axis]) - std::min(a.high[axis], b.high[axis]);
                    if (gap <= 0.0f) continue;
                    find(node.id, fmt::format("nothing is left of it: children {} and {} are {:.3g} m apart along {}",
                                              k + 1, i + 1, gap, "xyz"[axis]));
                    return;
                }
            }
    }

    /// `explained`: something in it has been found to be too steep, and it is so by that.
    void by_trying(const FieldNode& node, NodeAudit& entry, bool explained) {
        const double most = share_ / (5.0 * cost(tree_, node));
        const int samples = static_cast<int>(std::min<double>(options_.samples, most));
        if (samples < std::min(fewest_samples, options_.samples) || samples == 0 || stopped(options_)) return;

        SlopeSearch search(finite(node.extent.box), options_.seed);
        search.run(
            samples, options_.stop, [&](vec3 p) { return field_.distance(node, p); }, [](vec3, vec3) { return true; });
        entry.samples = search.tried();
        entry.slope = search.steepest().slope;
        if (search.not_finite())
            return find(node.id,
                        fmt::format("its value is not finite at {} of its parent's frame", text(*search.not_finite())));
        if (entry.slope > most_relative && !explained) {
            ++steep_;
            const SlopeSearch::Pair& pair = search.steepest();
            find(node.id, fmt::format("steeper than promised: {:.6g} at {} and {:.6g} at {}, in its parent's frame, a "
                                      "slope of {:.4g} where at most 1 is safe",
                                      pair.fa, text(pair.a), pair.fb, text(pair.b), pair.slope));
            if (node.code) slow_down(node, pair.slope, audit_.findings.back());
        }
        if (!node.kind->stretch) return;

        // Only where the content is: both images in what the children fill.
        Box content = node.children[0].extent.box;
        for (const FieldNode& child : node.children) content = content.united(child.extent.box);
        const auto within = [&](vec3 p) {
            if (!node.kind->domain) return true;
            const vec3 image = node.kind->domain(p, node.values, 0);
            return glm::clamp(p, node.region.low, node.region.high) == p &&
                   glm::clamp(image, content.low, content.high) == image;
        };
        SlopeSearch unsafe(finite(node.region), options_.seed);
        unsafe.run(
            samples, options_.stop, [&](vec3 p) { return field_.unsafe_distance(node, p); },
            [&](vec3 a, vec3 b) { return within(a) && within(b); });
        entry.unsafe_slope = unsafe.steepest().slope;
        if (*entry.unsafe_slope > most_relative * entry.stretch)
            find(node.id,
                 fmt::format("steeper than promised before it is made safe: a slope of {:.4g} between {} and "
                             "{}, in its own frame, where {:.4g} was to be the most",
                             *entry.unsafe_slope, text(unsafe.steepest().a), text(unsafe.steepest().b), entry.stretch));
    }

    /// Custom code that promises too little: a larger constant, with a tenth to spare for what no pair has met.
    static void slow_down(const FieldNode& node, float slope, Finding& finding) {
        const std::string enough = fmt::format("{:.2g}", 1.1f * slope * node.code->lipschitz());
        const std::string text = with_lipschitz(node.code->text(), enough);
        if (!CustomCode::parse(text).errors.empty()) return;
        finding.fix = fmt::format("Promise lipschitz = {}", enough);
        finding.edits = {SetCode{node.id, text}};
    }

    void far_away() {
        const NodeAudit* worst = nullptr;
        float most = furthest;
        for (const NodeAudit& node : audit_.nodes) {
            if (!node.shows || node.kind->takes_children()) continue;
            for (int axis = 0; axis < 3; ++axis) {
                if (!node.world.is_bounded(axis)) continue;
                const float reach = std::max(std::abs(node.world.low[axis]), std::abs(node.world.high[axis]));
                if (reach > most) most = reach, worst = &node;
            }
        }
        if (worst)
            find(worst->id, fmt::format("reaches {:.3g} m from the origin; beyond {:g} m single precision is coarser "
                                        "than a millimetre",
                                        most, furthest));
    }

    const Scene& scene_;
    FieldEvaluator field_;
    const FieldTree& tree_ = field_.tree();
    const AuditOptions& options_;
    std::unordered_map<Id, const FieldNode*> parts_;
    double share_ = 0.0;  ///< of the evaluations, for one node
    int steep_ = 0;       ///< nodes found to be steeper than they promise
    Audit audit_;
};

}  // namespace

const NodeAudit* Audit::find(Id node) const {
    const auto it = std::find_if(nodes.begin(), nodes.end(), [&](const NodeAudit& n) { return n.id == node; });
    return it == nodes.end() ? nullptr : &*it;
}

Audit audit(const Scene& scene, const AuditOptions& options) { return Auditor(scene, options).result(); }

std::vector<Finding> thin_from_camera(const Scene& scene, const Audit& audit, int picture_height) {
    std::vector<Finding> findings;
    if (picture_height <= 0) return findings;
    const vec3 eye = scene.camera.position;
    const float pixel_angle = 2.0f * CameraBasis(scene.camera).half_height / static_cast<float>(picture_height);
    for (const NodeAudit& entry : audit.nodes) {
        if (entry.kind->kind != NodeKind::shell || !entry.shows) continue;
        const Node* node = find_node(scene, entry.id);
        if (!node || find_top(scene, entry.id) != &scene.root) continue;
        const float scale = frame_of(scene, entry.id).scale, thickness = node->values[0].x;
        const float pixel =
            pixel_angle * glm::distance(eye, glm::clamp(eye, entry.world.low, entry.world.high)) / scale;
        // Thinner than rays can see is another finding, and worse; equal but for rounding is wide enough.
        if (!(thickness < 0.999f * pixel) || thickness < thinnest_skin) continue;
        const float enough = std::min(largest_value, pixel * 1.05f);
        findings.push_back(with_thickness(
            {entry.id,
             fmt::format("its skin of {:.3g} m is {:.2g} pixels thick from here: edges of it come and go with the "
                         "samples",
                         thickness, thickness / pixel)},
            enough));
    }
    return findings;
}

std::string size_text(const Box& box) {
    std::array<std::string, 3> sides;
    for (int axis = 0; axis < 3; ++axis)
        sides[static_cast<std::size_t>(axis)] =
            box.is_bounded(axis) ? fmt::format("{:.3g}", box.size()[axis]) : "no end";
    return fmt::format("{} x {} x {} m", sides[0], sides[1], sides[2]);
}

}  // namespace farfield
