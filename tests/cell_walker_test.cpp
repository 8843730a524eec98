// SPDX-License-Identifier: MIT
// Pieces and their cuts, and what the walk over the cells does where cells alone do not tell which triangle is nearest.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "distance/kernel/search_kernel.h"
#include "distance/paper/subdivision.h"
#include "meshbound/distance.h"
#include "proof/piece.h"
#include "reference/brute_force.h"
#include "reference/claims.h"
#include "reference/hard_meshes.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace cell_walker_test {

using Eigen::Vector3d;
using namespace reference;

/// A regular polygon in the plane z = 0.
Piece polygon(std::uint32_t corners) {
  Piece piece;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    piece.add({std::cos(angle), std::sin(angle), 0});
  }
  piece.pad();
  return piece;
}

double area(const Piece& piece) {
  double twice = 0;
  for (std::uint32_t i = 2; i < piece.count; ++i)
    twice += cross(piece.corner(i - 1) - piece.corner(0), piece.corner(i) - piece.corner(0)).z;
  return twice / 2;
}

TEST(Piece, OfElevenCornersIsCutWhereNineLieOnOneSide) {
  const Piece piece = polygon(11);
  const CornerDistances sides = distances_from_plane(piece, {1, 0, 0}, 0.7);
  Piece inside, outside;
  ASSERT_TRUE(cut(piece, sides, inside, outside));
  EXPECT_EQ(inside.count + outside.count, 11u + 4u);
  EXPECT_NEAR(area(inside) + area(outside), area(piece), 1e-14);
}

TEST(Piece, IsNotCutWhereAPartHasNoRoom) {
  const Piece piece = polygon(Piece::capacity);
  Piece inside, outside;
  EXPECT_FALSE(cut(piece, distances_from_plane(piece, {1, 1e-3, 0}, 0.95), inside, outside));
  EXPECT_FALSE(cut_by_chord(piece, {0, 0.5}, {11, 0.5}, inside, outside));
}

TEST(Piece, IsSplitAlongADiagonalWithoutNewCorners) {
  for (const std::uint32_t corners : {4u, 5u, 9u, 12u}) {
    const Piece piece = polygon(corners);
    Piece first, second;
    split_by_diagonal(piece, first, second);
    EXPECT_EQ(first.count + second.count, corners + 2);
    EXPECT_LE(std::max(first.count, second.count), corners / 2 + 2);
    EXPECT_NEAR(area(first) + area(second), area(piece), 1e-14);
    for (const Piece& part : {first, second})
      for (std::uint32_t i = 0; i < part.count; ++i) {
        double nearest = 1;
        for (std::uint32_t k = 0; k < corners; ++k)
          nearest = std::min(nearest, squared_length(part.corner(i) - piece.corner(k)));
        EXPECT_EQ(nearest, 0);
      }
  }
}

TEST(Piece, CutByAChordKeepsItsArea) {
  const Piece piece = polygon(7);
  for (std::uint32_t from = 0; from < 7; ++from)
    for (std::uint32_t to = 0; to < 7; ++to) {
      if (from == to) continue;
      Piece first, second;
      ASSERT_TRUE(cut_by_chord(piece, {from, 0.25}, {to, 0.75}, first, second));
      EXPECT_EQ(first.count + second.count, 7u + 4u);
      EXPECT_GT(area(first), 0);
      EXPECT_GT(area(second), 0);
      EXPECT_NEAR(area(first) + area(second), area(piece), 1e-14);
    }
}

/// h(A,B) of a pair at an error bound, checked against brute force; returns the statistics.
DistanceStats measured(const TriangleMesh& a, const TriangleMesh& b, double error_bound) {
  DistanceOptions options;
  options.error_bound = error_bound;
  options.threads = 1;
  const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(a), Bvh(b), options);
  EXPECT_EQ(result.outcome, Outcome::Converged);
  EXPECT_LE(result.bounds.upper - result.bounds.lower, error_bound);
  expect_witness(a, b, result);
  return result.stats;
}

/// A square among spheres: its furthest points lie where two, then three and four of them are equally near.
TEST(CellWalking, TiesBetweenCurvedSheetsCostTheSameForEveryErrorBound) {
  const TriangleMesh square = moved(scaled(unit_square(1), 2), {-1, -1, 0.01});
  const TriangleMesh two = both(moved(icosphere(3), {-2.5, 0.1, 0.3}), moved(icosphere(3), {2.55, 0, -0.2}));
  const TriangleMesh three = both(two, moved(icosphere(2), {0.1, 2.6, 0.1}));
  const TriangleMesh four = both(three, moved(icosphere(3), {0, -2.45, -0.1}));
  for (const TriangleMesh* spheres : {&two, &three, &four}) {
    const DistanceStats coarse = measured(square, *spheres, 1e-5), fine = measured(square, *spheres, 1e-9);
    EXPECT_LT(2 * fine.closest_point_queries, 3 * coarse.closest_point_queries);
    EXPECT_LT(2 * fine.pieces, 3 * coarse.pieces);
  }
}

