#include "app/document.h"

#include "sdf/scene_file.h"

namespace farfield {

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

void Document::reset() {
    history_.replace(new_scene());
    file_.clear();
    ++generation_;
    first_camera_ = scene().camera;
    saved_revision_ = history_.revision();
}

void Document::open(Scene scene, const std::filesystem::path& file) {
    history_.replace(std::move(scene));
    file_ = file;
    ++generation_;
    first_camera_ = history_.scene().camera;
    saved_revision_ = history_.revision();
}

void Document::save(const std::filesystem::path& file) {
    save_scene(scene(), file);
    file_ = file;
    saved_revision_ = history_.revision();
}

}  // namespace farfield
