// Edits that rearrange the tree around nodes that stay what and where they are.
#include "sdf/edit_steps.h"
#include "sdf/placement.h"

#include <utility>

namespace farfield {
namespace {

/// The material that shows on what is in `parent` and has none of its own; 0 where each instance decides.
Id material_in(const Scene& scene, Id parent) {
    for (const Node* node = find_node(scene, parent); node; node = find_parent(scene, node->id))
        if (node->material != 0) return node->material;
    return find_top(scene, parent) == &scene.root ? scene.materials.front().id : 0;
}

void check_placement(const Node& node) {
    for (const auto& field : fields<Transform>())
        if (const std::string why = why_refused(field.parameter, field.get(node.transform)); !why.empty())
            throw EditError(
                fmt::format("{} cannot stay where it is: {}: {}", display_name(node), field.parameter.key, why));
}

Node taken_out(Scene& scene, Id id) {
    Node& parent = node_for(scene, find_parent(scene, id)->id);
    const auto at =
        std::find_if(parent.children.begin(), parent.children.end(), [&](const Node& n) { return n.id == id; });
    Node taken = std::move(*at);
    parent.children.erase(at);
    return taken;
}

/// The node as it has to be in another parent to show as it does.
void stay(const Scene& scene, Node& node, Id from, Id to) {
    node.transform = moved_transform(scene, node.transform, from, to);
    check_placement(node);
    if (node.material == 0 && material_in(scene, from) != material_in(scene, to))
        node.material = material_in(scene, from);
}

bool contains_any(const Node& node, const std::vector<Id>& ids) {
    if (std::find(ids.begin(), ids.end(), node.id) != ids.end()) return true;
    return std::any_of(node.children.begin(), node.children.end(), [&](const Node& n) { return contains_any(n, ids); });
}

void show_only(Node& node, const std::vector<Id>& ids) {
    if (std::find(ids.begin(), ids.end(), node.id) != ids.end()) return;
    for (Node& child : node.children) {
        child.hidden = !contains_any(child, ids);
        if (!child.hidden) show_only(child, ids);
    }
}

}  // namespace

Id apply_one(Scene& scene, const WrapNodes& e) {
    check_name(e.name);
    if (e.nodes.empty()) throw EditError("there is nothing to put into it");
    if (!info(e.kind).takes_children()) throw EditError(fmt::format("a {} takes no children", info(e.kind).label));
    for (const Id id : e.nodes) {
        const Node& node = node_for(scene, id);
        if (!find_parent(scene, id)) throw EditError(fmt::format("{} stays where it is", display_name(node)));
        if (find_top(scene, id) != find_top(scene, e.nodes[0]))
            throw EditError(fmt::format("{} is in another definition", display_name(scene, node)));
        if (std::count_if(e.nodes.begin(), e.nodes.end(), [&](Id other) { return contains_any(node, {other}); }) > 1)
            throw EditError(fmt::format("{} cannot be put beside what is in it", display_name(node)));
    }
    const Id parent = find_parent(scene, e.nodes[0])->id;
    Node wrapper = make_node(e.kind);
    wrapper.id = scene.new_id();
    if (!e.name.empty()) wrapper.name = free_name(node_names(scene), e.name);
    const Id wrapper_id = wrapper.id;
    {
        auto& siblings = node_for(scene, parent).children;
        const auto first =
            std::find_if(siblings.begin(), siblings.end(), [&](const Node& n) { return n.id == e.nodes[0]; });
        siblings.insert(first, std::move(wrapper));
    }
    for (const Id id : e.nodes) {
        const Id from = find_parent(scene, id)->id;
        if (from != parent) check_unlocked(scene, id);
        Node node = taken_out(scene, id);
        if (from != parent) stay(scene, node, from, parent);
        node_for(scene, wrapper_id).children.push_back(std::move(node));
    }
    return wrapper_id;
}

Id apply_one(Scene& scene, const DissolveNode& e) {
    const Node& node = node_for(scene, e.node);
    if (!info(node.kind).takes_children())
        throw EditError(fmt::format("{} is a {}: nothing is in it", display_name(scene, node), info(node.kind).label));
    if (!find_parent(scene, e.node)) throw EditError(fmt::format("{} stays", display_name(node)));
    check_unlocked(scene, e.node);
    Node& parent = node_for(scene, find_parent(scene, e.node)->id);
    const auto at =
        std::find_if(parent.children.begin(), parent.children.end(), [&](const Node& n) { return n.id == e.node; });
    const Node group = *at;
    std::vector<Node> children = group.children;
    for (Node& child : children) {
        if (child.locked) check_unlocked(scene, child.id);
        child.transform = composed(group.transform, child.transform);
        check_placement(child);
        if (child.material == 0) child.material = group.material;
        child.hidden = child.hidden || group.hidden;
    }
    parent.children.insert(parent.children.erase(at), std::make_move_iterator(children.begin()),
                           std::make_move_iterator(children.end()));
    return 0;
}

Id apply_one(Scene& scene, const ShowOnly& e) {
    for (const Id id : e.nodes) node_for(scene, id);
    for (const Id id : e.nodes) show_only(node_for(scene, find_top(scene, id)->id), e.nodes);
    for (const Id id : e.nodes)
        for (Node* node = find_node(scene, id); node;) {
            node->hidden = false;
            const Node* parent = find_parent(scene, node->id);
            node = parent ? find_node(scene, parent->id) : nullptr;
        }
    return 0;
}

}  // namespace farfield
