// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "meshbound/proximity.h"
#include "simplify/distinct_corners.h"
#include "simplify/sampled_slope.h"

namespace meshbound {

/// How far a few faces and the part of the original that they stand for are apart, as one number to choose among
/// changes by: the sum of (distance / tolerance)^6 over sample points of both. The high power makes it follow the worst
/// deviation while it stays smooth. A guide, not a bound.
class LocalDeviation {
 public:
  using Corners = std::array<Vec3, 3>;

  LocalDeviation(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles)
      : vertices_(vertices),
        triangles_(triangles),
        corners_(triangles, vertices.size()),
        kernel_(fastest_slope_kernel()) {}

  /// Samples the corners of the given original triangles that lie within the tolerance of `faces`, those that the
  /// change takes away. `hint` is an original triangle near them.
  void begin(double tolerance, std::span<const std::uint32_t> originals, std::span<const Corners> faces,
             std::uint32_t hint);

  /// Sum and slope over the samples, and over the middles of `faces` and of the edges from their first corner to the
  /// second against the original, where the first corners move together. Lengths in tolerances.
  [[nodiscard]] SlopeSums of(std::span<const Corners> faces, Proximity& original);

 private:
  void set_faces(std::span<const Corners> faces);
  void add_to_original(Vec3 p, double share, std::size_t which, Proximity& original, SlopeSums& sums);

  const std::vector<Vec3>& vertices_;
  const std::vector<std::array<std::uint32_t, 3>>& triangles_;
  DistinctCorners corners_;
  SlopeKernel kernel_;
  double by_tolerance_ = 0;
  Vec3 origin_;
  SamplePoints samples_;
  std::vector<SampleFace> faces_;
  std::uint32_t hint_ = 0;
  std::vector<std::uint32_t> hints_;  ///< original triangle near each point of the faces
};

}  // namespace meshbound
