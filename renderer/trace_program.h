// The programs made from scenes: trace.glsl with the generated distance function in front, for each part of a large
// scene (sdf/scene_parts.h), and trace_family.glsl for each of its families (sdf/families.h). Two tiers
// (sdf/codegen.h); a cache by the code's text, so that undo and redo find their programs again, and so do the parts
// that an edit has not touched.
#pragma once

#include "renderer/gl.h"
#include "sdf/box_tree.h"
#include "sdf/codegen.h"
#include "sdf/families.h"

#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace farfield {

class TracePrograms {
public:
    TracePrograms();

    /// Makes the programs of `scene` (see generate) current for `trace`, whose rays count from local_origin of its
    /// camera; compiles those that the cache has not. When that fails it throws ShaderError whose message names the
    /// node, and the last good programs stay.
    void select(const Scene& scene, Tier tier, Id tuned = 0);
    /// How many parts select would have to compile, at least one for a scene that is refused.
    int missing(const Scene& scene, Tier tier, Id tuned = 0) const;
    /// Compiles one kernel of those parts, if any, and tells how many parts are not complete yet. Throws like select.
    int compile_one(const Scene& scene, Tier tier, Id tuned = 0);

    /// Ray buffer to hit buffer, `count` rays from the first. `surfaces`: normal and material too; without, any hit
    /// serves where rays meet several parts.
    void trace(std::size_t count, bool surfaces, bool counting) const;

    // For measurements: the march alone, of one of the parts, and kernels of their own with the scene in front.
    std::size_t parts() const { return current_.size(); }
    /// How lanes share the rays of a dispatch of `count`, see march.glsl: how many each has, and how many evaluations
    /// an invocation makes before it claims no more.
    std::size_t rays_each(std::size_t part, std::size_t count) const;
    std::size_t claiming_evaluations(std::size_t part) const;
    int pause() const { return schedule_.pause; }
    void march(std::size_t part, std::size_t count, bool any_hit) const;
    void count(std::size_t rays) const;                             ///< what they took, into the bound counters
    std::vector<gl::Program> make_kernels(const char* file) const;  ///< one for each part
    void run(const gl::Program& kernel, std::size_t part, std::size_t count) const;

    int structural_compiles() const { return static_cast<int>(structures_.size()); }
    int other_compiles() const { return compiles_ - structural_compiles(); }
    double last_compile_milliseconds() const { return compile_milliseconds_; }

private:
    struct Entry {
        std::string key;
        gl::Program march, surface;
    };
    using Cache = std::list<std::shared_ptr<const Entry>>;
    /// What rays need of a family beside its code.
    struct Members {
        std::size_t count;
        std::vector<float> numbers;
        BoxTree boxes;
    };
    /// Code of a part, kept as long as scenes have that part, because writing it all anew for each move of a hand takes
    /// milliseconds.
    struct Code {
        Scene part;  ///< empty for a family
        Tier tier;
        Id tuned;  ///< 0 where it is elsewhere
        bool by_distance;
        GeneratedScene generated;
        std::optional<Members> members;
    };
    struct Part {
        std::shared_ptr<const Entry> programs;
        std::shared_ptr<const Code> code;
        gl::Buffer parameters{"parameters"}, numbers{"numbers of members"}, boxes{"boxes of members"};
        Box bounds;
        unsigned first = 0;  ///< what stands for it in hits, for its first member if it is a family
        std::size_t members() const { return code->members ? code->members->count : 1; }
    };
    using Codes = std::vector<std::shared_ptr<const Code>>;
    /// Of a scene, in the order in which its parts are traced.
    struct Division {
        Scene scene;  ///< what programs are made of, and no more
        Tier tier;
        Id tuned;
        Codes codes;
    };
    const Codes& codes(const Scene& scene, Tier tier, Id tuned) const;
    Codes divide(const Scene& scene, Tier tier, Id tuned) const;
    /// Takes the families out of `scene`.
    Codes take_families(Scene& scene, Id tuned) const;
    Cache::const_iterator find(const std::string& key) const;
    /// Its march kernel, then its surface kernel, which completes it.
    void compile_next(const Code& code, const Scene& scene);
    bool is_begun(const Code& code) const;
    void compile_march(const Code& code, const Scene& scene);
    void compile_surface(const Code& code, const Scene& scene);
    gl::Program compiled(const Code& code, const Scene& scene, const char* name, const char* file);
    static void bind(const Part& part);
    bool claims_rays(const Part& part) const;
    /// Of loops, at most.
    struct Turns {
        std::uint64_t evaluation, march, ray;  ///< march: as far as the pause
    };
    Turns turns(const Part& part) const;

    /// See trace.glsl.
    struct Schedule {
        std::size_t rays_each = 1;
        int pause = 1 << 20;  ///< evaluations
        bool shares_rays = false;
    };
    Schedule schedule_;
    mutable gl::Buffer queue_{"queue"};  ///< claimed rays, see march.glsl
    gl::Program count_ = load_program("count.glsl");

    mutable std::list<Division> divisions_;  ///< of the last calls
    mutable FamilyFinder families_;
    Cache cache_;                 ///< most recently used first
    std::optional<Entry> begun_;  ///< its surface kernel is to follow
    std::vector<Part> current_;
    std::set<std::size_t> structures_;  ///< hashes of the live code of every scene that was compiled
    int compiles_ = 0;
    double compile_milliseconds_ = 0.0;
};

/// The whole text of a kernel, trace.glsl or surface.glsl, for a generated scene. `shares_rays`: see trace.glsl.
std::string scene_kernel_source(const std::string& file, const GeneratedScene& generated, bool shares_rays = false);

}  // namespace farfield
