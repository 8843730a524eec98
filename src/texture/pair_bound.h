// SPDX-License-Identifier: MIT
#pragma once
#include "texture/overlay.h"

namespace meshbound {

/// An upper bound of the distance between the points of two triangles with the same texture coordinate, over the
/// coordinates that both have; at most `least` counts as that. Infinite where doubles do not know it to within
/// `precision`. Both must have an area in the texture. O(1).
[[nodiscard]] double upper_of_pair(const ChartTriangle& a, const ChartTriangle& b, double least, double precision);

}  // namespace meshbound
