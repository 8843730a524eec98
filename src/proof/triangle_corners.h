// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "geometry/vec3.h"

namespace meshbound {

/// A triangle of A or a part of one, in B's working frame.
using TriangleCorners = std::array<Vec3, 3>;

}  // namespace meshbound
