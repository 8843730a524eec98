// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>

#include "meshbound/bounds.h"
#include "meshbound/bvh.h"

namespace meshbound {

/// Decides for single triangles whether their whole surface lies within a tolerance of a fixed mesh: the backward half
/// of the simplifier's check, and what a tool needs to test one edited face. Keeps scratch memory, so use one per
/// thread; the tree itself may be shared. `bvh` must outlive this.
class Proximity {
 public:
  explicit Proximity(const Bvh& bvh);          ///< O(n)
  Proximity(Proximity&&) noexcept;             ///< a moved-from object may only be destroyed or assigned to
  Proximity& operator=(Proximity&&) noexcept;  ///< a moved-from object may only be destroyed or assigned to
  ~Proximity();

  /// `Within` proves that every point of the triangle is at most `tolerance` from the mesh, `Exceeds` that one is
  /// further (rounding included both ways). `Undecided` after `max_subdivisions` cuts or where doubles cannot tell.
  /// Model units and coordinates. Throws `InvalidInput` for a tolerance that is no length and for corners that are not
  /// finite or beyond `largest_coordinate`. Expected O(log n), and the cuts. `hint` is a triangle of the mesh to try
  /// first and returns the one that served last; any value is right, a good one is faster.
  [[nodiscard]] Verdict triangle_within(const std::array<Eigen::Vector3d, 3>& triangle, double tolerance,
                                        std::uint32_t& hint, std::uint64_t max_subdivisions = 10000);

  /// Upper bound of the distance from `point` to the mesh, `hint` as above: the least one, or the first that is at most
  /// `enough`. Model units and coordinates. Throws `InvalidInput` as above for the point. Expected O(log n).
  [[nodiscard]] double upper_distance(const Eigen::Vector3d& point, std::uint32_t& hint, double enough = 0);

  /// A triangle near `point`, for guides that prove nothing: where a walk from `hint` from neighbour to neighbour comes
  /// no nearer; or the nearest one, where that is farther than `far`. Model units and coordinates. Throws
  /// `InvalidInput` as above for the point. O(1) where the hint is good, expected O(log n) else.
  [[nodiscard]] std::uint32_t nearby_triangle(const Eigen::Vector3d& point, std::uint32_t hint, double far);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshbound
