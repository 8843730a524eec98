// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

#include "geometry/vec3.h"
#include "simplify/texture/texture_map.h"

namespace meshbound {

/// How far a coordinate may be off a line or a point, of the size of the coordinates: much more than mixing those of
/// corners rounds.
inline constexpr double rounding_of_coordinates = 1e-9;

/// Of the points of a triangle without an area in the texture that have a coordinate, the one nearest to `p`, rounded.
/// Where the triangle has a line of coordinates, they lie on a segment from the edge between its ends to one of its
/// other edges. Where it has a single coordinate, all points have it. Rounding decides whether it is the same. O(1).
[[nodiscard]] std::optional<Vec3> nearest_with_coordinate(const std::array<Vec3, 3>& at, const CornerCoordinates& t,
                                                          const Eigen::Vector2d& coordinate, Vec3 p);

}  // namespace meshbound
