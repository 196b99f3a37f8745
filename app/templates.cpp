#include "app/templates.h"

#include "sdf/bundled_scenes.h"
#include "sdf/scene_file.h"

#include <string>

namespace farfield {

std::string_view embedded_templates(std::string_view name);  // generated from studio.json by embed.cmake

namespace {

constexpr SceneTemplate table[] = {
    {"empty", "Empty", "A sky and a sun to see the first shape by", ""},
    {"studio", "Studio", "A first shape between three lights, on a backdrop without an edge", "studio.json"},
    {"cornell", "Cornell box", "A closed room with coloured walls, lit from above", "cornell.json"},
    {"colonnade", "Colonnade", "Columns in the sun, one definition shown many times", "colonnade.json"},
    {"csg_part", "Machined part", "A part by union, subtraction and repetition", "csg_part.json"},
    {"still_life", "Still life", "A table with many things on it", "still_life.json"},
};

}  // namespace

std::span<const SceneTemplate> scene_templates() { return table; }

Scene SceneTemplate::make() const {
    const std::string_view name = scene;
    if (name.empty()) return new_scene();
    const std::string_view own = embedded_templates(name);
    return parse_scene(own.empty() ? embedded_scenes(name) : own, std::string(name));
}

}  // namespace farfield
