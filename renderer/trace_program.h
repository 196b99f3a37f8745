// The programs made from scenes: trace.glsl with the generated distance function in front. Two tiers (sdf/codegen.h); a cache
// by the code's text, so that undo and redo find their program again.
#pragma once

#include "renderer/gl.h"
#include "sdf/codegen.h"

#include <list>
#include <memory>
#include <string>

namespace farfield {

class TracePrograms {
public:
    TracePrograms();

    /// Makes the program of `scene` in `tier` current for `trace`; compiles it if the cache has none. When that fails it throws
    /// ShaderError whose message names the node, and the last good program stays.
    void select(const Scene& scene, Tier tier);
    /// Whether select would find its program in the cache.
    bool has(const Scene& scene, Tier tier) const;

    /// Ray buffer to hit buffer, `count` rays from the first. `surfaces`: normal and material too.
    void trace(std::size_t count, bool surfaces, bool counting) const;

    Tier tier() const { return tier_; }
    int compiled(Tier tier) const { return tier == Tier::live ? live_compiles_ : specialised_compiles_; }
    double last_compile_milliseconds() const { return compile_milliseconds_; }
    bool ready() const { return current_ != nullptr; }

private:
    struct Entry {
        std::string key;
        gl::Program program;
    };
    const gl::Program& compile(const Scene& scene, const GeneratedScene& generated, Tier tier);

    std::list<Entry> cache_;  ///< most recently used first
    const gl::Program* current_ = nullptr;
    Tier tier_ = Tier::live;
    gl::Buffer parameters_{"parameters"};
    int live_compiles_ = 0;
    int specialised_compiles_ = 0;
    double compile_milliseconds_ = 0.0;
};

/// The whole text of the trace kernel for a generated scene.
std::string trace_source(const GeneratedScene& generated, Tier tier);

}  // namespace farfield
