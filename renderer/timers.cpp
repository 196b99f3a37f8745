#include "renderer/timers.h"

#include <algorithm>
#include <ctime>

namespace farfield {
namespace {

gl::Handle<gl::QueryTraits> make_query() {
    GLuint name = 0;
    glGenQueries(1, &name);
    return gl::Handle<gl::QueryTraits>(name);
}

}  // namespace

double process_cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Timers::Scope::Scope(Timers& timers, const char* name) : timers_(timers), index_(timers.used_++) {
    if (index_ == timers.intervals_.size()) timers.intervals_.push_back({name, make_query(), make_query()});
    Interval& interval = timers.intervals_[index_];
    interval.name = name;
    glQueryCounter(interval.begin.name(), GL_TIMESTAMP);
}

Timers::Scope::~Scope() { glQueryCounter(timers_.intervals_[index_].end.name(), GL_TIMESTAMP); }

void Timers::begin_frame() { used_ = 0; }

std::vector<PassTime> Timers::collect() {
    std::vector<PassTime> passes;
    for (std::size_t i = 0; i < used_; ++i) {
        GLuint64 begin = 0, end = 0;
        glGetQueryObjectui64v(intervals_[i].begin.name(), GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(intervals_[i].end.name(), GL_QUERY_RESULT, &end);
        auto pass =
            std::find_if(passes.begin(), passes.end(), [&](const PassTime& p) { return p.name == intervals_[i].name; });
        if (pass == passes.end()) pass = passes.insert(passes.end(), {intervals_[i].name, 0.0});
        pass->milliseconds += static_cast<double>(end - begin) * 1e-6;
    }
    return passes;
}

}  // namespace farfield
