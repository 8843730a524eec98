// SPDX-License-Identifier: MIT
// h(A,B): known answers, random soups against brute force, and the promises about bounds, witness and budgets.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/proximity.h"
#include "meshbound/transform.h"
#include "reference/brute_force.h"
#include "reference/claims.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace one_sided_hausdorff_distance_test {

using Eigen::Vector3d;
using namespace reference;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A number known up to rounding of the test's own arithmetic.
Bounds about(double value) { return {value * (1 - 1e-15), value * (1 + 1e-15)}; }
Bounds exactly(double value) { return {value, value}; }

/// Measures, checks interval, width and witness, then asks for a decision on either side of the truth.
void expect_distance(const TriangleMesh& a, const TriangleMesh& b, const Bounds& truth) {
  const Bvh tree_a(a), tree_b(b);
  const OneSidedDistance result = one_sided_hausdorff_distance(tree_a, tree_b);
  expect_meets(result.bounds, truth);
  expect_witness(a, b, result);
  const double size = std::max(bounding_box_diagonal(both(a, b)), truth.upper);
  const double error_bound = 1e-6 * bounding_box_diagonal(a);
  EXPECT_LE(result.bounds.upper - result.bounds.lower, std::max(error_bound, 4e-12 * size));

  const double step = 1e-7 * size;
  EXPECT_EQ(check_one_sided_tolerance(tree_a, tree_b, truth.upper + step).verdict, Verdict::Within);
  if (truth.lower > step) {
    EXPECT_EQ(check_one_sided_tolerance(tree_a, tree_b, truth.lower - step).verdict, Verdict::Exceeds);
  }
  DistanceOptions at_most;
  at_most.budget.subdivisions = 20000;
  const Verdict at_equality = check_one_sided_tolerance(tree_a, tree_b, truth.upper, at_most).verdict;
  EXPECT_NE(at_equality, Verdict::Exceeds) << "no point is further than the distance";
}

TriangleMesh point(const Vector3d& at) { return single_triangle(at, at, at); }
TriangleMesh segment(const Vector3d& from, const Vector3d& to) { return single_triangle(from, to, to); }

TEST(OneSidedDistance, OfAShiftedPlaneIsTheShift) {
  const TriangleMesh plane = unit_square(5);
  expect_distance(plane, moved(plane, {0, 0, 0.25}), exactly(0.25));
  expect_distance(moved(plane, {0, 0, 0.25}), plane, exactly(0.25));
  expect_distance(unit_square(3), moved(unit_square(7), {0, 0, -0.5}), exactly(0.5));
  expect_distance(unit_square(4), moved(unit_square(4), {0.25, 0, 0}), exactly(0.25));
}

TEST(OneSidedDistance, OfConcentricSpheresIsTheGapUpToFaceting) {
  const TriangleMesh sphere = icosphere(3);
  const double inscribed = inscribed_radius(sphere) * (1 - 1e-14);
  expect_distance(scaled(sphere, 2), sphere, {1 - 1e-14, 2 - inscribed});
  // Where the inner mesh dips to its inscribed radius, the outer one is at least 2 * inscribed from the centre.
  const Bounds inner_to_outer = {inscribed, 2 - inscribed};
  const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(sphere), Bvh(scaled(sphere, 2)));
  expect_meets(result.bounds, inner_to_outer);
  expect_witness(sphere, scaled(sphere, 2), result);
}

TEST(OneSidedDistance, OfNestedCubesDiffersByDirection) {
  expect_distance(cube(1), cube(2), exactly(1));
  expect_distance(cube(2), cube(1), about(std::numbers::sqrt3));
}

TEST(OneSidedDistance, OfOverlappingCubes) {
  expect_distance(cube(1), moved(cube(1), {0.5, 0, 0}), exactly(0.5));
  expect_distance(moved(cube(1), {0, 0.25, 0}), cube(1), exactly(0.25));
}

TEST(OneSidedDistance, OfDisjointCubes) {
  expect_distance(cube(1), moved(cube(1), {8, 0, 0}), exactly(8));
  expect_distance(cube(1), moved(cube(1), {8, 8, 8}), about(8 * std::numbers::sqrt3));
}

