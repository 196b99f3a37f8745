// The document: a tree of shapes and operations, materials, lights, sky, camera and render settings, as plain values.
// y is up, right-handed, metres; angles in degrees here (radians in generated code); radiance linear Rec. 709.
#pragma once

#include "sdf/node_kinds.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace farfield {

class CustomCode;

/// Identifies a node, material, light or bookmark for the life of the document; never reused, 0 means none. Not saved.
using Id = std::uint32_t;

/// Places a node in its parent's frame: scale first, then rotate, then translate.
struct Transform {
    glm::vec3 translate{0.0f};  ///< metres
    glm::vec3 rotate{0.0f};     ///< degrees about x, then y, then z (fixed axes)
    float scale = 1.0f;         ///< uniform, > 0
    friend bool operator==(const Transform&, const Transform&) = default;
};

/// The rotation part: parent = rotation * (scale * own) + translate.
glm::mat3 rotation_matrix(const Transform& transform);
glm::dmat3 exact_rotation_matrix(const Transform& transform);

struct Node {
    Id id = 0;
    NodeKind kind = NodeKind::union_;
    std::string name;               ///< unique in the scene when not empty
    std::vector<glm::vec3> values;  ///< one for each of its parameters, in their order
    Transform transform;
    Id material = 0;    ///< 0: that of the nearest ancestor that has one, or the scene's first material
    Id definition = 0;  ///< instances: what they show, one of Scene::definitions
    std::vector<Node> children;
    std::shared_ptr<const CustomCode> code;  ///< of a custom node; without it, it shows nothing
    bool hidden = false;                     ///< counts as not there, with all below it
    bool locked = false;                     ///< neither picked, moved nor deleted, with all below it
    friend bool operator==(const Node&, const Node&) = default;
};

/// Lambert reflection plus a normalised Phong highlight on direct light.
struct Material {
    Id id = 0;
    std::string name;  ///< unique, not empty
    glm::vec3 albedo{0.8f};
    float specular = 0.0f;     ///< fraction of the light in the highlight, 0..1
    float exponent = 32.0f;    ///< Phong exponent, >= 1
    glm::vec3 emission{0.0f};  ///< emitted radiance, W/(m² sr)
    friend bool operator==(const Material&, const Material&) = default;
};

enum class LightKind { point, directional };
inline constexpr const char* light_kind_keys[] = {"point", "directional"};  ///< in files

struct Light {
    Id id = 0;
    std::string name;  ///< unique, not empty
    LightKind kind = LightKind::point;
    glm::vec3 position{0.0f, 3.0f, 0.0f};    ///< point: metres
    glm::vec3 direction{0.0f, -1.0f, 0.0f};  ///< directional: the way the light travels; any length but 0
    glm::vec3 intensity{10.0f};  ///< point: radiant intensity, W/sr; directional: irradiance across the beam, W/m²
    friend bool operator==(const Light&, const Light&) = default;
};

/// Radiance from directions that meet no surface: horizon at and below y = 0, zenith straight up, linear in y between.
struct Sky {
    glm::vec3 horizon{0.0f};
    glm::vec3 zenith{0.0f};
    friend bool operator==(const Sky&, const Sky&) = default;
};

struct Camera {
    glm::vec3 position{3.0f, 2.5f, 5.0f};
    glm::vec3 target{0.0f, 0.5f, 0.0f};
    float field_of_view = 40.0f;  ///< vertical, degrees
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// A view to come back to.
struct Bookmark {
    Id id = 0;
    std::string name;  ///< unique, not empty
    Camera camera;
    friend bool operator==(const Bookmark&, const Bookmark&) = default;
};

enum class Method { paper, farfield, reference };
inline constexpr const char* method_keys[] = {"paper", "farfield", "reference"};  ///< in files

/// How the scene is rendered; saved with it, because a good AO radius or exposure belongs to the scene.
struct Settings {
    Method method = Method::farfield;
    int samples = 4;      ///< hemisphere rays per pixel and frame
    float noise = 0.0f;   ///< %; frames are added until indirect light is so near its converged picture; 0: for ever
    int bounces = 1;      ///< diffuse bounces of far light; 0: as many as change its mean
    int blur_levels = 3;  ///< far light is averaged over about 2^levels pixels; 0 leaves it unfiltered; -1: by the size
    float ao_radius = 0.5f;  ///< metres
    float exposure = 0.0f;   ///< stops: the picture is multiplied by 2^exposure
    friend bool operator==(const Settings&, const Settings&) = default;
};

struct Scene {
    Node root;                        ///< a union named "scene"; never removed
    std::vector<Node> definitions;    ///< named subtrees, each in its own frame, that show where instances place them
    std::vector<Material> materials;  ///< never empty
    std::vector<Light> lights;
    Sky sky;
    Camera camera;
    std::vector<Bookmark> bookmarks;
    Settings settings;
    std::string schema;  ///< "$schema" of the file, for editors of text: kept as it is, not used
    Id next_id = 1;

