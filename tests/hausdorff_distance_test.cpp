// SPDX-License-Identifier: MIT
// H(A,B) = max(h(A,B), h(B,A)), and the decision H(A,B) <= tolerance.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/level_checker.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/tiles.h"
#include "reference/brute_force.h"
#include "reference/claims.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace hausdorff_distance_test {

using Eigen::Vector3d;
using namespace reference;

void expect_is_maximum(const HausdorffDistance& result) {
  EXPECT_EQ(result.bounds.lower, std::max(result.a_to_b.bounds.lower, result.b_to_a.bounds.lower));
  EXPECT_EQ(result.bounds.upper, std::max(result.a_to_b.bounds.upper, result.b_to_a.bounds.upper));
}

void expect_distance(const TriangleMesh& a, const TriangleMesh& b, const Bounds& truth) {
  const Bvh tree_a(a), tree_b(b);
  const HausdorffDistance result = hausdorff_distance(tree_a, tree_b);
  expect_meets(result.bounds, truth);
  expect_is_maximum(result);
  // A direction stops where it is known to be below the other; what it has found by then is realised all the same.
  expect_witness(a, b, result.a_to_b);
  expect_witness(b, a, result.b_to_a);
  const double size = std::max(bounding_box_diagonal(both(a, b)), truth.upper);
  EXPECT_LE(result.bounds.upper - result.bounds.lower, std::max(1e-6 * bounding_box_diagonal(a), 4e-12 * size));

  const double step = 1e-7 * size;
  EXPECT_EQ(check_tolerance(tree_a, tree_b, truth.upper + step).verdict, Verdict::Within);
  if (truth.lower > step) {
    EXPECT_EQ(check_tolerance(tree_a, tree_b, truth.lower - step).verdict, Verdict::Exceeds);
  }
  DistanceOptions at_most;
  at_most.budget.subdivisions = 20000;
  EXPECT_NE(check_tolerance(tree_a, tree_b, truth.upper, at_most).verdict, Verdict::Exceeds);
}

Bounds about(double value) { return {value * (1 - 1e-15), value * (1 + 1e-15)}; }

/// A mesh that is near everywhere in one direction, far in the other: the far one comes first and bounds the rest.
TEST(HausdorffDistance, SearchesFirstWhereVerticesAreFarther) {
  const TriangleMesh triangle = single_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), large = random_soup(3, 2000, 3);
  const Bvh tree_a(triangle), tree_b(large);
  for (const HausdorffDistance& result : {hausdorff_distance(tree_a, tree_b), hausdorff_distance(tree_b, tree_a)}) {
    EXPECT_LT(result.a_to_b.stats.closest_point_queries + result.b_to_a.stats.closest_point_queries, 1000u);
    EXPECT_EQ(result.a_to_b.outcome, Outcome::Converged);
    EXPECT_EQ(result.b_to_a.outcome, Outcome::Converged);
  }
}

TEST(HausdorffDistance, IsTheLargerDirection) {
  expect_distance(cube(1), cube(2), about(std::numbers::sqrt3));
  expect_distance(cube(2), cube(1), about(std::numbers::sqrt3));
  const TriangleMesh plane = unit_square(4);
  expect_distance(plane, both(plane, moved(plane, {0, 0, 0.5})), {0.5, 0.5});
  expect_distance(both(plane, moved(plane, {0, 0, 0.5})), plane, {0.5, 0.5});
}

/// The mesh with its vertices numbered, its triangles ordered and their corners rotated differently.
TriangleMesh renumbered(const TriangleMesh& mesh) {
  TriangleMesh result;
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  result.vertices.assign(mesh.vertices.rbegin(), mesh.vertices.rend());
  for (auto t = mesh.triangles.rbegin(); t != mesh.triangles.rend(); ++t)
    result.triangles.push_back({n - 1 - (*t)[2], n - 1 - (*t)[0], n - 1 - (*t)[1]});
  return result;
}

