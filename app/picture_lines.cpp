#include "app/picture_lines.h"

#include <cmath>
#include <map>

namespace farfield {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float finest = 7.5f, coarsest = 27.0f;  // pixels between points of the coarse lattice
constexpr int refinement = 3;                     // where a border is near

struct Area {
    vec2 low, high;
};

/// The part of the picture that the box covers.
Area covered(const PictureView& view, const std::optional<Box>& bounds) {
    const Area whole{view.low, view.low + view.size};
    if (!bounds || !bounds->is_bounded()) return whole;
    Area area{whole.high, whole.low};
    for (int corner = 0; corner < 8; ++corner) {
        const auto at =
            view.project({corner & 1 ? bounds->low.x : bounds->high.x, corner & 2 ? bounds->low.y : bounds->high.y,
                          corner & 4 ? bounds->low.z : bounds->high.z});
        if (!at) return whole;
        area.low = glm::min(area.low, *at), area.high = glm::max(area.high, *at);
    }
    return {glm::max(area.low - 2.0f * coarsest, whole.low), glm::min(area.high + 2.0f * coarsest, whole.high)};
}

class Lattice {
public:
    Lattice(const FieldEvaluator& field, const PictureView& view, const std::set<Id>& owners, Area area, int samples)
        : field_(field), view_(view), owners_(owners), low_(area.low) {
        const vec2 size = glm::max(area.high - area.low, vec2(0.0f));
        const float coarse =
            std::clamp(std::sqrt(size.x * size.y / static_cast<float>(std::max(samples, 1))), finest, coarsest);
        cells_across_ = static_cast<int>(std::ceil(size.x / coarse));
        cells_down_ = static_cast<int>(std::ceil(size.y / coarse));
        across_ = cells_across_ * refinement + 1;
        down_ = cells_down_ * refinement + 1;
        step_ = size / glm::max(vec2(across_ - 1, down_ - 1), vec2(1.0f));
        footprint_ = 0.6f * view.basis.half_height / view.size.y;
    }

    std::vector<Segment> outline(const std::function<bool()>& stop) {
        shows_.resize(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_));
        for (int y = 0; y < down_; y += refinement) {
            if (stop()) return {};
            for (int x = 0; x < across_; x += refinement) shows_[index(x, y)] = shows(place(x, y));
        }
        for (int y = 0; y < cells_down_; ++y) {
            if (stop()) return {};
            for (int x = 0; x < cells_across_; ++x) refine(x, y);
        }
        std::vector<Segment> segments;
        for (int y = 0; y + 1 < down_; ++y) {
            if (stop()) return {};
            for (int x = 0; x + 1 < across_; ++x) add_cell(x, y, segments);
        }
        return segments;
    }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(x);
    }
    vec2 place(int x, int y) const { return low_ + step_ * vec2(static_cast<float>(x), static_cast<float>(y)); }
    bool shows(vec2 pixel) const {
        const Ray ray = view_.ray(pixel);
        const auto hit = pick(field_, ray.origin, ray.direction, footprint_);
        return hit && owners_.count(hit->node) != 0;
    }
    /// Fills the points of a coarse cell: by rays where its corners or its neighbours' differ.
    void refine(int cell_x, int cell_y) {
        const bool first = shows_[index(cell_x * refinement, cell_y * refinement)];
        bool uniform = true;
        for (int y = std::max(cell_y - 1, 0); y <= std::min(cell_y + 2, cells_down_); ++y)
            for (int x = std::max(cell_x - 1, 0); x <= std::min(cell_x + 2, cells_across_); ++x)
                uniform = uniform && shows_[index(x * refinement, y * refinement)] == first;
        // The lines at the right and lower end are the next cell's, but for the last.
        const int most_x = refinement - (cell_x + 1 < cells_across_), most_y = refinement - (cell_y + 1 < cells_down_);
        for (int j = 0; j <= most_y; ++j)
            for (int i = 0; i <= most_x; ++i) {
                if (i % refinement == 0 && j % refinement == 0) continue;
                const int x = cell_x * refinement + i, y = cell_y * refinement + j;
                shows_[index(x, y)] = uniform ? first : shows(place(x, y));
            }
    }
    /// Where the border lies between neighbours of which one shows.
    vec2 border(int ax, int ay, int bx, int by) {
        // Two cells ask for each.
        const auto [found, fresh] = borders_.try_emplace({std::min(index(ax, ay), index(bx, by)), ay == by});
        if (!fresh) return found->second;
        vec2 in = place(ax, ay), out = place(bx, by);
        if (!shows_[index(ax, ay)]) std::swap(in, out);
        for (float width = std::max(step_.x, step_.y); width > 0.25f; width *= 0.5f) {
            const vec2 middle = 0.5f * (in + out);
            (shows(middle) ? in : out) = middle;
        }
        return found->second = 0.5f * (in + out);
    }
    void add_cell(int x, int y, std::vector<Segment>& segments) {
        const std::pair<int, int> corners[] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
        std::vector<vec2> crossings;
        for (int i = 0; i < 4; ++i) {
            const auto [ax, ay] = corners[i];
            const auto [bx, by] = corners[(i + 1) % 4];
            if (shows_[index(ax, ay)] != shows_[index(bx, by)]) crossings.push_back(border(ax, ay, bx, by));
        }
        for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) segments.emplace_back(crossings[i], crossings[i + 1]);
    }

    const FieldEvaluator& field_;
    const PictureView& view_;
    const std::set<Id>& owners_;
    vec2 low_;
    vec2 step_{1.0f};
    float footprint_ = 0.0f;
    int cells_across_ = 0, cells_down_ = 0;  ///< of the coarse lattice
    int across_ = 0, down_ = 0;              ///< points of the fine one
    std::vector<bool> shows_;
    std::map<std::pair<std::size_t, bool>, vec2> borders_;
};