    Scene();  ///< an empty root and one material named "default"
    Id new_id() { return next_id++; }
};

/// A node of `kind` with default values, no name and id 0 (inserting it assigns ids).
Node make_node(NodeKind kind);
Node make_instance(const Node& definition);

/// The code of new custom nodes, which shows how it is done.
std::shared_ptr<const CustomCode> default_custom_code();

/// Those of its kind, in the table's order, and then those that its code declares. They refer to texts of the code.
std::vector<Parameter> parameters(const Node& node);

/// In the tree and in the definitions.
const Node* find_node(const Scene& scene, Id id);
Node* find_node(Scene& scene, Id id);
/// The parent of node `id`; null for the root, for definitions and for unknown ids.
const Node* find_parent(const Scene& scene, Id id);
/// The root or the definition that it is or is in; null for unknown ids.
const Node* find_top(const Scene& scene, Id id);
/// Those of the nodes that exist and are in none of the others, each once, in the order of the tree.
std::vector<Id> topmost(const Scene& scene, const std::vector<Id>& nodes);
const Material* find_material(const Scene& scene, Id id);
const Light* find_light(const Scene& scene, Id id);
const Bookmark* find_bookmark(const Scene& scene, Id id);
/// Null for ids of anything but a definition.
const Node* find_definition(const Scene& scene, Id id);

/// The node and all below it, itself first.
template <class N, class Visit>
void visit_nodes(N& node, const Visit& visit) {
    visit(node);
    for (auto& child : node.children) visit_nodes(child, visit);
}
/// All in the tree, then those in the definitions.
template <class S, class Visit>
void visit_all_nodes(S& scene, const Visit& visit) {
    visit_nodes(scene.root, visit);
    for (auto& definition : scene.definitions) visit_nodes(definition, visit);
}
Node without_children(const Node& node);

/// What the user calls the node: its name, or the kind's label where it has none.
std::string display_name(const Node& node);
/// The same, but an instance without a name says of what: "instance of column".
std::string display_name(const Scene& scene, const Node& node);

/// Index in scene.materials of material `id`; `inherited` for 0 and unknown ids.
std::uint32_t material_index(const Scene& scene, Id id, std::uint32_t inherited);

/// The locked node that it is or that it is in; null where there is none.
const Node* find_lock(const Scene& scene, Id id);

/// The first child that is not hidden: what subtractions take from. Null where there is none.
const Node* first_shown(const Node& node);

/// Whether the node adds no shape: a hidden one, a group without shapes below it, a subtraction from such, an instance
/// of such, custom without code.
bool is_empty(const Scene& scene, const Node& node);
bool is_empty(const Node& node, const std::set<Id>& filled_definitions);
std::set<Id> filled_definitions(const Scene& scene);  ///< those that are not empty

int count_nodes(const Node& node);    ///< itself and everything below
int count_nodes(const Scene& scene);  ///< the root, the definitions and everything below
/// How many nodes the tree would have with the content of its definition below each instance and without what is
/// hidden: what a compiler that inlines every call has to deal with. Definitions that use each other double that
/// easily; the largest value stands for everything beyond.
std::uint64_t expanded_node_count(const Scene& scene);
/// The same for single nodes of a scene, which must not change meanwhile.
class ExpandedCounts {
public:
    explicit ExpandedCounts(const Scene& scene);
    std::uint64_t of(const Node& node) const;

private:
    std::unordered_map<Id, std::uint64_t> definitions_;
};
/// How many instances of the definition there are, in the tree and in other definitions.
int count_uses(const Scene& scene, Id definition);

/// So many nodes can be inside one another, through instances too. Files have the same limit: see scene_reader.
inline constexpr int largest_depth = 499;

/// What keeps a scene from having an end.
struct NestingProblem {
    Id node;       ///< where it shows
    bool endless;  ///< an instance inside its own definition, directly or through others; otherwise nested too deep
};
std::optional<NestingProblem> find_nesting_problem(const Scene& scene);

}  // namespace farfield
