// What the edits in edit_*.cpp have in common. Those that change how nodes are nested may leave the scene half changed
// where they throw: `apply` carries them out on a copy. The others change nothing before they are sure.
#pragma once

#include "sdf/edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace farfield {

/// Throws EditError where there is none, as the following do.
Node& node_for(Scene& scene, Id id);
/// One that takes children.
Node& parent_for(Scene& scene, Id id);

template <class T>
auto place_of(std::vector<T>& items, Id id, const char* what) {
    const auto it = std::find_if(items.begin(), items.end(), [&](const T& item) { return item.id == id; });
    if (it == items.end()) throw EditError(fmt::format("there is no {} {}", what, id));
    return it;
}
template <class T>
T& item_for(std::vector<T>& items, Id id, const char* what) {
    return *place_of(items, id, what);
}

using NameSet = std::set<std::string>;

NameSet node_names(const Scene& scene);

template <class T>
NameSet names_of(const std::vector<T>& items) {
    NameSet names;
    for (const T& item : items) names.insert(item.name);
    return names;
}

/// `name`, or when it is taken, with the next free number: "ring", "ring 2", "ring 3".
std::string free_name(const NameSet& taken, std::string name);
void check_name(const std::string& name);

/// Whether a node built elsewhere would be a valid part of the scene: what files check, checked for values in memory.
void check_subtree(const Scene& scene, const Node& node);
/// Gives a subtree that is not in the scene yet fresh ids, and names that are free.
void make_new(Scene& scene, Node& subtree);

void check_unlocked(const Scene& scene, Id node);

/// Adds it with a fresh id and a free name.
Id add_material(Scene& scene, Material material);

Id apply_one(Scene& scene, const SetValue& e);
Id apply_one(Scene& scene, const SetName& e);
Id apply_one(Scene& scene, const SetKind& e);
Id apply_one(Scene& scene, const SetLightKind& e);
Id apply_one(Scene& scene, const SetMaterial& e);
Id apply_one(Scene& scene, const SetHidden& e);
Id apply_one(Scene& scene, const SetLocked& e);
Id apply_one(Scene& scene, const SetCode& e);
Id apply_one(Scene& scene, const InsertNode& e);
Id apply_one(Scene& scene, const InsertExcerpt& e);
Id apply_one(Scene& scene, const RemoveNode& e);
Id apply_one(Scene& scene, const MoveNode& e);
Id apply_one(Scene& scene, const WrapNodes& e);
Id apply_one(Scene& scene, const DissolveNode& e);
Id apply_one(Scene& scene, const ShowOnly& e);
Id apply_one(Scene& scene, const SetDefinition& e);
Id apply_one(Scene& scene, const MakeDefinition& e);
Id apply_one(Scene& scene, const MakeIndependent& e);
Id apply_one(Scene& scene, const AddMaterial& e);
Id apply_one(Scene& scene, const RemoveMaterial& e);
Id apply_one(Scene& scene, const AddLight& e);
Id apply_one(Scene& scene, const RemoveLight& e);
Id apply_one(Scene& scene, const AddBookmark& e);
Id apply_one(Scene& scene, const RemoveBookmark& e);
Id apply_one(Scene& scene, const MoveBookmark& e);

}  // namespace farfield
