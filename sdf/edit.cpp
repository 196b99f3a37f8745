#include "sdf/edit.h"

#include "sdf/custom_code.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <set>
#include <utility>

namespace farfield {
namespace {

template <class... Visitors>
struct Overloaded : Visitors... {
    using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

Node& node_for(Scene& scene, Id id) {
    if (Node* node = find_node(scene, id)) return *node;
    throw EditError(fmt::format("there is no node {}", id));
}

Node& parent_for(Scene& scene, Id id) {
    Node& node = node_for(scene, id);
    if (!info(node.kind).takes_children())
        throw EditError(fmt::format("{} is a {}: it takes no children", display_name(node), info(node.kind).label));
    return node;
}

template <class T>
T& item_for(std::vector<T>& items, Id id, const char* what) {
    const auto it = std::find_if(items.begin(), items.end(), [&](const T& item) { return item.id == id; });
    if (it == items.end()) throw EditError(fmt::format("there is no {} {}", what, id));
    return *it;
}

void check_name(const std::string& name) {
    if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
        throw EditError("a name cannot hold control characters");
}

void visit_nodes(const Node& node, const std::function<void(const Node&)>& visit) {
    visit(node);
    for (const Node& child : node.children) visit_nodes(child, visit);
}

void visit_nodes(Node& node, const std::function<void(Node&)>& visit) {
    visit(node);
    for (Node& child : node.children) visit_nodes(child, visit);
}

/// In the tree and in the definitions.
template <class S, class Visit>
void visit_all_nodes(S& scene, Visit visit) {
    visit_nodes(scene.root, visit);
    for (auto& definition : scene.definitions) visit_nodes(definition, visit);
}

using Names = std::set<std::string>;

Names node_names(const Scene& scene) {
    Names names;
    visit_all_nodes(scene, [&](const Node& node) {
        if (!node.name.empty()) names.insert(node.name);
    });
    return names;
}

template <class T>
Names names_of(const std::vector<T>& items) {
    Names names;
    for (const T& item : items) names.insert(item.name);
    return names;
}

/// `name`, or when it is taken, with the next free number: "ring", "ring 2", "ring 3".
std::string free_name(const Names& taken, std::string name) {
    if (!taken.contains(name)) return name;
    while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back()))) name.pop_back();
    while (!name.empty() && name.back() == ' ') name.pop_back();
    for (int i = 2;; ++i)
        if (std::string numbered = fmt::format("{}{}{}", name, name.empty() ? "" : " ", i); !taken.contains(numbered))
            return numbered;
}

template <class T>
void rename(std::vector<T>& items, Id id, const std::string& name, const char* what) {
    T& item = item_for(items, id, what);
    if (name.empty()) throw EditError(fmt::format("a {} needs a name", what));
    if (name != item.name && names_of(items).contains(name))
        throw EditError(fmt::format("there is already a {} named {}", what, name));
    item.name = name;
}

/// Whether a node built elsewhere would be a valid part of the scene: what files check, checked for values in memory.
void check_subtree(const Scene& scene, const Node& node) {
    const KindInfo& kind = info(node.kind);
    check_name(node.name);
    if ((node.kind == NodeKind::custom) != (node.code != nullptr))
        throw EditError(fmt::format("{}: custom nodes have code, and no others", display_name(node)));
    const std::vector<Parameter> list = parameters(node);
    if (node.values.size() != list.size())
        throw EditError(fmt::format("a {} has {} parameters, not {}", kind.label, list.size(), node.values.size()));
    const auto check = [](const Parameter& parameter, glm::vec3 value) {
        if (const std::string why = why_refused(parameter, value); !why.empty())
            throw EditError(fmt::format("{}: {}", parameter.key, why));
    };
    for (std::size_t i = 0; i < node.values.size(); ++i) check(list[i], node.values[i]);
    for (const auto& field : fields<Transform>()) check(field.parameter, field.get(node.transform));
    if (node.material != 0 && !find_material(scene, node.material))
        throw EditError(fmt::format("there is no material {}", node.material));
    if ((kind.role == Role::instance) != (find_definition(scene, node.definition) != nullptr))
        throw EditError(fmt::format("{}: an instance shows a definition, and nothing else does", display_name(node)));
    if (!kind.takes_children() && !node.children.empty())
        throw EditError(fmt::format("a {} takes no children", kind.label));
    for (const Node& child : node.children) check_subtree(scene, child);
}

