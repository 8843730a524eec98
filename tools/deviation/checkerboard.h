// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

#include "deviation/colour_map.h"
#include "meshbound/attributes.h"

namespace meshbound::tools {

/// Squares of a checkerboard to a unit of texture coordinates.
inline constexpr int squares_per_unit = 16;

/// The colour of a checkerboard in the texture at a point of a triangle, by its barycentric coordinates: light and dark
/// squares whose hue grows with u and v, so that a square is recognised where it has moved to. `otherwise` where the
/// triangle has no texture coordinates.
[[nodiscard]] Colour checkerboard_at(const CornerAttribute& texture, std::uint32_t triangle,
                                     const Eigen::Vector3d& weights, const Colour& otherwise);

}  // namespace meshbound::tools
