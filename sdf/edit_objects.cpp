// Edits of what an object is: its values, name, kind, material, code; and of the lists of materials,
// lights and bookmarks.
#include "sdf/edit_steps.h"

#include "sdf/custom_code.h"

namespace farfield {
namespace {

template <class T>
void rename(std::vector<T>& items, Id id, const std::string& name, const char* what) {
    T& item = item_for(items, id, what);
    if (name.empty()) throw EditError(fmt::format("a {} needs a name", what));
    if (name != item.name && names_of(items).contains(name))
        throw EditError(fmt::format("there is already a {} named {}", what, name));
    item.name = name;
}

template <class T>
void check_fields(const T& object) {
    for (const auto& field : fields<T>())
        if (const std::string why = why_refused(field.parameter, field.get(object)); !why.empty())
            throw EditError(fmt::format("{}: {}", field.parameter.key, why));
}

void check_direction(const Light& light) {
    if (light.kind == LightKind::directional && light.direction == glm::vec3(0.0f))
        throw EditError("direction: expected any length but 0");
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

}  // namespace

Id apply_one(Scene& scene, const SetValue& e) {
    if (e.object.type == ObjectType::light && e.key == "direction" && e.value == glm::vec3(0.0f))
        throw EditError("direction: expected any length but 0");
    if (e.object.type == ObjectType::node)
        for (const auto& field : fields<Transform>())
            if (e.key == field.parameter.key) check_unlocked(scene, e.object.id);
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
        case ObjectType::bookmark:
            rename(scene.bookmarks, e.object.id, e.name, "bookmark");
            return 0;
        default:
            throw EditError("only nodes, materials, lights and bookmarks have names");
    }
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

Id apply_one(Scene& scene, const SetHidden& e) {
    node_for(scene, e.node).hidden = e.hidden;
    return 0;
}

Id apply_one(Scene& scene, const SetLocked& e) {
    node_for(scene, e.node).locked = e.locked;
    return 0;
}

namespace {

/// Gives the item a fresh id and a free name.
template <class T>
Id add_item(Scene& scene, std::vector<T>& items, T item, const char* usual_name) {
    item.id = scene.new_id();
    item.name = free_name(names_of(items), item.name.empty() ? usual_name : item.name);
    items.push_back(std::move(item));
    return items.back().id;
}

}  // namespace

Id add_material(Scene& scene, Material material) {
    if (scene.materials.size() >= largest_material_count)
        throw EditError(fmt::format("a scene has at most {} materials", largest_material_count));
    check_name(material.name);
    check_fields(material);
    return add_item(scene, scene.materials, std::move(material), "material");
}

Id apply_one(Scene& scene, const AddMaterial& e) { return add_material(scene, e.material); }

Id apply_one(Scene& scene, const RemoveMaterial& e) {
    const auto place = place_of(scene.materials, e.material, "material");
    if (scene.materials.size() == 1) throw EditError("the last material stays");
    scene.materials.erase(place);
    visit_all_nodes(scene, [&](Node& node) {
        if (node.material == e.material) node.material = 0;
    });
    return 0;
}

Id apply_one(Scene& scene, const AddLight& e) {
    check_name(e.light.name);
    check_fields(e.light);
    check_direction(e.light);
    return add_item(scene, scene.lights, e.light, "light");
}

Id apply_one(Scene& scene, const RemoveLight& e) {
    scene.lights.erase(place_of(scene.lights, e.light, "light"));
    return 0;
}

Id apply_one(Scene& scene, const AddBookmark& e) {
    check_name(e.bookmark.name);
    check_fields(e.bookmark.camera);
    return add_item(scene, scene.bookmarks, e.bookmark, "view");
}

Id apply_one(Scene& scene, const RemoveBookmark& e) {
    scene.bookmarks.erase(place_of(scene.bookmarks, e.bookmark, "bookmark"));
    return 0;
}

Id apply_one(Scene& scene, const MoveBookmark& e) {
    const auto from = place_of(scene.bookmarks, e.bookmark, "bookmark");
    if (e.index < 0 || e.index >= std::ssize(scene.bookmarks))
        throw EditError(fmt::format("there is no place {} among {} bookmarks", e.index, scene.bookmarks.size()));
    const auto to = scene.bookmarks.begin() + e.index;
    if (from < to)
        std::rotate(from, from + 1, to + 1);
    else
        std::rotate(to, from, from + 1);
    return 0;
}

}  // namespace farfield
