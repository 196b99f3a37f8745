// What was measured as a page, a table of numbers and a picture of every sweep.
#pragma once

#include "tests/stability/case.h"

#include <filesystem>

namespace farfield::stability {

struct Measured {
    Point point;
    Figures figures;
    double bound;
    bool within() const;  ///< whether farfield and reference meet the bound
};

struct Outcome {
    const Case* of;
    std::vector<Measured> points;
    double seconds = 0.0;  ///< of CPU time
    bool passed() const;
};

/// Writes README.md, results.csv and by gnuplot sweeps.png into the folder. `device`: what OpenGL calls the renderer.
void write_report(const std::vector<Outcome>& outcomes, const std::string& device, const std::filesystem::path& folder);

/// One line: the worst of each method over the sweep, the bound, the verdict.
std::string summary(const Outcome& outcome);

/// "1.2e-3" and "0.42": three digits, and no more than that.
std::string figure_text(double value);

}  // namespace farfield::stability
