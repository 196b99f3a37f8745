#include "sdf/excerpt.h"

#include "sdf/custom_code.h"
#include "sdf/edit_steps.h"
#include "sdf/located_json.h"
#include "sdf/scene_format.h"

#include <map>

namespace farfield {
namespace {

using Ids = std::map<Id, Id>;

/// The definitions that a node shows, each after those that it uses itself.
void add_used(const Scene& scene, const Node& node, std::vector<const Node*>& used) {
    if (const Node* definition = find_definition(scene, node.definition))
        if (std::find(used.begin(), used.end(), definition) == used.end()) {
            add_used(scene, *definition, used);
            used.push_back(definition);
        }
    for (const Node& child : node.children) add_used(scene, child, used);
}

bool uses_material(const Node& node, Id material) {
    return node.material == material || std::any_of(node.children.begin(), node.children.end(),
                                                    [&](const Node& child) { return uses_material(child, material); });
}

/// The node with the materials and definitions of the scene that it comes to.
void translate(Node& node, const Ids& materials, const Ids& definitions) {
    visit_nodes(node, [&](Node& n) {
        if (n.material != 0) n.material = materials.at(n.material);
        if (n.definition != 0) n.definition = definitions.at(n.definition);
    });
}

bool same_content(const Node& a, const Node& b) {
    const auto text = [](const Node& node) { return node.code ? std::string_view(node.code->text()) : ""; };
    return a.kind == b.kind && a.name == b.name && a.values == b.values && a.transform == b.transform &&
           a.material == b.material && a.definition == b.definition && a.hidden == b.hidden && a.locked == b.locked &&
           text(a) == text(b) &&
           std::equal(a.children.begin(), a.children.end(), b.children.begin(), b.children.end(), same_content);
}

Id material_for(Scene& scene, const Material& material) {
    Material wanted = material;
    for (const Material& m : scene.materials) {
        wanted.id = m.id;
        if (m == wanted) return m.id;
    }
    return add_material(scene, material);
}

Id definition_for(Scene& scene, const Node& definition) {
    for (const Node& other : scene.definitions)
        if (same_content(other, definition)) return other.id;
    check_subtree(scene, definition);
    Node added = definition;
    make_new(scene, added);
    scene.definitions.push_back(std::move(added));
    return scene.definitions.back().id;
}

/// Whether the text is a whole scene file, rather than nodes taken out of one.
bool is_scene(const std::string& text) {
    try {
        return parse_json(text).find(format::version_key) != nullptr;
    } catch (const JsonError&) {
        return text.find(fmt::format("\"{}\"", format::version_key)) != text.npos;
    }
}

}  // namespace

Scene excerpt(const Scene& scene, const std::vector<Id>& nodes) {
    Scene part;
    std::vector<const Node*> used;
    for (const Id id : topmost(scene, nodes)) {
        const Node* node = find_node(scene, id);
        part.root.children.push_back(find_definition(scene, id) ? make_instance(*node) : *node);
        add_used(scene, part.root.children.back(), used);
    }
    for (const Node* definition : used) part.definitions.push_back(*definition);
    std::vector<Material> materials;
    for (const Material& material : scene.materials) {
        bool needed = uses_material(part.root, material.id);
        for (const Node& definition : part.definitions) needed = needed || uses_material(definition, material.id);
        if (needed) materials.push_back(material);
    }
    if (!materials.empty()) part.materials = std::move(materials);
    part.next_id = scene.next_id;
    return part;
}

std::shared_ptr<const Scene> parse_excerpt(std::string text) {
    const auto trim = [&](std::string_view what) {
        text.erase(text.find_last_not_of(what) + 1);
        text.erase(0, text.find_first_not_of(what));
    };
    trim(" \t\r\n,");
    if (text.empty()) throw EditError("there is no text to paste");
    if (text[0] != '{')
        throw EditError("what was copied is no node: expected the text of a scene file, or nodes of one");
    if (text.size() > format::largest_file)
        throw EditError(
            fmt::format("what was copied is too large, expected at most {} MB", format::largest_file / 1'000'000));
    // On one line with what is put around it, so that the lines of messages stay right.
    if (!is_scene(text)) text = R"({"farfield": 1, "root": {"kind": "union", "children": [)" + text + "]}}";
    try {
        return std::make_shared<const Scene>(parse_scene(text, "pasted text"));
    } catch (const SceneFileError& error) {
        throw EditError(error.what());
    }
}

Id apply_one(Scene& scene, const InsertExcerpt& e) {
    if (!e.excerpt || e.excerpt->root.children.empty()) throw EditError("there are no nodes to paste");
    std::vector<Node> nodes = e.excerpt->root.children;
    std::vector<const Node*> used;
    add_used(*e.excerpt, e.excerpt->root, used);
    Ids materials, definitions;
    for (const Material& material : e.excerpt->materials) {
        bool needed = uses_material(e.excerpt->root, material.id);
        for (const Node* definition : used) needed = needed || uses_material(*definition, material.id);
        if (needed) materials[material.id] = material_for(scene, material);
    }
    for (const Node* original : used) {
        Node definition = *original;
        translate(definition, materials, definitions);
        definitions[original->id] = definition_for(scene, definition);
    }
    Id first = 0;
    int index = e.index;
    for (Node& node : nodes) {
        translate(node, materials, definitions);
        const Id id = apply_one(scene, InsertNode{e.parent, index, std::move(node)});
        if (first == 0) first = id;
        if (index >= 0) ++index;
    }
    return first;
}

}  // namespace farfield
