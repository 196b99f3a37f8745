#include "sdf/scene.h"

#include <algorithm>
#include <utility>

namespace farfield {
namespace {

template <class T>
const T* find_by_id(const std::vector<T>& items, Id id) {
    const auto it = std::find_if(items.begin(), items.end(), [&](const T& item) { return item.id == id; });
    return it == items.end() ? nullptr : &*it;
}

const Node* find_below(const Node& node, Id id) {
    if (node.id == id) return &node;
    for (const Node& child : node.children)
        if (const Node* found = find_below(child, id)) return found;
    return nullptr;
}

const Node* find_parent_below(const Node& node, Id id) {
    for (const Node& child : node.children) {
        if (child.id == id) return &node;
        if (const Node* found = find_parent_below(child, id)) return found;
    }
    return nullptr;
}

}  // namespace

Scene::Scene() {
    root = make_node(NodeKind::union_);
    root.id = new_id();
    root.name = "scene";
    Material material;
    material.id = new_id();
    material.name = "default";
    materials.push_back(material);
}

Node make_node(NodeKind kind) {
    Node node;
    node.kind = kind;
    for (const Parameter& parameter : info(kind).parameters) node.values.push_back(parameter.initial);
    return node;
}

const Node* find_node(const Scene& scene, Id id) { return id == 0 ? nullptr : find_below(scene.root, id); }
Node* find_node(Scene& scene, Id id) { return const_cast<Node*>(find_node(std::as_const(scene), id)); }
const Node* find_parent(const Scene& scene, Id id) { return id == 0 ? nullptr : find_parent_below(scene.root, id); }
const Material* find_material(const Scene& scene, Id id) { return find_by_id(scene.materials, id); }
const Light* find_light(const Scene& scene, Id id) { return find_by_id(scene.lights, id); }

std::string display_name(const Node& node) { return node.name.empty() ? info(node.kind).label : node.name; }

int count_nodes(const Node& node) {
    int count = 1;
    for (const Node& child : node.children) count += count_nodes(child);
    return count;
}

}  // namespace farfield