TEST(HausdorffDistance, OfMeshesOfTheSameTrianglesIsZeroWithoutTrees) {
  const TriangleMesh soup = random_soup(5, 300, 0.4);
  for (const TriangleMesh& mesh : {icosphere(3), soup, both(soup, cube(1))}) {
    for (const TriangleMesh& twin : {mesh, renumbered(mesh)}) {
      EXPECT_TRUE(same_surface(mesh, twin));
      const HausdorffDistance result = hausdorff_distance(mesh, twin);
      EXPECT_EQ(result.bounds.upper, 0);
      EXPECT_EQ(result.a_to_b.stats.nodes_visited, 0U);
      expect_witness(mesh, twin, result.a_to_b);
      expect_witness(twin, mesh, result.b_to_a);
    }
  }
}

TEST(HausdorffDistance, OfMeshesWithOneOtherTriangleIsThatOfTheirTrees) {
  const TriangleMesh mesh = icosphere(3);
  TriangleMesh nudged = renumbered(mesh), repeated = mesh, doubled = both(mesh, mesh), missing = doubled;
  nudged.vertices[7].x() = std::nextafter(nudged.vertices[7].x(), 2.0);
  repeated.triangles[5] = repeated.triangles[900];
  missing.triangles[5] = missing.triangles[900];  // its twin of the second half is still there
  for (TriangleMesh* m : {&doubled, &missing})
    std::rotate(m->triangles.begin(), m->triangles.begin() + 7, m->triangles.end());
  EXPECT_FALSE(same_surface(mesh, nudged));
  EXPECT_FALSE(same_surface(mesh, repeated));
  EXPECT_FALSE(same_surface(repeated, mesh));
  EXPECT_TRUE(same_surface(doubled, missing));
  const HausdorffDistance whole = hausdorff_distance(mesh, repeated),
                          trees = hausdorff_distance(Bvh(mesh), Bvh(repeated));
  EXPECT_GT(whole.bounds.lower, 0);
  EXPECT_EQ(whole.bounds.lower, trees.bounds.lower);
  EXPECT_EQ(whole.bounds.upper, trees.bounds.upper);
  DistanceOptions negative;
  negative.error_bound = -1;
  EXPECT_THROW((void)hausdorff_distance(mesh, mesh, negative), InvalidInput);
  EXPECT_THROW((void)same_surface(mesh, TriangleMesh{}), InvalidInput);
}

/// Corner k of each triangle moved by up to `most` in each coordinate, where vertices are shared by all of them alike.
TriangleMesh jittered(TriangleMesh mesh, double most) {
  unsigned state = 1;
  const auto next = [&] {
    return most * (static_cast<double>((state = 1664525 * state + 1013904223) >> 8) * 0x1p-23 - 1);
  };
  for (Vector3d& p : mesh.vertices) p += Vector3d(next(), next(), next());
  return mesh;
}

/// The mesh with vertices of its own for each triangle, in the same order, corners rotated by one, two or none.
TriangleMesh with_own_vertices(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(3 * i);
    for (std::size_t k = 0; k < 3; ++k) result.vertices.push_back(mesh.vertices[mesh.triangles[i][(k + i) % 3]]);
    result.triangles.push_back({first, first + 1, first + 2});
    if (i % 2 == 0) std::swap(result.triangles.back()[0], result.triangles.back()[1]);
  }
  return result;
}

double largest_move(const TriangleMesh& a, const TriangleMesh& b) {
  double most = 0;
  for (std::size_t v = 0; v < a.vertices.size(); ++v) most = std::max(most, (a.vertices[v] - b.vertices[v]).norm());
  return most;
}

