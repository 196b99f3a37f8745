// SHA-256 (FIPS 180-4): what stands for a text where another with the same hash must not be found.
#pragma once

#include <string>
#include <string_view>

namespace farfield {

/// In 64 small hexadecimal digits.
std::string sha256(std::string_view text);

}  // namespace farfield
