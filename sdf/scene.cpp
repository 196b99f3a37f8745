#include "sdf/scene.h"

#include "sdf/custom_code.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
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

void add_topmost(const Node& node, const std::set<Id>& wanted, std::vector<Id>& found) {
    if (wanted.contains(node.id)) return found.push_back(node.id);
    for (const Node& child : node.children) add_topmost(child, wanted, found);
}

/// Visits each definition once, after those that it uses.
template <class Visit>
void visit_definitions(const Scene& scene, Visit visit) {
    std::unordered_map<Id, const Node*> waiting;
    for (const Node& definition : scene.definitions) waiting.emplace(definition.id, &definition);
    const auto visit_one = [&](const auto& self, Id id) -> void {
        const auto found = waiting.find(id);
        if (found == waiting.end()) return;
        const Node& definition = *found->second;
        waiting.erase(found);
        visit_nodes(definition, [&](const Node& node) { self(self, node.definition); });
        visit(definition);
    };
    for (const Node& definition : scene.definitions) visit_one(visit_one, definition.id);
}

using Counts = std::unordered_map<Id, std::uint64_t>;

std::uint64_t expanded_count(const Node& node, const Counts& of_definitions) {
    const auto sum = [](std::uint64_t a, std::uint64_t b) {
        return a > std::numeric_limits<std::uint64_t>::max() - b ? std::numeric_limits<std::uint64_t>::max() : a + b;
    };
    if (node.hidden) return 0;
    std::uint64_t count = 1;
    if (const auto found = of_definitions.find(node.definition); found != of_definitions.end())
        count = sum(count, found->second);
    for (const Node& child : node.children) count = sum(count, expanded_count(child, of_definitions));
    return count;
}

/// Finds definitions without end, and measures how deep the others are.
class Nesting {
public:
    explicit Nesting(const Scene& scene) {
        for (const Node& definition : scene.definitions) definitions_.emplace(definition.id, Entry{&definition});
    }

    /// The height of a node that stands `depth` nodes below the one where the search began.
    int height(const Node& node, int depth) {
        int below = 0;
        if (depth >= largest_depth) problem = NestingProblem{node.id, false};
        if (problem) return 0;
        if (const auto found = definitions_.find(node.definition); found != definitions_.end())
            below = height(found->second, node, depth + 1);
        for (const Node& child : node.children)
            if (!problem) below = std::max(below, height(child, depth + 1));
        if (!problem && below >= largest_depth) problem = NestingProblem{node.id, false};
        return 1 + below;
    }

    std::optional<NestingProblem> problem;

private:
    struct Entry {
        const Node* node;
        bool open = false;
        int height = 0;  ///< 0: not known yet
    };
    int height(Entry& entry, const Node& instance, int depth) {
        if (entry.open) problem = NestingProblem{instance.id, true};
        if (problem || entry.height > 0) return entry.height;
        entry.open = true;
        entry.height = height(*entry.node, depth);
        entry.open = false;
        return entry.height;
    }
    std::unordered_map<Id, Entry> definitions_;
};

}  // namespace

glm::mat3 rotation_matrix(const Transform& transform) { return glm::mat3(exact_rotation_matrix(transform)); }

glm::dmat3 exact_rotation_matrix(const Transform& transform) {
    const glm::dvec3 a = glm::radians(glm::dvec3(transform.rotate));
    const glm::dvec3 c = glm::cos(a), s = glm::sin(a);
    const glm::dmat3 x(1.0, 0.0, 0.0, 0.0, c.x, s.x, 0.0, -s.x, c.x);
    const glm::dmat3 y(c.y, 0.0, -s.y, 0.0, 1.0, 0.0, s.y, 0.0, c.y);
    const glm::dmat3 z(c.z, s.z, 0.0, -s.z, c.z, 0.0, 0.0, 0.0, 1.0);
    glm::dmat3 m = z * y * x;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(m[column][row]) < 1e-12) m[column][row] = 0.0;  // quarter turns are exact
    return m;
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

Node make_instance(const Node& definition) {
    Node node = make_node(NodeKind::instance);
    node.definition = definition.id;
    return node;
}