TEST(WithoutTrees, MovedCornersBoundTheDistance) {
  for (const TriangleMesh& mesh : {icosphere(3), cube(1), random_soup(7, 300, 0.3)}) {
    for (const double most : {1e-3, 1e-9, 1e-14}) {
      const TriangleMesh copy = jittered(mesh, most);
      for (const TriangleMesh& other : {copy, with_own_vertices(copy)}) {
        const double move = largest_move(mesh, copy);
        const auto result = distance_without_trees(mesh, other, move * (1 + 1e-12));
        ASSERT_TRUE(result);
        EXPECT_GE(result->bounds.upper, move);
        EXPECT_LE(result->bounds.upper, move * (1 + 1e-12));
        expect_is_maximum(*result);
        const Bounds trees = hausdorff_distance(Bvh(mesh), Bvh(other)).bounds;
        EXPECT_LE(trees.lower, result->bounds.upper);
        EXPECT_GE(trees.upper, result->bounds.lower);
        expect_witness(mesh, other, result->a_to_b);
        expect_witness(other, mesh, result->b_to_a);
        EXPECT_FALSE(distance_without_trees(mesh, other, move * (1 - 1e-12)));
      }
    }
  }
}

TEST(WithoutTrees, OneCornerFurtherThanTheLimitIsNotOverlooked) {
  const TriangleMesh mesh = icosphere(3);
  for (const std::size_t moved : {std::size_t{0}, 3 * mesh.triangles.size() - 1}) {
    TriangleMesh other = with_own_vertices(jittered(mesh, 1e-9));
    other.vertices[moved] *= 1.01;
    EXPECT_FALSE(distance_without_trees(mesh, other, 1e-6));
    EXPECT_NEAR(hausdorff_distance(mesh, other).bounds.upper, 0.01, 1e-5);
  }
  EXPECT_FALSE(distance_without_trees(mesh, both(mesh, mesh), 1));
}

TEST(WithoutTrees, BoundsHoldAtAnyScale) {
  for (const double scale : {1e-290, 1e-160, 1e150, 1e290}) {
    const TriangleMesh mesh = scaled(icosphere(2), scale), other = moved(mesh, Vector3d(0, 0, 1e-9 * scale));
    const auto result = distance_without_trees(mesh, other, 1e-6 * scale);
    ASSERT_TRUE(result) << scale;
    const double move = mesh.vertices[0].z() - other.vertices[0].z();
    EXPECT_GE(result->bounds.upper, std::abs(move)) << scale;
    EXPECT_LE(result->bounds.upper, 2e-9 * scale) << scale;
    EXPECT_LE(result->bounds.lower, result->bounds.upper) << scale;
  }
}

TEST(WithoutTrees, DecisionOfMeshesIsThatOfTheirTrees) {
  const TriangleMesh mesh = icosphere(3), near = jittered(mesh, 1e-9), far = moved(mesh, {0, 0, 0.5});
  EXPECT_EQ(check_tolerance(mesh, mesh, 0).verdict, Verdict::Within);
  const ToleranceCheck within = check_tolerance(mesh, near, 1e-8);
  EXPECT_EQ(within.verdict, Verdict::Within);
  EXPECT_LE(within.bounds.upper, 2e-9);
  EXPECT_EQ(check_tolerance(mesh, near, 1e-11).verdict, Verdict::Exceeds);
  EXPECT_EQ(check_tolerance(mesh, far, 0.4).verdict, check_tolerance(Bvh(mesh), Bvh(far), 0.4).verdict);
  EXPECT_THROW((void)check_tolerance(mesh, near, -1), InvalidInput);
  EXPECT_THROW((void)distance_without_trees(TriangleMesh{}, TriangleMesh{}, 1), InvalidInput);
  for (const double limit : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)distance_without_trees(mesh, mesh, limit), InvalidInput);
  EXPECT_THROW((void)check_tolerance(mesh, TriangleMesh{}, 1), InvalidInput);
  TriangleMesh astray = mesh;
  astray.triangles[3][1] = 1000000000;
  EXPECT_THROW((void)hausdorff_distance(astray, mesh), InvalidInput);
  EXPECT_THROW((void)hausdorff_distance(mesh, astray), InvalidInput);
}

TEST(HausdorffDistance, OfConcentricSpheresIsTheGapUpToFaceting) {
  const TriangleMesh sphere = icosphere(3);
  expect_distance(sphere, scaled(sphere, 2), {1 - 1e-14, 2 - inscribed_radius(sphere) * (1 - 1e-14)});
}

