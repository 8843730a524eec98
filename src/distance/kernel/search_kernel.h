// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "bvh/bvh_data.h"
#include "bvh/nearest.h"
#include "distance/paper/group_bounds.h"
#include "geometry/triangle_corners.h"
#include "proof/cover_record.h"
#include "proof/goal.h"

namespace meshbound {

/// How `SearchKernel::sweep` bounded a triangle.
enum class Swept {
  NotAtAll,
  NotNear,  ///< not even the centroid is within the target: the hint may have been a bad one
  ByOneTriangle,
  ByWalk
};

/// One thread's search against one tree: the inner loops behind one interface, so that the instruction set is chosen
/// once, at run time. Points are in the working frame of the tree. Not thread-safe; the tree may be shared.
class SearchKernel {
 public:
  virtual ~SearchKernel() = default;

  /// Starts a new batch from a proven lower bound; the upper bound starts at 0.
  virtual void begin(const LowerBound& lower) = 0;

  /// The nearest triangle, or the first one found within `enough_squared`; starts with `hint`.
  virtual Nearest nearest(const Vec3& p, std::uint32_t hint, double enough_squared) = 0;

  /// Where a walk from `hint` from neighbour to neighbour comes no nearer to p: often the nearest triangle.
  virtual Nearest nearby(const Vec3& p, std::uint32_t hint) = 0;

  /// Offers a point of triangle `from_slot` of A, at a computed distance: raises the lower bound if it proves one.
  virtual void offer(const Vec3& p, const Nearest& nearest, std::uint32_t from_slot) = 0;

  /// Largest squared distance of three points to the triangle at `slot` (the paper's Eq. 5 for one triangle of B), or a
  /// bound of it that is within the target.
  virtual double farthest_squared(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t slot) = 0;

  /// Covers a whole triangle of A starting from a candidate, with at most `max_cuts` cuts.
  virtual void cover(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t from_slot, std::uint32_t slot,
                     std::uint64_t max_cuts) = 0;

  /// Tries to bound a triangle of A without a query, by the triangle a few steps from `hint` towards the centroid,
  /// which becomes the new hint, or by a short walk from there with at most `max_cuts` cuts.
  virtual Swept sweep(const TriangleCorners& triangle, std::uint32_t& hint, std::uint64_t max_cuts) = 0;

  /// From now on `cover` and `sweep` leave the triangles of B that the pieces were accepted on here; null: nowhere.
  virtual void record_in(CoverRecord* record) = 0;

  /// Bounds of h(T, B) for a triangle T of A, by one traversal (paper, Alg. 2); it ends early once the upper bound is
  /// within `enough_squared`. Starts with the triangles of B in `hints`.
  virtual GroupBounds cull_on_b(const TriangleCorners& triangle, std::span<const std::uint32_t> hints,
                                double enough_squared) = 0;

  /// Covers a whole triangle of A by subdivision (paper, section 5), known to be within the root of `upper_squared`.
  virtual void subdivide(const TriangleCorners& triangle, std::uint32_t from_slot, double upper_squared,
                         std::uint64_t max_cuts) = 0;

  /// Largest squared distance of the corners of a box of A to the triangle at `slot`.
  virtual double farthest_squared(const std::array<Vec3, 8>& box, std::uint32_t slot) = 0;

  virtual void accept(double squared) = 0;
  [[nodiscard]] virtual double accepted_squared() const = 0;
  [[nodiscard]] virtual const LowerBound& lower() const = 0;
  [[nodiscard]] virtual double upper_squared() const = 0;
  [[nodiscard]] virtual const WalkCounters& counters() const = 0;
};

/// The fastest kernel this machine runs. All of them give the same results to the last bit.
std::unique_ptr<SearchKernel> make_search_kernel(const Bvh::Data& target, const Goal& goal);

/// Sets the magnitude and the rounding slacks of a goal (numeric/rounding.h): `magnitude` bounds all coordinates,
/// `model_error` is what the coordinates themselves may be off.
void set_slack(Goal& goal, double magnitude, double model_error);

}  // namespace meshbound
