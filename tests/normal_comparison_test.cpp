// SPDX-License-Identifier: MIT
// Normals compared again after a small change: the same as if they were compared anew.
#include "normals/normal_comparison.h"

#include <gtest/gtest.h>

#include <random>

#include "datasets/analytic_meshes.h"

namespace meshbound {
namespace normal_comparison_test {

constexpr double tolerance = 12;  // degrees

void expect_equal(const NormalDeviation& found, const NormalDeviation& anew) {
  EXPECT_EQ(found.degrees, anew.degrees);
  ASSERT_EQ(found.worst.has_value(), anew.worst.has_value());
  EXPECT_EQ(found.worst->from.triangle, anew.worst->from.triangle);
  ASSERT_EQ(found.exceeding.size(), anew.exceeding.size());
  for (std::size_t i = 0; i < found.exceeding.size(); ++i) {
    EXPECT_EQ(found.exceeding[i].from.triangle, anew.exceeding[i].from.triangle);
    EXPECT_EQ(found.exceeding[i].degrees, anew.exceeding[i].degrees);
  }
}

/// Moves some vertices, turns a face over, takes a face away and puts one back.
void change(TriangleMesh& mesh, const TriangleMesh& whole, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.9, 1.1);
  for (int k = 0; k < 3; ++k) mesh.vertices[random() % mesh.vertices.size()] *= share(random);
  std::swap(mesh.triangles[random() % mesh.triangles.size()], mesh.triangles.back());
  if (random() % 2 == 0)
    mesh.triangles.pop_back();
  else
    std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
  mesh.triangles.push_back(whole.triangles[random() % whole.triangles.size()]);
}

TEST(NormalComparison, FindsWhatAMeasurementAnewFinds) {
  const TriangleMesh fine = datasets::icosphere(1, 3), coarse = datasets::icosphere(1, 2);
  for (const int threads : {1, 2}) {
    std::mt19937 random(7);
    NormalComparison comparison;
    TriangleMesh level = coarse;
    std::size_t exceeding = 0;
    for (int round = 0; round < 40; ++round) {
      const NormalDeviation found = comparison.measure(fine, level, {tolerance, threads});
      expect_equal(found, normal_deviation(fine, level, {tolerance, threads}));
      exceeding += found.exceeding.size();
      change(level, coarse, random);
    }
    EXPECT_GT(exceeding, 0U);
  }
}

TEST(NormalComparison, OfTheMeshItselfIsZeroAgainAfterAChange) {
  const TriangleMesh sphere = datasets::icosphere(1, 2);
  TriangleMesh moved = sphere;
  moved.vertices[5] *= 1.5;
  NormalComparison comparison;
  EXPECT_EQ(comparison.measure(sphere, sphere, {tolerance, 1}).degrees, 0);
  EXPECT_GT(comparison.measure(sphere, moved, {tolerance, 1}).degrees, tolerance);
  EXPECT_EQ(comparison.measure(sphere, sphere, {tolerance, 1}).degrees, 0);
}

/// Nothing goes, but a face that is turned over comes nearer than the one that was nearest.
TEST(NormalComparison, SeesAFaceThatIsAdded) {
  const TriangleMesh below{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  TriangleMesh level{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}};
  NormalComparison comparison;
  EXPECT_EQ(comparison.measure(below, level, {tolerance, 1}).degrees, 0);
  for (const auto& p : {Eigen::Vector3d(0, 0, 0.5), Eigen::Vector3d(0, 1, 0.5), Eigen::Vector3d(1, 0, 0.5)})
    level.vertices.push_back(p);
  level.triangles.push_back({3, 4, 5});
  EXPECT_EQ(comparison.measure(below, level, {tolerance, 1}).degrees, 180);
}

}  // namespace normal_comparison_test
}  // namespace meshbound
