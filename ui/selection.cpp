#include "ui/selection.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace farfield {
namespace {

bool holds(const std::vector<Id>& ids, Id id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); }

std::vector<Id> ids_of(const std::vector<Node>& nodes) {
    std::vector<Id> ids;
    for (const Node& node : nodes) ids.push_back(node.id);
    return ids;
}

/// The one after it that is still there, or before it, or what it was in.
Id neighbour(const Scene& before, const Scene& after, Id node) {
    for (const Node* parent = find_parent(before, node); parent;
         node = parent->id, parent = find_parent(before, node)) {
        const std::vector<Id> siblings = ids_of(parent->children);
        const auto at = std::find(siblings.begin(), siblings.end(), node);
        const auto is_there = [&](Id id) { return find_node(after, id) != nullptr; };
        if (const auto next = std::find_if(at, siblings.end(), is_there); next != siblings.end()) return *next;
        const auto last = std::find_if(std::make_reverse_iterator(at), siblings.rend(), is_there);
        if (last != siblings.rend()) return *last;
        if (is_there(parent->id)) return parent->id;
    }
    return 0;
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    return lower;
}

}  // namespace

std::vector<Id> selected_nodes(const Selection& selection) {
    if (selection.primary.type != ObjectType::node) return {};
    std::vector<Id> nodes;
    if (selection.further.beside == selection.primary.id) nodes = selection.further.nodes;
    nodes.push_back(selection.primary.id);
    return nodes;
}

bool is_selected(const Selection& selection, Id node) {
    if (selection.primary.type != ObjectType::node) return false;
    return selection.primary.id == node ||
           (selection.further.beside == selection.primary.id && holds(selection.further.nodes, node));
}

Selection select(ObjectRef object) { return {object, {}}; }

Selection select(const std::vector<Id>& nodes) {
    if (nodes.empty()) return {};
    return {{ObjectType::node, nodes.back()}, {nodes.back(), {nodes.begin(), nodes.end() - 1}}};
}

Selection toggled(const Selection& selection, Id node) {
    std::vector<Id> nodes = selected_nodes(selection);
    if (!holds(nodes, node))
        nodes.push_back(node);
    else if (nodes.size() > 1)
        std::erase(nodes, node);
    return select(nodes);
}

Selection extended(const Selection& selection, const std::vector<Id>& rows, Id node) {
    const Id primary = selection.primary.id;
    auto first = std::find(rows.begin(), rows.end(), primary), last = std::find(rows.begin(), rows.end(), node);
    if (selection.primary.type != ObjectType::node || first == rows.end() || last == rows.end())
        return select(ObjectRef{ObjectType::node, node});
    if (last < first) std::swap(first, last);
    std::vector<Id> nodes(first, last + 1);
    std::erase(nodes, primary);
    nodes.push_back(primary);
    return select(nodes);
}

Selection everything(const Scene& scene, const Selection& selection) {
    std::vector<Id> all = ids_of(scene.root.children);
    const Node* parent =
        selection.primary.type == ObjectType::node ? find_parent(scene, selection.primary.id) : nullptr;
    if (parent) {
        const std::vector<Id> siblings = ids_of(parent->children);
        const bool done =
            std::all_of(siblings.begin(), siblings.end(), [&](Id id) { return is_selected(selection, id); });
        if (!done) all = siblings;
    }
    return all.empty() ? selection : select(all);
}

Selection selection_after(const Scene& before, const Scene& after, std::span<const Edit> edits,
                          const std::vector<Id>& results, const Selection& selection) {
    std::vector<Id> added, taken_out;
    for (std::size_t i = 0; i < edits.size(); ++i) {
        const Edit& edit = edits[i];
        if (std::holds_alternative<AddMaterial>(edit)) return select(ObjectRef{ObjectType::material, results[i]});
        if (std::holds_alternative<AddLight>(edit)) return select(ObjectRef{ObjectType::light, results[i]});
        if (const auto* e = std::get_if<DissolveNode>(&edit)) {
            if (const Node* group = find_node(before, e->node))
                for (const Id id : ids_of(group->children)) taken_out.push_back(id);
        } else if (const auto* pasted = std::get_if<InsertExcerpt>(&edit)) {
            const std::vector<Id> siblings = ids_of(find_node(after, pasted->parent)->children);
            const auto first = std::find(siblings.begin(), siblings.end(), results[i]);
            const auto count = std::min(std::ssize(pasted->excerpt->root.children), siblings.end() - first);
            added.insert(added.end(), first, first + count);
        } else if (results[i] != 0 && !std::holds_alternative<AddBookmark>(edit)) {
            added.push_back(results[i]);
        }
    }
    if (!added.empty()) return select(added);
    if (!taken_out.empty()) return select(taken_out);
    std::vector<Id> left = selected_nodes(selection);
    std::erase_if(left, [&](Id id) { return !find_node(after, id); });
    if (left.size() == selected_nodes(selection).size()) return selection;
    if (!left.empty()) return select(left);
    const Id next = neighbour(before, after, selection.primary.id);
    return next != 0 ? select(ObjectRef{ObjectType::node, next}) : selection;
}

bool matches(const Scene& scene, const Node& node, std::string_view words) {
    const std::string text = lower_case(display_name(scene, node) + " " + info(node.kind).label);
    std::istringstream in(lower_case(words));
    for (std::string word; in >> word;)
        if (text.find(word) == text.npos) return false;
    return true;
}

}  // namespace farfield
