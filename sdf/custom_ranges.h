// What is known about numbers of custom code without running it: intervals of whole numbers, the number of steps of a
// loop, and whether an expression changes a variable.
#pragma once

#include "sdf/custom_compiler.h"

#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace glslang {
class TIntermLoop;
class TIntermTyped;
}  // namespace glslang

namespace farfield {

struct Refused : std::runtime_error {
    Refused(int at_line, const std::string& why) : std::runtime_error(why), line(at_line) {}
    int line;
};
[[noreturn]] void refuse(int line, const std::string& why);
int line_of(TIntermNode* node);  ///< in the user's text; 1 for the library's functions

/// Whether evaluating the expression may change a variable.
bool has_effects(TIntermNode* node);

struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

struct LoopSteps {
    double count;        ///< the most that there can be
    long long variable;  ///< glslang's id of the loop variable
    Range range;         ///< of the variable in the loop's body
};

class Ranges {
public:
    explicit Ranges(const std::vector<CustomInput>& inputs);

    /// Of a scalar; everything where nothing is known. Whole numbers keep their range only as long as they cannot wrap.
    Range of(glslang::TIntermTyped* node) const;

    /// A loop is for (T i = start; i < end; i += step): one variable of the loop that nothing else changes, compared
    /// with <, <=, >, >= or != (other conditions may follow after &&), start and step constant, end constant or, for
    /// whole numbers, of known range. `before`: what stands before the loop. Refuses all others, and more than `most`.
    LoopSteps steps(glslang::TIntermLoop* loop, TIntermNode* before, double most) const;

    /// In the loop's body its variable has a range.
    void enter(const LoopSteps& steps) { variables_[steps.variable] = steps.range; }
    void leave(const LoopSteps& steps) { variables_.erase(steps.variable); }

private:
    Range known(glslang::TIntermTyped* node) const;

    std::map<std::string, Range> inputs_;
    std::map<long long, Range> variables_;
};

}  // namespace farfield
