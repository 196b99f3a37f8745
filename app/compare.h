// `farfield compare`: how far an image is from a reference, by every metric.
#pragma once

#include <filesystem>
#include <string>

namespace farfield {

struct CompareOptions {
    std::filesystem::path image, reference;
    std::string layer;      ///< of EXR files; empty: the file's own R, G, B
    float exposure = 0.0f;  ///< stops, for FLIP, which compares what a screen shows
};

/// Returns the exit status as the commands of commands.h do; throws std::invalid_argument for files that cannot be read
/// or compared.
int run_compare(const CompareOptions& options);

}  // namespace farfield
