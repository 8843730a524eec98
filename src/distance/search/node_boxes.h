// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "bvh/build.h"
#include "geometry/mapping.h"

namespace meshbound {

/// The corners of a box of A in B's frame.
[[nodiscard]] inline std::array<Vec3, 8> corners_of(const Box& box, const Mapping& map) {
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = map(
        {(i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y, (i & 4) != 0 ? box.hi.z : box.lo.z});
  return corners;
}

}  // namespace meshbound