TEST(OneSidedDistance, OfVeryFarModels) {
  for (const double far : {0x1p30, 1e12, 0x1p70, 0x1p300}) {
    const Bounds truth = {far - 2, far + 2};
    // Without a budget: the default error bound is out of reach here, and the search has to see that by itself.
    const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(cube(1)), Bvh(moved(cube(1), {far, 0, 0})));
    expect_meets(result.bounds, truth);
    EXPECT_LE(result.bounds.upper - result.bounds.lower, 1e-6 + 4e-12 * far);
    EXPECT_EQ(check_one_sided_tolerance(Bvh(cube(1)), Bvh(moved(cube(1), {far, 0, 0})), far / 2).verdict,
              Verdict::Exceeds);
    EXPECT_EQ(check_one_sided_tolerance(Bvh(cube(1)), Bvh(moved(cube(1), {far, 0, 0})), far * 2).verdict,
              Verdict::Within);
  }
}

TEST(OneSidedDistance, ToThreePointsIsTheCircumradius) {
  // Every vertex is at distance 0; the furthest point is the circumcentre (2, 5/6), inside the triangle.
  const Vector3d a(0, 0, 0), b(4, 0, 0), c(2, 3, 0);
  const TriangleMesh corners_only = both(both(point(a), point(b)), point(c));
  expect_distance(single_triangle(a, b, c), corners_only, about(13.0 / 6));
  // A right angle moves it to the middle of the longest edge, an obtuse one further along.
  const Vector3d d(6, 0, 0), e(0, 8, 0);
  expect_distance(single_triangle(a, d, e), both(both(point(a), point(d)), point(e)), exactly(5));
}

TEST(OneSidedDistance, OfOneTriangleOverThreeSmallOnes) {
  // Small triangles at the corners of a large one: the vertices are covered, the interior is not.
  const Vector3d a(0, 0, 0), b(4, 0, 0), c(2, 3, 0);
  const TriangleMesh large = single_triangle(a, b, c);
  const auto shrunk_at = [&](const Vector3d& corner) {
    const double s = 0.125;
    return single_triangle(corner + s * (a - corner), corner + s * (b - corner), corner + s * (c - corner));
  };
  const TriangleMesh small = both(both(shrunk_at(a), shrunk_at(b)), shrunk_at(c));
  const Bounds truth = brute_force_one_sided(large, small, 1e-3);
  EXPECT_GT(truth.lower, 1.4);
  expect_distance(large, small, truth);
  expect_distance(small, large, exactly(0));
}

TEST(OneSidedDistance, IsFoundInTheInteriorOfATriangleBetweenTwoPlanes) {
  // A crosses the gap between the planes z = 0 and z = 2: its furthest points are where z = 1, none of them a vertex.
  const TriangleMesh planes = both(scaled(unit_square(1), 8), moved(scaled(unit_square(1), 8), {0, 0, 2}));
  expect_distance(single_triangle({3, 3, 0}, {5, 3, 2}, {4, 5, 0}), planes, exactly(1));
  // Not even an edge: all three corners on the planes z = 0, but over a hole.
  const TriangleMesh frame = soup({{Vector3d(-9, -9, 0), {9, -9, 0}, {9, -3, 0}},
                                   {Vector3d(-9, -9, 0), {9, -3, 0}, {-9, -3, 0}},
                                   {Vector3d(-9, 3, 0), {9, 3, 0}, {9, 9, 0}},
                                   {Vector3d(-9, 3, 0), {9, 9, 0}, {-9, 9, 0}}});
  expect_distance(single_triangle({-8, -8, 0}, {8, -8, 0}, {0, 8, 0}), frame, exactly(3));
}

TEST(OneSidedDistance, OfIdenticalMeshesIsExactlyZero) {
  for (const TriangleMesh& mesh : {cube(1), icosphere(3), random_soup(3, 200, 0.3), unit_square(9), point({1, 2, 3})}) {
    TriangleMesh shuffled = mesh;
    std::reverse(shuffled.triangles.begin(), shuffled.triangles.end());
    for (Triangle& t : shuffled.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
    for (const TriangleMesh& copy : {mesh, shuffled}) {
      const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(mesh), Bvh(copy));
      EXPECT_EQ(result.bounds.lower, 0);
      EXPECT_EQ(result.bounds.upper, 0);
      EXPECT_EQ(check_one_sided_tolerance(Bvh(mesh), Bvh(copy), 0).verdict, Verdict::Within);
    }
  }
}

TEST(OneSidedDistance, FindsTrianglesThatBothMeshesHave) {
  const TriangleMesh original = icosphere(1);
  TriangleMesh other = original;
  std::reverse(other.triangles.begin(), other.triangles.end());
  for (Triangle& t : other.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
  for (Vector3d& p : other.vertices)
    for (double& x : p)
      if (x == 0) x = -x;
  const Bvh tree(original);
  EXPECT_EQ(one_sided_hausdorff_distance(tree, Bvh(other)).stats.matched, 80U);
  // A vertex at a side of the box would change the frame.
  const Triangle lost = other.triangles[11];
  other.triangles[11] = {lost[0], lost[1], lost[1]};
  EXPECT_EQ(one_sided_hausdorff_distance(tree, Bvh(other)).stats.matched, 79U);
}

TEST(OneSidedDistance, OfASubdividedCopyIsRounding) {
  for (const TriangleMesh& mesh : {cube(1), icosphere(2), random_soup(5, 50, 0.3)}) {
    for (const auto& [a, b] : {std::pair(mesh, subdivided(mesh)), std::pair(subdivided(subdivided(mesh)), mesh)}) {
      const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(a), Bvh(b));
      EXPECT_LE(result.bounds.lower, 1e-15);
      EXPECT_LE(result.bounds.upper, 2e-6 * bounding_box_diagonal(a));
    }
  }
}

TEST(OneSidedDistance, HoldsAtAnyScale) {
  for (const int exponent : {-1000, -531, -100, 0, 100, 515, 990}) {
    SCOPED_TRACE(exponent);
    const double s = std::ldexp(1.0, exponent);
    expect_distance(cube(s), cube(2 * s), exactly(s));
    expect_distance(cube(2 * s), cube(s), about(std::numbers::sqrt3 * s));
    expect_distance(scaled(unit_square(3), s), moved(scaled(unit_square(4), s), {0, 0, s / 8}), exactly(s / 8));
  }
}

TEST(OneSidedDistance, HoldsAtLargeOffsets) {
  for (const double offset : {0x1p20, 0x1p30, 0x1p40}) {
    SCOPED_TRACE(offset);
    const Vector3d by(offset, -offset, offset / 2);
    expect_distance(moved(cube(1), by), moved(cube(2), by), exactly(1));
    const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(moved(cube(2), by)), Bvh(moved(cube(1), by)));
    EXPECT_LE(result.bounds.lower, std::numbers::sqrt3 * (1 + 1e-15));
    EXPECT_GE(result.bounds.upper, std::numbers::sqrt3 * (1 - 1e-15));
    EXPECT_LE(result.bounds.upper - result.bounds.lower, 1e-5) << "coordinates must be centred";
  }
}

TEST(OneSidedDistance, IgnoresDuplicateAndDegenerateFaces) {
  TriangleMesh messy = both(cube(1), cube(1));
  messy.triangles.push_back({0, 0, 0});
  messy.triangles.push_back({0, 1, 1});
  messy.triangles.push_back({0, 1, 0});
  messy = both(messy, both(point({1, 0.25, 0.5}), segment({-1, 0, 0}, {-1, 0.5, 0.5})));
  messy = both(messy, single_triangle({1, 0, 0}, {1, 0.5, 0}, {1, 1, 0}));
  expect_distance(messy, cube(2), exactly(1));
  expect_distance(cube(2), messy, about(std::numbers::sqrt3));
  expect_distance(cube(1), messy, exactly(0));
  expect_distance(messy, cube(1), exactly(0));
}

TEST(OneSidedDistance, CountsADegenerateFaceThatSticksOut) {
  expect_distance(both(cube(1), point({0, 0, 3})), cube(1), exactly(2));
  expect_distance(both(cube(1), segment({0, 0, 1}, {0, 3, 5})), cube(1), about(std::sqrt(4.0 + 16.0)));
  expect_distance(moved(cube(1), {0, 0, 3}), both(moved(cube(1), {0, 0, 2}), point({1, 1, 4})), exactly(1));
}

TEST(OneSidedDistance, OfPointsAndSegments) {
  expect_distance(point({0, 0, 0}), point({3, 4, 0}), exactly(5));
  expect_distance(point({0, 0, 0}), cube(1), exactly(1));
  expect_distance(cube(1), point({0, 0, 0}), about(std::numbers::sqrt3));
  expect_distance(segment({0, 0, 0}, {1, 0, 0}), segment({0, 1, 0}, {1, 1, 0}), exactly(1));
  expect_distance(segment({0, 0, 0}, {4, 0, 0}), point({1, 0, 0}), exactly(3));
  // Between two points the furthest point of a segment is its middle.
  expect_distance(segment({0, 0, 0}, {4, 0, 0}), both(point({0, 0, 0}), point({4, 0, 0})), exactly(2));
}

TEST(OneSidedDistance, OfRandomSoupsAgreesWithBruteForce) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const double size = seed % 3 == 0 ? 0.05 : seed % 3 == 1 ? 0.3 : 1.0;
    const TriangleMesh a = random_soup(seed, 1 + static_cast<int>(seed % 13), size);
    const TriangleMesh b = random_soup(seed + 1000, 1 + static_cast<int>(seed % 17), size);
    expect_distance(a, b, brute_force_one_sided(a, b, 1e-4));
  }
}

TEST(OneSidedDistance, HoldsToTheLastBit) {
  // The distance to one triangle is convex, so h(A,B) is reached at a corner of A: known exactly.
  for (std::uint32_t seed = 0; seed < 1500 && !testing::Test::HasFailure(); ++seed) {
    const TriangleMesh a = random_soup(seed, 1, 0.3), b = random_soup(seed + 7000, 1, 0.5);
    DistanceOptions options;
    options.error_bound = seed % 2 == 0 ? 0 : 1e-3;
    options.threads = 1;
    const Bounds bounds = one_sided_hausdorff_distance(Bvh(a, {1}), Bvh(b, {1}), options).bounds;
    ExactLength truth = exact_distance(a.vertices[0], b);
    for (const Vector3d& v : a.vertices) truth = std::max(truth, exact_distance(v, b));
    EXPECT_LE(truth.compare(bounds.upper), 0) << seed;
    EXPECT_GE(truth.compare(bounds.lower), 0) << seed;
  }
}

TEST(OneSidedDistance, OfAPerturbedCopyAgreesWithBruteForce) {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh a = icosphere(1);
    const TriangleMesh noise = random_soup(seed, static_cast<int>(a.vertices.size()), 0.0);
    TriangleMesh b = a;
    for (std::size_t i = 0; i < b.vertices.size(); ++i) b.vertices[i] += 0.05 * noise.vertices[3 * i];
    expect_distance(a, b, brute_force_one_sided(a, b, 1e-4));
  }
}

TEST(OneSidedDistance, HonoursTheErrorBound) {
  const std::vector<std::pair<TriangleMesh, TriangleMesh>> pairs = {
      {icosphere(3), icosphere(2)},
      {cube(2), cube(1)},
      {unit_square(6), random_soup(7, 40, 0.2)},
      {random_soup(8, 40, 0.4), random_soup(9, 30, 0.4)},
  };
  for (const auto& [a, b] : pairs) {
    const Bvh tree_a(a), tree_b(b);
    Bounds tightest = {0, infinity};
    for (int digits = 2; digits <= 9; ++digits) {
      SCOPED_TRACE(digits);
      DistanceOptions options;
      options.error_bound = std::pow(10.0, -digits) * tree_a.bounding_box_diagonal();
      const OneSidedDistance result = one_sided_hausdorff_distance(tree_a, tree_b, options);
      EXPECT_EQ(result.outcome, Outcome::Converged);
      EXPECT_LE(result.bounds.upper - result.bounds.lower, *options.error_bound);
      expect_meets(result.bounds, tightest);
      tightest = {std::max(tightest.lower, result.bounds.lower), std::min(tightest.upper, result.bounds.upper)};
    }
  }
}

TEST(OneSidedDistance, WithAZeroErrorBoundEndsAtThePrecisionOfDoubles) {
  DistanceOptions options;
  options.error_bound = 0;
  options.budget.subdivisions = 1000000;
  const OneSidedDistance result = one_sided_hausdorff_distance(Bvh(cube(2)), Bvh(cube(1)), options);
  expect_meets(result.bounds, about(std::numbers::sqrt3));
  EXPECT_LE(result.bounds.upper - result.bounds.lower, 1e-11);
}

TEST(CheckOneSidedTolerance, DecidesOnBothSidesOfTheDistance) {
  const TriangleMesh a = random_soup(21, 30, 0.3), b = random_soup(22, 30, 0.3);
  const Bvh tree_a(a), tree_b(b);
  DistanceOptions tight;
  tight.error_bound = 1e-10;
  const Bounds truth = one_sided_hausdorff_distance(tree_a, tree_b, tight).bounds;
  expect_meets(truth, brute_force_one_sided(a, b, 1e-3));
  for (const double factor : {1e-9, 1e-6, 1e-3, 0.1, 0.9}) {
    const ToleranceCheck within = check_one_sided_tolerance(tree_a, tree_b, truth.upper * (1 + factor));
    EXPECT_EQ(within.verdict, Verdict::Within) << factor;
    EXPECT_LE(within.bounds.upper, truth.upper * (1 + factor));
    EXPECT_GE(within.bounds.upper, truth.lower);
    const ToleranceCheck exceeds = check_one_sided_tolerance(tree_a, tree_b, truth.lower * (1 - factor));
    EXPECT_EQ(exceeds.verdict, Verdict::Exceeds) << factor;
    EXPECT_EQ(exceeds.a_to_b.outcome, Outcome::ExceedsTolerance);
    EXPECT_GT(exceeds.bounds.lower, truth.lower * (1 - factor));
    EXPECT_LE(exceeds.bounds.lower, truth.upper);
    expect_witness(a, b, exceeds.a_to_b);
  }
}

TEST(CheckOneSidedTolerance, EndsAtEqualityWithoutABudget) {
  const TriangleMesh square = unit_square(5);
  const ToleranceCheck check = check_one_sided_tolerance(Bvh(square), Bvh(moved(square, {0, 0, 0.25})), 0.25);
  EXPECT_NE(check.verdict, Verdict::Exceeds);
  EXPECT_LE(check.bounds.lower, 0.25);
  EXPECT_GE(check.bounds.upper, 0.25);
  EXPECT_LE(check.bounds.upper, 0.25 + 1e-11);
}

TEST(Budgets, LeaveValidBounds) {
  const TriangleMesh a = icosphere(3), b = random_soup(31, 60, 0.5);
  const Bvh tree_a(a), tree_b(b);
  const Bounds truth = one_sided_hausdorff_distance(tree_a, tree_b).bounds;
  std::atomic<bool> cancelled = true;
  DistanceOptions no_time, no_subdivisions, cancel;
  no_time.budget.seconds = 0;
  no_subdivisions.budget.subdivisions = 0;
  cancel.cancel = &cancelled;
  for (DistanceOptions options : {no_time, no_subdivisions, cancel}) {
    options.error_bound = 1e-9;
    const OneSidedDistance result = one_sided_hausdorff_distance(tree_a, tree_b, options);
    EXPECT_EQ(result.outcome, Outcome::BudgetExhausted);
    expect_meets(result.bounds, truth);
    EXPECT_GT(result.bounds.upper - result.bounds.lower, 1e-9);
    EXPECT_EQ(check_one_sided_tolerance(tree_a, tree_b, truth.upper, options).verdict, Verdict::Undecided);
  }
}

TEST(Budgets, OfFewSubdivisionsNarrowTheInterval) {
  const Bvh a(icosphere(3)), b(random_soup(32, 60, 0.5));
  const Bounds truth = one_sided_hausdorff_distance(a, b).bounds;
  for (const std::uint64_t subdivisions : {1, 10, 100, 1000}) {
    DistanceOptions options;
    options.error_bound = 1e-12;
    options.budget.subdivisions = subdivisions;
    expect_meets(one_sided_hausdorff_distance(a, b, options).bounds, truth);
  }
}