TEST(HausdorffDistance, OfIdenticalMeshesIsExactlyZero) {
  for (const TriangleMesh& mesh : {cube(1), icosphere(4), random_soup(3, 300, 0.2)}) {
    const HausdorffDistance result = hausdorff_distance(Bvh(mesh), Bvh(mesh));
    EXPECT_EQ(result.bounds.lower, 0);
    EXPECT_EQ(result.bounds.upper, 0);
    EXPECT_EQ(check_tolerance(Bvh(mesh), Bvh(mesh), 0).verdict, Verdict::Within);
  }
}

TEST(HausdorffDistance, SeesAMissingPart) {
  const TriangleMesh whole = both(cube(1), moved(cube(0.125), {0, 0, 4}));
  const double furthest = std::sqrt(3.125 * 3.125);
  expect_distance(whole, cube(1), about(furthest));
  expect_distance(cube(1), whole, about(furthest));
}

TEST(HausdorffDistance, OfRandomSoupsAgreesWithBruteForce) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh a = random_soup(seed + 2000, 1 + static_cast<int>(seed % 11), 0.4);
    const TriangleMesh b = random_soup(seed + 3000, 1 + static_cast<int>(seed % 7), 0.4);
    expect_distance(a, b, brute_force_symmetric(a, b, 1e-4));
  }
}

TEST(HausdorffDistance, DoesNotDependOnTheOrderOfTheModels) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Bvh a(random_soup(seed, 200, 0.3)), b(random_soup(seed + 99, 150, 0.3));
    expect_meets(hausdorff_distance(a, b).bounds, hausdorff_distance(b, a).bounds);
  }
}

TEST(HausdorffDistance, HonoursTheErrorBound) {
  const Bvh a(random_soup(11, 60, 0.3)), b(random_soup(12, 80, 0.3));
  for (int digits = 2; digits <= 9; ++digits) {
    DistanceOptions options;
    options.error_bound = std::pow(10.0, -digits) * a.bounding_box_diagonal();
    const HausdorffDistance result = hausdorff_distance(a, b, options);
    EXPECT_LE(result.bounds.upper - result.bounds.lower, *options.error_bound);
  }
}

TEST(HausdorffDistance, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh a = icosphere(4), b = random_soup(13, 500, 0.3);
  DistanceOptions one, two;
  one.threads = 1;
  two.threads = 2;
  const HausdorffDistance x = hausdorff_distance(Bvh(a, {1}), Bvh(b, {1}), one);
  const HausdorffDistance y = hausdorff_distance(Bvh(a, {2}), Bvh(b, {2}), two);
  EXPECT_EQ(x.bounds.lower, y.bounds.lower);
  EXPECT_EQ(x.bounds.upper, y.bounds.upper);
  EXPECT_EQ(x.a_to_b.witness.from.position, y.a_to_b.witness.from.position);
  EXPECT_EQ(x.b_to_a.witness.from.position, y.b_to_a.witness.from.position);
}

/// Builds and searches form teams of their own, whatever the caller's threads do meanwhile.
TEST(HausdorffDistance, IsTheSameOnThreadsOfTheCallersOwn) {
  const TriangleMesh a = icosphere(5), b = random_soup(13, 5000, 0.3);
  DistanceOptions options;
  options.threads = 2;
  const HausdorffDistance alone = hausdorff_distance(a, b, options);
  std::atomic<int> same{0};
#pragma omp parallel num_threads(3)
  {
#pragma omp for
    for (int i = 0; i < 6; ++i) {
      const HausdorffDistance here = hausdorff_distance(a, b, options);
      if (here.bounds.lower == alone.bounds.lower && here.bounds.upper == alone.bounds.upper) ++same;
    }
#pragma omp single
    for (int i = 0; i < 6; ++i) {
#pragma omp task shared(a, b, options, alone, same)
      {
        const HausdorffDistance here = hausdorff_distance(a, b, options);
        if (here.bounds.lower == alone.bounds.lower && here.bounds.upper == alone.bounds.upper) ++same;
      }
    }
  }
  EXPECT_EQ(same, 12);
}

