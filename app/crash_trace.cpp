#include "app/crash_trace.h"

#include <array>
#include <csignal>
#include <execinfo.h>
#include <string_view>
#include <unistd.h>

namespace farfield {
namespace {

/// Only what is allowed in a signal's handler.
void write_trace(int signal) {
    constexpr std::string_view message =
        "Farfield has crashed. What was not saved is offered when it starts again. Where it was:\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    std::array<void*, 48> calls;
    ::backtrace_symbols_fd(calls.data(), ::backtrace(calls.data(), static_cast<int>(calls.size())), STDERR_FILENO);
    std::raise(signal);  // as it would have been: the handler was for once
}

}  // namespace

void trace_crashes() {
    void* call = nullptr;
    ::backtrace(&call, 1);  // loads what it needs, which a handler may not
    struct sigaction action {};
    action.sa_handler = write_trace;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
    for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

}  // namespace farfield
