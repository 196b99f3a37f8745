// Measures the speed and accuracy of a view on a thread of its own, for the editor's panel: the reference first, kept
// for the next time, then settings around the scene's own, one seed after the other.
#pragma once

#include "renderer/context.h"
#include "renderer/sweep.h"
#include "ui/measure_panel.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

namespace farfield {

class Measuring {
public:
    Measuring() = default;
    ~Measuring() { stop(); }
    Measuring(const Measuring&) = delete;
    Measuring& operator=(const Measuring&) = delete;

    /// The view of a window of `size` pixels, in a picture as small as is good for comparison. `context` is used by the
    /// thread alone.
    void start(std::unique_ptr<Context> context, std::shared_ptr<const Scene> scene, glm::ivec2 size);
    /// Keeps what there is.
    void stop();
    /// Takes over what the thread has found; true when that is something new. Ends the measurement of a view that is no
    /// longer the scene's: other settings of light are the same view. `revision` tells without looking that nothing has
    /// changed.
    bool refresh(const Scene& scene, std::uint64_t revision);
    const MeasureResults& results() const { return results_; }

private:
    void run(const Scene& scene, const SweepPlan& plan);
    void measure(const Scene& scene, const SweepPlan& plan);
    void tell(double part, std::string doing);

    MeasureResults results_;
    std::string view_;  ///< that is measured, as text
    std::uint64_t revision_ = 0;
    std::unique_ptr<Context> context_;  ///< made and destroyed where windows are
    std::thread thread_;
    std::atomic<bool> stop_{false};

    std::mutex mutex_;  ///< guards the rest
    std::vector<Measurement> measurements_;
    double part_ = 0.0;
    std::string doing_, problem_;
    bool news_ = false, done_ = false;
};

}  // namespace farfield
