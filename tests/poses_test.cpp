// SPDX-License-Identifier: MIT
// Distances of posed models where rounding weighs most, against rational arithmetic.
#include <gtest/gtest.h>

#include <cmath>

#include "meshbound/distance.h"
#include "reference/exact_intersection.h"
#include "reference/small_meshes.h"
#include "reference/texture_oracle.h"

namespace meshbound {
namespace poses_test {

using Eigen::Vector3d;

/// The squared distance between two posed points, exactly.
mpq_class squared_distance(const Vector3d& p, const Eigen::Isometry3d& pose_of_p, const Vector3d& q,
                           const Eigen::Isometry3d& pose_of_q) {
  const reference::ExactVector a = reference::exact_image(pose_of_p, p), b = reference::exact_image(pose_of_q, q);
  mpq_class squared = 0;
  for (std::size_t i = 0; i < 3; ++i) squared += (a[i] - b[i]) * (a[i] - b[i]);
  return squared;
}

/// A point far from the origin of its model, and a pose that brings it back: rounding goes with what cancels.
TEST(Poses, ThatCancelLargeCoordinatesLeaveTheDistanceInTheInterval) {
  const TriangleMesh a = reference::single_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const double far : {5e6, 1e10}) {
    const Vector3d p = far * Vector3d(1, 0.7, -0.3);
    const Bvh tree_a(a), tree_b(reference::single_triangle(p, p, p));
    for (int i = 1; i < 20; ++i) {
      Eigen::Isometry3d pose(Eigen::AngleAxisd(0.2 * i, Vector3d(1, 2, 3).normalized()));
      pose.translation() = Vector3d(3, 0, 0) - pose.linear() * p;
      mpq_class farthest = 0;
      for (const Vector3d& v : a.vertices)
        farthest = std::max(farthest, squared_distance(v, Eigen::Isometry3d::Identity(), p, pose));
      const Bounds found = one_sided_hausdorff_distance(tree_a, {tree_b, pose}).bounds;
      EXPECT_GE(reference::compare_root(farthest, found.lower), 0) << far << ' ' << i;
      EXPECT_LE(reference::compare_root(farthest, found.upper), 0) << far << ' ' << i;
      EXPECT_LE(found.upper - found.lower, 1e-13 * far);
    }
  }
}

/// Where coordinates are a few steps of the smallest double, each product of a pose is off by half a step.
TEST(Poses, OfTheSmallestModelsLeaveTheDistanceInTheInterval) {
  constexpr double step = 0x1p-1074;
  for (int i = 1; i < 400; ++i) {
    Eigen::Isometry3d pose_a(Eigen::AngleAxisd(0.37 * i, Vector3d(3, 1, i % 7).normalized()));
    Eigen::Isometry3d pose_b(Eigen::AngleAxisd(0.2 * i, Vector3d(1, 2, 3).normalized()));
    pose_a.translation() = step * Vector3d(i % 50, 7, -13);
    pose_b.translation() = step * Vector3d(3, i % 31, -20);
    const std::array<Vector3d, 3> b = {step * Vector3d(i % 11 + 20, 10, 3), step * Vector3d(i % 11 + 28, 10, 5),
                                       step * Vector3d(i % 11 + 20, 19, 2)};
    // Beyond the first corner of B, which is the nearest point then.
    const Vector3d away = (b[0] / step - b[1] / step) + (b[0] / step - b[2] / step);
    const Vector3d there = pose_b * Vector3d(b[0] / step + 10 * away);
    const Vector3d p = (pose_a.inverse() * there).array().round().matrix() * step;
    const Bvh tree_a(reference::single_triangle(p, p, p)), tree_b(reference::single_triangle(b[0], b[1], b[2]));
    for (const bool point_first : {true, false}) {
      const PlacedModel model_a{tree_a, pose_a}, model_b{tree_b, pose_b};
      const Bounds found = point_first ? one_sided_hausdorff_distance(model_a, model_b).bounds
                                       : one_sided_hausdorff_distance(model_b, model_a).bounds;
      mpq_class squared = squared_distance(p, pose_a, b[0], pose_b);
      for (const Vector3d& corner : b)
        if (!point_first) squared = std::max(squared, squared_distance(p, pose_a, corner, pose_b));
      EXPECT_GE(reference::compare_root(squared, found.lower), 0) << i << ' ' << found.lower / step;
      EXPECT_LE(reference::compare_root(squared, found.upper), 0) << i << ' ' << found.upper / step;
      EXPECT_LE(found.upper - found.lower, 2000 * step);
    }
  }
}

}  // namespace poses_test
}  // namespace meshbound
