#include "sdf/edit.h"

#include "sdf/edit_steps.h"

#include <cctype>
#include <type_traits>

namespace farfield {
namespace {

template <class T, class... Types>
constexpr bool is_one_of = (std::is_same_v<T, Types> || ...);

}  // namespace

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

void check_name(const std::string& name) {
    if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
        throw EditError("a name cannot hold control characters");
}

NameSet node_names(const Scene& scene) {
    NameSet names;
    visit_all_nodes(scene, [&](const Node& node) {
        if (!node.name.empty()) names.insert(node.name);
    });
    return names;
}

std::string free_name(const NameSet& taken, std::string name) {
    if (!taken.contains(name)) return name;
    while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back()))) name.pop_back();
    while (!name.empty() && name.back() == ' ') name.pop_back();
    for (int i = 2;; ++i)
        if (std::string numbered = fmt::format("{}{}{}", name, name.empty() ? "" : " ", i); !taken.contains(numbered))
            return numbered;
}

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

void make_new(Scene& scene, Node& subtree) {
    NameSet taken = node_names(scene);
    visit_nodes(subtree, [&](Node& node) {
        node.id = scene.new_id();
        if (node.name.empty()) return;
        node.name = free_name(taken, node.name);
        taken.insert(node.name);
    });
}

void check_unlocked(const Scene& scene, Id id) {
    if (const Node* lock = find_lock(scene, id))
        throw EditError(lock->id == id ? fmt::format("{} is locked", display_name(scene, *lock))
                                       : fmt::format("{} is in {}, which is locked",
                                                     display_name(scene, *find_node(scene, id)), display_name(*lock)));
}

Id apply(Scene& scene, const Edit& edit) {
    const auto carry_out = [&](Scene& to) { return std::visit([&](const auto& e) { return apply_one(to, e); }, edit); };
    const bool nests = std::visit(
        []<class E>(const E&) {
            return is_one_of<E, InsertNode, InsertExcerpt, MoveNode, WrapNodes, DissolveNode, SetDefinition,
                             MakeDefinition, MakeIndependent>;
        },
        edit);
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

std::vector<Id> apply_all(Scene& scene, std::span<const Edit> edits) {
    if (edits.size() == 1) return {apply(scene, edits[0])};
    Scene changed = scene;
    std::vector<Id> ids;
    for (const Edit& edit : edits) ids.push_back(apply(changed, edit));
    scene = std::move(changed);
    return ids;
}

}  // namespace farfield
