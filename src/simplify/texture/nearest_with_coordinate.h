// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"
#include "simplify/texture/texture_map.h"

namespace meshbound {

/// How far a coordinate may be off a line or a point, of the size of the coordinates: much more than mixing those of
/// corners rounds.
inline constexpr double rounding_of_coordinates = 1e-9;

/// The point of a triangle that is nearest to `p` among its points with the given texture coordinate, rounded; absent
/// if it has none. The triangle has no area in the texture. Where its texture coordinates lie on a line, the points
/// with one of them form a segment, from the edge between the ends of the line to another edge. Where all its corners
/// have one texture coordinate, all its points have it. Coordinates count as equal within `rounding_of_coordinates`.
/// O(1).
[[nodiscard]] std::optional<Vec3> nearest_with_coordinate(const TriangleCorners& at, const CornerCoordinates& t,
                                                          const Eigen::Vector2d& coordinate, Vec3 p);

}  // namespace meshbound
