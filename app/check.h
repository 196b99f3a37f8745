// `farfield check`: whether a file holds a scene, what is in it, and what an audit finds.
#pragma once

#include "sdf/scene.h"

#include <filesystem>

namespace farfield {

struct CheckOptions {
    std::filesystem::path scene;
    int samples = 2000;  ///< pairs of points for each node; see AuditOptions
};

/// Prints facts and a table of nodes, warnings to stderr. Warnings are no failure: 0. Throws SceneFileError for a file
/// that holds no scene.
int run_check(const CheckOptions& options);

}  // namespace farfield
