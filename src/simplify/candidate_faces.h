// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>

#include "geometry/point_triangle.h"
#include "simplify/plane_block.h"

namespace meshbound {

/// Bit k stands for candidate face k.
using FaceMask = std::uint64_t;

/// Up to 64 triangles that are asked over and over: which of you are within the tolerance of this point?
///
/// A triangle answers by its plane and the three planes through its edges perpendicular to it where these are accurate
/// enough (`set_tolerance`), which is exact inside the prism that they bound, and by `closest_on_triangle` elsewhere.
/// An answer may be "no" for a point that is within the tolerance by rounding alone, and is "yes" only for points
/// within tolerance (1 + plane_slack) + rounding_slack(M) in real arithmetic.
class CandidateFaces {
 public:
  static constexpr int capacity = 64;
  /// Share of the tolerance that the inaccuracy of a plane may cost.
  static constexpr double plane_slack = 1e-6;
  /// Error of evaluating plane equations and distances at coordinates of magnitude at most M: `primal_error` M, and for
  /// a plane 3 products and 3 sums of terms of at most 2 sqrt(3) M, each with relative error u.
  [[nodiscard]] static double rounding_slack(double magnitude) { return 0x1p-45 * magnitude; }

  void clear(double tolerance);
  /// `size()` must be less than `capacity`.
  void add(const std::array<Vec3, 3>& corners) { put(size_++, corners); }
  /// Another triangle in the place of candidate k.
  void replace(int k, const std::array<Vec3, 3>& corners) { put(k, corners); }
  [[nodiscard]] int size() const { return size_; }

  /// The members of `among` that are within the tolerance of p.
  [[nodiscard]] FaceMask holding(Vec3 p, FaceMask among) const;

  /// The member of `among` that is nearest to p.
  [[nodiscard]] FaceMask nearest(Vec3 p, FaceMask among) const;

  /// How far one can go from p towards q without leaving the slab around one of the faces of `mask`, as a share of the
  /// way: a guess where to cut, not a bound.
  [[nodiscard]] double reach(Vec3 p, Vec3 q, FaceMask mask) const;

 private:
  static constexpr int face_plane = 0, sides = 3;  ///< of `PlaneBlock`: the face, then its sides
  [[nodiscard]] const PlaneBlock& block_of(int k) const { return blocks_[k / PlaneBlock::lanes]; }
  [[nodiscard]] bool holds(int k, Vec3 p) const;
  void put(int k, const std::array<Vec3, 3>& corners);

  SlabTest test_ = slab_test();
  double tolerance_ = 0, squared_tolerance_ = 0;
  int size_ = 0;
  std::array<PlaneBlock, capacity / PlaneBlock::lanes> blocks_{};
  std::array<CornerTriangle<double>, capacity> triangles_;
  FaceMask flat_ = 0;  ///< those whose planes are accurate
};

}  // namespace meshbound