void expect_same(const OneSidedDistance& x, const OneSidedDistance& y) {
  EXPECT_EQ(x.bounds.lower, y.bounds.lower);
  EXPECT_EQ(x.bounds.upper, y.bounds.upper);
  EXPECT_EQ(x.outcome, y.outcome);
  EXPECT_EQ(x.witness.from.position, y.witness.from.position);
  EXPECT_EQ(x.witness.nearest.position, y.witness.nearest.position);
  EXPECT_EQ(x.witness.from.triangle, y.witness.from.triangle);
  EXPECT_EQ(x.witness.nearest.triangle, y.witness.nearest.triangle);
  EXPECT_EQ(x.stats.subdivisions, y.stats.subdivisions);
  EXPECT_EQ(x.stats.closest_point_queries, y.stats.closest_point_queries);
}

TEST(Threads, DoNotChangeTheResult) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const TriangleMesh a = seed % 2 == 0 ? icosphere(4) : random_soup(seed, 1000, 0.2);
    const TriangleMesh b = random_soup(seed + 50, 700, 0.3);
    DistanceOptions one, two;
    one.threads = 1;
    two.threads = 2;
    const OneSidedDistance serial = one_sided_hausdorff_distance(Bvh(a, {1}), Bvh(b, {1}), one);
    expect_same(serial, one_sided_hausdorff_distance(Bvh(a, {2}), Bvh(b, {2}), two));
    expect_same(serial, one_sided_hausdorff_distance(Bvh(a), Bvh(b)));
    one.tolerance = two.tolerance = serial.bounds.lower / 2;
    expect_same(one_sided_hausdorff_distance(Bvh(a), Bvh(b), one), one_sided_hausdorff_distance(Bvh(a), Bvh(b), two));
  }
}

TEST(Threads, DoNotChangeWhichNodesAreCulled) {
  for (const double apart : {0.5, 3.0}) {
    TriangleMesh a = icosphere(5);
    for (Vector3d& p : a.vertices) p.x() += apart;
    const Bvh tree_a(a), tree_b(random_soup(50, 3000, 0.3));
    DistanceOptions options;
    options.threads = 1;
    const OneSidedDistance serial = one_sided_hausdorff_distance(tree_a, tree_b, options);
    EXPECT_GT(serial.stats.culled_by_node, 0U);
    for (const int threads : {2, 3}) {
      options.threads = threads;
      const OneSidedDistance parallel = one_sided_hausdorff_distance(tree_a, tree_b, options);
      expect_same(serial, parallel);
      EXPECT_EQ(serial.stats.culled_by_node, parallel.stats.culled_by_node);
    }
  }
}

TEST(Poses, GiveTheDistanceOfTheTransformedMesh) {
  const TriangleMesh a = random_soup(41, 40, 0.3), b = random_soup(42, 40, 0.3);
  const Bvh tree_a(a), tree_b(b);
  for (int i = 0; i < 12; ++i) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.rotate(Eigen::AngleAxisd(0.7 * i, Vector3d(1, i, 2).normalized()));
    pose.pretranslate(std::pow(10.0, i - 6) * Vector3d(1, -2, 0.5));
    const TransformedMesh moved_a = transformed(a, Eigen::Affine3d(pose));
    const TransformedMesh moved_b = transformed(b, Eigen::Affine3d(pose));
    // The matrix of a pose is rounded, so a posed tree may differ from the mapped vertices by that as well.
    const double slack = 1e-14 * (1 + pose.translation().norm());
    const OneSidedDistance posed_a = one_sided_hausdorff_distance({tree_a, pose}, tree_b);
    const OneSidedDistance posed_b = one_sided_hausdorff_distance(tree_a, {tree_b, pose});
    expect_meets(posed_a.bounds, widened(one_sided_hausdorff_distance(Bvh(moved_a.mesh), tree_b).bounds, slack));
    expect_meets(posed_b.bounds, widened(one_sided_hausdorff_distance(tree_a, Bvh(moved_b.mesh)).bounds, slack));
    expect_witness(moved_a.mesh, b, posed_a);
    expect_witness(a, moved_b.mesh, posed_b);
    const OneSidedDistance together = one_sided_hausdorff_distance({tree_a, pose}, {tree_b, pose});
    expect_meets(together.bounds, widened(one_sided_hausdorff_distance(tree_a, tree_b).bounds, slack));
  }
}

