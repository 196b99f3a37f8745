// Custom code: a distance function that the user writes in GLSL, inside a scene's node.
//
//     uniform float radius = 0.5;   // [0, 2] m  Radius of the ball
//     uniform int folds = 4;        // [1, 12]   Number of folds
//     const float lipschitz = 1.5;
//     float sdf(vec3 p) { ... return length(p) - radius; }
//
// Each uniform is a parameter of the node: float, int, bool (0 or 1), vec3, ivec3 (three whole numbers) or bvec3 (three
// switches). The comment after it gives range, unit (m, °, °/m) and tip, each optional; angles are radians in the code.
// `lipschitz` is the author's bound of how fast sdf changes: |sdf(a) - sdf(b)| <= lipschitz |a - b|. The code may call
// the functions of shapes.glsl and operations.glsl; where it declares a name of theirs, its own counts.
//
// glslang (Khronos' reference compiler) checks the text as version 430 and makes the tree from which the CPU evaluates;
// the GPU gets the text itself. What could hang or read out of bounds on either is refused: see custom_source.h for the
// words, custom_ranges.h for loops and custom_compiler.h for indices, recursion and the limits of work.
#pragma once

#include "sdf/custom_program.h"
#include "sdf/custom_source.h"
#include "sdf/parameter.h"

#include <glm/vec3.hpp>

#include <deque>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace farfield {

/// Immutable; all members may be called from several threads at a time.
class CustomCode {
public:
    struct Parsed {
        std::shared_ptr<const CustomCode> code;  ///< null when there are errors
        std::vector<CodeError> errors;           ///< by line
    };
    static Parsed parse(std::string_view text);

    const std::string& text() const { return text_; }  ///< as it was given
    const std::string& hash() const { return hash_; }  ///< SHA-256 of the text, 64 hexadecimal digits
    /// They refer to texts that live as long as this object.
    std::span<const Parameter> parameters() const { return parameters_; }
    float lipschitz() const { return lipschitz_; }  ///< as declared, or 1
    /// Of its loops in one evaluation, at most, each loop's last turn included; 0: it has none.
    double loop_turns() const {
        const auto repetitions = static_cast<double>(program_.repetitions);
        return repetitions > 0.0 ? 2.0 * repetitions + 16.0 : 0.0;
    }

    /// GLSL that declares `float sdf_<suffix>(vec3 p)`. Line i belongs to line i of the text. All global names end in
    /// the suffix, of letters and digits. `arguments`: for each parameter a float or vec3 expression in code units;
    /// they initialise global variables, so what they call must be declared before. So must the functions of
    /// shapes.glsl and operations.glsl that the result calls (see used_shapes).
    std::string glsl(std::string_view suffix, std::span<const std::string> arguments) const;

    /// Names in the text that are not its own, for used_shapes: comments do not count.
    std::string called() const;

    /// The value of sdf at p on the CPU; `values` in code units, in the order of the parameters. As on the GPU it may
    /// be infinite or not a number where the code divides by zero.
    float evaluate(glm::vec3 p, std::span<const glm::vec3> values) const;

private:
    explicit CustomCode(std::string_view text);
    void add_parameter(const CustomUniform& uniform, std::span<const float> initial, std::vector<CodeError>& errors);

    std::string text_, hash_;
    std::unique_ptr<const CustomSource> source_;
    std::deque<std::string> strings_;  ///< keys and tips of the parameters
    std::vector<Parameter> parameters_;
    float lipschitz_ = 1.0f;
    CustomProgram program_;
};

}  // namespace farfield
