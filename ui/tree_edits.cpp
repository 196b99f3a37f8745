#include "ui/tree_edits.h"

#include "sdf/excerpt.h"
#include "sdf/placement.h"
#include "sdf/scene_file.h"

#include <algorithm>
#include <iterator>

namespace farfield {
namespace {

/// Edits that follow from each other: each is made for the scene that those before it leave.
class Plan {
public:
    explicit Plan(const Scene& scene) : scene_(scene) {}
    const Scene& scene() const { return scene_; }
    void add(Edit edit) {
        edits_.push_back(std::move(edit));
        if (refused_) return;
        try {
            farfield::apply(scene_, edits_.back());
        } catch (const EditError&) {
            refused_ = true;  // whoever carries the edits out meets the same error and tells it
        }
    }
    bool refused() const { return refused_; }
    Edits take() { return std::move(edits_); }

private:
    Scene scene_;
    Edits edits_;
    bool refused_ = false;
};

/// The selected nodes that are in none of the others.
std::vector<Id> tops(const Scene& scene, const Selection& selection) {
    return topmost(scene, selected_nodes(selection));
}

/// Those of them that have a parent.
std::vector<Id> movable(const Scene& scene, const Selection& selection) {
    std::vector<Id> nodes = tops(scene, selection);
    std::erase_if(nodes, [&](Id id) { return !find_parent(scene, id); });
    return nodes;
}

/// Sets a flag where it is not set; where it is set everywhere, takes it away.
template <class SetFlag>
Edits toggle(const Scene& scene, std::vector<Id> nodes, bool Node::*flag) {
    std::erase_if(nodes, [&](Id id) { return id == scene.root.id || !find_node(scene, id); });
    const bool all = std::all_of(nodes.begin(), nodes.end(), [&](Id id) { return find_node(scene, id)->*flag; });
    Edits edits;
    for (const Id id : nodes)
        if (all || !(find_node(scene, id)->*flag)) edits.push_back(SetFlag{id, !all});
    return edits;
}

void show(const Node& node, Edits& edits) {
    if (node.hidden) edits.push_back(SetHidden{node.id, false});
    for (const Node& child : node.children) show(child, edits);
}

/// Of a scene before and after edits of nothing but what is hidden.
bool same_shown(const Node& a, const Node& b) {
    return a.hidden == b.hidden && std::equal(a.children.begin(), a.children.end(), b.children.begin(), same_shown);
}

/// What keeps a node where it is when it gets into another parent; nothing where that cannot be.
Edits stay_in_place(const Scene& scene, Id id, Id to) {
    const Node* from = find_parent(scene, id);
    if (!from || from->id == to || find_top(scene, id) != find_top(scene, to)) return {};
    const Transform now = find_node(scene, id)->transform;
    const Transform wanted = moved_transform(scene, now, from->id, to);
    Edits edits;
    for (const auto& field : fields<Transform>()) {
        const glm::vec3 value = field.get(wanted);
        if (!why_refused(field.parameter, value).empty()) return {};
        if (value != field.get(now)) edits.push_back(SetValue{{ObjectType::node, id}, field.parameter.key, value});
    }
    return edits;
}

bool is_placement(std::string_view key) {
    const auto all = fields<Transform>();
    return std::any_of(all.begin(), all.end(), [&](const auto& field) { return key == field.parameter.key; });
}

/// What `set`, of another node, comes to for this one; nothing where it has no such value.
std::optional<SetValue> carried_over(const Scene& scene, const SetValue& set, Id to) {
    const Node &from = *find_node(scene, set.object.id), &node = *find_node(scene, to);
    const bool placement = is_placement(set.key);
    if (!placement && (node.kind != from.kind || (node.code && node.code != from.code))) return std::nullopt;
    const ObjectRef object{ObjectType::node, to};
    const glm::vec3 old = value(scene, set.object, set.key), now = value(scene, object, set.key);
    glm::vec3 wanted = now;
    for (int i = 0; i < 3; ++i) {
        if (set.value[i] == old[i]) continue;
        wanted[i] = !placement           ? set.value[i]
                    : set.key == "scale" ? now[i] * (set.value[i] / old[i])
                                         : now[i] + (set.value[i] - old[i]);
    }
    const std::vector<Parameter> list = parameters(scene, object);
    const auto parameter = std::find_if(list.begin(), list.end(), [&](const Parameter& p) { return set.key == p.key; });
    return SetValue{object, set.key, clamped(*parameter, wanted)};
}

}  // namespace

int index_in(const Node& parent, Id child) {
    const auto it =
        std::find_if(parent.children.begin(), parent.children.end(), [&](const Node& n) { return n.id == child; });
    return static_cast<int>(it - parent.children.begin());
}

Edit insert_at_selection(const Scene& scene, const Selection& selection, Node node) {
    const Node* selected =
        selection.primary.type == ObjectType::node ? find_node(scene, selection.primary.id) : nullptr;
    if (selected) {
        if (info(selected->kind).takes_children()) return InsertNode{selected->id, -1, std::move(node)};
        if (const Node* parent = find_parent(scene, selected->id))
            return InsertNode{parent->id, index_in(*parent, selected->id) + 1, std::move(node)};
    }
    return InsertNode{scene.root.id, -1, std::move(node)};
}

Edits delete_selection(const Scene& scene, const Selection& selection) {
    const Id id = selection.primary.id;
    if (selection.primary.type == ObjectType::material && find_material(scene, id) && scene.materials.size() > 1)
        return {RemoveMaterial{id}};
    if (selection.primary.type == ObjectType::light && find_light(scene, id)) return {RemoveLight{id}};
    Edits edits;
    for (const Id node : tops(scene, selection))
        if (node != scene.root.id) edits.push_back(RemoveNode{node});
    return edits;
}

Edits duplicate_selection(const Scene& scene, const Selection& selection) {
    if (selection.primary.type == ObjectType::material)
        if (const Material* material = find_material(scene, selection.primary.id)) return {AddMaterial{*material}};
    if (selection.primary.type == ObjectType::light)
        if (const Light* light = find_light(scene, selection.primary.id)) return {AddLight{*light}};
    Plan plan(scene);
    for (const Id id : movable(scene, selection)) {
        const Node& parent = *find_parent(plan.scene(), id);
        Node copy = *find_node(scene, id);
        copy.locked = false;
        plan.add(InsertNode{parent.id, index_in(parent, id) + 1, std::move(copy)});
    }
    return plan.take();
}

std::string copied_selection(const Scene& scene, const Selection& selection) {
    const std::vector<Id> nodes = tops(scene, selection);
    return nodes.empty() ? "" : to_text(excerpt(scene, nodes));
}

Edits paste_at_selection(const Scene& scene, const Selection& selection, const std::string& text) {
    const std::vector<Id> nodes = movable(scene, selection);
    const Node* parent = nodes.empty() ? nullptr : find_parent(scene, nodes.back());
    if (parent) return {InsertExcerpt{parent->id, index_in(*parent, nodes.back()) + 1, parse_excerpt(text)}};
    const Node* definition =
        selection.primary.type == ObjectType::node ? find_definition(scene, selection.primary.id) : nullptr;
    const bool inside = definition && info(definition->kind).takes_children();
    return paste_into(inside ? definition->id : scene.root.id, text);
}

Edits paste_into(Id parent, const std::string& text) { return {InsertExcerpt{parent, -1, parse_excerpt(text)}}; }

Edits define_selection(const Scene& scene, const Selection& selection) {
    Edits edits;
    for (const Id id : movable(scene, selection))
        if (find_node(scene, id)->kind != NodeKind::instance) edits.push_back(MakeDefinition{id});
    return edits;
}

Edits free_selection(const Scene& scene, const Selection& selection) {
    Edits edits;
    for (const Id id : movable(scene, selection))
        if (find_node(scene, id)->kind == NodeKind::instance) edits.push_back(MakeIndependent{id});
    return edits;
}

Edits shift_selection(const Scene& scene, const Selection& selection, int by) {
    std::vector<Id> nodes = movable(scene, selection);
    if (by > 0) std::reverse(nodes.begin(), nodes.end());
    Plan plan(scene);
    for (const Id id : nodes) {
        const Node& parent = *find_parent(plan.scene(), id);
        const int to = index_in(parent, id) + by;
        if (to < 0 || to >= static_cast<int>(parent.children.size())) continue;
        // Those at the end stay in their order.
        const Id other = parent.children[static_cast<std::size_t>(to)].id;
        if (std::find(nodes.begin(), nodes.end(), other) != nodes.end()) continue;
        plan.add(MoveNode{id, parent.id, by < 0 ? to : to + 1});
    }
    return plan.take();
}

Edits move_nodes(const Scene& scene, const std::vector<Id>& nodes, Id parent, int index) {
    const Node* to = find_node(scene, parent);
    if (!to) return {};
    const auto count = static_cast<int>(to->children.size());
    const Id next = index >= 0 && index < count ? to->children[static_cast<std::size_t>(index)].id : 0;
    Plan plan(scene);
    Id before = next;
    // From the last to the first, each before the one that was moved last.
    const std::vector<Id> ordered = topmost(scene, nodes);
    for (auto id = ordered.rbegin(); id != ordered.rend(); ++id) {
        if (*id != before) {
            const Node& now = *find_node(plan.scene(), parent);
            plan.add(MoveNode{*id, parent, before == 0 ? -1 : index_in(now, before)});
            for (Edit& edit : stay_in_place(scene, *id, parent)) plan.add(std::move(edit));
        }
        if (plan.refused()) break;
        before = *id;
    }
    return plan.take();
}

Edits group_selection(const Scene& scene, const Selection& selection) {
    std::vector<Id> nodes = movable(scene, selection);
    if (nodes.empty()) return {};
    const Node& parent = *find_parent(scene, nodes[0]);
    const KindInfo& kind = info(parent.kind);
    const auto is_selected = [&](const Node& child) { return std::count(nodes.begin(), nodes.end(), child.id) > 0; };
    const bool all_here = std::count_if(parent.children.begin(), parent.children.end(), is_selected) ==
                          static_cast<std::ptrdiff_t>(nodes.size());
    // What is taken away from the first child is a union.
    const bool alike =
        kind.role == Role::combine && all_here && (kind.gather != Gather::first || is_selected(parent.children[0]));
    Plan plan(scene);
    const Id first = nodes[0];
    plan.add(WrapNodes{std::move(nodes), alike ? parent.kind : NodeKind::union_, "group"});
    if (!alike || plan.refused()) return plan.take();
    const Id group = find_parent(plan.scene(), first)->id;
    for (std::size_t i = 0; i < parent.values.size(); ++i)
        if (parent.values[i] != kind.parameters[i].initial)
            plan.add(SetValue{{ObjectType::node, group}, kind.parameters[i].key, parent.values[i]});
    return plan.take();
}

Edits wrap_selection(const Scene& scene, const Selection& selection, NodeKind kind) {
    std::vector<Id> nodes = movable(scene, selection);
    if (nodes.empty()) return {};
    return {WrapNodes{std::move(nodes), kind, ""}};
}

Edits dissolve_selection(const Scene& scene, const Selection& selection) {
    Edits edits;
    for (const Id id : movable(scene, selection))
        if (info(find_node(scene, id)->kind).takes_children()) edits.push_back(DissolveNode{id});
    return edits;
}

Edits hide_selection(const Scene& scene, const Selection& selection) {
    return toggle<SetHidden>(scene, selected_nodes(selection), &Node::hidden);
}

Edits show_only_selection(const Scene& scene, const Selection& selection) {
    std::vector<Id> nodes = movable(scene, selection);
    if (nodes.empty()) return {};
    Scene changed = scene;
    const Edit edit = ShowOnly{std::move(nodes)};
    farfield::apply(changed, edit);
    return std::equal(changed.definitions.begin(), changed.definitions.end(), scene.definitions.begin(), same_shown) &&
                   same_shown(changed.root, scene.root)
               ? show_everything(scene)
               : Edits{edit};
}

Edits show_everything(const Scene& scene) {
    Edits edits;
    show(scene.root, edits);
    for (const Node& definition : scene.definitions) show(definition, edits);
    return edits;
}

Edits lock_selection(const Scene& scene, const Selection& selection) {
    return toggle<SetLocked>(scene, selected_nodes(selection), &Node::locked);
}

Edits for_all_selected(const Scene& scene, const Selection& selection, Edits edits) {
    const std::vector<Id> nodes = selected_nodes(selection);
    Edits all;
    for (Edit& edit : edits) {
        const auto* set = std::get_if<SetValue>(&edit);
        const auto* kind = std::get_if<SetKind>(&edit);
        const auto* material = std::get_if<SetMaterial>(&edit);
        Edits others;
        for (const Id id : nodes) {
            const Node* node = find_node(scene, id);
            if (!node || id == selection.primary.id) continue;
            if (set && set->object == selection.primary) {
                if (auto carried = carried_over(scene, *set, id)) others.push_back(std::move(*carried));
            } else if (kind && kind->node == selection.primary.id && id != scene.root.id &&
                       (node->children.empty() || info(kind->kind).takes_children())) {
                others.push_back(SetKind{id, kind->kind});
            } else if (material && material->node == selection.primary.id) {
                others.push_back(SetMaterial{id, material->material});
            }
        }
        all.push_back(std::move(edit));
        std::move(others.begin(), others.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace farfield
