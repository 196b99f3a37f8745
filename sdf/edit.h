// Edits as values. The user interface never changes the scene: it returns edits, and `apply` is the only place that
// carries them out; so undo covers everything.
#pragma once

#include "sdf/fields.h"

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace farfield {

struct SetValue {
    ObjectRef object;
    std::string key;
    glm::vec3 value;
};
/// Nodes, materials, lights and bookmarks. Names are unique within their type; a node's name may be empty.
struct SetName {
    ObjectRef object;
    std::string name;
};
/// Values whose key both kinds share are kept, the others take their defaults.
struct SetKind {
    Id node;
    NodeKind kind;
};
struct SetLightKind {
    Id light;
    LightKind kind;
};
struct SetMaterial {
    Id node;
    Id material;
};  ///< material 0: inherit
/// A hidden node counts as not there: what is left of a subtraction begins with the first child that shows.
struct SetHidden {
    Id node;
    bool hidden;
};
/// A locked node and what is in it are not moved, turned, scaled or deleted: such edits are refused.
struct SetLocked {
    Id node;
    bool locked;
};
/// Inserts a subtree before child `index` (-1: at the end). Fresh ids are given to all of it, names that are taken get
/// a number.
struct InsertNode {
    Id parent;
    int index;
    Node node;
};
/// Inserts the nodes that the root of another scene holds, in their order, with the materials and definitions that they
/// use. What is there already under the same name with the same content serves; otherwise it is added, under another
/// name where that is taken. Returns the first of the nodes.
struct InsertExcerpt {
    Id parent;
    int index;
    std::shared_ptr<const Scene> excerpt;
};
struct RemoveNode {
    Id node;
};  ///< or a definition, once nothing shows it
struct MoveNode {
    Id node;
    Id parent;
    int index;
};  ///< index counts in the parent before the node is taken out
/// Puts nodes that share a root into a new node of `kind`, in their order, where the first of them was. They stay where
/// they are and keep their materials, whatever groups they came from. Returns the new node.
struct WrapNodes {
    std::vector<Id> nodes;
    NodeKind kind;
    std::string name;  ///< a number is added where it is taken
};
/// Puts what is in a node in its place: placed and coloured as it was, without what the node did to it.
struct DissolveNode {
    Id node;
};
/// Shows these nodes and hides all others of the same tree but what they are in and what is in them.
struct ShowOnly {
    std::vector<Id> nodes;
};
/// Chooses what an instance shows.
struct SetDefinition {
    Id instance;
    Id definition;
};
/// Turns a node with all below it into a definition and puts an instance of it in its place, which takes over placement
/// and material: the picture stays. Returns the instance.
struct MakeDefinition {
    Id node;
};
/// Replaces an instance by a copy of what it shows: the picture stays. Returns the copy.
struct MakeIndependent {
    Id instance;
};
struct AddMaterial {
    Material material;
};  ///< gets a fresh id and a free name
struct RemoveMaterial {
    Id material;
};  ///< its nodes inherit afterwards; the last material stays
struct AddLight {
    Light light;
};
struct RemoveLight {
    Id light;
};
struct AddBookmark {
    Bookmark bookmark;
};  ///< gets a fresh id and a free name
struct RemoveBookmark {
    Id bookmark;
};
struct MoveBookmark {
    Id bookmark;
    int index;
};  ///< in the list, once it is there

/// Of a custom node: values whose key both codes declare are kept, brought into their range. Refused with all errors,
/// each with its line, where the text is no distance function.
struct SetCode {
    Id node;
    std::string text;
};

using Edit = std::variant<SetValue, SetName, SetKind, SetLightKind, SetMaterial, SetHidden, SetLocked, InsertNode,
                          InsertExcerpt, RemoveNode, MoveNode, WrapNodes, DissolveNode, ShowOnly, SetDefinition,
                          MakeDefinition, MakeIndependent, AddMaterial, RemoveMaterial, AddLight, RemoveLight,
                          AddBookmark, RemoveBookmark, MoveBookmark, SetCode>;
using Edits = std::vector<Edit>;

struct EditError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Carries out one edit. Throws EditError and leaves the scene as it was when the edit makes no sense: unknown id,
/// value out of range, name taken, children for a primitive, a node moved into itself, a definition that would contain
/// itself, removal of the root or of what is locked. Returns the id of what was inserted or added, otherwise 0.
Id apply(Scene& scene, const Edit& edit);
/// One after the other; all of them or, where one throws, none. Returns what each one returned.
std::vector<Id> apply_all(Scene& scene, std::span<const Edit> edits);

/// What the list of steps calls it, as "radius of ring" or "delete sphere"; of several edits "delete sphere and 2
/// more".
std::string describe(const Scene& before, const Edit& edit);
std::string describe(const Scene& before, std::span<const Edit> edits);

}  // namespace farfield
