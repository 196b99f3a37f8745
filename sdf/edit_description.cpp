// What edits are called in the list of steps.
#include "sdf/edit.h"

#include <fmt/format.h>

#include <algorithm>

namespace farfield {
namespace {

template <class... Visitors>
struct Overloaded : Visitors... {
    using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

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

std::string several(const Scene& scene, const std::vector<Id>& nodes) {
    if (nodes.empty()) return "nothing";
    return node_name(scene, nodes[0]) + (nodes.size() > 1 ? fmt::format(" and {} more", nodes.size() - 1) : "");
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
        case ObjectType::bookmark:
            return name_in(scene.bookmarks, object.id);
        case ObjectType::settings:
            return "settings";
    }
    return "?";
}

}  // namespace

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
            [&](const SetHidden& e) {
                return fmt::format("{} {}", e.hidden ? "hide" : "show", node_name(before, e.node));
            },
            [&](const SetLocked& e) {
                return fmt::format("{} {}", e.locked ? "lock" : "unlock", node_name(before, e.node));
            },
            [&](const InsertExcerpt& e) {
                const auto& nodes = e.excerpt->root.children;
                if (nodes.empty()) return std::string("paste nothing");
                const std::string first = display_name(*e.excerpt, nodes[0]);
                return fmt::format("paste {}{}", first,
                                   nodes.size() > 1 ? fmt::format(" and {} more", nodes.size() - 1) : "");
            },
            [&](const InsertNode& e) { return fmt::format("add {}", display_name(before, e.node)); },
            [&](const RemoveNode& e) { return fmt::format("delete {}", node_name(before, e.node)); },
            [&](const MoveNode& e) { return fmt::format("move {}", node_name(before, e.node)); },
            [&](const WrapNodes& e) {
                return e.kind == NodeKind::union_
                           ? "group " + several(before, e.nodes)
                           : fmt::format("put {} in a {}", several(before, e.nodes), label(e.kind));
            },
            [&](const DissolveNode& e) { return fmt::format("dissolve {}", node_name(before, e.node)); },
            [&](const ShowOnly& e) { return fmt::format("show only {}", several(before, e.nodes)); },
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
            [&](const AddBookmark&) { return std::string("add bookmark"); },
            [&](const RemoveBookmark& e) {
                return fmt::format("delete bookmark {}", name_in(before.bookmarks, e.bookmark));
            },
            [&](const MoveBookmark& e) {
                return fmt::format("move bookmark {}", name_in(before.bookmarks, e.bookmark));
            },
            [&](const RemoveLight& e) { return fmt::format("delete light {}", name_in(before.lights, e.light)); },
        },
        edit);
}

std::string describe(const Scene& before, std::span<const Edit> edits) {
    if (edits.empty()) return "nothing";
    const auto of_the_same_kind = [&](const Edit& edit) { return edit.index() == edits[0].index(); };
    const std::string first = describe(before, edits[0]);
    if (edits.size() == 1 || !std::all_of(edits.begin(), edits.end(), of_the_same_kind)) return first;
    return fmt::format("{} and {} more", first, edits.size() - 1);
}

}  // namespace farfield
