// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "simplify/sampled_slope.h"

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

/// A few faces that are asked for the heights of points around them, in single precision: an estimate needs no more.
class HeightField {
 public:
  /// No faces, no points. All that is added lies around `origin`.
  void clear(Vec3 origin);
  void add(const std::array<Vec3, 3>& corners);
  [[nodiscard]] std::size_t size() const { return faces_.size(); }
  void ask(Vec3 p) { points_.add(p - origin_); }
  /// Of the points in the order in which they were asked for: above the nearest face, below 0 on its other side. At
  /// least one face. Valid until the next call.
  [[nodiscard]] std::span<const Heights::Offset> heights();

 private:
  SlopeKernel kernel_ = fastest_slope_kernel();
  Vec3 origin_;
  std::vector<SampleFace> faces_;
  SamplePoints points_;
  std::vector<SampleOffsets> offsets_;
  std::vector<Heights::Offset> heights_;
};

}  // namespace meshbound::cgal
