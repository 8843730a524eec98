// SPDX-License-Identifier: MIT
// What MovingPair keeps from step to step saves queries, never truth.
#include "meshbound/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "random_poses.h"
#include "reference/small_meshes.h"

namespace motion_test {

using namespace meshbound;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::translated;

constexpr double error_bound = 1e-4;

DistanceOptions wanted(int threads = 1) {
  DistanceOptions options;
  options.error_bound = error_bound;
  options.threads = threads;
  return options;
}

class Random : public test::RandomPoses {
 public:
  Random() : RandomPoses(7) {}
};

std::uint64_t queries(const HausdorffDistance& distance) {
  return distance.a_to_b.stats.closest_point_queries + distance.b_to_a.stats.closest_point_queries;
}

/// Queries of all steps, warm and cold, with B at each pose. Every interval is as narrow as was asked, and contains
/// the distance that the other one contains.
struct Work {
  double warm = 0, cold = 0;
};

Work compare(const Bvh& a, const Bvh& b, const std::vector<Isometry3d>& poses) {
  MovingPair pair(a, b);
  Work work;
  for (const Isometry3d& pose : poses) {
    const HausdorffDistance warm = pair.hausdorff_distance(Isometry3d::Identity(), pose, wanted());
    const HausdorffDistance cold = hausdorff_distance(a, {b, pose}, wanted());
    EXPECT_LE(warm.bounds.upper - warm.bounds.lower, error_bound);
    EXPECT_LE(warm.bounds.lower, cold.bounds.upper);
    EXPECT_LE(cold.bounds.lower, warm.bounds.upper);
    const Witness& witness = (warm.a_to_b.bounds.lower > warm.b_to_a.bounds.lower ? warm.a_to_b : warm.b_to_a).witness;
    EXPECT_NEAR((witness.from.position - witness.nearest.position).norm(), warm.bounds.lower, 1e-12);
    work.warm += static_cast<double>(queries(warm));
    work.cold += static_cast<double>(queries(cold));
  }
  return work;
}

/// Against a translated copy of itself by t, a corner of a cube is exactly |t| away for every t: no point is further
/// than |t|, and the corner towards t has its own image nearest.
class CubeThatMoves : public testing::Test {
 protected:
  const Bvh cube_{datasets::cube(1, 40)};
};

TEST_F(CubeThatMoves, IsItsTranslationAway) {
  MovingPair pair(cube_, cube_);
  for (int step = 0; step <= 300; ++step) {
    SCOPED_TRACE(step);
    // First apart, then nearer again, past zero.
    const double length = 0.9 - std::abs(step - 60) * 0.004;
    const Vector3d by = length * Vector3d(0.48, 0.64, 0.6);
    const Bounds bounds = pair.hausdorff_distance(Isometry3d::Identity(), translated(by), wanted()).bounds;
    EXPECT_LE(bounds.lower, std::abs(length) * (1 + 1e-15));
    EXPECT_GE(bounds.upper, std::abs(length) * (1 - 1e-15));
    EXPECT_LE(bounds.upper - bounds.lower, error_bound);
  }
}

TEST_F(CubeThatMoves, IsDecidedRightlyAtEveryStepAndMostlyWithoutASearch) {
  const double tolerance = 0.5;
  MovingPair pair(cube_, cube_);
  for (int step = 0; step <= 200; ++step) {
    SCOPED_TRACE(step);
    const double length = 0.301 + 0.002 * step;
    const Isometry3d pose_b = translated(length * Vector3d(0, 0.6, 0.8));
    const ToleranceCheck check = pair.check_tolerance(Isometry3d::Identity(), pose_b, tolerance, wanted());
    EXPECT_EQ(check.verdict, length <= tolerance ? Verdict::Within : Verdict::Exceeds);
    const auto asked = check.a_to_b.stats.closest_point_queries + check.b_to_a.stats.closest_point_queries;
    if (step > 0 && std::abs(length - tolerance) > 0.02) {
      EXPECT_LE(asked, 30u);  // a hundred and more without what was kept
    }
  }
}

TEST_F(CubeThatMoves, BothMayMove) {
  MovingPair pair(cube_, cube_);
  Random random;
  for (int step = 0; step < 30; ++step) {
    const Vector3d by = Vector3d(0.5 + 0.01 * step, 0.1, -0.2);
    const Isometry3d world = random.pose({10, 0, 0}, 5, 3);
    const Bounds bounds = pair.hausdorff_distance(world, world * translated(by), wanted()).bounds;
    EXPECT_LE(bounds.lower, by.norm() * (1 + 1e-12));
    EXPECT_GE(bounds.upper, by.norm() * (1 - 1e-12));
    EXPECT_LE(bounds.upper - bounds.lower, error_bound);
  }
}

TEST_F(CubeThatMoves, IsMeasuredAnewAfterARefit) {
  Bvh other(datasets::cube(1, 40));
  MovingPair pair(cube_, other);
  (void)pair.hausdorff_distance(Isometry3d::Identity(), translated({0.5, 0, 0}), wanted());
  TriangleMesh moved = datasets::cube(1, 40);
  for (Vector3d& p : moved.vertices) p.x() += 0.25;
  other.refit(moved);
  const Bounds bounds = pair.hausdorff_distance(Isometry3d::Identity(), translated({0.5, 0, 0}), wanted()).bounds;
  EXPECT_GE(bounds.upper, 0.75);
  EXPECT_LE(bounds.lower, 0.75);
}

TEST_F(CubeThatMoves, APoseThatIsNoRigidMotionIsRefusedAndChangesNothing) {
  MovingPair pair(cube_, cube_);
  Isometry3d scaled = Isometry3d::Identity();
  scaled.linear() *= 2;
  (void)pair.hausdorff_distance(Isometry3d::Identity(), translated({0.5, 0, 0}), wanted());
  EXPECT_THROW((void)pair.hausdorff_distance(Isometry3d::Identity(), scaled, wanted()), InvalidInput);
  Isometry3d transposed = translated({0.5, 0, 0});
  transposed.matrix().transposeInPlace();
  EXPECT_THROW((void)pair.hausdorff_distance(Isometry3d::Identity(), transposed, wanted()), InvalidInput);
  EXPECT_THROW((void)hausdorff_distance(cube_, {cube_, transposed}), InvalidInput);
  const auto after = pair.hausdorff_distance(Isometry3d::Identity(), translated({0.5, 0, 0}), wanted());
  EXPECT_GE(after.bounds.upper, 0.5);
  EXPECT_LE(queries(after), 24u);
}

/// A cube moves along a bar: the furthest point is one end of the bar, then the other, whose bound was small before.
TEST(MovingPair, FindsTheFurthestPointWhereItJumps) {
  const Bvh bar(datasets::box({2, 0.1, 0.1}, {80, 4, 4})), cube(datasets::cube(0.1, 4));
  MovingPair pair(bar, cube);
  for (int step = 0; step <= 80; ++step) {
    const double x = 0.02 * (step - 40), truth = 1 + std::abs(x) - 0.05;
    SCOPED_TRACE(x);
    const Bounds bounds =
        pair.hausdorff_distance(translated({-1, 0, 0}), translated({x - 0.05, 0, 0}), wanted()).bounds;
    EXPECT_NEAR(bounds.lower, truth, error_bound);
    EXPECT_GE(bounds.upper, truth * (1 - 1e-15));
  }
}

/// Two different surfaces, of which neither is symmetric to the motion.
class TorusAndGear : public testing::Test {
 protected:
  const Bvh torus_{datasets::torus(0.35, 0.15, 60, 30)}, gear_{datasets::gear(0.5, 0.3, 12, 6, 4)};
};

TEST_F(TorusAndGear, AskAFifthWhenTheyApproachInSmallSteps) {
  std::vector<Isometry3d> poses;
  for (int step = 0; step <= 350; step += 1) poses.push_back(translated({3 * (1 - step / 350.0), 0.1, 0.05}));
  const Work work = compare(torus_, gear_, poses);
  EXPECT_LE(work.warm, work.cold / 5);
}

TEST_F(TorusAndGear, AskNoMoreThanColdWhateverTheSizeOfTheSteps) {
  Random random;
  for (const double size : {0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 1.0}) {
    SCOPED_TRACE(size);
    std::vector<Isometry3d> poses;
    for (int step = 0; step < 40; ++step) poses.push_back(random.pose({0.4, 0.2, 0}, size, 3 * size));
    const Work work = compare(torus_, gear_, poses);
    EXPECT_LE(work.warm, 1.05 * work.cold);
  }
}

TEST_F(TorusAndGear, GiveTheSameForAnyNumberOfThreads) {
  MovingPair alone(torus_, gear_), several(torus_, gear_);
  Random random;
  for (int step = 0; step < 20; ++step) {
    const Isometry3d pose = random.pose({0.4, 0.2, 0}, 0.05, 0.1);
    const HausdorffDistance one = alone.hausdorff_distance(Isometry3d::Identity(), pose, wanted(1));
    const HausdorffDistance many = several.hausdorff_distance(Isometry3d::Identity(), pose, wanted(3));
    EXPECT_EQ(one.bounds.lower, many.bounds.lower);
    EXPECT_EQ(one.bounds.upper, many.bounds.upper);
    EXPECT_EQ(queries(one), queries(many));
    EXPECT_EQ(one.a_to_b.witness.from.position, many.a_to_b.witness.from.position);
    EXPECT_EQ(one.b_to_a.witness.from.position, many.b_to_a.witness.from.position);
  }
}

/// Triangles without any order, moved by steps of all sizes, measured and decided in turn: what is kept contradicts no
/// answer that is found without it.
TEST(MovingPair, AgreesWithColdAnswersForSoups) {
  Random random;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    const Bvh a(reference::random_soup(seed, 400, 0.1)), b(reference::random_soup(seed + 50, 300, 0.05));
    MovingPair pair(a, b);
    Isometry3d pose = random.pose({0.5, 0, 0}, 1, 3);
    for (int step = 0; step < 60; ++step) {
      SCOPED_TRACE(step);
      pose = pose * random.pose({0, 0, 0}, std::pow(10, random.uniform(-4, 0)), std::pow(10, random.uniform(-4, 0)));
      if (step % 20 == 19) pose = random.pose({0.5, 0, 0}, 1, 3);
      const Bounds cold = hausdorff_distance(a, {b, pose}, wanted()).bounds;
      if (step % 3 == 0) {
        const double tolerance = cold.upper * random.uniform(0.8, 1.2);
        const Bounds warm = pair.check_tolerance(Isometry3d::Identity(), pose, tolerance, wanted()).bounds;
        EXPECT_LE(warm.lower, cold.upper);
        EXPECT_GE(warm.upper, cold.lower);
      } else {
        const Bounds warm = pair.hausdorff_distance(Isometry3d::Identity(), pose, wanted()).bounds;
        EXPECT_LE(warm.lower, cold.upper);
        EXPECT_GE(warm.upper, cold.lower);
        EXPECT_LE(warm.upper - warm.lower, error_bound);
      }
    }
  }
}

}  // namespace motion_test
