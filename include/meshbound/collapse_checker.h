// SPDX-License-Identifier: MIT
/// The two-sided bound for anyone's own decimation by edge collapses: each collapse is proven before it is made.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "meshbound/error.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// Follows a triangle mesh from collapse to collapse, and admits those after which the symmetric Hausdorff distance to
/// the mesh at the start is proven to be within the tolerance:
///
///     CollapseChecker checker(mesh, tolerance);
///     if (checker.admits(u, v, point)) {
///       ...                                       // the caller collapses its own edge u v into the point
///       checker.commit();
///     }
///
/// Vertices are indices in the mesh at the start. A collapse is also refused where it would leave no 2-manifold
/// (link condition), turn a face by more than 84 degrees or make one that is next to nothing, move a locked vertex,
/// or change more than 48 faces. The state is a proof, rounding included, for the points as they were given; measure
/// the result all the same (`check_tolerance`) where it matters. Not thread-safe. Memory: O(original); a collapse takes
/// time by the number of original triangles near it.
class CollapseChecker {
 public:
  /// `original` is an oriented 2-manifold, with or without borders, joined by the indices of its vertices. Throws
  /// `InvalidInput` where it is not, for what `validate` refuses, and for a tolerance that is no length. Model units.
  /// O(n log n).
  CollapseChecker(const TriangleMesh& original, double tolerance);
  CollapseChecker(CollapseChecker&&) noexcept;             ///< a moved-from object may only be destroyed or assigned to
  CollapseChecker& operator=(CollapseChecker&&) noexcept;  ///< a moved-from object may only be destroyed or assigned to
  ~CollapseChecker();

  /// Whether the bound holds after the collapse of the edge between the vertices u and v into `point`. After `commit`
  /// the mesh has this collapse; any other call goes on from the mesh as it was before. Throws `InvalidInput` for
  /// vertices that a collapse has removed or that no edge joins.
  [[nodiscard]] bool admits(std::uint32_t u, std::uint32_t v, const Eigen::Vector3d& point);
  /// The first point of these for which the bound holds: `wanted`, where the largest sampled distance is least, the
  /// ends. With a locked end, that one. None: the edge is refused, and again until something near has changed.
  [[nodiscard]] std::optional<Eigen::Vector3d> admitted_placement(std::uint32_t u, std::uint32_t v,
                                                                  const Eigen::Vector3d& wanted);
  /// Makes the collapse that was admitted by the call before. Returns the number that its vertex has from now on: u,
  /// but for some edges at a border v. Throws `Error` where nothing was admitted.
  std::uint32_t commit();

  /// The vertex stays where it is: collapses of its edges go to its position.
  /// Throws `InvalidInput` for a vertex that no triangle has, or that a collapse has removed.
  void lock(std::uint32_t vertex);
  /// Whether it stays where it is; while a collapse is admitted, once that is made. Throws as `lock`.
  [[nodiscard]] bool is_locked(std::uint32_t vertex) const;
  /// By triangle of the original, model units, beside `tolerance`: as `SimplifyOptions::face_tolerances`. Before the
  /// first collapse; throws `InvalidInput` for another number of them or one that is no length.
  void limit_triangles(std::span<const double> tolerances);
  /// Goes on with a larger tolerance. Throws `InvalidInput` for a smaller one.
  void grow_tolerance(double tolerance);

  [[nodiscard]] double tolerance() const;   ///< model units
  [[nodiscard]] std::size_t faces() const;  ///< that are left
  /// What became of the collapses that were asked for.
  struct Counts {
    std::uint64_t performed = 0;  ///< admitted and committed
    std::uint64_t refused = 0;    ///< tested, and not admitted
    std::uint64_t repeated = 0;   ///< refused without a test: nothing near has changed since the last one
  };
  [[nodiscard]] const Counts& counts() const;  ///< since the start

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshbound
