// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/prepared_triangle.h"

namespace meshbound::cgal {

/// Where a surface lies above another one around a vertex, in lengths along the normal of the other.
struct Heights {
  double least = 0, most = 0;

  /// Of one point, or to both sides when it lies beside the other surface rather than above it.
  struct Offset {
    double low = 0, high = 0;
  };
  [[nodiscard]] Heights raised(const Offset& by) const { return {least + by.low, most + by.high}; }
  [[nodiscard]] Heights lowered(const Offset& by) const { return {least - by.high, most - by.low}; }
  [[nodiscard]] Heights middle(const Heights& other) const {
    return {0.5 * (least + other.least), 0.5 * (most + other.most)};
  }
  [[nodiscard]] Heights joined(const Heights& other) const {
    return {least < other.least ? least : other.least, most > other.most ? most : other.most};
  }
};

/// A few faces that are asked for the heights of many points above them.
class HeightField {
 public:
  void clear() { faces_.clear(); }
  void add(const std::array<Vec3, 3>& corners);
  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  /// Above the nearest face, below 0 on its other side.
  [[nodiscard]] Heights::Offset height_of(Vec3 p);

 private:
  struct Face {
    PreparedTriangle triangle;
    Vec3 normal;  ///< unit, or 0 for zero area
    Vec3 middle;
    double radius = 0;  ///< of a ball around `middle` that holds the face
  };
  std::vector<Face> faces_;
  std::size_t last_ = 0;  ///< the face nearest to the point before: a point beside it begins there
};

}  // namespace meshbound::cgal
