// Where a program crashed, for a report of it.
#pragma once

namespace farfield {

/// From now on a crash writes the addresses that led to it to standard error (`addr2line -Cfe FARFIELD ADDRESS` tells
/// the lines in a build with debug information) and ends the program as it would have.
void trace_crashes();

}  // namespace farfield
