#include "renderer/statistics.h"

#include <fmt/format.h>

#include <cmath>

namespace farfield {

std::string bounces_text(const Statistics& statistics) {
    const int bounces = statistics.bounces;
    if (bounces == 0) return {};
    std::string text = fmt::format("{} {}", bounces, bounces == 1 ? "bounce" : "bounces");
    if (static_cast<std::size_t>(bounces) < statistics.bounce_shares.size())
        text += fmt::format("; bounce {} adds {:.1f} %", bounces + 1,
                            100.0f * statistics.bounce_shares[static_cast<std::size_t>(bounces)]);
    return text;
}

std::string percent_text(double part) {
    if (!std::isfinite(part)) return "unknown";
    return std::abs(part) >= 0.1 ? fmt::format("{:.0f} %", 1e2 * part) : fmt::format("{:.2g} %", 1e2 * part);
}

}  // namespace farfield
