// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace meshbound::tools {

/// Red, green and blue of sRGB, 0 to 255.
using Colour = std::array<std::uint8_t, 3>;

/// Colours from 0 to the end of the scale at equal steps: the map viridis by S. van der Walt and N. Smith (matplotlib,
/// CC0), whose lightness grows evenly and which people with a colour vision deficiency can read.
[[nodiscard]] std::span<const Colour> colour_stops();

/// The colour of deviations beyond the scale; no mixture of the stops is close to it.
inline constexpr Colour colour_beyond = {255, 0, 144};

/// The colour of a deviation as a share of the scale; `colour_beyond` above 1, and for what is not a number.
[[nodiscard]] Colour colour_of(double share);

}  // namespace meshbound::tools
