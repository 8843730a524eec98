// SPDX-License-Identifier: MIT
// What LevelChecker keeps from level to level costs time at worst, never truth.
#include "meshbound/level_checker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "meshbound/error.h"
#include "random_poses.h"
#include "reference/brute_force.h"
#include "reference/small_meshes.h"

namespace level_checker_test {

using namespace meshbound;
using namespace meshbound::reference;

class Random : public test::RandomPoses {
 public:
  using RandomPoses::RandomPoses;
  std::size_t below(std::size_t n) { return engine_() % n; }
  std::mt19937& engine() { return engine_; }
};

TriangleMesh jittered(TriangleMesh mesh, double size, Random& random, double share = 1) {
  for (Eigen::Vector3d& v : mesh.vertices)
    if (random.uniform(0, 1) < share) v += random.offset(size);
  return mesh;
}

/// The surface under other numbers: vertices and triangles shuffled, corners rotated or mirrored.
TriangleMesh renumbered(const TriangleMesh& mesh, Random& random) {
  std::vector<std::uint32_t> place(mesh.vertices.size());
  std::iota(place.begin(), place.end(), 0U);
  std::shuffle(place.begin(), place.end(), random.engine());
  TriangleMesh result = mesh;
  for (std::size_t v = 0; v < place.size(); ++v) result.vertices[place[v]] = mesh.vertices[v];
  for (Triangle& t : result.triangles) {
    for (std::uint32_t& v : t) v = place[v];
    std::shuffle(t.begin(), t.end(), random.engine());
  }
  std::shuffle(result.triangles.begin(), result.triangles.end(), random.engine());
  return result;
}

TriangleMesh without_some_triangles(TriangleMesh mesh, double share, Random& random) {
  std::vector<Triangle> left;
  for (const Triangle& t : mesh.triangles)
    if (random.uniform(0, 1) >= share) left.push_back(t);
  if (!left.empty()) mesh.triangles = left;
  return mesh;
}

/// One level made from another in a way that a cache could get wrong.
TriangleMesh altered(const TriangleMesh& original, const TriangleMesh& level, Random& random) {
  switch (random.below(12)) {
    case 0:
      return level;
    case 1:
      return renumbered(level, random);
    case 2:
      return jittered(level, 0.02, random, 0.05);
    case 3:
      return jittered(level, 1e-15, random, 0.3);  // the last bits only
    case 4:
      return without_some_triangles(level, 0.1, random);
    case 5:
      return moved(level, random.offset(0.05));
    case 6:
      return scaled(level, random.uniform(0.9, 1.1));
    case 7:
      return jittered(original, 0.05, random, 0.2);
    case 8:
      return random_soup(static_cast<std::uint32_t>(random.below(1000)), 40, 0.3);
    case 9:
      return both(level, single_triangle(random.offset(1), random.offset(1), random.offset(1)));
    case 10: {  // same triangles, other geometry: two vertices change places
      TriangleMesh result = level;
      std::swap(result.vertices[random.below(result.vertices.size())],
                result.vertices[random.below(result.vertices.size())]);
      return result;
    }
    default:
      return original;
  }
}

void expect_compatible(const Bounds& kept, const Bounds& fresh) {
  EXPECT_LE(kept.lower, kept.upper);
  EXPECT_LE(kept.lower, fresh.upper);
  EXPECT_LE(fresh.lower, kept.upper);
}

void expect_same_answer(const ToleranceCheck& kept, const ToleranceCheck& fresh) {
  EXPECT_EQ(kept.verdict, fresh.verdict);
  EXPECT_EQ(kept.tolerance, fresh.tolerance);
  EXPECT_EQ(kept.verdict == Verdict::Within, kept.bounds.upper <= kept.tolerance);
  EXPECT_EQ(kept.verdict == Verdict::Exceeds, kept.bounds.lower > kept.tolerance);
  expect_compatible(kept.bounds, fresh.bounds);
  expect_compatible(kept.a_to_b.bounds, fresh.a_to_b.bounds);
}

std::uint64_t kept_triangles(const ToleranceCheck& check) {
  return check.a_to_b.stats.proven_before + check.b_to_a.stats.proven_before;
}

class AlteredLevels : public testing::TestWithParam<std::uint32_t> {};

TEST_P(AlteredLevels, AreAnsweredAsByAFreshCheck) {
  Random random(GetParam());
  const TriangleMesh original = jittered(icosphere(2), 0.05, random);
  const Bvh tree(original);
  LevelChecker levels(tree);
  TriangleMesh level = original;
  int within = 0, exceeds = 0;
  for (int step = 0; step < 40; ++step) {
    level = altered(original, level, random);
    const double tolerance = std::pow(10, random.uniform(-2.5, 0.2));
    DistanceOptions options;
    options.threads = 1 + static_cast<int>(random.below(2));
    const ToleranceCheck answer = levels.check(level, tolerance, options);
    const Bvh level_tree(level);
    expect_same_answer(answer, check_tolerance(tree, level_tree, tolerance, options));
    const HausdorffDistance truth = hausdorff_distance(tree, level_tree, options);
    expect_compatible(answer.bounds, truth.bounds);
    within += answer.verdict == Verdict::Within ? 1 : 0;
    exceeds += answer.verdict == Verdict::Exceeds ? 1 : 0;
    if (random.below(3) == 0) {
      options.error_bound = 1e-3;
      const HausdorffDistance measured = levels.measure(level, options);
      expect_compatible(measured.bounds, truth.bounds);
      EXPECT_LE(measured.bounds.upper - measured.bounds.lower, 1e-3);
    }
  }
  EXPECT_GT(within, 0);
  EXPECT_GT(exceeds, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AlteredLevels, testing::Range(1U, 31U));

TEST(LevelChecker, CheckOfTheSameLevelAgainChecksNothing) {
  Random random(1);
  const TriangleMesh original = icosphere(3), level = jittered(original, 0.01, random);
  LevelChecker levels(original);
  const Bvh level_tree(level);
  const Bounds truth = hausdorff_distance(levels.original(), level_tree).bounds;
  const ToleranceCheck first = levels.check(level, 0.1);
  EXPECT_EQ(first.verdict, Verdict::Within);
  EXPECT_EQ(kept_triangles(first), 0U);
  const ToleranceCheck again = levels.check(renumbered(level, random), 0.1);
  EXPECT_EQ(again.verdict, Verdict::Within);
  EXPECT_EQ(kept_triangles(again), original.triangles.size() + level.triangles.size());
  EXPECT_LT(again.bounds.lower, truth.lower);  // nothing was looked at that far away,
  EXPECT_GE(again.bounds.upper, truth.lower);  // so what covers it is the kept bounds
}

TEST(LevelChecker, UpperBoundOfKeptProofsIsAboveTheTruth) {
  Random random(2);
  for (int i = 0; i < 10; ++i) {
    const TriangleMesh original = random_soup(static_cast<std::uint32_t>(i), 12, 0.4);
    const TriangleMesh first = jittered(original, 0.1, random);
    LevelChecker levels(original);
    for (const TriangleMesh& level : {first, without_some_triangles(first, 0.2, random)}) {
      const Bounds truth = brute_force_symmetric(original, level, 1e-3);
      const ToleranceCheck check = levels.check(level, 2);
      EXPECT_GE(check.bounds.upper, truth.lower);
      EXPECT_LE(check.bounds.lower, truth.upper);
      const Bounds measured = levels.measure(level).bounds;
      EXPECT_GE(measured.upper, truth.lower - brute_force_allowance);
      EXPECT_LE(measured.lower, truth.upper + brute_force_allowance);
    }
  }
}

TEST(LevelChecker, ProofEndsWithTheFaceItRestsOn) {
  const TriangleMesh original = unit_square(4), level = moved(unit_square(16), {0, 0, 0.01});
  for (std::size_t gone = 0; gone < level.triangles.size(); gone += 37) {
    LevelChecker levels(original);
    EXPECT_EQ(levels.check(level, 0.015).verdict, Verdict::Within);
    TriangleMesh holed = level;
    holed.triangles.erase(holed.triangles.begin() + static_cast<std::ptrdiff_t>(gone));
    const ToleranceCheck check = levels.check(holed, 0.015);
    EXPECT_EQ(check.verdict, Verdict::Exceeds) << gone;
    (void)levels.measure(level);
    const ToleranceCheck loose = levels.check(holed, 0.2);
    EXPECT_EQ(loose.verdict, Verdict::Within);
    EXPECT_GT(loose.a_to_b.stats.proven_before, original.triangles.size() / 2);
    EXPECT_LT(loose.a_to_b.stats.proven_before, original.triangles.size());
  }
}

TEST(LevelChecker, TriangleThatThousandsOfFacesCoverTogetherRestsOnEach) {
  const TriangleMesh original = unit_square(1), level = moved(unit_square(64), {0, 0, 0.01});
  for (std::size_t gone = 0; gone < level.triangles.size(); gone += 999) {
    LevelChecker levels(original);
    EXPECT_EQ(levels.check(level, 0.0105).verdict, Verdict::Within);
    TriangleMesh holed = level;
    holed.triangles.erase(holed.triangles.begin() + static_cast<std::ptrdiff_t>(gone));
    const ToleranceCheck check = levels.check(holed, 0.0105);
    EXPECT_EQ(check.verdict, Verdict::Exceeds) << gone;
    EXPECT_EQ(check.a_to_b.stats.proven_before, 1u) << "the triangle of the original that did not lie on it";
  }
}

TEST(LevelChecker, OneLargeTriangleRestsOnAllFacesItLiesOn) {
  const TriangleMesh original = single_triangle({0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  const TriangleMesh level = moved(unit_square(8), {0, 0, 0.01});
  std::size_t exceeding = 0, inside = 0;
  for (std::size_t gone = 0; gone < level.triangles.size(); ++gone) {
    LevelChecker levels(original);
    // The square's other half is far from the original, so only one direction is of interest.
    EXPECT_LE(levels.check(level, 2).a_to_b.bounds.upper, 2);
    (void)levels.measure(level);
    TriangleMesh holed = level;
    holed.triangles.erase(holed.triangles.begin() + static_cast<std::ptrdiff_t>(gone));
    const HausdorffDistance measured = levels.measure(holed);
    exceeding += measured.a_to_b.bounds.upper > 0.015 ? 1U : 0U;
    inside += gone % 2 == 0 ? 1U : 0U;
  }
  EXPECT_GE(exceeding, inside / 2);
}

TEST(LevelChecker, SmallerToleranceChecksAgainWhatItsBoundDoesNotCover) {
  const TriangleMesh original = unit_square(8), level = moved(original, {0, 0, 0.01});
  LevelChecker levels(original);
  EXPECT_EQ(levels.check(level, 1).verdict, Verdict::Within);
  EXPECT_EQ(levels.check(level, 0.005).verdict, Verdict::Exceeds);
  EXPECT_EQ(levels.check(level, 0.02).verdict, Verdict::Within);
}

TEST(LevelChecker, OnlyWhatChangedIsCheckedWhereverTheFrameOfTheLevelLies) {
  Random random(3);
  const TriangleMesh original = icosphere(4);
  TriangleMesh level = jittered(original, 0.001, random);
  LevelChecker levels(original);
  EXPECT_EQ(levels.check(level, 0.01).verdict, Verdict::Within);
  level.vertices[7] += Eigen::Vector3d(0.001, 0, 0);
  const ToleranceCheck local = levels.check(renumbered(level, random), 0.01);
  EXPECT_EQ(local.verdict, Verdict::Within);
  EXPECT_GT(kept_triangles(local), 2 * original.triangles.size() - 60);
  // A far triangle changes the scale and the origin of the level's tree, but no other triangle of the level.
  const TriangleMesh with_far = both(level, single_triangle({5000, 0, 0}, {5001, 0, 0}, {5000, 1, 0}));
  const ToleranceCheck far = levels.check(with_far, 6000);
  EXPECT_EQ(far.verdict, Verdict::Within);
  EXPECT_EQ(kept_triangles(far), 2 * original.triangles.size());
}

TEST(LevelChecker, KeepsAllItKnowsWhenALevelIsRefused) {
  Random random(4);
  const TriangleMesh original = icosphere(2), level = jittered(original, 0.01, random);
  LevelChecker levels(original);
  EXPECT_EQ(levels.check(level, 0.1).verdict, Verdict::Within);
  TriangleMesh broken = level;
  broken.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)levels.check(broken, 0.1), InvalidInput);
  EXPECT_THROW((void)levels.check(level, -1), InvalidInput);
  EXPECT_EQ(kept_triangles(levels.check(level, 0.1)), 2 * original.triangles.size());
}

TEST(LevelChecker, ForgetsEverythingWhenTheOriginalMoves) {
  const TriangleMesh shape = icosphere(3), level = scaled(shape, 1.01);
  for (std::size_t v = 0; v < 40; ++v) {  // more than the few vertices that a search looks at first
    Bvh original(shape);
    LevelChecker levels(original);
    EXPECT_EQ(levels.check(level, 0.1).verdict, Verdict::Within);
    TriangleMesh spiked = shape;
    spiked.vertices[v] *= 1.5;
    original.refit(spiked);
    EXPECT_EQ(levels.check(level, 0.1).verdict, Verdict::Exceeds);
    original = Bvh(shape);
    const ToleranceCheck check = levels.check(level, 0.1);
    EXPECT_EQ(check.verdict, Verdict::Within);
    EXPECT_EQ(kept_triangles(check), 0U);
  }
}

TEST(LevelChecker, GivesTheSameBitsForAnyNumberOfThreads) {
  Random random(5);
  const TriangleMesh original = icosphere(4);
  LevelChecker one(original, {.threads = 1}), two(original, {.threads = 2});
  TriangleMesh level = original;
  for (int step = 0; step < 5; ++step) {
    level = jittered(level, 0.01, random, 0.1);
    DistanceOptions single, both_cores;
    single.threads = 1;
    both_cores.threads = 2;
    const ToleranceCheck a = one.check(level, 0.05, single), b = two.check(level, 0.05, both_cores);
    EXPECT_EQ(a.bounds.lower, b.bounds.lower);
    EXPECT_EQ(a.bounds.upper, b.bounds.upper);
    EXPECT_EQ(kept_triangles(a), kept_triangles(b));
    const Bounds c = one.measure(level, single).bounds, d = two.measure(level, both_cores).bounds;
    EXPECT_EQ(c.lower, d.lower);
    EXPECT_EQ(c.upper, d.upper);
  }
}

TEST(LevelChecker, MeasuresLevelsOfAnyScaleAndPlace) {
  const TriangleMesh original = icosphere(1);
  LevelChecker levels(original);
  for (const double scale : {1.0, 1e-30, 1e20, 1.0, 1e-300, 1e300, 0.0, 1.0}) {
    const TriangleMesh level = scaled(original, scale);
    const Bvh tree(level);
    expect_compatible(levels.measure(level).bounds, hausdorff_distance(levels.original(), tree).bounds);
  }
}

}  // namespace level_checker_test
