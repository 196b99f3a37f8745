#include "tests/test_support.h"

#include "sdf/custom_code.h"
#include "sdf/excerpt.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <stdlib.h>

namespace farfield {
namespace fs = std::filesystem;
namespace {

/// Uniform in [0, 1). The standard's distributions differ between libraries; its generators do not.
float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }
int below(std::mt19937& random, size_t count) { return static_cast<int>(random() % static_cast<unsigned>(count)); }

Node& find_below(Node& node, Id id) {
    if (node.id == id) return node;
    for (Node& child : node.children)
        if (const std::vector<Id> ids = all_ids(child); std::find(ids.begin(), ids.end(), id) != ids.end())
            return find_below(child, id);
    throw std::logic_error("no such node");
}

template <class T>
void randomise(T& object, std::mt19937& random) {
    for (const Field<T>& field : fields<T>())
        if (below(random, 3) != 0) field.set(object, random_value(field.parameter, random));
}

/// Makes a node of another scene one that can be inserted: no materials, instances of `definition` alone.
void adapt(Node& node, Id definition) {
    node.material = 0;
    if (node.kind == NodeKind::instance) node.definition = definition;
    for (Node& child : node.children) adapt(child, definition);
}

}  // namespace

std::vector<fs::path> bundled_scenes() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(FARFIELD_SCENES))
        if (entry.path().extension() == ".json" && entry.path().filename() != "schema.json")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string read_text(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_text(const fs::path& file, std::string_view text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "farfield-test-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::vector<Id> all_ids(const Node& node) {
    std::vector<Id> ids{node.id};
    for (const Node& child : node.children) {
        const std::vector<Id> below = all_ids(child);
        ids.insert(ids.end(), below.begin(), below.end());
    }
    return ids;
}

Scene expanded(Scene scene) {
    const auto is_instance = [&](Id id) { return find_node(scene, id)->kind == NodeKind::instance; };
    for (std::vector<Id> ids = all_ids(scene.root);;) {
        const auto found = std::find_if(ids.begin(), ids.end(), is_instance);
        if (found == ids.end()) break;
        apply(scene, MakeIndependent{*found});
        ids = all_ids(scene.root);
    }
    scene.definitions.clear();
    return scene;
}

std::vector<Id> all_ids(const Scene& scene) {
    std::vector<Id> ids = all_ids(scene.root);
    for (const Node& definition : scene.definitions) {
        const std::vector<Id> below = all_ids(definition);
        ids.insert(ids.end(), below.begin(), below.end());
    }
    return ids;
}

glm::vec3 random_value(const Parameter& parameter, std::mt19937& random) {
    glm::vec3 value = parameter.initial;
    for (int i = 0; i < parameter.components(); ++i) {
        if (parameter.is_whole())
            value[i] += static_cast<float>(below(random, 7)) - 3.0f;
        else if (parameter.unit == Unit::degrees || parameter.unit == Unit::degrees_per_metre)
            value[i] += 90.0f * (uniform(random) - 0.5f);
        else
            value[i] =
                value[i] * (0.5f + uniform(random)) + (value[i] == 0.0f ? 2.0f * (uniform(random) - 0.5f) : 0.0f);
    }
    return clamped(parameter, value);
}

std::string random_code(std::mt19937& random) {
    static const char* const texts[] = {
        "uniform float radius = 0.5;  // [0.1, 0.6] m Radius\nfloat sdf(vec3 p) { return length(p) - radius; }",
        "// Größe\nuniform vec3 size = vec3(0.4, 0.3, 0.2); // [0, 1] m\nuniform int radius = 2; // [0, 9]\n"
        "uniform float turn = 30.0; // [0, 90] °\nconst float lipschitz = 1.5;\n\nfloat sdf(vec3 p) {\n\t"
        "for (int i = 0; i < radius; ++i) p.x = abs(p.x) - 0.1 * cos(turn);\n    return box(p, size);\n}\n",
        "uniform bvec3 axes = bvec3(true, false, true);\nuniform ivec3 counts = ivec3(1, 2, 3); // [0, 4]\n"
        "uniform bool on = true;\n"
        "float sdf(vec3 p) { return sphere(mix(p, abs(p), axes), on ? 0.5 : 0.1 * float(counts.x)); }"};
    return texts[random() % std::size(texts)];
}

std::vector<Scene> scenes_with_cut_copies() {
    std::vector<Scene> scenes;
    const auto add = [&](NodeKind repeat, std::vector<glm::vec3> values, NodeKind content, glm::vec3 at,
                         glm::vec3 rotate) {
        Scene& scene = scenes.emplace_back();
        Node node = make_node(repeat), child = make_node(content);
        node.values = std::move(values);
        child.transform.translate = at;
        child.transform.rotate = rotate;
        node.children.push_back(std::move(child));
        apply(scene, InsertNode{scene.root.id, -1, node});
    };
    using K = NodeKind;
    const glm::vec3 turned(20.0f, 30.0f, 40.0f);
    add(K::repeat, {{0.03f, 0.9f, 0.0f}, {0.0f, 3.0f, 0.0f}}, K::torus, {0.3f, 0.0f, 0.2f}, turned);
    add(K::repeat, {{0.02f, 0.05f, 0.05f}, {30.0f, 0.0f, 18.0f}}, K::box, {0.0f, 0.1f, 0.0f}, turned);
    add(K::repeat, {{0.7f, 0.0f, 0.6f}, {0.0f, 1.0f, 5.0f}}, K::infinite_cylinder, {0.1f, 0.0f, 0.2f}, turned);
    add(K::repeat, {{0.0f, 0.8f, 0.0f}, {1.0f, 0.0f, 1.0f}}, K::plane, {0.0f, 0.3f, 0.0f}, {0.0f, 0.0f, 0.0f});
    add(K::polar_repeat, {{90.0f, 0.0f, 0.0f}}, K::box, {0.8f, 0.0f, 0.5f}, turned);
    add(K::polar_repeat, {{17.0f, 0.0f, 0.0f}}, K::sphere, {0.1f, 0.0f, 0.0f}, turned);
    return scenes;
}

Scene random_scene(unsigned seed, int nodes) {
    std::mt19937 random(seed);
    Scene scene;
    randomise(scene.camera, random);
    randomise(scene.settings, random);
    randomise(scene.sky, random);
    randomise(scene.materials.front(), random);
    for (int i = below(random, 4); i > 0; --i) {
        Material& material = scene.materials.emplace_back();
        material.id = scene.new_id();
        material.name = fmt::format("material {}", i);
        randomise(material, random);
    }
    for (int i = below(random, 3); i >= 0; --i) {
        Light& light = scene.lights.emplace_back();
        light.id = scene.new_id();
        light.name = fmt::format("light \"{}\"", i);
        light.kind = i % 2 ? LightKind::directional : LightKind::point;
        for (const Field<Light>& field : fields<Light>())
            if (applies(light, field.parameter.key)) field.set(light, random_value(field.parameter, random));
    }

    // Each node joins one that is there already and takes children. Instances show the definitions so far.
    const auto random_node = [&](int number) {
        Node node = make_node(node_kinds()[static_cast<size_t>(below(random, node_kinds().size()))].kind);
        if (node.kind == NodeKind::instance && scene.definitions.empty()) node = make_node(NodeKind::sphere);
        if (node.kind == NodeKind::instance)
            node.definition = scene.definitions[static_cast<size_t>(below(random, scene.definitions.size()))].id;
        node.id = scene.new_id();
        if (node.kind == NodeKind::custom && below(random, 3) != 0) {
            node.code = CustomCode::parse(random_code(random)).code;
            node.values.clear();
            for (const Parameter& parameter : parameters(node)) node.values.push_back(parameter.initial);
        }
        if (below(random, 2)) node.name = fmt::format("näme {}", number);
        if (below(random, 3) == 0)
            node.material = scene.materials[static_cast<size_t>(below(random, scene.materials.size()))].id;
        for (size_t k = 0; k < node.values.size(); ++k) node.values[k] = random_value(parameters(node)[k], random);
        randomise(node.transform, random);
        return node;
    };
    const auto grow = [&](Node& top, int first, int last) {
        std::vector<Id> parents{top.id};
        for (int i = first; i < last; ++i) {
            Node node = random_node(i);
            const Id id = node.id;
            const bool takes_children = info(node.kind).takes_children();
            find_below(top, parents[static_cast<size_t>(below(random, parents.size()))])
                .children.push_back(std::move(node));
            if (takes_children) parents.push_back(id);
        }
    };
    const int definitions = below(random, 4);
    for (int i = 0; i < definitions; ++i) {
        Node definition = random_node(-1);
        definition.name = fmt::format("part {}", i);
        if (info(definition.kind).takes_children()) grow(definition, 1000 + 10 * i, 1003 + 10 * i);
        scene.definitions.push_back(std::move(definition));
    }
    grow(scene.root, 1, nodes);
    // Instances are rare among the kinds: the last definition is sure to show.
    if (definitions > 0 && nodes > 1) {
        Node& last = scene.root.children.back();
        if (last.children.empty()) {
            Node instance = make_node(NodeKind::instance);
            instance.id = last.id;
            instance.transform = last.transform;
            instance.material = last.material;
            instance.definition = scene.definitions.back().id;
            last = instance;
        }
    }
    for (unsigned i = 0; i < seed % 4; ++i) {
        Bookmark& bookmark = scene.bookmarks.emplace_back();
        bookmark.id = scene.new_id();
        bookmark.name = fmt::format("bookmark {}", i);
        randomise(bookmark.camera, random);
    }
    return scene;
}

Edit random_edit(const Scene& scene, std::mt19937& random) {
    const auto pick = [&](std::size_t count) { return below(random, count); };
    const auto any_node = [&] {
        const std::vector<Id> ids = all_ids(scene);
        return pick(20) == 0 ? Id{99999} : ids[pick(ids.size())];
    };
    const auto any_kind = [&] { return node_kinds()[pick(node_kinds().size())].kind; };
    const auto any_material = [&] { return pick(5) ? scene.materials[pick(scene.materials.size())].id : Id(pick(2)); };
    const auto any_light = [&] {
        return scene.lights.empty() ? Id{77777} : scene.lights[pick(scene.lights.size())].id;
    };
    const auto any_bookmark = [&] {
        return scene.bookmarks.empty() ? Id{66666} : scene.bookmarks[pick(scene.bookmarks.size())].id;
    };
    const auto any_object = [&] {
        const ObjectRef objects[] = {{ObjectType::node, any_node()},
                                     {ObjectType::material, any_material()},
                                     {ObjectType::light, any_light()},
                                     {ObjectType::sky},
                                     {ObjectType::camera},
                                     {ObjectType::bookmark, any_bookmark()},
                                     {ObjectType::settings}};
        return objects[pick(7)];
    };
    const auto any_definition = [&] {
        return scene.definitions.empty() ? any_node() : scene.definitions[pick(scene.definitions.size())].id;
    };
    const auto any_instance = [&] {
        std::vector<Id> instances;
        for (const Id id : all_ids(scene))
            if (find_node(scene, id)->kind == NodeKind::instance) instances.push_back(id);
        return instances.empty() ? any_node() : instances[pick(instances.size())];
    };
    const std::string name = std::string(1, static_cast<char>('a' + pick(6)));
    switch (pick(std::variant_size_v<Edit>)) {
        case 0: {
            const ObjectRef object = any_object();
            const std::vector<Parameter> list = parameters(scene, object);
            if (list.empty()) return SetValue{object, "radius", glm::vec3(1.0f)};
            const Parameter& parameter = list[pick(list.size())];
            return SetValue{object, parameter.key, pick(5) ? random_value(parameter, random) : glm::vec3(-1e9f)};
        }
        case 1:
            return SetName{any_object(), name};
        case 2:
            return SetKind{any_node(), any_kind()};
        case 3:
            return SetLightKind{any_light(), pick(2) ? LightKind::point : LightKind::directional};
        case 4:
            return SetMaterial{any_node(), any_material()};
        case 5: {
            Node node = make_node(pick(6) ? any_kind() : NodeKind::instance);
            if (info(node.kind).takes_children())
                node.children = random_scene(static_cast<unsigned>(random()), 1 + pick(4)).root.children;
            adapt(node, any_definition());
            node.name = pick(2) ? name : "";
            return InsertNode{any_node(), pick(6) - 1, node};
        }
        case 6:
            return RemoveNode{any_node()};
        case 7:
            return MoveNode{any_node(), any_node(), pick(6) - 1};
        case 8:
            return AddMaterial{{0, name}};
        case 9:
            return RemoveMaterial{any_material()};
        case 10:
            return AddLight{{0, name}};
        case 11:
            return SetDefinition{pick(3) ? any_instance() : any_node(), any_definition()};
        case 12:
            return MakeDefinition{any_node()};
        case 13:
            return MakeIndependent{pick(3) ? any_instance() : any_node()};
        case 14:
            return RemoveLight{any_light()};
        case 15:
            return SetHidden{any_node(), pick(3) != 0};
        case 16:
            return SetLocked{any_node(), pick(6) == 0};
        case 17:
            return WrapNodes{{any_node(), any_node()}, any_kind(), pick(2) ? name : ""};
        case 18:
            return DissolveNode{any_node()};
        case 19:
            return ShowOnly{{any_node(), any_node()}};
        case 20: {
            // Of this scene or of another.
            const Scene other = pick(2) ? scene : random_scene(static_cast<unsigned>(random()), 6);
            const std::vector<Id> ids = all_ids(other);
            Scene part = excerpt(other, {ids[pick(ids.size())], ids[pick(ids.size())]});
            return InsertExcerpt{any_node(), pick(6) - 1, std::make_shared<const Scene>(std::move(part))};
        }
        case 21: {
            Camera camera;
            randomise(camera, random);
            return AddBookmark{{0, name, camera}};
        }
        case 22:
            return RemoveBookmark{any_bookmark()};
        case 23:
            return MoveBookmark{any_bookmark(), pick(4) - 1};
        default: {
            std::vector<Id> custom{any_node()};
            for (const Id id : all_ids(scene.root))
                if (find_node(scene, id)->kind == NodeKind::custom) custom.push_back(id);
            return SetCode{custom[pick(custom.size())], pick(5) ? random_code(random) : "float sdf(vec3 p) {\n x; }"};
        }
    }
}

Node random_tree(int depth, std::mt19937& random) {
    const auto random_place = [](std::mt19937& r, float half) {
        const auto coordinate = [&] { return half * (static_cast<float>(r() >> 8) * 0x1p-23f - 1.0f); };
        const float x = coordinate(), y = coordinate();
        return glm::vec3(x, y, coordinate());
    };
    std::vector<NodeKind> kinds;
    for (const KindInfo& kind : node_kinds())
        if (kind.takes_children() == (depth > 1) && kind.role != Role::instance) kinds.push_back(kind.kind);
    Node node = make_node(kinds[random() % kinds.size()]);
    const KindInfo& kind = info(node.kind);
    const std::vector<Parameter> list = parameters(node);
    for (std::size_t i = 0; i < node.values.size(); ++i) node.values[i] = random_value(list[i], random);
    node.transform.translate = random_place(random, 0.5f);
    node.transform.rotate = random() % 3 ? random_place(random, 180.0f) : glm::vec3(0.0f);
    node.transform.scale = random() % 3 ? 1.0f : 0.3f + 1.7f * static_cast<float>(random() >> 8) * 0x1p-24f;
    if (kind.takes_children()) {
        const int below = depth - 1;
        node.children.push_back(random_tree(below, random));
        if (kind.role == Role::combine && random() % 3)
            node.children.push_back(random_tree(1 + static_cast<int>(random() % static_cast<unsigned>(below)), random));
    }
    return node;
}

}  // namespace farfield
