// chart.csv: a line for each measurement of `farfield chart`. Lines are only ever added, so that a run can be
// interrupted and taken up again, and no measurement is lost; which lines count is decided when they are read.
#pragma once

#include "renderer/sweep.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace farfield {

/// A measurement of a scene.
struct ChartLine {
    std::string scene;   ///< the file's name without folder and extension
    std::string hash;    ///< of its content, so that a changed scene is measured anew
    std::string device;  ///< what OpenGL calls the renderer
    glm::ivec2 size{0};  ///< of the picture, pixels
    Measurement measurement;

    /// What was measured; results and the reference's samples do not count.
    std::string key() const;
};

/// The first line of the file, and what `farfield chart --help` says of it.
std::string chart_columns();

class ChartTable {
public:
    /// Reads the file where there is one. Lines that are torn or not understood are left out and named in `problems`.
    /// Throws ImageError where it cannot be read or is another table.
    explicit ChartTable(std::filesystem::path file);

    const std::vector<std::string>& problems() const { return problems_; }
    /// The latest with the key of `line`, against a reference of at least as many samples; null for none.
    const ChartLine* find(const ChartLine& line) const;
    /// Written at once. Throws ImageError.
    void add(const ChartLine& line);

private:
    std::filesystem::path file_;
    std::map<std::string, ChartLine> lines_;  ///< by key
    std::vector<std::string> problems_;
    bool torn_ = false;  ///< the file ends within a line
};

}  // namespace farfield
