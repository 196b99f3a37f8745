#include "app/picture_overlay.h"

#include "sdf/evaluate.h"
#include "sdf/local_scene.h"
#include "sdf/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>

namespace farfield {
namespace {

/// While something moves all the time the processor belongs to the picture.
constexpr double rest = 0.06;  // seconds

constexpr double share = 0.1;  // of the time, at most, that it takes to find out whether the lines still hold

ImVec2 im(glm::vec2 v) { return {v.x, v.y}; }

/// All that the shapes and what the camera sees of them depend on, by the one description of a scene that is complete.
std::string key_of(const Scene& scene, const PictureView& view, const std::vector<Id>& selected, bool grid) {
    Scene seen = scene;
    seen.bookmarks.clear();
    seen.settings = {};
    seen.sky = {};
    seen.lights.clear();
    return fmt::format("{} {} {} {} {} {}\n", view.low.x, view.low.y, view.size.x, view.size.y,
                       fmt::join(selected, "+"), grid) +
           to_text(seen);
}

/// The node, or the outermost group above it that melts its edge into others': there it may show beyond its own bounds.
Id blended(const Scene& scene, Id node) {
    for (const Node* above = find_parent(scene, node); above; above = find_parent(scene, above->id)) {
        const KindInfo& kind = info(above->kind);
        if (kind.role == Role::combine && kind.reach && kind.reach(above->values) > 0.0f) node = above->id;
    }
    return node;
}

/// So many rays take some 50 ms, and for hundreds of nodes, each of which every ray asks, half a second.
int samples_for(const Scene& scene) {
    const std::uint64_t nodes = std::clamp<std::uint64_t>(expanded_node_count(scene), 30, 100);
    return static_cast<int>(150'000 / nodes);
}

}  // namespace

PictureOverlay::PictureOverlay() : thread_([this] { work(); }) {}

PictureOverlay::~PictureOverlay() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void PictureOverlay::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [this] { return stop_ || next_; });
        if (stop_) return;
        const Request request = std::move(*next_);
        next_.reset();
        lock.unlock();
        Lines lines = find(request);
        lock.lock();
        found_ = std::move(lines);
    }
}

PictureOverlay::Lines PictureOverlay::find(const Request& request) {
    const auto over = [this] {
        const std::lock_guard lock(mutex_);
        return stop_;
    };
    // The outline of an older scene is of no use, what is seen of the grid is.
    const auto outdated = [this] {
        const std::lock_guard lock(mutex_);
        return stop_ || next_;
    };
    const Scene& scene = *request.scene;
    const Scene local = local_scene(scene);
    const FieldEvaluator field(local);
    const PictureView view(local.camera, request.low, request.size);
    Lines lines;
    lines.key = request.key;
    if (request.grid) {
        lines.grid = GroundGrid(scene.camera);
        lines.seen = seen_points(FieldEvaluator(scene), {scene.camera, request.low, request.size}, lines.grid, over);
    }
    std::set<Id> shapes;
    std::optional<Box> bounds;
    for (const Id id : request.selected) {
        shapes.merge(shapes_of(scene, id));
        const Box box = world_bounds(field.tree(), blended(scene, id)).value_or(Box{});  // without end: anywhere
        bounds = bounds ? bounds->united(box) : box;
    }
    lines.outline = outline_of(field, view, shapes, bounds, samples_for(scene), outdated);
    if (outdated()) lines.key.clear();
    return lines;
}

bool PictureOverlay::news() const {
    const std::lock_guard lock(mutex_);
    return found_.has_value();
}

/// The selected nodes but the scene as a whole.
std::vector<Id> PictureOverlay::outlined(const Ui& ui, const Scene& scene) {
    std::vector<Id> nodes = selected_nodes(ui.selected());
    std::erase(nodes, scene.root.id);
    return nodes;
}

void PictureOverlay::ask(const Ui& ui, const std::shared_ptr<const Scene>& shown, const PictureView& view) {
    Request request{shown, view.low, view.size, outlined(ui, *shown), ui.tools.grid};
    if (request.scene != asked_.scene || request.low != asked_.low || request.size != asked_.size ||
        request.selected != asked_.selected || request.grid != asked_.grid) {
        // A scene that is large enough for it to take long is not looked at in each frame.
        current_ = ImGui::GetTime() >= next_look_;
        if (!current_) return;
        const auto start = std::chrono::steady_clock::now();
        request.key = key_of(*shown, view, request.selected, request.grid);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        next_look_ = ImGui::GetTime() + taken.count() / share;
        if (request.key != asked_.key) due_ = ImGui::GetTime() + rest;
        asked_ = std::move(request);
    }
    if (due_ == 0.0 || ImGui::GetTime() < due_) return;
    due_ = 0.0;
    if (asked_.selected.empty() && !asked_.grid) return;
    {
        const std::lock_guard lock(mutex_);
        next_ = asked_;
    }
    wake_.notify_one();
}