template <class T>
void check_fields(const T& object) {
    for (const auto& field : fields<T>())
        if (const std::string why = why_refused(field.parameter, field.get(object)); !why.empty())
            throw EditError(fmt::format("{}: {}", field.parameter.key, why));
}

std::vector<Node>::iterator place(Node& parent, int index) {
    const int count = static_cast<int>(parent.children.size());
    if (index < -1 || index > count)
        throw EditError(fmt::format("there is no place {} among {} children", index, count));
    return parent.children.begin() + (index < 0 ? count : index);
}

std::vector<Node>::iterator position_in(Node& parent, Id child) {
    return std::find_if(parent.children.begin(), parent.children.end(), [&](const Node& n) { return n.id == child; });
}

void check_direction(const Light& light) {
    if (light.kind == LightKind::directional && light.direction == glm::vec3(0.0f))
        throw EditError("direction: expected any length but 0");
}

Id apply_one(Scene& scene, const SetValue& e) {
    if (e.object.type == ObjectType::light && e.key == "direction" && e.value == glm::vec3(0.0f))
        throw EditError("direction: expected any length but 0");
    try {
        set_value(scene, e.object, e.key, e.value);
    } catch (const std::logic_error& error) {
        throw EditError(error.what());
    }
    return 0;
}

Id apply_one(Scene& scene, const SetName& e) {
    check_name(e.name);
    switch (e.object.type) {
        case ObjectType::node: {
            Node& node = node_for(scene, e.object.id);
            if (e.name.empty() && find_definition(scene, node.id)) throw EditError("a definition needs a name");
            if (!e.name.empty() && e.name != node.name && node_names(scene).contains(e.name))
                throw EditError(fmt::format("there is already a node named {}", e.name));
            node.name = e.name;
            return 0;
        }
        case ObjectType::material:
            rename(scene.materials, e.object.id, e.name, "material");
            return 0;
        case ObjectType::light:
            rename(scene.lights, e.object.id, e.name, "light");
            return 0;
        default:
            throw EditError("only nodes, materials and lights have names");
    }
}

/// Gives `to` the values of `from` whose keys both have, as `adapted(parameter, value)`.
template <class Adapt>
void carry_over(const Node& from, Node& to, Adapt adapted) {
    const std::vector<Parameter> old = parameters(from), list = parameters(to);
    for (std::size_t i = 0; i < list.size(); ++i)
        for (std::size_t j = 0; j < old.size(); ++j)
            if (std::string_view(list[i].key) == old[j].key && list[i].components() == old[j].components())
                to.values[i] = adapted(list[i], from.values[j]);
}

Id apply_one(Scene& scene, const SetKind& e) {
    Node& node = node_for(scene, e.node);
    const KindInfo& to = info(e.kind);
    if (node.id == scene.root.id && e.kind != NodeKind::union_) throw EditError("the root stays a union");
    if (!to.takes_children() && !node.children.empty())
        throw EditError(fmt::format("{} has children, which a {} cannot take", display_name(node), to.label));
    if (to.role == Role::instance && node.kind != e.kind)
        throw EditError(fmt::format("{} cannot become an instance: add an instance of a definition instead",
                                    display_name(scene, node)));
    Node fresh = make_node(e.kind);
    carry_over(node, fresh, [](const Parameter& parameter, glm::vec3 value) {
        return why_refused(parameter, value).empty() ? value : parameter.initial;
    });
    if (to.role != Role::instance) node.definition = 0;
    node.kind = e.kind;
    node.values = std::move(fresh.values);
    node.code = std::move(fresh.code);
    return 0;
}

Id apply_one(Scene& scene, const SetCode& e) {
    Node& node = node_for(scene, e.node);
    if (node.kind != NodeKind::custom) throw EditError(fmt::format("{} has no code", display_name(node)));
    CustomCode::Parsed parsed = CustomCode::parse(e.text);
    if (!parsed.code) {
        std::string errors;
        for (const CodeError& error : parsed.errors) errors += fmt::format("\nline {}: {}", error.line, error.message);
        throw EditError(fmt::format("the code of {} stays as it was:{}", display_name(node), errors));
    }
    Node fresh = make_node(NodeKind::custom);
    fresh.code = std::move(parsed.code);
    fresh.values.clear();
    for (const Parameter& parameter : parameters(fresh)) fresh.values.push_back(parameter.initial);
    carry_over(node, fresh, clamped);
    node.values = std::move(fresh.values);
    node.code = std::move(fresh.code);
    return 0;
}