TEST(CheckTolerance, DecidesOnBothSidesOfTheDistance) {
  const TriangleMesh a = random_soup(23, 40, 0.3), b = random_soup(24, 40, 0.3);
  const Bvh tree_a(a), tree_b(b);
  DistanceOptions tight;
  tight.error_bound = 1e-10;
  const Bounds truth = hausdorff_distance(tree_a, tree_b, tight).bounds;
  for (const double factor : {1e-8, 1e-5, 1e-2, 0.5}) {
    const ToleranceCheck within = check_tolerance(tree_a, tree_b, truth.upper * (1 + factor));
    EXPECT_EQ(within.verdict, Verdict::Within);
    EXPECT_LE(within.bounds.upper, within.tolerance);
    EXPECT_GE(within.bounds.upper, truth.lower);
    const ToleranceCheck exceeds = check_tolerance(tree_a, tree_b, truth.lower * (1 - factor));
    EXPECT_EQ(exceeds.verdict, Verdict::Exceeds);
    EXPECT_GT(exceeds.bounds.lower, exceeds.tolerance);
    EXPECT_LE(exceeds.bounds.lower, truth.upper);
    EXPECT_GE(exceeds.bounds.upper, truth.lower) << "a direction that was not finished has no upper bound yet";
  }
}

TEST(CheckTolerance, LooksAtBothDirections) {
  const TriangleMesh part = unit_square(2);
  const TriangleMesh whole = both(part, moved(part, {0, 0, 1}));
  EXPECT_EQ(check_tolerance(Bvh(part), Bvh(whole), 0.5).verdict, Verdict::Exceeds);
  EXPECT_EQ(check_tolerance(Bvh(whole), Bvh(part), 0.5).verdict, Verdict::Exceeds);
  EXPECT_EQ(check_one_sided_tolerance(Bvh(part), Bvh(whole), 0.5).verdict, Verdict::Within);
}

TEST(CheckTolerance, DoesNotSearchBackWhenForwardExceeds) {
  const ToleranceCheck result = check_tolerance(Bvh(cube(2)), Bvh(cube(1)), 0.5);
  EXPECT_EQ(result.verdict, Verdict::Exceeds);
  EXPECT_EQ(result.b_to_a.bounds.lower, 0);
  EXPECT_EQ(result.b_to_a.bounds.upper, std::numeric_limits<double>::infinity());
}

TEST(CheckTolerance, IsUndecidedWhenABudgetRunsOut) {
  const Bvh a(icosphere(3)), b(random_soup(31, 60, 0.5));
  const Bounds truth = hausdorff_distance(a, b).bounds;
  std::atomic<bool> cancelled = true;
  DistanceOptions no_time, cancel;
  no_time.budget.seconds = 0;
  cancel.cancel = &cancelled;
  for (const DistanceOptions& options : {no_time, cancel}) {
    const ToleranceCheck result = check_tolerance(a, b, truth.upper, options);
    EXPECT_EQ(result.verdict, Verdict::Undecided);
    expect_meets(result.bounds, truth);
    expect_meets(hausdorff_distance(a, b, options).bounds, truth);
  }
}

/// Building the trees counts as well.
TEST(CheckTolerance, OfMeshesEndsWithTheirTrees) {
  const TriangleMesh a = icosphere(3), b = random_soup(31, 60, 0.5);
  std::atomic<bool> cancelled = true;
  DistanceOptions no_time, cancel;
  no_time.budget.seconds = 0;
  cancel.cancel = &cancelled;
  LevelChecker checker(a);
  for (const DistanceOptions& options : {no_time, cancel}) {
    for (const HausdorffDistance& unknown : {hausdorff_distance(a, b, options), checker.measure(b, options)}) {
      EXPECT_EQ(unknown.bounds.lower, 0);
      EXPECT_EQ(unknown.bounds.upper, std::numeric_limits<double>::infinity());
      EXPECT_EQ(unknown.a_to_b.outcome, Outcome::BudgetExhausted);
    }
    const OneSidedDistance one_sided = one_sided_hausdorff_distance(a, b, options);
    EXPECT_EQ(one_sided.bounds.upper, std::numeric_limits<double>::infinity());
    EXPECT_EQ(one_sided.outcome, Outcome::BudgetExhausted);
    EXPECT_EQ(check_tolerance(a, b, 1, options).verdict, Verdict::Undecided);
    EXPECT_EQ(check_one_sided_tolerance(a, b, 1, options).verdict, Verdict::Undecided);
    EXPECT_EQ(checker.check(b, 1, options).verdict, Verdict::Undecided);
  }
  EXPECT_LT(checker.measure(b).bounds.upper, 10);
}

