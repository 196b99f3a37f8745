// The editor in its window: waits for input, draws frames while there is something new to show, renders.
#pragma once

#include <filesystem>

namespace farfield {

struct EditorOptions {
    std::filesystem::path scene;   ///< empty: a new scene
    std::filesystem::path report;  ///< where to write what tests need to know; empty: nowhere
    bool trust_code = false;       ///< run the scene's custom code without asking
};

/// Runs until the window is closed; returns the exit status. Throws ContextError when no window can be opened,
/// or before that what is wrong with the scene.
int run_editor(const EditorOptions& options);

}  // namespace farfield
