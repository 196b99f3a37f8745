// `farfield chart`: speed against accuracy of scenes as CSV, pictures and tables.
#pragma once

#include "renderer/context.h"
#include "renderer/sweep.h"

#include <filesystem>
#include <vector>

namespace farfield {

struct ChartOptions {
    std::vector<std::filesystem::path> scenes;
    std::filesystem::path output;      ///< folder; made where it is missing
    std::filesystem::path references;  ///< folder; empty: the user's cache
    SweepPlan plan;
    bool trust_code = false;
    ContextKind context = ContextKind::automatic;
};

/// Returns the exit status as the commands of commands.h do. Measures what chart.csv does not have yet.
int run_chart(const ChartOptions& options);

}  // namespace farfield
