// Time per pass by timestamp queries; results are read when they are there, a frame or more late.
#pragma once

#include "renderer/gl.h"
#include "renderer/statistics.h"

#include <vector>

namespace farfield {

/// CPU time of the process so far, all threads: what work costs where the CPU renders, whoever else uses it.
double process_cpu_seconds();

class Timers {
public:
    /// Between construction and destruction of the scope the pass's time runs. Names must be literals.
    class Scope {
    public:
        Scope(Timers& timers, const char* name);
        ~Scope();
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        Timers& timers_;
        std::size_t index_;
    };

    void begin_frame();  ///< what was measured before is dropped
    /// Sum for each pass since begin_frame; waits for the device.
    std::vector<PassTime> collect();

private:
    struct Interval {
        const char* name;
        gl::Handle<gl::QueryTraits> begin, end;
    };
    std::vector<Interval> intervals_;
    std::size_t used_ = 0;
};

/// Time of work on the device: what `work` adds to the clock that counts.
class Stopwatch {
public:
    explicit Stopwatch(bool on_cpu) : on_cpu_(on_cpu) {}
    template <class Work>
    double seconds(Work work) {
        if (on_cpu_) {
            const double start = process_cpu_seconds();
            work();
            glFinish();
            return process_cpu_seconds() - start;
        }
        timers_.begin_frame();
        {
            Timers::Scope scope(timers_, "work");
            work();
        }
        return 1e-3 * timers_.collect().at(0).milliseconds;
    }

private:
    bool on_cpu_;
    Timers timers_;
};

}  // namespace farfield
