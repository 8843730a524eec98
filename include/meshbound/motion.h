// SPDX-License-Identifier: MIT
/// Distances between two models that move rigidly, step by step: each step begins with what the one before it found.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>

#include "meshbound/bvh.h"
#include "meshbound/distance.h"
#include "meshbound/pose.h"

namespace meshbound {

/// Two models of which only the poses change. Kept from step to step, for each direction:
///
///     the furthest point             measured again first: it is a lower bound at the new poses
///     the closest triangles          where the queries of the vertices begin
///     the nodes that were culled     a distance changes by no more than the models move against each other, so the
///                                    bound of a node, raised by that much, mostly culls it again without a query
///
/// Answers have the guarantees of those of the functions of the same names in distance.h; as other points are looked
/// at, bounds may differ inside these guarantees. They depend on the steps before but not on the number of threads.
/// Where a step is too large for the nodes to help, it is measured as if it were the first one; surfaces that are
/// nearer than their triangles are large gain little. With `Method::CrossCulling` nothing is kept. Source: the future
/// work of the paper (section 8, motion coherence). Not thread-safe: use one per thread; the trees may be shared.
/// Memory: 4 bytes per vertex, 24 per node that was culled.
class MovingPair {
 public:
  /// Both trees must outlive this. After a refit of one of them, or when another is moved into it, everything is
  /// measured anew.
  MovingPair(const Bvh& a, const Bvh& b);
  MovingPair(MovingPair&&) noexcept;             ///< a moved-from object may only be destroyed or assigned to
  MovingPair& operator=(MovingPair&&) noexcept;  ///< a moved-from object may only be destroyed or assigned to
  ~MovingPair();

  /// Measures H(A, B) at these poses, model to world. Throws as the function of the same name.
  [[nodiscard]] HausdorffDistance hausdorff_distance(const Pose& pose_a, const Pose& pose_b,
                                                     const DistanceOptions& options = {});

  /// Decides H(A, B) <= tolerance (model units) at these poses. Throws as the function of the same name.
  [[nodiscard]] ToleranceCheck check_tolerance(const Pose& pose_a, const Pose& pose_b, double tolerance,
                                               const DistanceOptions& options = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshbound
