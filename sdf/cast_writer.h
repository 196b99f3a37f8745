// Where rays meet shapes in closed form, without a march: float scene_cast(vec3 p, vec3 v), how far a ray from p along
// the unit vector v goes until it is inside of something; 0 where p is, 1e20 or more if it never is.
//
// A line crosses a convex shape from one place to another (KindInfo::span). What several of them have in common is
// again such a span; a hard union is met where the first of its children is; and what others are taken away from is met
// at the first place inside it that is in none of these (after Roth 1982, "Ray casting for modeling solids"): each is
// left once and for all, but it may end within another one, so that n of them are looked at n times. Everything else is
// marched, as far as the cast got at most.
//
// Such hits are exact where a march ends within its tolerance before the surface, one evaluation takes the place of two
// or three, and no lane waits for another.
#pragma once

#include "sdf/code_writer.h"

#include <string>
#include <vector>

namespace farfield {

/// What hard unions unite in `tree`, in two trees with the same definitions; each may be empty.
struct CastAndMarched {
    FieldTree cast, marched;
};
CastAndMarched divide_for_rays(const FieldTree& tree, const ParameterBlock& block);

class CastWriter : private CodeWriter {
public:
    /// `tree`: what divide_for_rays has found to be cast.
    CastWriter(const FieldTree& tree, const CodeNames& names, ParameterBlock& block)
        : CodeWriter(tree, names, block, false) {}

    CodeLines write();

private:
    /// Brings to `t` what is met, and declares it if it is the first.
    void meet(const FieldNode& n, const std::string& p, const std::string& v, const std::string& factor,
              CodeLines& out);
    void add(const FieldNode& n, const std::string& span, const std::string& factor, const std::string& comment,
             CodeLines& out);
    /// An expression of the span of a convex node.
    std::string span(const FieldNode& n, const std::string& p, const std::string& v, CodeLines& out);
    /// Declares the spans of what is taken away.
    void cuts(const FieldNode& n, const std::string& p, const std::string& v, const std::string& factor,
              std::vector<std::string>& names, CodeLines& out);

    bool is_first_ = true;
};

}  // namespace farfield
