// SPDX-License-Identifier: MIT
// Levels are chosen so that no proven error covers more pixels than asked, and none is made that nobody needs.
#include "meshbound/view_levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"

namespace view_levels_test {

using namespace meshbound;
using Eigen::Affine3d;
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

Affine3d at(const Vector3d& position, double scale = 1) {
  Affine3d pose = Affine3d::Identity();
  pose.translation() = position;
  pose.linear() *= scale;
  return pose;
}

/// Along -z from the origin, a right angle both ways, 1000 pixels each.
ViewCamera square_camera() {
  ViewCamera camera;
  camera.screen = {1000, std::numbers::pi / 2};
  camera.aspect_ratio = 1;
  return camera;
}

const AlignedBox3d unit_box(Vector3d(-1, -1, -1), Vector3d(1, 1, 1));

/// At depth 10 a right angle shows 20 units over 1000 pixels; in the corner, where all three coordinates are equal, a
/// length covers root 3 times as many.
TEST(ViewTolerance, IsWhatAPixelShowsAtTheNearestDepthInTheCornerOfTheScreen) {
  const double t = view_tolerance(square_camera(), 1, unit_box, at({0, 0, -11}));
  EXPECT_NEAR(t, 0.02 / std::sqrt(3), 0.02 * 0.002);
  EXPECT_NEAR(view_tolerance(square_camera(), 3, unit_box, at({0, 0, -11})), 3 * t, 1e-4);
  ViewCamera turned = square_camera();
  turned.direction = {5, 0, 0};
  EXPECT_NEAR(view_tolerance(turned, 1, unit_box, at({11, 0, 0})), t, 1e-12);
}

TEST(ViewTolerance, IsZeroAroundTheCameraAndWithoutLimitBehindIt) {
  EXPECT_EQ(view_tolerance(square_camera(), 1, unit_box, at({0, 0, 0})), 0);
  EXPECT_EQ(view_tolerance(square_camera(), 1, unit_box, at({0, 0, 0.5})), 0);
  EXPECT_EQ(view_tolerance(square_camera(), 1, unit_box, at({0, 0, 2})), std::numeric_limits<double>::infinity());
}

/// Points of the box that move by the tolerance, on the screen before and after, move by at most the pixels asked for.
TEST(ViewTolerance, NoDeviationCoversMorePixelsAnywhereOnTheScreen) {
  std::mt19937 engine(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
  };
  const ViewCamera camera = square_camera();
  const auto project = [&](const Vector3d& p) {
    return Eigen::Vector2d(500 * p.x() / -p.z(), 500 * p.y() / -p.z());  // pixels from the centre
  };
  double largest = 0;
  for (const double pixels : {1.0, 40.0}) {
    const Affine3d pose = at({3, 3, -5});
    const double t = view_tolerance(camera, pixels, unit_box, pose);
    for (int i = 0; i < 200000; ++i) {
      const Vector3d p = pose * Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      const Vector3d moved = p + t * Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
      const Eigen::Vector2d before = project(p), after = project(moved);
      if (before.cwiseAbs().maxCoeff() > 500 || after.cwiseAbs().maxCoeff() > 500) continue;
      largest = std::max(largest, (after - before).norm() / pixels);
    }
  }
  EXPECT_LE(largest, 1);
  EXPECT_GE(largest, 0.8);  // not far too careful
}

class Tori : public testing::Test {
 protected:
  static ViewOptions options() {
    ViewOptions options;
    options.lod.threads = 1;
    return options;
  }
  ViewLevels choose(const std::vector<ViewInstance>& instances, const ViewOptions& options = Tori::options()) {
    made_ = 0;
    return view_levels(models_, instances, std::vector{square_camera()}, options,
                       [this](std::size_t, std::size_t, const LodLevel&) { ++made_; });
  }
  std::vector<TriangleMesh> models_{datasets::torus(1, 0.3, 80, 40)};
  std::size_t made_ = 0;
};

TEST_F(Tori, EachGetsTheCoarsestLevelWhoseErrorIsSmallEnoughAndNoOtherIsMade) {
  std::vector<ViewInstance> instances;
  for (const double depth : {3.0, 12.0, 13.0, 100.0, 2000.0}) instances.push_back({0, at({0, 0, -depth}), {}});
  instances.push_back({0, at({0, 0, 50}), {}});
  const ViewLevels levels = choose(instances);
  ASSERT_EQ(levels.cameras.size(), 1u);
  const ViewChoice& choice = levels.cameras[0];
  const AlignedBox3d box = used_bounding_box(models_[0]);
  std::set<std::uint32_t> used;
  std::size_t triangles = 0;
  for (std::size_t i = 0; i + 1 < instances.size(); ++i) {
    const double tolerance = view_tolerance(square_camera(), 1, box, instances[i].pose);
    ASSERT_LT(choice.level[i], levels.models[0].size());
    EXPECT_LE(levels.models[0][choice.level[i]].error, tolerance);
    if (choice.level[i] + 1 < levels.models[0].size()) {
      EXPECT_GT(levels.models[0][choice.level[i] + 1].error, tolerance);
    }
    used.insert(choice.level[i]);
    triangles += levels.models[0][choice.level[i]].faces;
  }
  EXPECT_EQ(choice.level.back(), ViewChoice::hidden);
  EXPECT_EQ(choice.triangles, triangles);
  EXPECT_EQ(choice.full_triangles, 5 * models_[0].triangles.size());
  EXPECT_LT(choice.triangles, choice.full_triangles / 2);
  EXPECT_EQ(levels.levels_computed, made_);
  EXPECT_EQ(levels.levels_computed + 1, levels.models[0].size());
  EXPECT_LE(levels.levels_computed, 5u);
  EXPECT_EQ(levels.levels_computed + levels.levels_skipped, 12u);
}

TEST_F(Tori, ErrorsGrowAndTrianglesDoNot) {
  std::vector<ViewInstance> instances;
  for (double depth = 2; depth < 10000; depth *= 1.5) instances.push_back({0, at({0, 0, -depth}), {}});
  const std::vector<ViewLevel> levels = choose(instances).models[0];
  ASSERT_GE(levels.size(), 8u);
  EXPECT_EQ(levels[0].error, 0);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    EXPECT_GE(levels[i].error, levels[i - 1].error);
    EXPECT_LE(levels[i].error, levels[i].tolerance);
    EXPECT_LE(levels[i].faces, levels[i - 1].faces);
  }
}

