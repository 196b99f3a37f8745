// Edits as values. The user interface never changes the scene: it returns edits, and `apply` is the only place that
// carries them out; so undo covers everything.
#pragma once

#include "sdf/fields.h"

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
/// Nodes, materials and lights. Names are unique within their type; a node's name may be empty.
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
/// Inserts a subtree before child `index` (-1: at the end). Fresh ids are given to all of it, names that are taken get
/// a number.
struct InsertNode {
    Id parent;
    int index;
    Node node;
};
struct RemoveNode {
    Id node;
};  ///< or a definition, once nothing shows it
struct MoveNode {
    Id node;
    Id parent;
    int index;
};  ///< index counts in the parent before the node is taken out
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

/// Of a custom node: values whose key both codes declare are kept, brought into their range. Refused with all errors,
/// each with its line, where the text is no distance function.
struct SetCode {
    Id node;
    std::string text;
};

using Edit =
    std::variant<SetValue, SetName, SetKind, SetLightKind, SetMaterial, InsertNode, RemoveNode, MoveNode, SetDefinition,
                 MakeDefinition, MakeIndependent, AddMaterial, RemoveMaterial, AddLight, RemoveLight, SetCode>;

struct EditError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Carries out one edit. Throws EditError and leaves the scene as it was when the edit makes no sense: unknown id,
/// value out of range, name taken, children for a primitive, a node moved into itself, a definition that would contain
/// itself, removal of the root. Returns the id of what was inserted or added, otherwise 0.
Id apply(Scene& scene, const Edit& edit);

/// What the undo list calls it, as "radius of ring" or "delete sphere".
std::string describe(const Scene& before, const Edit& edit);

/// Undo and redo by whole scenes: a scene is a value of some kilobytes, so keeping it beats inverting edits.
class History {
public:
    explicit History(Scene scene = {});
    const Scene& scene() const;
    /// Edits that carry the same non-zero `gesture` (one drag of a slider) make one step.
    Id apply(const Edit& edit, unsigned gesture = 0);
    void replace(Scene scene);  ///< a new document: forgets all steps
    /// A step that was made elsewhere.
    void record(Scene scene, std::string description);
    bool can_undo() const;
    bool can_redo() const;
    void undo();
    void redo();
    /// Descriptions of the steps that undo would revert, oldest first.
    std::vector<std::string> steps() const;
    /// Changes with every edit, undo, redo and replace; equal revisions mean equal scenes.
    std::uint64_t revision() const;

private:
    struct Step {
        Scene scene;
        std::string description;
        unsigned gesture;
        std::uint64_t revision;
    };
    std::vector<Step> steps_;  ///< the state after each step; the first is the start
    std::size_t current_ = 0;
    std::uint64_t next_revision_ = 1;
};

}  // namespace farfield
