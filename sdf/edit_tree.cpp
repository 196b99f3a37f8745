// Edits of the tree: what is in it, where, and what instances show.
#include "sdf/edit_steps.h"

#include <utility>

namespace farfield {
namespace {

std::vector<Node>::iterator place(Node& parent, int index) {
    const int count = static_cast<int>(parent.children.size());
    if (index < -1 || index > count)
        throw EditError(fmt::format("there is no place {} among {} children", index, count));
    return parent.children.begin() + (index < 0 ? count : index);
}

std::vector<Node>::iterator position_in(Node& parent, Id child) {
    return std::find_if(parent.children.begin(), parent.children.end(), [&](const Node& n) { return n.id == child; });
}

Node& instance_for(Scene& scene, Id id) {
    Node& node = node_for(scene, id);
    if (node.kind != NodeKind::instance) throw EditError(fmt::format("{} is no instance", display_name(node)));
    return node;
}

}  // namespace

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
    const Node& removed = node_for(scene, e.node);
    if (e.node == scene.root.id) throw EditError("the root stays");
    check_unlocked(scene, e.node);
    visit_nodes(removed, [&](const Node& node) {
        if (node.locked)
            throw EditError(
                fmt::format("{} holds {}, which is locked", display_name(removed), display_name(scene, node)));
    });
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
    check_unlocked(scene, e.node);
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
    std::swap(instance.hidden, node.hidden);
    std::swap(instance.locked, node.locked);
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
        copy.hidden = copy.hidden || instance.hidden;
        copy.locked = copy.locked || instance.locked;
    } else {  // two placements are two nodes
        Node outer = make_node(NodeKind::union_);
        outer.id = scene.new_id();
        outer.transform = instance.transform;
        outer.material = instance.material;
        outer.hidden = instance.hidden;
        outer.locked = instance.locked;
        outer.children.push_back(std::move(copy));
        copy = std::move(outer);
    }
    if (!instance.name.empty()) copy.name = instance.name;
    instance = std::move(copy);
    return instance.id;
}

}  // namespace farfield
