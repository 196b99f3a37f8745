// The font files, by preference; see app/packages.
#pragma once

#include <array>

namespace farfield::fonts {

using Files = std::array<const char*, 2>;  ///< the second where the first is not installed

inline constexpr Files regular{"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
                               "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"};
inline constexpr Files bold{"/usr/share/fonts/opentype/inter/Inter-SemiBold.otf",
                            "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"};
inline constexpr Files mono{"/usr/share/fonts/truetype/jetbrains-mono/JetBrainsMono-Regular.ttf",
                            "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"};

}  // namespace farfield::fonts
