// What a new scene can begin with.
#pragma once

#include "app/document.h"

#include <span>

namespace farfield {

struct SceneTemplate {
    const char* key;  ///< in the report
    const char* label;
    const char* tip;
    const char* scene;  ///< the file that is embedded; none for the empty scene
    Scene make() const;
};

/// The first is the empty scene.
std::span<const SceneTemplate> scene_templates();

}  // namespace farfield
