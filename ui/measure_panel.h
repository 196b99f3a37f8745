// Speed against accuracy of the view at hand: a plot of what was measured, a click on a point applies its settings.
#pragma once

#include "renderer/measurement.h"
#include "ui/ui.h"

#include <string>
#include <vector>

namespace farfield {

/// What there is to show; whoever measures fills it in.
struct MeasureResults {
    std::vector<ChartPoint> points;  ///< medians over the seeds so far
    std::vector<ChartPoint> front;   ///< of them those that no other beats in both time and error, by time
    glm::ivec2 size{0};              ///< pixels of the pictures
    bool device_time = false;        ///< the device's, not the CPU's
    bool running = false;
    float progress = 0.0f;  ///< of all that is to be done, 0 to 1
    std::string doing;      ///< "reference: 512 of 2048 samples"
    std::string problem;    ///< why it has ended early, empty if it has not
    bool stale = false;     ///< the view has changed since
};

enum class MeasureWish { none, start, stop };

/// The window while ui.show_measure. Returns edits of the settings where a point or preset was chosen.
Edits measure_panel(Ui& ui, const Scene& scene, const MeasureResults& results, MeasureWish& wish);

}  // namespace farfield
