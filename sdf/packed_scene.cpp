#include "sdf/packed_scene.h"

#include "sdf/custom_code.h"

#include <unordered_map>
#include <utility>

namespace farfield {
namespace {

bool equal_beside_children(const Node& a, const Node& b) {
    return a.id == b.id && a.kind == b.kind && a.name == b.name && a.values == b.values && a.transform == b.transform &&
           a.material == b.material && a.definition == b.definition && a.code == b.code && a.hidden == b.hidden &&
           a.locked == b.locked;
}

Scene without_nodes(const Scene& scene) {
    Scene rest;
    rest.materials = scene.materials;
    rest.lights = scene.lights;
    rest.sky = scene.sky;
    rest.camera = scene.camera;
    rest.bookmarks = scene.bookmarks;
    rest.settings = scene.settings;
    rest.schema = scene.schema;
    return rest;
}

bool equal_beside_nodes(const Scene& a, const Scene& b) {
    return a.materials == b.materials && a.lights == b.lights && a.sky == b.sky && a.camera == b.camera &&
           a.bookmarks == b.bookmarks && a.settings == b.settings && a.schema == b.schema;
}

}  // namespace

class PackedScene::Packer {
public:
    void remember(const std::shared_ptr<const Part>& part) {
        known_.emplace(part->node.id, &part);
        for (const auto& child : part->children) remember(child);
    }

    std::shared_ptr<const Part> packed(const Node& node) const {
        Parts children;
        children.reserve(node.children.size());
        for (const Node& child : node.children) children.push_back(packed(child));
        if (const auto found = known_.find(node.id); found != known_.end()) {
            const auto& before = *found->second;
            if (before->children == children && equal_beside_children(before->node, node)) return before;
        }
        return std::make_shared<const Part>(Part{without_children(node), std::move(children)});
    }

private:
    std::unordered_map<Id, const std::shared_ptr<const Part>*> known_;
};

PackedScene::PackedScene(const Scene& scene)
    : rest_(std::make_shared<const Scene>(without_nodes(scene))),
      root_(Packer().packed(scene.root)),
      next_id_(scene.next_id) {
    for (const Node& definition : scene.definitions) definitions_.push_back(Packer().packed(definition));
}

PackedScene::PackedScene(const Scene& scene, const PackedScene& similar) : next_id_(scene.next_id) {
    rest_ =
        equal_beside_nodes(scene, *similar.rest_) ? similar.rest_ : std::make_shared<const Scene>(without_nodes(scene));
    Packer packer;
    packer.remember(similar.root_);
    for (const auto& definition : similar.definitions_) packer.remember(definition);
    root_ = packer.packed(scene.root);
    for (const Node& definition : scene.definitions) definitions_.push_back(packer.packed(definition));
}

Node PackedScene::unpacked(const Part& part) {
    Node node = part.node;
    node.children.reserve(part.children.size());
    for (const auto& child : part.children) node.children.push_back(unpacked(*child));
    return node;
}

Scene PackedScene::unpacked() const {
    Scene scene = *rest_;
    scene.root = unpacked(*root_);
    for (const auto& definition : definitions_) scene.definitions.push_back(unpacked(*definition));
    scene.next_id = next_id_;
    return scene;
}

}  // namespace farfield
