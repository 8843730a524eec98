// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "deviation/deviation_scale.h"
#include "deviation/picture.h"

namespace meshbound::tools {

/// Colour and size of texts in a picture, before it is halved.
inline constexpr Colour ink = {40, 44, 52};
inline constexpr int text_size = 3;

/// Draws what the colours of a picture mean, 64 pixels high and `width` pixels wide, its upper left corner at (left,
/// top): the colours of the scale, the values at both ends, and the colour for deviations beyond. A text that is wider
/// than the bar of colours is written smaller, and a unit that is too long for that is cut.
void draw_legend(Picture& picture, int left, int top, int width, const DeviationScale& scale, const std::string& unit);

}  // namespace meshbound::tools
