// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>

namespace meshbound::tools {

/// A letter of 5 x 7 pixels, row by row from the top; the highest of the five bits is the leftmost pixel.
using Glyph = std::array<std::uint8_t, 7>;

/// The glyph of a letter (small ones look like capitals), a digit or one of `.,:%+-/()[]<>=`; empty for all others.
[[nodiscard]] Glyph glyph_of(char letter);

}  // namespace meshbound::tools