TEST(InvalidArguments, AreRefused) {
  const Bvh a(cube(1)), b(cube(2));
  for (const double bad : {-1.0, -1e-300, std::nan("")}) {
    DistanceOptions options;
    options.error_bound = bad;
    EXPECT_THROW((void)one_sided_hausdorff_distance(a, b, options), InvalidInput);
    EXPECT_THROW((void)check_one_sided_tolerance(a, b, bad), InvalidInput);
    DistanceOptions with_tolerance;
    with_tolerance.tolerance = bad;
    EXPECT_THROW((void)one_sided_hausdorff_distance(a, b, with_tolerance), InvalidInput);
  }
  Eigen::Isometry3d scaling = Eigen::Isometry3d::Identity();
  scaling.matrix()(0, 0) = 2;
  EXPECT_THROW((void)one_sided_hausdorff_distance({a, scaling}, b), InvalidInput);
  Eigen::Isometry3d undefined = Eigen::Isometry3d::Identity();
  undefined.matrix()(1, 3) = std::nan("");
  EXPECT_THROW((void)one_sided_hausdorff_distance(a, {b, undefined}), InvalidInput);
}

TEST(InvalidMeshes, AreRefused) {
  EXPECT_THROW(Bvh(TriangleMesh{}), InvalidInput);
  TriangleMesh out_of_range = cube(1);
  out_of_range.triangles[3][1] = 8;
  EXPECT_THROW(Bvh{out_of_range}, InvalidInput);
  TriangleMesh not_finite = cube(1);
  not_finite.vertices[2].y() = std::nan("");
  EXPECT_THROW(Bvh{not_finite}, InvalidInput);
  not_finite.vertices[2].y() = infinity;
  EXPECT_THROW(Bvh{not_finite}, InvalidInput);
  TriangleMesh unused_is_fine = cube(1);
  unused_is_fine.vertices.emplace_back(infinity, 0, 0);
  EXPECT_NO_THROW(Bvh{unused_is_fine});
}

TEST(Progress, IsAFraction) {
  DistanceOptions options;
  options.error_bound = 1e-8;
  double last = 0;
  options.progress = [&last](double fraction) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    last = fraction;
  };
  (void)one_sided_hausdorff_distance(Bvh(icosphere(4)), Bvh(random_soup(61, 200, 0.4)), options);
  EXPECT_GE(last, 0);
}

TEST(Proximity, AgreesWithTheDistanceOfTheTriangle) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const TriangleMesh target = seed % 2 == 0 ? random_soup(seed, 40, 0.3) : moved(icosphere(2), {0.5, 0.5, 0.5});
    const Bvh tree(target);
    Proximity proximity(tree);
    const TriangleMesh probes = random_soup(seed + 500, 20, 0.3);
    std::uint32_t hint = 0;
    for (std::size_t i = 0; i < probes.triangles.size(); ++i) {
      const Corners triangle = corners(probes, i);
      const Bounds truth =
          one_sided_hausdorff_distance(Bvh(single_triangle(triangle[0], triangle[1], triangle[2])), tree).bounds;
      EXPECT_EQ(proximity.triangle_within(triangle, truth.upper * (1 + 1e-5) + 1e-5, hint), Verdict::Within);
      EXPECT_LT(hint, target.triangles.size());
      EXPECT_EQ(proximity.triangle_within(triangle, truth.lower * (1 - 1e-5), hint), Verdict::Exceeds);
      EXPECT_NE(proximity.triangle_within(triangle, truth.upper * 0.9, hint, 0), Verdict::Within);
      const ExactLength exact = exact_distance(triangle[0], target);
      const double smallest = proximity.upper_distance(triangle[0], hint);
      EXPECT_LE(exact.compare(smallest), 0);
      for (const double enough : {0.5 * smallest, 1.001 * smallest, 2 * smallest, 10 * smallest}) {
        hint = 0;
        const double upper = proximity.upper_distance(triangle[0], hint, enough);
        EXPECT_LE(exact.compare(upper), 0);
        EXPECT_LE(upper, std::max(enough, smallest * (1 + 1e-12)));
      }
    }
  }
}

double distance_to(const TriangleMesh& mesh, std::size_t triangle, const Eigen::Vector3d& p) {
  const Corners c = corners(mesh, triangle);
  return closest_point(Bvh(single_triangle(c[0], c[1], c[2])), p).distance.upper;
}