const Node* find_node(const Scene& scene, Id id) {
    if (id == 0) return nullptr;
    if (const Node* found = find_below(scene.root, id)) return found;
    for (const Node& definition : scene.definitions)
        if (const Node* found = find_below(definition, id)) return found;
    return nullptr;
}
Node* find_node(Scene& scene, Id id) { return const_cast<Node*>(find_node(std::as_const(scene), id)); }
const Node* find_parent(const Scene& scene, Id id) {
    if (id == 0) return nullptr;
    if (const Node* found = find_parent_below(scene.root, id)) return found;
    for (const Node& definition : scene.definitions)
        if (const Node* found = find_parent_below(definition, id)) return found;
    return nullptr;
}
const Node* find_top(const Scene& scene, Id id) {
    if (id == 0) return nullptr;
    if (find_below(scene.root, id)) return &scene.root;
    for (const Node& definition : scene.definitions)
        if (find_below(definition, id)) return &definition;
    return nullptr;
}
std::vector<Id> topmost(const Scene& scene, const std::vector<Id>& nodes) {
    const std::set<Id> wanted(nodes.begin(), nodes.end());
    std::vector<Id> found;
    add_topmost(scene.root, wanted, found);
    for (const Node& definition : scene.definitions) add_topmost(definition, wanted, found);
    return found;
}
const Material* find_material(const Scene& scene, Id id) { return find_by_id(scene.materials, id); }
const Light* find_light(const Scene& scene, Id id) { return find_by_id(scene.lights, id); }
const Bookmark* find_bookmark(const Scene& scene, Id id) { return find_by_id(scene.bookmarks, id); }
const Node* find_definition(const Scene& scene, Id id) { return find_by_id(scene.definitions, id); }

Node without_children(const Node& node) {
    return {node.id,         node.kind, node.name, node.values, node.transform, node.material,
            node.definition, {},        node.code, node.hidden, node.locked};
}

std::string display_name(const Node& node) { return node.name.empty() ? info(node.kind).label : node.name; }

std::string display_name(const Scene& scene, const Node& node) {
    const Node* definition = node.name.empty() ? find_definition(scene, node.definition) : nullptr;
    return definition ? "instance of " + definition->name : display_name(node);
}

std::uint32_t material_index(const Scene& scene, Id id, std::uint32_t inherited) {
    const Material* material = find_material(scene, id);
    return material ? static_cast<std::uint32_t>(material - scene.materials.data()) : inherited;
}

const Node* find_lock(const Scene& scene, Id id) {
    for (const Node* node = find_node(scene, id); node; node = find_parent(scene, node->id))
        if (node->locked) return node;
    return nullptr;
}

const Node* first_shown(const Node& node) {
    const auto it =
        std::find_if(node.children.begin(), node.children.end(), [](const Node& child) { return !child.hidden; });
    return it == node.children.end() ? nullptr : &*it;
}

bool is_empty(const Scene& scene, const Node& node) { return is_empty(node, filled_definitions(scene)); }

std::set<Id> filled_definitions(const Scene& scene) {
    std::set<Id> filled;
    visit_definitions(scene, [&](const Node& definition) {
        if (!is_empty(definition, filled)) filled.insert(definition.id);
    });
    return filled;
}

bool is_empty(const Node& node, const std::set<Id>& filled_definitions) {
    if (node.hidden) return true;
    if (node.kind == NodeKind::custom) return !node.code;
    if (node.kind == NodeKind::instance) return !filled_definitions.contains(node.definition);
    if (!info(node.kind).takes_children()) return false;
    const auto is_empty_too = [&](const Node& child) { return is_empty(child, filled_definitions); };
    const Node* first = first_shown(node);
    if (!first) return true;
    if (node.kind == NodeKind::subtract) return is_empty_too(*first);
    return std::all_of(node.children.begin(), node.children.end(), is_empty_too);
}

int count_nodes(const Node& node) {
    int count = 1;
    for (const Node& child : node.children) count += count_nodes(child);
    return count;
}

int count_nodes(const Scene& scene) {
    int count = count_nodes(scene.root);
    for (const Node& definition : scene.definitions) count += count_nodes(definition);
    return count;
}

ExpandedCounts::ExpandedCounts(const Scene& scene) {
    visit_definitions(scene, [&](const Node& definition) { definitions_[definition.id] = of(definition); });
}

std::uint64_t ExpandedCounts::of(const Node& node) const { return expanded_count(node, definitions_); }

std::uint64_t expanded_node_count(const Scene& scene) { return ExpandedCounts(scene).of(scene.root); }

int count_uses(const Scene& scene, Id definition) {
    int count = 0;
    const auto look = [&](const Node& node) { count += definition != 0 && node.definition == definition; };
    visit_all_nodes(scene, look);
    return count;
}

std::optional<NestingProblem> find_nesting_problem(const Scene& scene) {
    Nesting nesting(scene);
    nesting.height(scene.root, 0);
    for (const Node& definition : scene.definitions)
        if (!nesting.problem) nesting.height(definition, 0);
    return nesting.problem;
}

}  // namespace farfield
