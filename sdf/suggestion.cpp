#include "sdf/suggestion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace farfield {
namespace {

/// Levenshtein distance.
size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = std::exchange(row[0], i + 1);
        for (size_t j = 0; j < b.size(); ++j) {
            size_t substituted = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
        }
    }
    return row.back();
}

}  // namespace

std::string expected_one_of(const std::vector<std::string_view>& known, std::string_view found) {
    const bool is_long = known.size() > 20;
    const auto end = is_long ? known.begin() + 8 : known.end();
    std::string text = fmt::format("expected {}{}{}", known.size() == 1 ? "" : "one of ",
                                   fmt::join(known.begin(), end, ", "), is_long ? ", ..." : "");
    auto distance = [&](std::string_view key) { return edit_distance(key, found.substr(0, 64)); };
    auto nearest =
        std::min_element(known.begin(), known.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
    if (known.size() > 1 && nearest != known.end() && distance(*nearest) <= std::max<size_t>(1, nearest->size() / 3))
        text += fmt::format(" (perhaps {})", *nearest);
    return text;
}

}  // namespace farfield