Id apply_one(Scene& scene, const SetLightKind& e) {
    Light& light = item_for(scene.lights, e.light, "light");
    Light changed = light;
    changed.kind = e.kind;
    check_direction(changed);
    light = changed;
    return 0;
}

Id apply_one(Scene& scene, const SetMaterial& e) {
    Node& node = node_for(scene, e.node);
    if (e.material != 0 && !find_material(scene, e.material))
        throw EditError(fmt::format("there is no material {}", e.material));
    node.material = e.material;
    return 0;
}

/// Fresh ids for a subtree that is not in the scene yet, and names that are free.
void make_new(Scene& scene, Node& subtree) {
    Names taken = node_names(scene);
    visit_nodes(subtree, [&](Node& node) {
        node.id = scene.new_id();
        if (node.name.empty()) return;
        node.name = free_name(taken, node.name);
        taken.insert(node.name);
    });
}

Id apply_one(Scene& scene, const InsertNode& e) {
    Node& parent = parent_for(scene, e.parent);
    const auto where = place(parent, e.index);
    check_subtree(scene, e.node);
    Node inserted = e.node;
    make_new(scene, inserted);
    const Id id = inserted.id;
    parent.children.insert(where, std::move(inserted));
    return id;
}

Id apply_one(Scene& scene, const RemoveNode& e) {
    node_for(scene, e.node);
    if (e.node == scene.root.id) throw EditError("the root stays");
    if (const Node* definition = find_definition(scene, e.node)) {
        if (const int uses = count_uses(scene, e.node); uses > 0)
            throw EditError(fmt::format("{} is shown by {} instance{}: delete {} first or make {} independent",
                                        definition->name, uses, uses == 1 ? "" : "s", uses == 1 ? "it" : "them",
                                        uses == 1 ? "it" : "them"));
        scene.definitions.erase(scene.definitions.begin() + (definition - scene.definitions.data()));
        return 0;
    }
    Node& parent = node_for(scene, find_parent(scene, e.node)->id);
    parent.children.erase(position_in(parent, e.node));
    return 0;
}

Id apply_one(Scene& scene, const MoveNode& e) {
    const Node& moved = node_for(scene, e.node);
    Node& to = parent_for(scene, e.parent);
    if (e.node == scene.root.id) throw EditError("the root stays where it is");
    if (find_definition(scene, e.node)) throw EditError("a definition stays where it is: add an instance of it");
    // A search below the moved node: it cannot become its own descendant.
    bool inside = false;
    visit_nodes(moved, [&](const Node& node) { inside |= node.id == e.parent; });
    if (inside) throw EditError(fmt::format("{} cannot be moved into itself", display_name(moved)));
    const auto where = place(to, e.index);
    Node& from = node_for(scene, find_parent(scene, e.node)->id);
    const auto source = position_in(from, e.node);
    if (&from == &to) {
        if (source < where)
            std::rotate(source, source + 1, where);
        else
            std::rotate(where, source, source + 1);
        return 0;
    }
    Node taken = std::move(*source);
    const auto index = where - to.children.begin();
    // Erasing moves later siblings, and the new parent may be below one of them: it is looked up again.
    from.children.erase(source);
    Node& target = node_for(scene, e.parent);
    target.children.insert(target.children.begin() + index, std::move(taken));
    return 0;
}

Node& instance_for(Scene& scene, Id id) {
    Node& node = node_for(scene, id);
    if (node.kind != NodeKind::instance) throw EditError(fmt::format("{} is no instance", display_name(node)));
    return node;
}

Id apply_one(Scene& scene, const SetDefinition& e) {
    Node& instance = instance_for(scene, e.instance);
    if (!find_definition(scene, e.definition)) throw EditError(fmt::format("there is no definition {}", e.definition));
    instance.definition = e.definition;
    return 0;
}

Id apply_one(Scene& scene, const MakeDefinition& e) {
    Node& node = node_for(scene, e.node);
    if (e.node == scene.root.id) throw EditError("the root cannot become a definition");
    if (find_definition(scene, e.node)) throw EditError(fmt::format("{} is a definition already", node.name));
    if (node.kind == NodeKind::instance)
        throw EditError(fmt::format("{} shows a definition already", display_name(scene, node)));
    Node instance = make_instance(node);
    instance.id = scene.new_id();
    std::swap(instance.transform, node.transform);
    std::swap(instance.material, node.material);
    if (node.name.empty()) node.name = free_name(node_names(scene), info(node.kind).label);
    Node definition = std::exchange(node, instance);
    scene.definitions.push_back(std::move(definition));
    return instance.id;
}

