// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cmath>

#include "texture/overlay.h"

namespace meshbound {

/// A chart for a triangle A whose texture coordinates lie on a line, and for others with coordinates on that line.
///
/// The points of A with one texture coordinate form a segment, in a direction that is the same for all of A. A point
/// has two coordinates here: the texture coordinate along the line, and the place in that direction, which is free to
/// choose where only points with the same texture coordinate are compared.
class LineChart {
 public:
  /// `a` has texture coordinates on a line, and not one alone.
  explicit LineChart(const ChartTriangle& a) : at_(a.source->corners[a.along[0]]) {
    const auto& uv = a.source->coordinates;
    const auto& corners = a.source->corners;
    const auto [first, middle, last] = a.along;
    const Eigen::Vector2d way = uv[last] - uv[first];
    axis_ = std::fabs(way.x()) > std::fabs(way.y()) ? 0 : 1;
    const double share = (uv[middle][axis_] - uv[first][axis_]) / way[axis_];
    const Eigen::Vector3d way_across = corners[middle] - (at_ + share * (corners[last] - at_));
    const double width = way_across.stableNorm();
    across_ = width > 0 ? ((std::fabs(way[axis_]) / width) * (way_across / width)).eval() : way_across;
  }

  /// Corner k of a triangle in the chart.
  [[nodiscard]] Eigen::Vector2d corner(const TexturedTriangle& t, std::size_t k) const {
    return {t.coordinates[k][axis_], across_.dot(t.corners[k] - at_)};
  }

 private:
  Eigen::Index axis_ = 0;  ///< of texture coordinates: differs along the line
  Eigen::Vector3d at_;     ///< where the place is 0: a corner of A
  /// Where the texture coordinate stays the same, so long that A is as wide in the second coordinate as in the first,
  /// whatever the units of both; 0 without an area in space.
  Eigen::Vector3d across_;
};

}  // namespace meshbound
