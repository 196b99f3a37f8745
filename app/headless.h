// A scene with the settings of the command line, and a renderer in a context of its own.
#pragma once

#include "app/commands.h"
#include "renderer/context.h"
#include "renderer/renderer.h"

#include <memory>
#include <optional>

namespace farfield {

struct Headless {
    Headless(Scene of, const Overrides& overrides, ContextKind kind) : scene(std::move(of)) {
        overrides.apply(scene.settings);
        context = make_headless_context(kind);
        context->make_current();
        renderer.emplace();
    }
    Scene scene;
    std::unique_ptr<Context> context;
    std::optional<Renderer> renderer;  ///< goes before its context
};

}  // namespace farfield