/// From a bad hint a walk may end at a triangle that is not the nearest one.
TEST(Proximity, FindsATriangleNearby) {
  const TriangleMesh sphere = icosphere(3);
  const Bvh tree(sphere);
  Proximity proximity(tree);
  const TriangleMesh probes = random_soup(7, 40, 0.3);
  std::size_t nearer_than_walked = 0;
  for (std::size_t i = 0; i < probes.triangles.size(); ++i) {
    const Eigen::Vector3d p = corners(probes, i)[0];
    const auto hint = static_cast<std::uint32_t>(37 * i % sphere.triangles.size());
    const std::uint32_t walked = proximity.nearby_triangle(p, hint, HUGE_VAL),
                        nearest = proximity.nearby_triangle(p, hint, 0);
    EXPECT_LE(distance_to(sphere, walked, p), distance_to(sphere, hint, p));
    EXPECT_NEAR(distance_to(sphere, nearest, p), closest_point(tree, p).distance.upper, 1e-12);
    if (distance_to(sphere, nearest, p) < distance_to(sphere, walked, p) - 1e-6) ++nearer_than_walked;
    const double in_between = 0.5 * (distance_to(sphere, nearest, p) + distance_to(sphere, walked, p));
    EXPECT_LE(distance_to(sphere, proximity.nearby_triangle(p, hint, in_between), p), in_between + 1e-12);
  }
  EXPECT_LT(nearer_than_walked, probes.triangles.size() / 2);
}

TEST(Proximity, TakesAnyNumberForAHint) {
  const Bvh tree(icosphere(2));
  for (const std::uint32_t hint : {static_cast<std::uint32_t>(tree.triangle_count()), ~0u}) {
    Proximity proximity(tree);
    std::uint32_t used = hint;
    EXPECT_NEAR(proximity.upper_distance({0, 0, 3}, used), 2, 1e-9);
    EXPECT_LT(used, tree.triangle_count());
    EXPECT_LT(proximity.nearby_triangle({0, 0, 3}, hint, 0), tree.triangle_count());
    used = hint;
    const Corners inside{Vector3d{0, 0, 0.99}, Vector3d{0.01, 0, 0.99}, Vector3d{0, 0.01, 0.99}};
    EXPECT_EQ(proximity.triangle_within(inside, 0.1, used), Verdict::Within);
  }
}

/// A triangle that lies above a square by as much as one likes: both have z = 0 but for that.
TEST(Proximity, IsNeverWithinAToleranceThatRoundingHides) {
  const Bvh tree(unit_square(3));
  Proximity proximity(tree);
  for (double height = 1e-20; height < 1e-6; height *= 1.7) {
    const Corners triangle{Vector3d{0.1, 0.1, height}, Vector3d{0.9, 0.2, height}, Vector3d{0.3, 0.8, height}};
    for (const double tolerance : {0.0, 0.5 * height, 0.99 * height}) {
      std::uint32_t hint = 0;
      EXPECT_NE(proximity.triangle_within(triangle, tolerance, hint), Verdict::Within) << height << " " << tolerance;
    }
  }
}

TEST(OneSidedDistance, ToAPointFarAwayIsConvergedOnlyWhereItIsNarrowEnough) {
  const TriangleMesh tiny = scaled(unit_square(1), 1e-300), far = moved(unit_square(2), {1e9, 0, 0});
  const Bvh from(far), to(tiny);
  DistanceOptions options;
  options.error_bound = 0;
  const OneSidedDistance exact = one_sided_hausdorff_distance(from, to, options);
  EXPECT_LT(exact.bounds.lower, exact.bounds.upper);
  EXPECT_EQ(exact.outcome, Outcome::PrecisionReached);
  options.error_bound = 2 * (exact.bounds.upper - exact.bounds.lower);
  EXPECT_EQ(one_sided_hausdorff_distance(from, to, options).outcome, Outcome::Converged);
  EXPECT_EQ(check_one_sided_tolerance(from, to, 2e9).a_to_b.outcome, Outcome::Converged);
}

}  // namespace one_sided_hausdorff_distance_test
}  // namespace meshbound