/// The side of a cylinder of radius 1 along z from 0 to 4, in `along` rings of `around` squares.
TriangleMesh cylinder(std::uint32_t around, std::uint32_t along) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= along; ++i)
    for (std::uint32_t j = 0; j < around; ++j) {
      const double angle = 2 * std::numbers::pi * j / around;
      mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 4.0 * i / along);
    }
  for (std::uint32_t i = 0; i < along; ++i)
    for (std::uint32_t j = 0; j < around; ++j) {
      const std::uint32_t p = i * around + j, q = i * around + (j + 1) % around;
      mesh.triangles.push_back({p, q, q + around});
      mesh.triangles.push_back({p, q + around, p + around});
    }
  return mesh;
}

/// Segments one after another along z from 0 to 4, with vertices of their own or shared ones.
TriangleMesh chain_on_axis(std::uint32_t segments, bool welded) {
  TriangleMesh chain;
  for (std::uint32_t i = 0; i <= segments; ++i) chain.vertices.emplace_back(0, 0, 4.0 * i / segments);
  for (std::uint32_t i = 0; i < segments; ++i) chain.triangles.push_back({i, i + 1, i + 1});
  return welded ? chain : unwelded(chain);
}

TEST(CellWalking, SegmentsOfAnAxisBoundACylinderAtEveryErrorBound) {
  for (const bool welded : {true, false}) {
    // Each of the 288 triangles crosses 168 slabs, which are walked through from end to end: some of them are asked for
    // where a triangle is split.
    const DistanceStats stats = measured(cylinder(24, 6), chain_on_axis(1000, welded), 1e-8);
    EXPECT_LT(stats.closest_point_queries, 288u * 40);
    EXPECT_LT(stats.subdivisions, 288u * 240);
    EXPECT_LT(stats.resolved, 288u);
  }
}

/// Around the axis all cells of a ring meet, and walking from cell to cell leads around it.
TEST(CellWalking, ANeedleAcrossTheAxisOfACylinderIsSplitBetweenFarCells) {
  const TriangleMesh needle =
      single_triangle({0.00028, -0.00033, 0.00027}, {-0.00037, 0.0002, 4.00099}, {0.00063, 0.0002, 4.00099});
  EXPECT_LT(measured(needle, cylinder(141, 70), 4.9e-6).closest_point_queries, 5000u);
}

/// Beside the axis half of the cylinder is near enough, and the other half, a little further away, has boxes as near.
TEST(CellWalking, NeedlesBesideTheAxisOfACylinderFindItsNearHalf) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> beside(-1e-3, 1e-3);
  std::vector<std::array<Vector3d, 3>> needles;
  for (int i = 0; i < 20; ++i) {
    const Vector3d from(beside(random), beside(random), 0), to(beside(random), beside(random), 4);
    needles.push_back({from, to, to + Vector3d(1e-3, 0, 0)});
  }
  const DistanceStats stats = measured(soup(needles), cylinder(141, 70), 4.9e-6);
  EXPECT_LT(stats.triangles_tested, 1'200'000u);
}

/// Every interior point lies under hundreds of triangles that are equally far.
TEST(CellWalking, OverlappingLayersDoNotLookAtAllThatOverlaps) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<std::array<Vector3d, 3>> layer, copy;
  for (int i = 0; i < 600; ++i) {
    std::array<Vector3d, 3> triangle, shifted;
    for (int k = 0; k < 3; ++k) {
      triangle[k] = {normal(random), normal(random), 0};
      shifted[k] = triangle[k] + Vector3d(0.1 * normal(random), 0.1 * normal(random), 0.01);
    }
    layer.push_back(triangle);
    copy.push_back(shifted);
  }
  const DistanceStats stats = measured(soup(layer), soup(copy), 1e-6);
  EXPECT_LT(stats.triangles_tested, 60 * stats.closest_point_queries);
  EXPECT_LT(stats.triangles_tested, 100'000u);
}

/// As where one of two meshes has lost its offset: floats do not tell the boxes of the other one apart from there.
TEST(CellWalking, FarFromTheOtherMeshLooksAtFewOfItsTriangles) {
  const TriangleMesh sphere = icosphere(5);
  const DistanceStats stats = measured(sphere, moved(sphere, {3e6, 1e6, 2e6}), 1e-3);
  EXPECT_LT(stats.triangles_tested, 1000 * stats.closest_point_queries);
}

TEST(CellWalking, WhatTheWalkLeavesIsSubdivided) {
  const Bvh tree(both(unit_square(4), moved(unit_square(3), {0.05, 0.02, 0.7})));
  Goal goal;
  goal.error_bound = 1e-6;
  set_slack(goal, 1, 0);
  ProvenBounds bounds(tree.data(), goal);
  Subdivision subdivision(bounds);
  Piece piece;
  for (const Vec3& corner : {Vec3{-0.2, -0.3, -0.3}, Vec3{0.3, -0.3, 0}, Vec3{0.3, 0.1, 0.2}, Vec3{0, 0.3, 0.25}})
    piece.add(corner);
  piece.pad();
  piece.depth = 90;
  EXPECT_LT(subdivision.refine(piece, 4, 1'000'000), 1'000'000u);
  EXPECT_EQ(bounds.counters().given_up, 0u);
  EXPECT_GT(bounds.counters().cuts, 0u);
  EXPECT_GT(bounds.counters().deepest, piece.depth);
  EXPECT_LE(std::sqrt(bounds.upper_squared()), bounds.lower().lower + goal.error_bound);
}

}  // namespace cell_walker_test
}  // namespace meshbound
