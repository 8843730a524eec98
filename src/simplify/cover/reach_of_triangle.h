// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>

#include "geometry/boxes.h"
#include "geometry/triangle_corners.h"

namespace meshbound {

/// What lies within a distance of a triangle, and more: a box along the axes, cut to a slab along the longest edge. The
/// box alone is full of others where the triangle is a needle askew to the axes. As computed, for guides.
class ReachOfTriangle {
 public:
  ReachOfTriangle(const TriangleCorners& corners, double distance) : box_(grown(box_of(corners), distance)) {
    const auto& [a, b, c] = corners;
    Vec3 longest = b - a;
    for (const Vec3 edge : {c - b, a - c})
      if (squared_length(edge) > squared_length(longest)) longest = edge;
    across_ = cross(cross(b - a, c - a), longest);
    const double beyond = distance * length(across_);
    const auto [min, max] = std::minmax({dot(across_, a), dot(across_, b), dot(across_, c)});
    min_ = min - beyond;
    max_ = max + beyond;
  }
  /// Whether a triangle may have a point in it.
  [[nodiscard]] bool meets(const TriangleCorners& corners) const {
    const auto& [a, b, c] = corners;
    const double p = dot(across_, a), q = dot(across_, b), r = dot(across_, c);
    return std::min({p, q, r}) <= max_ && std::max({p, q, r}) >= min_ && box_meets(corners, box_);
  }
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  Eigen::AlignedBox3d box_;
  Vec3 across_;  ///< in the plane of the triangle, at right angles to its longest edge; of any length
  double min_ = 0, max_ = 0;
};

}  // namespace meshbound
