// SPDX-License-Identifier: MIT
#pragma once
#include "texture/overlay.h"

namespace meshbound {

/// An upper bound of the distance between the points of two triangles with the same texture coordinate, over the
/// coordinates that both have; not below `min_upper`, and that where they have none in common. Infinite where doubles
/// do not know the distance to within `precision`. Both must have an area in the texture. Lengths in model units. O(1).
[[nodiscard]] double upper_of_pair(const ChartTriangle& a, const ChartTriangle& b, double min_upper, double precision);

}  // namespace meshbound