Id apply_one(Scene& scene, const MakeIndependent& e) {
    Node& instance = instance_for(scene, e.instance);
    if (find_definition(scene, e.instance))
        throw EditError(fmt::format("{} is a definition: change its kind instead", instance.name));
    Node copy = *find_definition(scene, instance.definition);
    make_new(scene, copy);
    if (const Transform& t = copy.transform;
        t.translate == glm::vec3(0.0f) && t.rotate == glm::vec3(0.0f) && t.scale == 1.0f) {
        copy.transform = instance.transform;
        if (copy.material == 0) copy.material = instance.material;
    } else {  // two placements are two nodes
        Node outer = make_node(NodeKind::union_);
        outer.id = scene.new_id();
        outer.transform = instance.transform;
        outer.material = instance.material;
        outer.children.push_back(std::move(copy));
        copy = std::move(outer);
    }
    if (!instance.name.empty()) copy.name = instance.name;
    instance = std::move(copy);
    return instance.id;
}

Id apply_one(Scene& scene, const AddMaterial& e) {
    if (scene.materials.size() >= largest_material_count)
        throw EditError(fmt::format("a scene has at most {} materials", largest_material_count));
    check_name(e.material.name);
    check_fields(e.material);
    Material material = e.material;
    material.id = scene.new_id();
    material.name = free_name(names_of(scene.materials), material.name.empty() ? "material" : material.name);
    scene.materials.push_back(std::move(material));
    return scene.materials.back().id;
}

Id apply_one(Scene& scene, const RemoveMaterial& e) {
    const Material& material = item_for(scene.materials, e.material, "material");
    if (scene.materials.size() == 1) throw EditError("the last material stays");
    scene.materials.erase(scene.materials.begin() + (&material - scene.materials.data()));
    visit_all_nodes(scene, [&](Node& node) {
        if (node.material == e.material) node.material = 0;
    });
    return 0;
}

Id apply_one(Scene& scene, const AddLight& e) {
    check_name(e.light.name);
    check_fields(e.light);
    check_direction(e.light);
    Light light = e.light;
    light.id = scene.new_id();
    light.name = free_name(names_of(scene.lights), light.name.empty() ? "light" : light.name);
    scene.lights.push_back(std::move(light));
    return scene.lights.back().id;
}

Id apply_one(Scene& scene, const RemoveLight& e) {
    const Light& light = item_for(scene.lights, e.light, "light");
    scene.lights.erase(scene.lights.begin() + (&light - scene.lights.data()));
    return 0;
}

template <class T>
std::string name_in(const std::vector<T>& items, Id id) {
    for (const T& item : items)
        if (item.id == id) return item.name;
    return "?";
}

std::string node_name(const Scene& scene, Id id) {
    const Node* node = find_node(scene, id);
    return node ? display_name(scene, *node) : "?";
}

std::string object_name(const Scene& scene, ObjectRef object) {
    switch (object.type) {
        case ObjectType::node:
            return node_name(scene, object.id);
        case ObjectType::material:
            return name_in(scene.materials, object.id);
        case ObjectType::light:
            return name_in(scene.lights, object.id);
        case ObjectType::sky:
            return "sky";
        case ObjectType::camera:
            return "camera";
        case ObjectType::settings:
            return "settings";
    }
    return "?";
}

}  // namespace

Id apply(Scene& scene, const Edit& edit) {
    const auto carry_out = [&](Scene& to) { return std::visit([&](const auto& e) { return apply_one(to, e); }, edit); };
    const bool nests = std::holds_alternative<InsertNode>(edit) || std::holds_alternative<MoveNode>(edit) ||
                       std::holds_alternative<SetDefinition>(edit) || std::holds_alternative<MakeDefinition>(edit) ||
                       std::holds_alternative<MakeIndependent>(edit);
    if (!nests) return carry_out(scene);
    // Whether the result has an end is easiest to see in the result.
    Scene changed = scene;
    const Id id = carry_out(changed);
    if (const auto problem = find_nesting_problem(changed)) {
        const Node& node = *find_node(changed, problem->node);
        if (!problem->endless)
            throw EditError(fmt::format("at most {} nodes can be inside one another", largest_depth));
        throw EditError(
            fmt::format("{} cannot contain an instance of itself", find_definition(changed, node.definition)->name));
    }
    scene = std::move(changed);
    return id;
}

