// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>

namespace meshbound::tools {

/// A letter of 5 x 7 pixels, row by row from the top; the highest of the five bits is the leftmost pixel.
using Glyph = std::array<std::uint8_t, 7>;

/// The glyph of a letter from A to Z (small ones look like capitals), a digit, one of `.,:%+-/()[]<>=_^'"` and the
/// Unicode signs of units µ (both code points), Å, °, ′ and ″. A space is empty; any other code point is a box, so that
/// a text never reads as another one.
[[nodiscard]] Glyph glyph_of(char32_t letter);

}  // namespace meshbound::tools