TEST_F(Tori, NothingIsMadeWhereEveryInstanceIsNearOrHidden) {
  const ViewLevels levels = choose({{0, at({0, 0, -0.35}), {}}, {0, at({0, 0, 90}), {}}});
  EXPECT_EQ(made_, 0u);
  EXPECT_EQ(levels.levels_computed, 0u);
  EXPECT_EQ(levels.cameras[0].level[0], 0u);
  EXPECT_EQ(levels.cameras[0].triangles, models_[0].triangles.size());
}

TEST_F(Tori, ALargerInstanceNeedsAFinerLevel) {
  const ViewLevels levels = choose({{0, at({0, 0, -200}), {}}, {0, at({0, 0, -200}, 20), {}}});
  EXPECT_GT(levels.cameras[0].level[0], levels.cameras[0].level[1]);
}

/// Where a pose stretches directions by different factors, the largest factor counts.
TEST_F(Tori, AStretchedInstanceNeedsTheLevelOfItsLongestDirection) {
  Affine3d stretched = at({0, 0, -50});
  stretched.linear() = Vector3d(-1, 4, 0.5).asDiagonal();
  const ViewLevels levels = choose({{0, stretched, {}}, {0, at({0, 0, -50}), {}}});
  const double tolerance = view_tolerance(square_camera(), 1, used_bounding_box(models_[0]), stretched);
  const std::vector<ViewLevel>& of_torus = levels.models[0];
  const std::uint32_t chosen = levels.cameras[0].level[0];
  EXPECT_LE(4 * of_torus[chosen].error, tolerance);
  EXPECT_GT(levels.cameras[0].level[1], chosen);
  EXPECT_GT(4 * of_torus[chosen + 1].error, tolerance);
}

