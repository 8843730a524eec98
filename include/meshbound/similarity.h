// SPDX-License-Identifier: MIT
/// Which shapes are most like another one: nearest by the Hausdorff distance, whatever their position and scale.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "meshbound/mesh_view.h"
#include "meshbound/pose.h"

namespace meshbound {

/// A mesh moved and scaled so that the centroid of its surface is the origin and the root mean square distance of the
/// surface from there is 1: both are integrals over the surface, so another triangulation of it changes them little. A
/// mesh without area is placed by its bounding box. Distances of shapes are in this unit, and proven for the normalised
/// coordinates, which are rounded.
class Shape {
 public:
  /// Throws `InvalidInput` as `validate` does, and for a mesh that is a single point. O(n).
  explicit Shape(const MeshView& mesh, const BvhOptions& options = {});
  Shape(Shape&&) noexcept;             ///< a moved-from object may only be destroyed or assigned to
  Shape& operator=(Shape&&) noexcept;  ///< a moved-from object may only be destroyed or assigned to
  ~Shape();

  [[nodiscard]] const AffineMap& normalisation() const;  ///< from the mesh to normalised coordinates, rounded
  /// Columns: the principal axes of the surface in normalised coordinates, longest first, a right-handed frame. They
  /// are well defined only where the three extents differ: not for a sphere or a cube.
  [[nodiscard]] const Eigen::Matrix3d& axes() const;
  /// The tree of the normalised mesh. Built by the first call, O(n log n), which must not run in two threads at once.
  [[nodiscard]] const Bvh& tree() const;

 private:
  friend class ShapeSearch;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What is asked of a search for similar shapes.
struct SimilarityOptions {
  std::size_t count = 1;  ///< how many shapes are wanted
  /// Also turn each shape so that its principal axes lie on those of the query: the nearest of the 4 proper ways counts
  /// (reflections do not).
  bool align = false;
  /// An interval is narrow enough, and distances that differ by no more are not told apart, at the larger of this
  /// length, in units of normalised shapes,
  double error_bound = 1e-3;
  /// and this share of its upper bound: the distance is then known to a factor of two, and nothing that is missing is
  /// less than half as far. Less costs more; with 0, shapes are ranked to `error_bound` whatever their distances.
  double relative_error_bound = 0.5;
  DistanceOptions distance;  ///< method, threads, budget of the whole search and cancel; other members are ignored
};

/// A shape that was found.
struct SimilarShape {
  std::size_t index = 0;  ///< among the candidates
  Bounds distance;        ///< H of the normalised shapes, under `alignment`
  /// Turns the normalised candidate to where it was measured; the identity unless asked to align.
  Pose alignment = Pose::Identity();
  bool converged = true;  ///< the interval is as narrow as wanted
};

/// How the candidates, each in each of its alignments, were decided.
struct SimilarityStats {
  std::uint64_t alignments = 0;             ///< of all candidates together
  std::uint64_t ended_by_extents = 0;       ///< too long or too short along an axis, without a tree
  std::uint64_t ended_by_samples = 0;       ///< a few points are too far away
  std::uint64_t ended_by_decision = 0;      ///< a vertex or `check_tolerance` shows a point that is too far away
  std::uint64_t measured = 0;               ///< both bounds are known
  std::uint64_t closest_point_queries = 0;  ///< of all candidates together
};

/// The shapes that are nearest to a query.
struct SimilarShapes {
  /// By upper bound, at most `SimilarityOptions::count`. No candidate that comes later or is missing is nearer than the
  /// upper bound of one minus its error bound.
  std::vector<SimilarShape> nearest;
  /// False: the budget of the search, or the token of a tree that it had to build, ended it before that was proven.
  bool complete = true;
  SimilarityStats stats;  ///< of this search
};

/// Ranks candidates by H(query, candidate). Best first: the candidate with the smallest lower bound so far is looked at
/// more closely, and the search ends when that bound exceeds the upper bounds of as many shapes as are wanted, less the
/// error bound, and these are narrow enough. Lower bounds come from the extents along the axes, then from a few closest
/// points, then from a decision against the best upper bound (Seidl and Kriegel, "Optimal multi-step k-nearest neighbor
/// search", SIGMOD 1998). Throws `InvalidInput` for a count of 0, an error bound that is no length and a relative one
/// that is not a share below 1. The same for any number of threads, but for a budget of time. Trees of candidates are
/// built only for those that extents and points of their own leave open.
[[nodiscard]] SimilarShapes nearest_shapes(const Shape& query, std::span<const Shape> candidates,
                                           const SimilarityOptions& options = {});

}  // namespace meshbound
