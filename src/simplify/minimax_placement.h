// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "meshbound/proximity.h"
#include "simplify/distinct_corners.h"
#include "simplify/linear_heights.h"

namespace meshbound {

/// Where the one vertex that a few faces share lies best: the largest distance of the part of the original that they
/// stand for, and of the vertex from the original, is least. Distances are linear while closest points stay, so each
/// step solves a Chebyshev problem in three unknowns, by Newton's method on p-norms of growing p, and looks again. A
/// guide, not a bound.
class MinimaxPlacement {
 public:
  using Corners = std::array<Vec3, 3>;

  MinimaxPlacement(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles)
      : vertices_(vertices),
        triangles_(triangles),
        corners_(triangles, vertices.size()),
        kernel_(fastest_height_kernel()) {}

  /// Samples the corners of the given original triangles, and where these are few also middles of edges, that lie
  /// within the tolerance of `faces`, those that the change takes away. `hint` is an original triangle near them.
  /// `originals` must stay as it is until the last step.
  void begin(double tolerance, std::span<const std::uint32_t> originals, std::span<const Corners> faces,
             std::uint32_t hint);

  /// Largest sampled distances in tolerances.
  struct Step {
    double here = 0;   ///< with `faces`
    double there = 0;  ///< expected after `move`; where no move makes it small, a number that none goes below
    Vec3 move;         ///< of the first corner of every face
  };
  [[nodiscard]] Step step(std::span<const Corners> faces, Proximity& original);

 private:
  void take_samples(std::size_t coarseness, SamplePoints& to) const;
  void take_middles(std::size_t coarseness, std::size_t next, std::size_t at, SamplePoints& to) const;
  void set_faces(std::span<const Corners> faces, std::vector<SampleFace>& to) const;
  [[nodiscard]] Step step_by(const SamplePoints& samples, Vec3 vertex, Proximity& original);
  void add_vertex(Vec3 p, Proximity& original);
  [[nodiscard]] Step lowered() const;

  const std::vector<Vec3>& vertices_;
  const std::vector<std::array<std::uint32_t, 3>>& triangles_;
  DistinctCorners corners_;
  HeightKernel kernel_;
  SlopeKernel slope_kernel_ = fastest_slope_kernel();
  double by_tolerance_ = 0;
  Vec3 origin_;
  std::span<const std::uint32_t> originals_, corners_of_originals_;
  SamplePoints samples_, few_;
  bool only_few_ = false;  ///< `samples_` have not been taken yet
  std::vector<SampleFace> removed_, faces_;
  std::uint32_t hint_ = 0;
  LinearHeights heights_;
};

}  // namespace meshbound
