// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "geometry/prepared_triangle.h"
#include "geometry/triangle_corners.h"
#include "simplify/kernel/kernels.h"

namespace meshbound {

/// Bit k stands for candidate face k.
using FaceMask = std::uint64_t;

/// Up to 64 triangles, and which of them are within the tolerance of a point; made for many points.
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
  void add(const TriangleCorners& corners);
  [[nodiscard]] int size() const { return size_; }

  /// The members of `among` that are within the tolerance of p.
  [[nodiscard]] FaceMask holding(Vec3 p, FaceMask among);

  /// Whether candidate k is within the tolerance of all these points, as `holding` tells: `at(i)` is point i of
  /// `count`.
  template <class At>
  [[nodiscard]] bool holds_all(int k, std::size_t count, const At& at) {
    const PlaneBlock& block = planes(static_cast<std::size_t>(k / PlaneBlock::lanes));
    const auto lane = static_cast<std::size_t>(k % PlaneBlock::lanes);
    const bool is_flat = ((flat_ >> k) & 1U) != 0;
    const auto above = [&](int plane, Vec3 p) {
      return block.x[plane][lane] * p.x + block.y[plane][lane] * p.y + block.z[plane][lane] * p.z +
             block.offset[plane][lane];
    };
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = at(i);
      const bool is_inside =
          std::abs(above(PlaneBlock::face, p)) <= tolerance_ && std::max({above(1, p), above(2, p), above(3, p)}) <= 0;
      if (!(is_flat && is_inside) && !holds(k, p)) return false;
    }
    return true;
  }

  /// The member of `among` that is nearest to p.
  [[nodiscard]] FaceMask nearest(Vec3 p, FaceMask among);

  /// How far one can go from p towards q without leaving the slab around one of the faces of `of_p`, as a share of the
  /// way, and from q towards p with those of `of_q`; no face is in both. A guess where to cut, not a bound.
  [[nodiscard]] Reach reach(Vec3 p, Vec3 q, FaceMask of_p, FaceMask of_q);

 private:
  static constexpr std::size_t blocks = capacity / PlaneBlock::lanes;
  [[nodiscard]] bool holds(int k, Vec3 p);
  [[nodiscard]] const PreparedTriangle& triangle(int k);
  /// The planes of candidates 4 block to 4 block + 3, made when they are first asked for, all at once.
  const PlaneBlock& planes(std::size_t block) {
    if (((missing_ >> block) & 1U) != 0) make_planes(block);
    return blocks_[block];
  }
  void make_planes(std::size_t block);

  PlaneKernel kernel_ = simplify_kernels().planes;
  double tolerance_ = 0, squared_tolerance_ = 0;
  int size_ = 0;
  std::array<PlaneBlock, blocks> blocks_{};
  std::uint32_t missing_ = 0;  ///< bit for each block whose planes are not those of its triangles yet
  std::array<TriangleCorners, capacity> corners_{};
  std::array<PreparedTriangle, capacity> triangles_{};
  FaceMask prepared_ = 0;  ///< those whose triangle is that of the corners
  FaceMask flat_ = 0;      ///< those whose planes are accurate
};

}  // namespace meshbound
