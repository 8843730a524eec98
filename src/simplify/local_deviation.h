// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/point_triangle.h"
#include "meshbound/proximity.h"

namespace meshbound {

/// How far a few faces and the part of the original that they stand for are apart, as one number to choose among
/// changes by: the sum of (distance / tolerance)^6 over sample points of both. The high power makes it follow the worst
/// deviation while it stays smooth. A guide, not a bound.
class LocalDeviation {
 public:
  LocalDeviation(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles)
      : vertices_(vertices), triangles_(triangles), seen_(vertices.size(), 0) {}

  /// Samples the corners of the given original triangles that lie within the tolerance of `faces`, those that the
  /// change takes away.
  void begin(double tolerance, std::span<const std::uint32_t> originals, std::span<const std::array<Vec3, 3>> faces);

  /// Sum over the samples, and over the middles of `faces` and of the edges between them against the original. `hint`
  /// is an original triangle near them. Gives up, returning `enough` or more, once the sum has reached that.
  [[nodiscard]] double of(std::span<const std::array<Vec3, 3>> faces, Proximity& original, std::uint32_t hint,
                          double enough);

 private:
  [[nodiscard]] double squared_distance(Vec3 p) const;
  void set_faces(std::span<const std::array<Vec3, 3>> faces);

  const std::vector<Vec3>& vertices_;
  const std::vector<std::array<std::uint32_t, 3>>& triangles_;
  std::vector<std::uint32_t> seen_;
  std::uint32_t round_ = 0;
  double squared_tolerance_ = 0;
  std::vector<Vec3> samples_;
  std::vector<Vec3> middles_;                   ///< of edges, seen once
  std::vector<CornerTriangle<Double4>> faces_;  ///< four in each, the last one repeated
};

}  // namespace meshbound
