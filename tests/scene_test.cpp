// SPDX-License-Identifier: MIT
// A scene gives the answers of all pairs by themselves, and says which of them it did not have to look for.
#include "meshbound/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "random_poses.h"
#include "scene/world_box.h"

namespace scene_test {

using namespace meshbound;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::translated;

class Random : public test::RandomPoses {
 public:
  Random() : RandomPoses(11) {}
  using RandomPoses::pose;
  Isometry3d pose(double size, double angle) { return pose(Vector3d::Zero(), size, angle); }
};

DistanceOptions with_threads(int threads) {
  DistanceOptions options;
  options.threads = threads;
  return options;
}

/// The verdict of each pair by itself against the scene's, for which a pair that is not listed exceeds.
void expect_what_pairs_say(Scene& scene, double tolerance) {
  const SceneCheck check = scene.check_tolerance(tolerance, with_threads(2));
  std::map<std::pair<std::uint32_t, std::uint32_t>, Verdict> listed;
  for (const ScenePair& pair : check.pairs) listed[{pair.a, pair.b}] = pair.check.verdict;
  EXPECT_EQ(check.stats.skipped_by_boxes + check.stats.unmoved + check.stats.searched, check.stats.pairs);
  for (std::uint32_t a = 0; a < scene.size(); ++a) {
    for (std::uint32_t b = a + 1; b < scene.size(); ++b) {
      const Verdict truth = check_tolerance(scene.model(a), scene.model(b), tolerance).verdict;
      const auto found = listed.find({a, b});
      EXPECT_EQ(found == listed.end() ? Verdict::Exceeds : found->second, truth) << a << ' ' << b;
    }
  }
}

class ManyTori : public testing::Test {
 protected:
  ManyTori() {
    for (int i = 0; i < 24; ++i) scene_.add(torus_, random_.pose(0.5, 0.3));
  }
  Random random_;
  const Bvh torus_{datasets::torus(0.35, 0.15, 24, 12)};
  Scene scene_;
};

TEST_F(ManyTori, AreAnsweredAsEachPairIs) {
  for (int step = 0; step < 5; ++step) {
    expect_what_pairs_say(scene_, 0.3);
    for (std::uint32_t body = 0; body < scene_.size(); body += 2) {
      Isometry3d pose = scene_.model(body).pose;
      pose.translation() += random_.offset(0.02);
      scene_.move(body, pose);
    }
  }
}

TEST_F(ManyTori, SearchOnlyPairsThatHaveMovedAndCanBeNear) {
  const SceneStats first = scene_.check_tolerance(0.3).stats;
  EXPECT_EQ(first.pairs, 24u * 23 / 2);
  EXPECT_GT(first.skipped_by_boxes, first.pairs / 2);
  EXPECT_GT(first.searched, 0u);
  EXPECT_EQ(first.unmoved, 0u);
  const SceneStats again = scene_.check_tolerance(0.3).stats;
  EXPECT_EQ(again.unmoved, first.searched);
  EXPECT_EQ(again.searched, 0u);
  EXPECT_EQ(again.closest_point_queries, 0u);
  // Another tolerance is another question, of pairs of which something is known.
  const SceneStats other = scene_.check_tolerance(0.31).stats;
  EXPECT_EQ(other.unmoved, 0u);
  EXPECT_LT(other.closest_point_queries, first.closest_point_queries);
}

TEST_F(ManyTori, GiveTheSameForAnyNumberOfThreads) {
  Scene other;
  for (std::uint32_t body = 0; body < scene_.size(); ++body) other.add(torus_, scene_.model(body).pose);
  for (int step = 0; step < 3; ++step) {
    const SceneCheck one = scene_.check_tolerance(0.3, with_threads(1));
    const SceneCheck many = other.check_tolerance(0.3, with_threads(4));
    ASSERT_EQ(one.pairs.size(), many.pairs.size());
    for (std::size_t i = 0; i < one.pairs.size(); ++i) {
      EXPECT_EQ(one.pairs[i].a, many.pairs[i].a);
      EXPECT_EQ(one.pairs[i].b, many.pairs[i].b);
      EXPECT_EQ(one.pairs[i].check.bounds.lower, many.pairs[i].check.bounds.lower);
      EXPECT_EQ(one.pairs[i].check.bounds.upper, many.pairs[i].check.bounds.upper);
    }
    EXPECT_EQ(one.stats.closest_point_queries, many.stats.closest_point_queries);
    const Isometry3d pose = random_.pose(0.5, 0.3);
    scene_.move(3, pose);
    other.move(3, pose);
  }
}

/// Against a copy of itself moved by t, a cube is exactly |t| away.
TEST(Scene, CubesAreWithinTheToleranceByWhichTheyAreMoved) {
  const Bvh cube(datasets::cube(1, 4));
  Scene scene;
  scene.add(cube);
  scene.add(cube, translated({0.25, 0, 0}));
  scene.add(cube, translated({0.125, 0, 0}));
  scene.add(cube, translated({7, 0, 0}));
  const SceneCheck check = scene.check_tolerance(0.125);
  ASSERT_EQ(check.pairs.size(), 2u);  // 0 and 2, 1 and 2
  for (const ScenePair& pair : check.pairs) {
    EXPECT_NE(pair.check.verdict, Verdict::Exceeds);
    EXPECT_EQ(pair.b, 2u);
  }
  EXPECT_EQ(scene.check_tolerance(0.2).pairs.size(), 2u);
  EXPECT_EQ(scene.check_tolerance(0.25).pairs.size(), 3u);
  EXPECT_EQ(scene.check_tolerance(0).pairs.size(), 0u);
}

TEST(Scene, PairsWhoseBoxesTouchAreNear) {
  const Bvh cube(datasets::cube(1, 2));
  Scene scene;
  for (const double x : {0.0, 1.0, 2.5, 0.5}) scene.add(cube, translated({x, 0, 0}));
  scene.add(cube, translated({0, 1.25, 0}));
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  EXPECT_EQ(scene.pairs_near(), (Pairs{{0, 1}, {0, 3}, {1, 3}}));
  EXPECT_EQ(scene.pairs_near(0.25), (Pairs{{0, 1}, {0, 3}, {0, 4}, {1, 3}, {1, 4}, {3, 4}}));
  EXPECT_EQ(scene.pairs_near(0.5), (Pairs{{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {1, 4}, {3, 4}}));
  EXPECT_THROW((void)scene.pairs_near(-1), InvalidInput);
}

/// Unit cubes in a row, each 0.25 in the next: the volume in common is a box of that width, so it is as deep at least.
TEST(SceneContacts, AreTheDepthsOfAllPairsThatShareContent) {
  const ClosedModel cube(datasets::cube(1, 3));
  Scene scene;
  for (int i = 0; i < 6; ++i) scene.add(cube, translated({0.75 * i, 0.01 * i, 0}));
  scene.add(cube, translated({40, 0, 0}));
  const SceneContacts contacts = scene.contacts();
  ASSERT_EQ(contacts.pairs.size(), 5u);
  for (std::uint32_t i = 0; i < 5; ++i) {
    const SceneContact& pair = contacts.pairs[i];
    EXPECT_EQ(pair.a, i);
    EXPECT_EQ(pair.b, i + 1);
    const Bounds alone = penetration_depth({cube, scene.model(pair.a).pose}, {cube, scene.model(pair.b).pose}).depth;
    EXPECT_EQ(pair.penetration.depth.lower, alone.lower);
    EXPECT_EQ(pair.penetration.depth.upper, alone.upper);
    EXPECT_GE(alone.upper, 0.25);
  }
  EXPECT_EQ(contacts.stats.pairs, 21u);
  EXPECT_EQ(contacts.stats.measured + contacts.stats.skipped_by_boxes, 21u);
  EXPECT_EQ(contacts.stats.measured - contacts.stats.without_volume, 5u);
}

TEST(SceneContacts, AreFoundAnewOnlyForPairsThatHaveMoved) {
  const ClosedModel cube(datasets::cube(1, 3));
  const Bvh no_solid(datasets::cube(1, 1));
  Scene scene;
  for (int i = 0; i < 4; ++i) scene.add(cube, translated({0.75 * i, 0, 0.01 * i}));
  scene.add(no_solid);
  const SceneContacts first = scene.contacts();
  EXPECT_EQ(first.pairs.size(), 3u);
  EXPECT_EQ(first.stats.measured, 3u);
  EXPECT_EQ(first.stats.without_solid, 2u);
  scene.move(3, translated({2.375, 0, 0}));
  const SceneContacts then = scene.contacts();
  EXPECT_EQ(then.stats.unmoved, 2u);
  EXPECT_EQ(then.stats.measured, 1u);
  EXPECT_EQ(then.pairs.size(), 3u);
  PenetrationOptions deeper;
  deeper.decide = 2;
  const SceneContacts decided = scene.contacts(deeper);
  EXPECT_EQ(decided.stats.unmoved, 0u);
  for (const SceneContact& pair : decided.pairs) EXPECT_EQ(pair.penetration.volumes[0].verdict, Verdict::Within);
}

TEST(SceneContacts, WhatEndedEarlyIsMeasuredAgain) {
  const ClosedModel cube(datasets::cube(1, 1));
  Scene scene;
  scene.add(cube);
  scene.add(cube, translated({0.5, 0.25, 0.125}));
  PenetrationOptions no_time;
  no_time.budget.seconds = 0;
  const SceneContacts open = scene.contacts(no_time);
  ASSERT_EQ(open.pairs.size(), 1u);
  EXPECT_FALSE(open.pairs[0].penetration.volumes_known);
  const SceneContacts known = scene.contacts();
  EXPECT_EQ(known.stats.measured, 1u);
  ASSERT_EQ(known.pairs.size(), 1u);
  EXPECT_TRUE(known.pairs[0].penetration.volumes_known);
  EXPECT_TRUE(std::isfinite(known.pairs[0].penetration.depth.upper));
  EXPECT_EQ(scene.contacts().stats.unmoved, 1u);
}

TEST(SceneContacts, WhatEndedAtTheFirstDeeperVolumeIsNoAnswerToTheWholeQuestion) {
  TriangleMesh fork = datasets::cube(1, 1);  // two cubes in one model, both in contact with the third
  const TriangleMesh prong = fork;
  for (const Vector3d& p : prong.vertices) fork.vertices.emplace_back(p.x() + 2, p.y(), p.z());
  for (const Triangle& t : prong.triangles) fork.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  TriangleMesh bar = prong;
  for (Vector3d& p : bar.vertices) p = Vector3d(4 * p.x() + 0.25, 0.5 * p.y() + 0.25, 0.5 * p.z() + 0.25);
  const ClosedModel two(fork), across(bar);
  Scene scene;
  scene.add(two);
  scene.add(across);
  PenetrationOptions options;
  options.decide = 0.125;
  options.stop_when_deeper = true;
  ASSERT_EQ(scene.contacts(options).pairs.at(0).penetration.volumes.size(), 1u);
  options.stop_when_deeper = false;
  EXPECT_EQ(scene.contacts(options).pairs.at(0).penetration.volumes.size(), 2u);
}

TEST(SceneContacts, AreTheSameForAnyNumberOfThreads) {
  const ClosedModel torus(datasets::torus(0.35, 0.15, 24, 12));
  Scene scene, other;
  Random random;
  for (int i = 0; i < 12; ++i) {
    const Isometry3d pose = random.pose(0.6, 3);
    scene.add(torus, pose);
    other.add(torus, pose);
  }
  PenetrationOptions one, many;
  one.threads = 1;
  many.threads = 4;
  const SceneContacts a = scene.contacts(one), b = other.contacts(many);
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  EXPECT_GE(a.pairs.size(), 5u);
  for (std::size_t i = 0; i < a.pairs.size(); ++i) {
    EXPECT_EQ(a.pairs[i].penetration.depth.lower, b.pairs[i].penetration.depth.lower);
    EXPECT_EQ(a.pairs[i].penetration.depth.upper, b.pairs[i].penetration.depth.upper);
  }
}

TEST(Scene, FollowsARefit) {
  TriangleMesh mesh = datasets::cube(1, 4);
  Bvh still(mesh), moving(mesh);
  Scene scene;
  scene.add(still);
  scene.add(moving);
  EXPECT_EQ(scene.check_tolerance(0.1).pairs.size(), 1u);
  for (Vector3d& p : mesh.vertices) p.x() += 0.5;
  moving.refit(mesh);
  EXPECT_EQ(scene.check_tolerance(0.1).stats.skipped_by_boxes, 1u);
}

TEST(Scene, RefusesWhatIsNoPoseOrNoBody) {
  const Bvh cube(datasets::cube(1, 1));
  Scene scene;
  scene.add(cube);
  Isometry3d scaled = Isometry3d::Identity();
  scaled.linear() *= 2;
  EXPECT_THROW(scene.add(cube, scaled), InvalidInput);
  EXPECT_THROW(scene.move(0, scaled), InvalidInput);
  EXPECT_THROW(scene.move(1, Isometry3d::Identity()), InvalidInput);
  EXPECT_THROW((void)scene.model(1), InvalidInput);
  const ClosedModel solid(datasets::cube(1, 1));
  Scene solids;
  Isometry3d mirrored = Isometry3d::Identity();
  mirrored.linear()(0, 0) = -1;
  EXPECT_THROW(solids.add(solid, mirrored), InvalidInput);
  solids.add(solid);
  EXPECT_THROW(solids.move(0, mirrored), InvalidInput);
  PenetrationOptions options;
  options.error_bound = std::nan("");
  EXPECT_THROW((void)solids.contacts(options), InvalidInput);
  EXPECT_THROW((void)scene.check_tolerance(-1), InvalidInput);
  EXPECT_EQ(scene.size(), 1u);
  EXPECT_TRUE(scene.model(0).pose.matrix().isIdentity(0));
}

/// The box of a turned model holds every vertex, and each side has one, up to the error that it states.
TEST(WorldBox, TouchesTheModelOnEverySide) {
  Random random;
  const TriangleMesh mesh = datasets::gear(0.5, 0.3, 12, 6, 4);
  const Bvh tree(mesh);
  for (int i = 0; i < 50; ++i) {
    const Isometry3d pose = random.pose(i < 25 ? 1 : 1e6, 3);
    Eigen::AlignedBox3d truth;
    for (const Vector3d& p : mesh.vertices) truth.extend(pose * p);
    const WorldBox box = world_box({tree, pose});
    const double allowed = box.error + 1e-15 * (1 + pose.translation().norm());
    EXPECT_LT(box.error, 1e-12 * (1 + pose.translation().norm()));
    EXPECT_NEAR(box.lo.x, truth.min().x(), allowed);
    EXPECT_NEAR(box.lo.y, truth.min().y(), allowed);
    EXPECT_NEAR(box.lo.z, truth.min().z(), allowed);
    EXPECT_NEAR(box.hi.x, truth.max().x(), allowed);
    EXPECT_NEAR(box.hi.y, truth.max().y(), allowed);
    EXPECT_NEAR(box.hi.z, truth.max().z(), allowed);
  }
}

}  // namespace scene_test
