// Progress of long work on a terminal, and the wish to stop it (SIGINT, SIGTERM), so that no half-written file stays
// behind.
#pragma once

#include <chrono>
#include <string>

namespace farfield {

class Progress {
public:
    /// Catches the signals from here on. Prints only to a terminal.
    Progress(std::string what, int total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void advance();
    void expect(int total) { total_ = total; }
    int done() const { return done_; }
    static bool interrupted();

private:
    std::string what_;
    int total_;
    int done_ = 0;
    bool terminal_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace farfield