TEST_F(Tori, APointIsHidden) {
  const ViewLevels levels = choose({{0, at({0, 0, -5}, 0), {}}, {0, at({0, 0, 0}, 0), {}}});
  EXPECT_EQ(levels.cameras[0].level, std::vector<std::uint32_t>(2, ViewChoice::hidden));
}

TEST_F(Tori, TheErrorOfAGroupIsThatOfItsWorstPart) {
  const ViewLevels levels = choose(
      {{0, at({0, 0, -20}), 1}, {0, at({5, 0, -400}, 2), 1}, {0, at({0, 0, -0.35}), 0}, {0, at({0, 0, -900}), {}}});
  ASSERT_EQ(levels.group_errors[0].size(), 2u);
  EXPECT_EQ(levels.group_errors[0][0], 0);
  const ViewChoice& choice = levels.cameras[0];
  const double first = levels.models[0][choice.level[0]].error, second = 2 * levels.models[0][choice.level[1]].error;
  EXPECT_GE(levels.group_errors[0][1], std::max(first, second));
  EXPECT_NEAR(levels.group_errors[0][1], std::max(first, second), 1e-6);
}

/// Squares of these lengths are no numbers.
TEST(ViewTolerance, TakesDirectionsOfAnyLength) {
  ViewCamera camera;
  camera.direction = {0.1, 0.2, -1};
  const double expected = view_tolerance(camera, 1, unit_box, at({0, 0, -5}));
  for (const double length : {1e-300, 3e-162, 1e160, 1e300}) {
    camera.direction = length * Eigen::Vector3d(0.1, 0.2, -1);
    EXPECT_NEAR(view_tolerance(camera, 1, unit_box, at({0, 0, -5})), expected, 1e-12) << length;
  }
  camera.direction = {1e150, 1e150, -1e150};
  EXPECT_LT(view_tolerance(camera, 1, unit_box, at({0, 0, -1e200})), HUGE_VAL);  // in front of it
  EXPECT_EQ(view_tolerance(camera, 1, unit_box, at({1.5e308, 1.5e308, 1.5e308})), 0);
}

TEST_F(Tori, WhatCannotBeIsRefused) {
  EXPECT_THROW((void)choose({{0, at({0, 0, -std::numeric_limits<double>::infinity()}), {}}}), InvalidInput);
  EXPECT_THROW((void)choose({{1, at({0, 0, -5}), {}}}), InvalidInput);
  ViewOptions none = options();
  none.pixels = 0;
  EXPECT_THROW((void)choose({{0, at({0, 0, -5}), {}}}, none), InvalidInput);
  none = options();
  none.ratio = 1;
  EXPECT_THROW((void)choose({{0, at({0, 0, -5}), {}}}, none), InvalidInput);
  ViewCamera camera;
  camera.direction.setZero();
  EXPECT_THROW((void)view_tolerance(camera, 1, unit_box, at({0, 0, -5})), InvalidInput);
  AffineMap transposed = at({0, 0, -5});
  transposed.matrix().transposeInPlace();
  EXPECT_THROW((void)view_tolerance({}, 1, unit_box, transposed), InvalidInput);
  EXPECT_THROW((void)choose({{0, transposed, {}}}), InvalidInput);
  const double none_at_all = std::nan("");
  camera = {};
  EXPECT_THROW((void)view_tolerance(camera, 1, unit_box, at({0, none_at_all, -5})), InvalidInput);
  camera.position.x() = none_at_all;
  EXPECT_THROW((void)view_tolerance(camera, 1, unit_box, at({0, 0, -5})), InvalidInput);
  EXPECT_THROW((void)choose({{0, at({0, 0, -5}), std::numeric_limits<std::size_t>::max()}}), InvalidInput);
  const std::vector<TriangleMesh> broken = {{{{0, 0, 0}}, {{0, 1, 2}}}};
  const std::vector<ViewInstance> shown = {{0, at({0, 0, -5}), {}}};
  EXPECT_THROW((void)view_levels(broken, shown, std::vector<ViewCamera>{{}}, options()), InvalidInput);
}

}  // namespace view_levels_test
