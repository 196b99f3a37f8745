#include "tests/stability/stage.h"

#include "renderer/metrics.h"

#include <stdexcept>
#include <utility>

namespace farfield::stability {

Id Built::add(Node node, glm::vec3 at, Id parent) {
    node.transform.translate += at;
    return apply(*this, InsertNode{parent > 0 ? parent : root.id, -1, node});
}

Id Built::add_material(glm::vec3 albedo, glm::vec3 emission) {
    const Id id = apply(*this, AddMaterial{Material{}});
    materials.back().albedo = albedo;
    materials.back().emission = emission;
    return id;
}

void Built::add_point_light(glm::vec3 position, glm::vec3 intensity) {
    apply(*this, AddLight{Light{}});
    lights.back().position = position;
    lights.back().intensity = intensity;
}

void Built::look(glm::vec3 from, glm::vec3 at, float field_of_view) { camera = {from, at, field_of_view}; }

Node shape(NodeKind kind, std::vector<glm::vec3> values) {
    Node node = make_node(kind);
    for (std::size_t i = 0; i < values.size(); ++i) node.values[i] = values[i];
    return node;
}

Node sphere(float radius) { return shape(NodeKind::sphere, {number(radius)}); }
Node box(glm::vec3 half_size) { return shape(NodeKind::box, {half_size}); }

Node beam() {
    Node node = box({0.4f, 0.5f, 0.06f});
    node.transform.rotate = {0.0f, 20.0f, 0.0f};
    return node;
}

Node ball() {
    Node node = sphere(0.2f);
    node.transform.translate = {0.35f, 0.3f, 0.1f};
    return node;
}

Image Pictures::indirect(Method method) const { return difference(result[static_cast<std::size_t>(method)], direct); }

Stage::Stage(std::unique_ptr<Context> context) : context_(std::move(context)) {
    context_->make_current();
    renderer_.emplace();
}

Stage::~Stage() {
    renderer_.reset();
    context_->release();
}

Pictures Stage::render(Scene scene, const FrameOptions& given, int samples, int frames) {
    FrameOptions options = given;
    options.occlusion = true;  // for the paper's picture
    scene.settings.samples = samples;
    renderer_->update(scene, options);
    renderer_->discard();
    while (renderer_->statistics().frames < frames) renderer_->render_frame();
    Pictures pictures;
    for (const Method method : methods)
        pictures.result[static_cast<std::size_t>(method)] = read(scene, options, method, View::result);
    pictures.direct = renderer_->read(View::direct);
    pictures.depth = renderer_->read(View::depth);
    return pictures;
}

Image Stage::read(Scene scene, FrameOptions options, Method method, View view) {
    options.occlusion = true;
    scene.settings.method = method;
    if (renderer_->update(scene, options)) throw std::logic_error("reading discarded the samples");
    return renderer_->read(view);
}

}  // namespace farfield::stability
