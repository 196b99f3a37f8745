// farfield bench: what a scene costs, as a table and as JSON.
#pragma once

#include "app/commands.h"

namespace farfield {

struct BenchOptions {
    std::filesystem::path scene;
    bool trust_code = false;
    glm::ivec2 size{512, 512};
    bool live = false;           ///< the live tier too
    bool limit = false;          ///< how near the tracer comes to what the device could do
    int frames = 5;              ///< measured, after one that is not
    std::filesystem::path json;  ///< empty: none
    ContextKind context = ContextKind::automatic;
    Overrides overrides;
};
int run_bench(const BenchOptions& options);

}  // namespace farfield
