// From the tree that glslang makes of custom code to a CustomProgram, and the checks that need the tree: only
// operations that distance code may use, no recursion, loops whose number of steps is known, indices that cannot leave
// their array (so that the GPU, which does not check, cannot either), and limits on the work of one evaluation.
#pragma once

#include "sdf/custom_program.h"
#include "sdf/custom_source.h"

#include <string>
#include <vector>

class TIntermNode;

namespace farfield {

/// A uniform in the program's memory, inputs first to last.
struct CustomInput {
    std::string name;
    int cells;  ///< 1 or 3
    double minimum, maximum;
};

inline constexpr double most_repetitions = 4096.0;    ///< of all loops together in one evaluation
inline constexpr double most_operations = 500'000.0;  ///< in one evaluation
/// Length of the code as drivers see it, with calls inlined and short loops unrolled. Mesa's llvmpipe takes 0.7 s for
/// 2000 operations of which 500 are sines, and more than in proportion beyond.
inline constexpr double longest_inlined = 4'000.0;

/// `root`: the tree of the library's functions (source string 0) and the user's text (1), free of errors. What is
/// refused is added to `errors`; then the program must not be run.
CustomProgram compile_custom(TIntermNode* root, const std::vector<CustomInput>& inputs, std::vector<CodeError>& errors);

}  // namespace farfield
