#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace farfield {
namespace {

volatile std::sig_atomic_t stop_wanted = 0;

void on_signal(int) { stop_wanted = 1; }

}  // namespace

Progress::Progress(std::string what, int total)
    : what_(std::move(what)), total_(total), terminal_(isatty(STDERR_FILENO) != 0) {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
}

Progress::~Progress() {
    if (terminal_ && done_ > 0) fmt::print(stderr, "\r\x1b[K");
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

void Progress::advance() {
    ++done_;
    if (!terminal_) return;
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    fmt::print(stderr, "\r\x1b[K{} {}/{}, {:.0f} s left", what_, done_, total_, elapsed / done_ * (total_ - done_));
    std::fflush(stderr);
}

bool Progress::interrupted() { return stop_wanted != 0; }

}  // namespace farfield