/// A sheet of two triangles inside a larger one: equally many triangles, so that they are compared without trees first.
TEST(CheckTolerance, OfMeshesInOneDirection) {
  const auto sheet = [](double size) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
  };
  const TriangleMesh small = sheet(1), large = sheet(2);
  EXPECT_LE(one_sided_hausdorff_distance(small, large).bounds.upper, 1e-5);
  EXPECT_NEAR(one_sided_hausdorff_distance(large, small).bounds.lower, std::sqrt(2.0), 1e-5);
  for (const double tolerance : {0.5, 2.0}) {  // 2: told by the corners, which correspond in order
    const ToleranceCheck check = check_one_sided_tolerance(small, large, tolerance);
    EXPECT_EQ(check.verdict, Verdict::Within);
    EXPECT_EQ(check.bounds.lower, 0);
    EXPECT_EQ(check.b_to_a.bounds.upper, std::numeric_limits<double>::infinity());
  }
  EXPECT_EQ(check_one_sided_tolerance(large, small, 0.5).verdict, Verdict::Exceeds);
  EXPECT_THROW((void)check_one_sided_tolerance(small, large, -1), InvalidInput);
}

/// Their squares are beyond the numbers there are.
TEST(CheckTolerance, IsWithinTolerancesOfAnySize) {
  const TriangleMesh a = icosphere(2), b = random_soup(3, 40, 0.3);
  const Bvh tree_a(a), tree_b(b);
  for (const double tolerance : {1e10, 1e155, 1e308, std::numeric_limits<double>::infinity()}) {
    const ToleranceCheck check = check_tolerance(tree_a, tree_b, tolerance);
    EXPECT_EQ(check.verdict, Verdict::Within) << tolerance;
    EXPECT_TRUE(std::isfinite(check.bounds.upper)) << tolerance;
    DistanceOptions options;
    options.error_bound = options.tolerance = tolerance;
    for (const Bounds& bounds : {hausdorff_distance(tree_a, tree_b, options).bounds,
                                 hausdorff_distance_in_tiles(a, b, options, {64}).bounds}) {
      EXPECT_LE(bounds.lower, 10);
      EXPECT_TRUE(std::isfinite(bounds.upper)) << tolerance;
    }
  }
}

/// Early or late, before the first step or in the middle of one: several threads are at work.
TEST(HausdorffDistance, HoldsWhenAnotherThreadCancelsIt) {
  const Bvh a(icosphere(5)), b(random_soup(37, 5000, 0.3));
  const Bounds truth = hausdorff_distance(a, b).bounds;
  for (int microseconds = 1; microseconds < 50000; microseconds *= 2) {
    std::atomic<bool> cancelled = false;
    DistanceOptions options;
    options.threads = 3;
    options.error_bound = 1e-10;
    options.cancel = &cancelled;
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
      cancelled = true;
    });
    const HausdorffDistance result = hausdorff_distance(a, b, options);
    other.join();
    expect_meets(result.bounds, truth);
  }
}

TEST(CheckTolerance, RefusesAToleranceThatIsNotOne) {
  EXPECT_THROW((void)check_tolerance(Bvh(cube(1)), Bvh(cube(1)), -1.0), InvalidInput);
  EXPECT_THROW((void)check_tolerance(Bvh(cube(1)), Bvh(cube(1)), std::nan("")), InvalidInput);
}

}  // namespace hausdorff_distance_test
}  // namespace meshbound
