#include "app/document.h"

#include "sdf/matching_ids.h"
#include "sdf/scene_file.h"

#include <fmt/format.h>

namespace farfield {
namespace {

bool same(const Camera& a, const Camera& b) {
    return a.position == b.position && a.target == b.target && a.field_of_view == b.field_of_view;
}

}  // namespace

Scene new_scene() {
    Scene scene;
    scene.sky.horizon = glm::vec3(0.3f, 0.33f, 0.37f);
    scene.sky.zenith = glm::vec3(0.14f, 0.22f, 0.38f);
    Light sun;
    sun.id = scene.new_id();
    sun.name = "sun";
    sun.kind = LightKind::directional;
    sun.direction = glm::vec3(-0.5f, -1.0f, -0.4f);
    sun.intensity = glm::vec3(2.6f, 2.45f, 2.2f);
    scene.lights.push_back(sun);
    return scene;
}

std::shared_ptr<const Scene> Document::snapshot() {
    const std::pair now(revision(), trust_.revision());
    if (!snapshot_ || snapshot_revision_ != now) {
        snapshot_ = std::make_shared<const Scene>(without_unknown_code(scene(), trust_));
        snapshot_revision_ = now;
    }
    return snapshot_;
}

std::vector<Id> Document::apply(const Edits& edits, unsigned gesture) {
    std::vector<Id> ids = history_.apply(edits, gesture);
    for (const Edit& edit : edits)
        if (const auto* set = std::get_if<SetCode>(&edit))
            if (const Node* node = find_node(scene(), set->node); node && node->code) trust_.accept(*node->code);
    return ids;
}

void Document::begin(Scene scene, const std::filesystem::path& file) {
    history_.replace(std::move(scene));
    file_ = file;
    ++generation_;
    first_camera_ = history_.scene().camera;
    in_file_ = nullptr;
    file_lost_ = false;
    saved_revision_ = 0;
}

void Document::reset(Scene scene) {
    begin(std::move(scene), {});
    saved_revision_ = history_.revision();
}

void Document::open(Scene scene, const std::filesystem::path& file) {
    begin(std::move(scene), file);
    in_file_ = std::make_shared<const Scene>(history_.scene());
    saved_revision_ = history_.revision();
}

void Document::recover(Scene scene, const std::filesystem::path& file) { begin(std::move(scene), file); }

void Document::reload(Scene scene) {
    scene = with_ids_of(std::move(scene), history_.scene());
    const std::shared_ptr<const Scene> before = std::exchange(in_file_, std::make_shared<const Scene>(scene));
    file_lost_ = false;
    const bool touched = !before || !same(before->camera, scene.camera);
    if (touched)
        first_camera_ = scene.camera;
    else
        scene.camera = history_.scene().camera;
    const bool as_in_file = same(scene.camera, in_file_->camera);
    history_.record(std::move(scene), fmt::format("reload {}", name()));
    saved_revision_ = as_in_file ? history_.revision() : 0;
}

void Document::save(const std::filesystem::path& file) {
    save_scene(scene(), file);
    file_ = file;
    in_file_ = std::make_shared<const Scene>(scene());
    file_lost_ = false;
    saved_revision_ = history_.revision();
}

bool Document::saved_but_for_camera() const {
    if (saved()) return true;
    if (file_lost_ || !in_file_) return false;
    Scene moved = *in_file_;
    moved.camera = scene().camera;
    return to_text(moved) == to_text(scene());
}

}  // namespace farfield
