// The tables of `farfield chart`.
#pragma once

#include "app/chart_plot.h"

namespace farfield {

/// tables.md: equal samples, equal time, equal error, and what each setting does.
std::string chart_tables(const std::vector<ChartScene>& scenes, const std::string& title);

}  // namespace farfield
