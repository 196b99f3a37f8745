#include "ui/scene_audit.h"

#include "sdf/scene_file.h"

#include <chrono>
#include <utility>

namespace farfield {
namespace {

/// All that shapes depend on, by the one description of a scene that is complete.
std::string shapes_text(const Scene& scene) {
    Scene shapes = scene;
    shapes.camera = {};
    shapes.bookmarks.clear();
    shapes.settings = {};
    shapes.sky = {};
    shapes.lights.clear();
    return to_text(shapes);
}

}  // namespace

void SceneAudit::refresh(const std::shared_ptr<const Scene>& scene, std::uint64_t revision, int picture_height,
                         double now) {
    if (finished()) {
        show(run_.get());
        sampled_ = true;
    }
    if (revision == revision_ || now < next_) return;
    const auto start = std::chrono::steady_clock::now();
    revision_ = revision;
    scene_ = scene;
    std::string shapes = shapes_text(*scene);
    if (shapes != shapes_ || nodes_.count(scene->root.id) == 0) {
        cancel();
        shapes_ = std::move(shapes);
        sampled_ = false;
        AuditOptions options;
        options.samples = 0;
        show(audit(*scene, options));
    }
    of_view_ = thin_from_camera(*scene, audit_, picture_height);
    note_warnings();
    constexpr double share = 0.1;  // of the time, at most
    next_ = now + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / share;
}

void SceneAudit::start() {
    if (running() || !scene_) return;
    stop_ = false;
    run_ = std::async(std::launch::async, [scene = scene_, stop = &stop_] {
        AuditOptions options;
        options.stop = stop;
        return audit(*scene, options);
    });
}

bool SceneAudit::finished() const {
    return run_.valid() && run_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void SceneAudit::cancel() {
    if (!run_.valid()) return;
    stop_ = true;
    run_.wait();
    run_ = {};
}

void SceneAudit::show(Audit audit) {
    audit_ = std::move(audit);
    nodes_.clear();
    for (const NodeAudit& node : audit_.nodes) nodes_.emplace(node.id, &node);
    note_warnings();
}

void SceneAudit::note_warnings() {
    warnings_.clear();
    for (const auto* findings : {&audit_.findings, &of_view_})
        for (const Finding& finding : *findings) warnings_[finding.node].push_back(finding);
}

const NodeAudit* SceneAudit::find(Id node) const {
    const auto found = nodes_.find(node);
    return found == nodes_.end() ? nullptr : found->second;
}

const std::vector<Finding>& SceneAudit::warnings(Id node) const {
    static const std::vector<Finding> none;
    const auto found = warnings_.find(node);
    return found == warnings_.end() ? none : found->second;
}

}  // namespace farfield
