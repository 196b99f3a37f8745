// What to say about a word that is not one of those that are known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace farfield {

/// "expected one of a, b, c (perhaps b)", with the nearest to `found` where one is near; of a long list only the
/// beginning.
std::string expected_one_of(const std::vector<std::string_view>& known, std::string_view found);

}  // namespace farfield