void PictureOverlay::draw_outline(Ui& ui) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (const bool rim : {true, false})
        for (const auto& [a, b] : lines_.outline)
            draw.AddLine(im(a), im(b), rim ? IM_COL32(10, 11, 13, 110) : ui.theme.accent,
                         ui.theme.px(rim ? 3.6f : 1.8f));
    if (lines_.outline.empty()) return;
    ImVec2 low = im(lines_.outline[0].first), high = low;
    for (const auto& [a, b] : lines_.outline)
        for (const glm::vec2 p : {a, b}) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    ui.report.rectangle("outline", "", low, high);
}

void PictureOverlay::draw_grid(const Ui& ui, const Scene& scene, const PictureView& view) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const GroundGrid& grid = lines_.grid;
    constexpr int middle = GroundGrid::lines / 2;
    const glm::vec3 centre = grid.point(0, middle, middle);
    for (int direction = 0; direction < 2; ++direction)
        for (int k = 0; k < GroundGrid::lines; ++k) {
            const int number = (direction == 0 ? grid.z : grid.x) + k;
            const ImU32 ink = number == 0        ? ui.theme.axis[direction == 0 ? 0 : 2]
                              : number % 10 == 0 ? IM_COL32(225, 230, 238, 255)
                                                 : IM_COL32(190, 196, 206, 255);
            const float strength = number == 0 ? 0.85f : number % 10 == 0 ? 0.4f : 0.22f;
            for (int i = 0; i + 1 < GroundGrid::points; ++i) {
                if (!lines_.seen[GroundGrid::index(direction, k, i)] ||
                    !lines_.seen[GroundGrid::index(direction, k, i + 1)])
                    continue;
                const glm::vec3 from = grid.point(direction, k, i), to = grid.point(direction, k, i + 1);
                const auto a = view.project(from), b = view.project(to);
                const float off = glm::distance(0.5f * (from + to), centre) / (grid.step * middle);
                const float alpha = strength * std::clamp(1.2f - off, 0.0f, 1.0f);
                if (!a || !b || alpha <= 0.01f) continue;
                draw.AddLine(im(*a), im(*b),
                             (ink & ~IM_COL32_A_MASK) | (static_cast<ImU32>(255.0f * alpha) << IM_COL32_A_SHIFT),
                             ui.theme.px(number == 0 ? 1.6f : 1.0f));
            }
        }
    // The axes' directions, in the lower left corner.
    const glm::vec2 at{view.low.x + ui.theme.px(42.0f), view.low.y + view.size.y - ui.theme.px(42.0f)};
    const CameraBasis basis(scene.camera);
    static constexpr const char* names[] = {"x", "y", "z"};
    draw.AddCircleFilled(im(at), ui.theme.px(34.0f), IM_COL32(18, 20, 24, 110));
    for (int axis = 0; axis < 3; ++axis) {
        const glm::vec2 end = at + ui.theme.px(22.0f) * glm::vec2(basis.right[axis], -basis.up[axis]);
        draw.AddLine(im(at), im(end), ui.theme.axis[axis], ui.theme.px(2.0f));
        const ImVec2 size = ImGui::CalcTextSize(names[axis]);
        const glm::vec2 text = at + ui.theme.px(30.0f) * glm::vec2(basis.right[axis], -basis.up[axis]);
        draw.AddText({std::floor(text.x - 0.5f * size.x), std::floor(text.y - 0.5f * size.y)}, ui.theme.axis[axis],
                     names[axis]);
    }
}

void PictureOverlay::draw(Ui& ui, const std::shared_ptr<const Scene>& shown, const PictureView& view) {
    ask(ui, shown, view);
    {
        const std::lock_guard lock(mutex_);
        if (found_) {
            lines_ = std::move(*found_);
            found_.reset();
        }
    }
    if (ui.tools.grid && !lines_.seen.empty()) draw_grid(ui, *shown, view);
    if (current_ && !asked_.selected.empty() && lines_.key == asked_.key) draw_outline(ui);
}

}  // namespace farfield