void add_shapes(const Node& node, std::set<Id>& shapes) {
    if (node.children.empty()) shapes.insert(node.id);
    for (const Node& child : node.children) add_shapes(child, shapes);
}

bool holds(const Node& node, const std::function<bool(const Node&)>& wanted) {
    if (wanted(node)) return true;
    for (const Node& child : node.children)
        if (holds(child, wanted)) return true;
    return false;
}

void add_instances(const Node& node, const std::set<Id>& definitions, std::set<Id>& shapes) {
    if (definitions.count(node.definition) != 0) shapes.insert(node.id);
    for (const Node& child : node.children) add_instances(child, definitions, shapes);
}

}  // namespace

std::set<Id> shapes_of(const Scene& scene, Id id) {
    std::set<Id> shapes;
    const Node* node = find_node(scene, id);
    if (!node) return shapes;
    std::set<Id> showing;  // definitions
    for (std::size_t before = 0;;) {
        for (const Node& definition : scene.definitions)
            if (holds(definition, [&](const Node& n) { return n.id == id || showing.count(n.definition) != 0; }))
                showing.insert(definition.id);
        if (showing.size() == before) break;
        before = showing.size();
    }
    if (showing.empty())
        add_shapes(*node, shapes);
    else
        add_instances(scene.root, showing, shapes);
    return shapes;
}

std::vector<Segment> outline_of(const FieldEvaluator& field, const PictureView& view, const std::set<Id>& owners,
                                const std::optional<Box>& bounds, int samples, const std::function<bool()>& stop) {
    return owners.empty() ? std::vector<Segment>()
                          : Lattice(field, view, owners, covered(view, bounds), samples).outline(stop);
}

GroundGrid::GroundGrid(const Camera& camera) : step(grid_step(camera)) {
    const auto first = [&](float middle) {
        return static_cast<int>(std::round(std::clamp(middle, -1e6f, 1e6f) / step)) - lines / 2;
    };
    x = first(camera.target.x);
    z = first(camera.target.z);
}

vec3 GroundGrid::point(int direction, int k, int i) const {
    const int across = direction == 0 ? i : k, deep = direction == 0 ? k : i;
    return {step * static_cast<float>(x + across), 0.0f, step * static_cast<float>(z + deep)};
}

std::vector<bool> seen_points(const FieldEvaluator& field, const PictureView& view, const GroundGrid& grid,
                              const std::function<bool()>& stop) {
    std::vector<bool> seen(GroundGrid::count);
    const float footprint = 2.0f * view.basis.half_height / view.size.y;
    for (int direction = 0; direction < 2; ++direction)
        for (int k = 0; k < GroundGrid::lines; ++k) {
            if (stop()) return {};
            for (int i = 0; i < GroundGrid::points; ++i) {
                const vec3 point = grid.point(direction, k, i);
                if (!view.project(point)) continue;
                const float distance = glm::distance(point, view.eye);
                const auto hit = pick(field, view.eye, (point - view.eye) / distance, footprint);
                // A floor on the ground does not hide what is drawn on it.
                const float tolerance = 0.01f * distance + 0.02f * grid.step;
                seen[GroundGrid::index(direction, k, i)] = !hit || hit->distance > distance - tolerance;
            }
        }
    return seen;
}

}  // namespace farfield
