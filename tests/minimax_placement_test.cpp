// SPDX-License-Identifier: MIT
// Where the vertex of a change should go, as far as distances are linear: to where the largest sampled one is least.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "meshbound/bvh.h"
#include "meshbound/deviation_tracker.h"
#include "simplify/linear_heights.h"

namespace meshbound {
namespace {

/// The faces around vertex 200 of a sphere, and the tracker that stands at the sphere itself.
struct Star {
  static constexpr double tolerance = 0.02;
  TriangleMesh sphere = datasets::icosphere(1, 3);
  Bvh bvh{sphere};
  DeviationTracker tracker{sphere, bvh, tolerance};
  std::vector<std::uint32_t> removed;
  std::vector<TrackedFace> faces;
  std::vector<std::size_t> moved_corner;

  Star() {
    for (std::uint32_t t = 0; t < sphere.triangles.size(); ++t) {
      tracker.start(t, t);
      const Triangle& v = sphere.triangles[t];
      const auto found = std::find(v.begin(), v.end(), 200u);
      if (found == v.end()) continue;
      removed.push_back(t);
      moved_corner.push_back(static_cast<std::size_t>(found - v.begin()));
      faces.push_back({t, {sphere.vertices[v[0]], sphere.vertices[v[1]], sphere.vertices[v[2]]}});
    }
    tracker.sample_heights(removed);
  }
  HeightStep at(const Eigen::Vector3d& p) {
    for (std::size_t i = 0; i < faces.size(); ++i) faces[i].corners[moved_corner[i]] = p;
    return tracker.height_step(faces, moved_corner);
  }
};

TEST(MinimaxPlacement, GoesBackToWhereTheSurfaceIs) {
  Star star;
  const Eigen::Vector3d home = star.sphere.vertices[200];
  EXPECT_LT(star.at(home).here, 1e-3);
  Eigen::Vector3d p = home * 1.1 + Eigen::Vector3d(0.01, 0.02, -0.01);
  const HeightStep first = star.at(p);
  EXPECT_GT(first.here, 3);
  EXPECT_LT(first.there, 1);
  for (int k = 0; k < 3; ++k) p += star.at(p).move;
  EXPECT_LT(star.at(p).here, 1);
}

/// What it says of the place it proposes is what it sees there, where distances are nearly linear.
TEST(MinimaxPlacement, ForeseesTheDistanceAfterASmallMove) {
  Star star;
  const Eigen::Vector3d p = star.sphere.vertices[200] * 1.03;
  const HeightStep step = star.at(p);
  EXPECT_GT(step.here, 1.2);
  EXPECT_NEAR(star.at(p + step.move).here, step.there, 0.05);
}

/// Faces that leave out a bump of several tolerances to both sides: no vertex can be near all of it.
TEST(MinimaxPlacement, SeesThatThereIsNothingToGain) {
  TriangleMesh grid;
  constexpr std::uint32_t n = 9;
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const double height = x == 3 && y == 4 ? 0.5 : (x == 5 && y == 4 ? -0.5 : 0);
      grid.vertices.emplace_back(x, y, height);
    }
  }
  for (std::uint32_t y = 0; y + 1 < n; ++y) {
    for (std::uint32_t x = 0; x + 1 < n; ++x) {
      const std::uint32_t v = y * n + x;
      grid.triangles.push_back({v, v + 1, v + n});
      grid.triangles.push_back({v + 1, v + n + 1, v + n});
    }
  }
  const Bvh bvh(grid);
  DeviationTracker tracker(grid, bvh, 0.1);
  std::vector<std::uint32_t> removed;
  for (std::uint32_t t = 0; t < grid.triangles.size(); ++t) {
    tracker.start(t, t);
    removed.push_back(t);
  }
  tracker.sample_heights(removed);
  const Eigen::Vector3d middle(4, 4, 0);
  const std::vector<Eigen::Vector3d> rim = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
  std::vector<TrackedFace> fan;
  for (std::uint32_t k = 0; k < 4; ++k) fan.push_back({k, {middle, rim[k], rim[(k + 1) % 4]}});
  const HeightStep step = tracker.height_step(fan, std::vector<std::size_t>(4, 0));
  EXPECT_GT(step.here, 2);
  EXPECT_GT(step.there, 1.1);
}

TEST(HeightKernel, IsTheSameOnEveryProcessor) {
  SamplePoints points;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 40; ++i) points.add({unit(random), unit(random), i % 4 == 0 ? 0 : unit(random)});
  const std::vector<SampleFace> faces = {SampleFace({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                                         SampleFace({0, 0, 0}, {0, 1, 0}, {-1, -1, 0.2}),
                                         SampleFace({0, 0, 0}, {1, 1, 1}, {1, 1, 1})};
  const HeightKernel one = portable_height_kernel(), two = fastest_height_kernel();
  LinearHeights a, b;
  one.linearise(points, faces, 2, a);
  two.linearise(points, faces, 2, b);
  EXPECT_EQ(a.blocks.size(), 5U);
  EXPECT_TRUE(a.blocks == b.blocks);
  const HeightKernel::Move move = {0.1F, 0.2F, -0.1F}, step = {0.3F, -0.1F, 0.2F};
  const WeightedSums sums = one.weighted_sums(a, move, 0.3F, 3), same = two.weighted_sums(a, move, 0.3F, 3);
  EXPECT_GT(sums.square, 0);
  EXPECT_EQ(sums.weight, same.weight);
  EXPECT_EQ(sums.square, same.square);
  EXPECT_EQ(sums.right, same.right);
  EXPECT_EQ(sums.matrix, same.matrix);
  const std::array<float, 8> shares = {0, 0.1F, 0.2F, 0.3F, 0.5F, 0.7F, 0.9F, 1};
  const auto largest = one.largest_along(a, move, step, shares);
  EXPECT_EQ(largest, two.largest_along(a, move, step, shares));
  for (std::size_t k = 0; k < shares.size(); ++k) {
    float expected = 0;
    for (const LinearHeights::Block& block : a.blocks) {
      for (std::size_t i = 0; i < 8; ++i)
        expected = std::max(expected, std::abs(block.height[i] - block.x[i] * (move[0] + shares[k] * step[0]) -
                                               block.y[i] * (move[1] + shares[k] * step[1]) -
                                               block.z[i] * (move[2] + shares[k] * step[2])));
    }
    EXPECT_NEAR(largest[k], expected, 1e-5);
  }
}

}  // namespace
}  // namespace meshbound