std::string describe(const Scene& before, const Edit& edit) {
    const auto words = [](std::string key) {
        std::replace(key.begin(), key.end(), '_', ' ');
        return key;
    };
    const auto label = [](NodeKind kind) { return info(kind).label; };
    return std::visit(
        Overloaded{
            [&](const SetValue& e) { return fmt::format("{} of {}", words(e.key), object_name(before, e.object)); },
            [&](const SetName& e) { return fmt::format("rename {}", object_name(before, e.object)); },
            [&](const SetKind& e) { return fmt::format("make {} a {}", node_name(before, e.node), label(e.kind)); },
            [&](const SetLightKind& e) {
                return fmt::format("make {} {}", name_in(before.lights, e.light),
                                   light_kind_keys[static_cast<int>(e.kind)]);
            },
            [&](const SetMaterial& e) { return fmt::format("material of {}", node_name(before, e.node)); },
            [&](const InsertNode& e) { return fmt::format("add {}", display_name(before, e.node)); },
            [&](const RemoveNode& e) { return fmt::format("delete {}", node_name(before, e.node)); },
            [&](const MoveNode& e) { return fmt::format("move {}", node_name(before, e.node)); },
            [&](const SetDefinition& e) {
                return fmt::format("let {} show {}", node_name(before, e.instance), node_name(before, e.definition));
            },
            [&](const MakeDefinition& e) { return fmt::format("make {} a definition", node_name(before, e.node)); },
            [&](const MakeIndependent& e) { return fmt::format("make {} independent", node_name(before, e.instance)); },
            [&](const AddMaterial&) { return std::string("add material"); },
            [&](const RemoveMaterial& e) {
                return fmt::format("delete material {}", name_in(before.materials, e.material));
            },
            [&](const AddLight&) { return std::string("add light"); },
            [&](const SetCode& e) { return fmt::format("code of {}", node_name(before, e.node)); },
            [&](const RemoveLight& e) { return fmt::format("delete light {}", name_in(before.lights, e.light)); },
        },
        edit);
}

History::History(Scene scene) { replace(std::move(scene)); }

const Scene& History::scene() const { return steps_[current_].scene; }

Id History::apply(const Edit& edit, unsigned gesture) {
    Scene changed = scene();
    const Id id = farfield::apply(changed, edit);
    steps_.resize(current_ + 1);
    if (gesture != 0 && current_ > 0 && steps_[current_].gesture == gesture) {
        steps_[current_].scene = std::move(changed);
        steps_[current_].revision = next_revision_++;
        return id;
    }
    steps_.push_back({std::move(changed), describe(scene(), edit), gesture, next_revision_++});
    ++current_;
    return id;
}

void History::replace(Scene scene) {
    steps_.clear();
    steps_.push_back({std::move(scene), "", 0, next_revision_++});
    current_ = 0;
}

void History::record(Scene scene, std::string description) {
    scene.next_id = std::max(scene.next_id, steps_[current_].scene.next_id);
    steps_.resize(current_ + 1);
    steps_.push_back({std::move(scene), std::move(description), 0, next_revision_++});
    ++current_;
}

bool History::can_undo() const { return current_ > 0; }
bool History::can_redo() const { return current_ + 1 < steps_.size(); }

void History::undo() {
    if (!can_undo()) return;
    // Identifiers are never reused, not even by an edit that follows an undo.
    const Id next_id = scene().next_id;
    --current_;
    steps_[current_].scene.next_id = std::max(steps_[current_].scene.next_id, next_id);
}

void History::redo() {
    if (!can_redo()) return;
    const Id next_id = scene().next_id;
    ++current_;
    steps_[current_].scene.next_id = std::max(steps_[current_].scene.next_id, next_id);
}

std::vector<std::string> History::steps() const {
    std::vector<std::string> descriptions;
    for (std::size_t i = 1; i <= current_; ++i) descriptions.push_back(steps_[i].description);
    return descriptions;
}

std::uint64_t History::revision() const { return steps_[current_].revision; }

}  // namespace farfield
