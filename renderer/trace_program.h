// The programs made from scenes: trace.glsl with the generated distance function in front. Two tiers (sdf/codegen.h); a
// cache by the code's text, so that undo and redo find their program again.
#pragma once

#include "renderer/gl.h"
#include "sdf/codegen.h"

#include <list>
#include <set>
#include <string>

namespace farfield {

class TracePrograms {
public:
    TracePrograms();

    /// Makes a program of `scene` (see generate) current for `trace`; compiles it if the cache has none. When that
    /// fails it throws ShaderError whose message names the node, and the last good program stays.
    void select(const Scene& scene, Tier tier, Id tuned = 0);
    /// Whether select would find its program in the cache.
    bool has(const Scene& scene, Tier tier, Id tuned = 0) const;

    /// Ray buffer to hit buffer, `count` rays from the first. `surfaces`: normal and material too.
    void trace(std::size_t count, bool surfaces, bool counting) const;

    int structural_compiles() const { return static_cast<int>(structures_.size()); }
    int other_compiles() const { return compiles_ - structural_compiles(); }
    double last_compile_milliseconds() const { return compile_milliseconds_; }

private:
    struct Entry {
        std::string key;
        gl::Program march, surface;
    };
    void compile(const Scene& scene, const GeneratedScene& generated);

    /// See trace.glsl.
    struct Schedule {
        std::size_t rays_each;
        int pause;  ///< evaluations
    };
    Schedule schedule_;

    std::list<Entry> cache_;  ///< most recently used first
    const Entry* current_ = nullptr;
    gl::Buffer parameters_{"parameters"};
    Box bounds_;                        ///< of the current scene
    std::set<std::size_t> structures_;  ///< hashes of the live code of every scene that was compiled
    int compiles_ = 0;
    double compile_milliseconds_ = 0.0;
};

/// The whole text of a kernel, trace.glsl or surface.glsl, for a generated scene.
std::string scene_kernel_source(const std::string& file, const GeneratedScene& generated);

}  // namespace farfield
