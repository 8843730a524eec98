// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"
#include "simplify/texture/texture_map.h"

namespace meshbound {

/// How far a coordinate may be off a line or a point, of the size of the coordinates: much more than mixing those of
/// corners rounds.
inline constexpr double rounding_of_coordinates = 1e-9;

/// The texture coordinates of a triangle that has no area in the texture: they lie on a line, or are all the same.
class LineCoordinates {
 public:
  LineCoordinates() = default;
  explicit LineCoordinates(const CornerCoordinates& t);

  /// The point of the triangle that is nearest to `p` among its points with the given texture coordinate, rounded;
  /// absent if it has none. `at` are its corners. Where its texture coordinates lie on a line, the points with one of
  /// them form a segment, from the edge between the ends of the line to another edge. Where all its corners have one
  /// texture coordinate, all its points have it. Coordinates count as equal within `rounding_of_coordinates`. O(1).
  [[nodiscard]] std::optional<Vec3> nearest(const TriangleCorners& at, const Eigen::Vector2d& coordinate, Vec3 p) const;

 private:
  bool is_one_ = false;
  std::array<std::uint8_t, 3> along_{};         ///< the first, the middle and the last corner along the line
  Eigen::Vector2d from_, to_;                   ///< coordinates of the first and of the last
  double tolerance_ = 0;                        ///< how far a coordinate may be off
  double turn_ = 0;                             ///< position of the middle one, as a share of the way
  std::array<double, 2> lowest_{}, highest_{};  ///< by axis: no coordinate below or beyond is on the line
};

/// As `LineCoordinates(t).nearest(at, coordinate, p)`.
[[nodiscard]] std::optional<Vec3> nearest_with_coordinate(const TriangleCorners& at, const CornerCoordinates& t,
                                                          const Eigen::Vector2d& coordinate, Vec3 p);

}  // namespace meshbound
