// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"

namespace meshbound {

/// A few triangles, for the nearest one to each of many points. Boxes tell which ones need not be looked at.
class NearestTriangle {
 public:
  void add(const TriangleCorners& corners);

  /// The nearest triangle to p, the first of several. There must be one. Begins at the one that it found last, so
  /// points near one another should follow each other.
  [[nodiscard]] std::size_t operator()(Vec3 p);

 private:
  struct Extent {
    Vec3 lo{HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    void extend(Vec3 p);
    /// Whether what it encloses is not proven to be further from p than that.
    [[nodiscard]] bool may_be_within(Vec3 p, double squared) const;
  };
  struct Boxed {
    TriangleCorners corners;
    Extent box;
  };
  std::vector<Boxed> triangles_;
  std::size_t nearest_ = 0;
};

}  // namespace meshbound
