#include "sdf/scene.h"

#include "sdf/custom_code.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace farfield {

std::string_view embedded_shapes(std::string_view name);  // generated from the .glsl files by embed.cmake

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

glm::mat3 rotation_matrix(const Transform& transform) {
    const glm::dvec3 a = glm::radians(glm::dvec3(transform.rotate));
    const glm::dvec3 c = glm::cos(a), s = glm::sin(a);
    const glm::dmat3 x(1.0, 0.0, 0.0, 0.0, c.x, s.x, 0.0, -s.x, c.x);
    const glm::dmat3 y(c.y, 0.0, -s.y, 0.0, 1.0, 0.0, s.y, 0.0, c.y);
    const glm::dmat3 z(c.z, s.z, 0.0, -s.z, c.z, 0.0, 0.0, 0.0, 1.0);
    glm::dmat3 m = z * y * x;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(m[column][row]) < 1e-12) m[column][row] = 0.0;  // quarter turns are exact
    return glm::mat3(m);
}

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
    if (kind == NodeKind::custom) node.code = default_custom_code();
    for (const Parameter& parameter : parameters(node)) node.values.push_back(parameter.initial);
    return node;
}

std::shared_ptr<const CustomCode> default_custom_code() {
    static const auto code = CustomCode::parse(embedded_shapes("custom_default.glsl")).code;
    return code;
}

std::vector<Parameter> parameters(const Node& node) {
    std::vector<Parameter> list = info(node.kind).parameters;
    if (node.code) list.insert(list.end(), node.code->parameters().begin(), node.code->parameters().end());
    return list;
}

const Node* find_node(const Scene& scene, Id id) { return id == 0 ? nullptr : find_below(scene.root, id); }
Node* find_node(Scene& scene, Id id) { return const_cast<Node*>(find_node(std::as_const(scene), id)); }
const Node* find_parent(const Scene& scene, Id id) { return id == 0 ? nullptr : find_parent_below(scene.root, id); }
const Material* find_material(const Scene& scene, Id id) { return find_by_id(scene.materials, id); }
const Light* find_light(const Scene& scene, Id id) { return find_by_id(scene.lights, id); }

std::string display_name(const Node& node) { return node.name.empty() ? info(node.kind).label : node.name; }

std::uint32_t material_index(const Scene& scene, Id id, std::uint32_t inherited) {
    const Material* material = find_material(scene, id);
    return material ? static_cast<std::uint32_t>(material - scene.materials.data()) : inherited;
}

bool is_empty(const Node& node) {
    if (node.kind == NodeKind::custom) return !node.code;
    if (!info(node.kind).takes_children()) return false;
    if (node.children.empty()) return true;
    if (node.kind == NodeKind::subtract) return is_empty(node.children[0]);
    return std::all_of(node.children.begin(), node.children.end(), is_empty);
}

int count_nodes(const Node& node) {
    int count = 1;
    for (const Node& child : node.children) count += count_nodes(child);
    return count;
}

}  // namespace farfield
