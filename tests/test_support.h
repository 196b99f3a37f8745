// Helpers that tests share. Nothing here needs OpenGL.
#pragma once

#include "sdf/edit.h"

#include <filesystem>
#include <ostream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace farfield {

/// Test names say the kind, not its bytes.
inline void PrintTo(NodeKind kind, std::ostream* out) { *out << info(kind).key; }

/// The scene files in scenes/, sorted by name.
std::vector<std::filesystem::path> bundled_scenes();

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, std::string_view text);

/// A folder for one test, removed with everything in it at the end.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

/// Repetitions of content so wide, or without end, that their copies are cut off.
std::vector<Scene> scenes_with_cut_copies();

/// A valid scene of `nodes` nodes (the root included; up to twelve more in definitions), made from the tables: every
/// kind, parameter, material and light kind occurs sooner or later. Equal seeds give equal scenes, on every machine.
/// Values lie near their defaults, so that the shapes are of about a metre's size and stand a few metres around the
/// origin.
Scene random_scene(unsigned seed, int nodes = 20);

/// Operations down to `depth` levels, then primitives, custom code among them, with random parameters, places and
/// scales; often two children where the kind combines, else one.
Node random_tree(int depth, std::mt19937& random);

/// The same scene without instances: each is a copy of what it shows.
Scene expanded(Scene scene);

/// The ids of a node and everything below it.
std::vector<Id> all_ids(const Node& node);
/// Those of the root and the definitions and everything below them.
std::vector<Id> all_ids(const Scene& scene);

/// A value that `parameter` takes, near its default.
glm::vec3 random_value(const Parameter& parameter, std::mt19937& random);

/// One of a few codes with parameters of every type; some keys occur in several, with other types and ranges.
std::string random_code(std::mt19937& random);

/// Any edit, sensible or not: of every kind, with ids that exist and ids that do not, names that are free and names
/// that are taken, values in range and out of it.
Edit random_edit(const Scene& scene, std::mt19937& random);

}  // namespace farfield
