// Uniform access to every editable value of a scene, so that files, edits and the inspector need no knowledge of a
// particular object: an ObjectRef names the object, a key names the value, a vec3 carries it.
#pragma once

#include "sdf/scene.h"

#include <string_view>
#include <vector>

namespace farfield {

/// One member of T: its description and how to reach it.
template <class T>
struct Field {
    Parameter parameter;
    glm::vec3 (*get)(const T&);
    void (*set)(T&, glm::vec3);
};

/// Transform, Material, Light, Sky, Camera, Settings. Defaults are those of a default-constructed T.
/// A light's `position` counts for point lights only and its `direction` for directional ones: see `applies`.
template <class T>
std::span<const Field<T>> fields();

bool applies(const Light& light, std::string_view key);

enum class ObjectType { node, material, light, sky, camera, bookmark, settings };

struct ObjectRef {
    ObjectType type = ObjectType::node;
    Id id = 0;  ///< of the node, material, light or bookmark; 0 for the others
    friend bool operator==(const ObjectRef&, const ObjectRef&) = default;
};

/// The values an object has, in the order to show and save them. A node has its kind's parameters, then translate,
/// rotate and scale; a bookmark those of its camera. Empty for unknown ids.
std::vector<Parameter> parameters(const Scene& scene, ObjectRef object);

/// Throws std::out_of_range for an unknown object or key.
glm::vec3 value(const Scene& scene, ObjectRef object, std::string_view key);
/// As `value`; throws std::invalid_argument with `why_refused` for a value that the parameter does not take.
void set_value(Scene& scene, ObjectRef object, std::string_view key, glm::vec3 value);

}  // namespace farfield
