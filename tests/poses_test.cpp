// SPDX-License-Identifier: MIT
// Distances of posed models where rounding weighs most, against rational arithmetic.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

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

using reference::ExactVector;

mpq_class dot(const ExactVector& a, const ExactVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
ExactVector operator-(const ExactVector& a, const ExactVector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

mpq_class squared_distance_to_segment(const ExactVector& p, const ExactVector& a, const ExactVector& b) {
  const ExactVector edge = b - a, way = p - a;
  mpq_class share = dot(edge, edge) == 0 ? mpq_class(0) : mpq_class(dot(way, edge) / dot(edge, edge));
  share = std::clamp(share, mpq_class(0), mpq_class(1));
  return dot(way, way) - 2 * share * dot(way, edge) + share * share * dot(edge, edge);
}

mpq_class squared_distance_to_triangle(const ExactVector& p, const std::array<ExactVector, 3>& t) {
  mpq_class best = std::min({squared_distance_to_segment(p, t[0], t[1]), squared_distance_to_segment(p, t[1], t[2]),
                             squared_distance_to_segment(p, t[2], t[0])});
  const ExactVector u = t[1] - t[0], v = t[2] - t[0], way = p - t[0];
  const mpq_class uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), pu = dot(way, u), pv = dot(way, v);
  const mpq_class area = uu * vv - uv * uv;
  if (area == 0) return best;
  const mpq_class s = (vv * pu - uv * pv) / area, r = (uu * pv - uv * pu) / area;
  if (s < 0 || r < 0 || s + r > 1) return best;
  return dot(way, way) - s * pu - r * pv;
}

/// Where coordinates are a few hundred steps of the smallest double, each product of a pose is off by half a step.
TEST(Poses, OfTheSmallestModelsLeaveTheDistanceInTheInterval) {
  constexpr double step = 0x1p-1074;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> steps(-100, 100);
  const auto corner = [&] { return Vector3d(step * steps(random), step * steps(random), step * steps(random)); };
  const auto pose = [&] {
    Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
    Eigen::Isometry3d result(turn.normalized());
    result.translation() = corner();
    return result;
  };
  for (int i = 0; i < 300; ++i) {
    const std::array<TriangleMesh, 2> meshes{reference::single_triangle(corner(), corner(), corner()),
                                             reference::single_triangle(corner(), corner(), corner())};
    const std::array<Eigen::Isometry3d, 2> poses{pose(), pose()};
    std::array<std::array<ExactVector, 3>, 2> images;
    for (std::size_t m = 0; m < 2; ++m)
      for (std::size_t k = 0; k < 3; ++k) images[m][k] = reference::exact_image(poses[m], meshes[m].vertices[k]);
    mpq_class farthest = 0;  // one of the corners: the distance to a triangle is convex
    for (const ExactVector& p : images[0]) farthest = std::max(farthest, squared_distance_to_triangle(p, images[1]));
    const Bvh a(meshes[0]), b(meshes[1]);
    const Bounds found = one_sided_hausdorff_distance({a, poses[0]}, {b, poses[1]}).bounds;
    EXPECT_GE(reference::compare_root(farthest, found.lower), 0) << i << ' ' << found.lower / step;
    EXPECT_LE(reference::compare_root(farthest, found.upper), 0) << i << ' ' << found.upper / step;
    EXPECT_LE(found.upper - found.lower, 3000 * step);
  }
}

}  // namespace poses_test
}  // namespace meshbound
