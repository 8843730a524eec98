// SPDX-License-Identifier: GPL-3.0-or-later
// The collapses that are made by an estimate, before anything is proven: what they leave is proven or given up, and
// they move nothing that is to stay.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cgal/estimate_fault.h"
#include "cgal/height_field.h"
#include "datasets/analytic_meshes.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "reference/small_meshes.h"

namespace meshbound::cgal {
namespace {

SimplifyOptions within(double tolerance) {
  SimplifyOptions options;
  options.tolerance = tolerance;
  options.threads = 1;
  return options;
}

/// Multiplies the limit of the estimate for its lifetime; below 0 it admits nothing.
class EstimateFault {
 public:
  explicit EstimateFault(double factor) { internal::estimate_fault = factor; }
  ~EstimateFault() { internal::estimate_fault = 1; }
  EstimateFault(const EstimateFault&) = delete;
  EstimateFault& operator=(const EstimateFault&) = delete;
};

void expect_equal(const SimplifyResult& a, const SimplifyResult& b) {
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_EQ(a.levels[i].mesh.vertices, b.levels[i].mesh.vertices);
    EXPECT_EQ(a.levels[i].mesh.triangles, b.levels[i].mesh.triangles);
  }
}

/// A square in the plane z = 1: points above and below it have the height over the plane, those beside it lie to both
/// sides, and answers come in the order of the questions.
TEST(HeightField, TellsPointsAboveFromThoseBelowAndBeside) {
  HeightField field;
  const Vec3 a{0, 0, 1}, b{1, 0, 1}, c{1, 1, 1}, d{0, 1, 1};
  for (int round = 0; round < 2; ++round) {
    field.clear({0.5, 0.5, 1});
    field.add({a, b, c});
    field.add({a, c, d});
    EXPECT_EQ(field.size(), 2u);
    for (int k = 0; k < 10; ++k) field.ask({0.1 * k, 0.3, 1 + 0.01 * (k + 1)});
    for (int k = 0; k < 10; ++k) field.ask({0.3, 0.1 * k, 1 - 0.01 * (k + 1)});
    field.ask({1.5, 0.5, 1.1});
    const auto heights = field.heights();
    ASSERT_EQ(heights.size(), 21u);
    for (std::size_t k = 0; k < 10; ++k) {
      const double height = 0.01 * (static_cast<double>(k) + 1);
      EXPECT_NEAR(heights[k].low, height, 1e-6);
      EXPECT_NEAR(heights[k].high, height, 1e-6);
      EXPECT_NEAR(heights[10 + k].low, -height, 1e-6);
      EXPECT_NEAR(heights[10 + k].high, -height, 1e-6);
    }
    const double beside = std::hypot(0.5, 0.1);
    EXPECT_NEAR(heights[20].low, -beside, 1e-6);
    EXPECT_NEAR(heights[20].high, beside, 1e-6);
  }
}

TEST(EstimatedPhase, MakesMostCollapsesOfSmoothShapesAndIsProven) {
  for (const TriangleMesh& shape :
       {datasets::icosphere(1, 5), datasets::torus(1, 0.3, 120, 48), datasets::cube(1, 30)}) {
    const SimplifyResult result = simplify_with_bound(shape, within(0.01));
    EXPECT_EQ(result.last().verdict, Verdict::Within);
    EXPECT_EQ(result.estimated.restarts, 0u);
    EXPECT_GT(2 * result.estimated.performed, result.last().collapses_performed);
    EXPECT_EQ(2 * result.last().collapses_performed + result.last().faces(), shape.triangles.size());
  }
}

TEST(EstimatedPhase, LosesNoFacesToSpeakOf) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 120, 48);
  const std::size_t faces = simplify_with_bound(torus, within(0.01)).last().faces();
  const EstimateFault nothing(-1);
  const SimplifyResult proven = simplify_with_bound(torus, within(0.01));
  EXPECT_EQ(proven.estimated.performed, 0u);
  EXPECT_LT(static_cast<double>(faces), 1.05 * static_cast<double>(proven.last().faces()));
}

/// Where the estimate is far off, what comes out is that of a run without one.
TEST(EstimatedPhase, BeginsAgainWhereTheProofFails) {
  const TriangleMesh shape = datasets::terrain(1, 40, 3);
  SimplifyOptions options = within(0.01);
  options.levels = {0.003};
  options.locked_vertices.assign(shape.vertices.size(), false);
  options.locked_vertices[777] = true;
  const auto run_with = [&](double fault) {
    const EstimateFault at_work(fault);
    return simplify_with_bound(shape, options);
  };
  const SimplifyResult proven = run_with(-1), restarted = run_with(30);
  EXPECT_EQ(proven.estimated.restarts, 0u);
  EXPECT_GE(restarted.estimated.restarts, 1u);
  EXPECT_EQ(restarted.estimated.performed, 0u);
  EXPECT_EQ(restarted.last().verdict, Verdict::Within);
  expect_equal(proven, restarted);
}

/// A little too far, so that a few places fail, and without these nothing does.
TEST(EstimatedPhase, LeavesAloneWhatItCouldNotProveAtFirst) {
  const TriangleMesh shape = datasets::terrain(1, 60, 3);
  bool was_mended = false;
  for (const double fault : {1.9, 2.0, 2.2, 2.4}) {
    const EstimateFault at_work(fault);
    const SimplifyResult result = simplify_with_bound(shape, within(0.01));
    EXPECT_EQ(result.last().verdict, Verdict::Within);
    was_mended = was_mended || (result.estimated.restarts == 1 && result.estimated.performed > 1000);
  }
  EXPECT_TRUE(was_mended);
}

TEST(EstimatedPhase, BeginsAgainForATargetThatItReachedWithoutAProof) {
  SimplifyOptions options = within(0.001);
  options.target_faces = 20;
  const EstimateFault at_work(1000);
  const SimplifyResult result = simplify_with_bound(datasets::icosphere(1, 4), options);
  EXPECT_GE(result.estimated.restarts, 1u);
  EXPECT_EQ(result.last().verdict, Verdict::Within);
  EXPECT_EQ(result.last().ended_by, EndedBy::NothingFits);
  EXPECT_GT(result.last().faces(), 100u);
}

TEST(EstimatedPhase, EndsAtATargetThatIsNearAndSaysSo) {
  SimplifyOptions options = within(0.05);
  options.target_faces = 4000;
  const SimplifyResult result = simplify_with_bound(datasets::icosphere(1, 4), options);
  EXPECT_EQ(result.last().ended_by, EndedBy::Target);
  EXPECT_EQ(result.last().faces(), 4000u);
  EXPECT_EQ(result.last().collapses_performed, result.estimated.performed);
}

TEST(EstimatedPhase, LeavesLockedVerticesAndTheBoundaryWhereTheyAre) {
  const TriangleMesh terrain = datasets::terrain(1, 60, 3);
  SimplifyOptions options = within(0.02);
  options.preserve_boundary = true;
  options.locked_vertices.assign(terrain.vertices.size(), false);
  for (std::size_t v = 0; v < terrain.vertices.size(); v += 97) options.locked_vertices[v] = true;
  const SimplifyResult result = simplify_with_bound(terrain, options);
  EXPECT_GT(result.estimated.performed, 1000u);
  const auto& left = result.last().mesh.vertices;
  for (std::size_t v = 0; v < terrain.vertices.size(); ++v) {
    const Eigen::Vector3d& p = terrain.vertices[v];
    const bool on_border = p.x() == 0 || p.y() == 0 || p.x() == 1 || p.y() == 1;
    if (!options.locked_vertices[v] && !on_border) continue;
    EXPECT_NE(std::find(left.begin(), left.end(), p), left.end()) << v;
  }
}

TEST(EstimatedPhase, GivesTheSameMeshForAnyNumberOfThreads) {
  const TriangleMesh terrain = datasets::terrain(1, 60, 3);
  SimplifyOptions options = within(0.01);
  const SimplifyResult one = simplify_with_bound(terrain, options);
  options.threads = 2;
  expect_equal(one, simplify_with_bound(terrain, options));
  EXPECT_GT(one.estimated.performed, 0u);
}

TEST(EstimatedPhase, StaysOutWhereItIsNotSound) {
  const TriangleMesh sphere = datasets::icosphere(1, 4);
  SimplifyOptions pruned = within(0.01), limited = within(0.01);
  pruned.prune = true;
  limited.face_tolerances.assign(sphere.triangles.size(), 0.02);
  EXPECT_EQ(simplify_with_bound(sphere, pruned).estimated.performed, 0u);
  EXPECT_EQ(simplify_with_bound(sphere, limited).estimated.performed, 0u);
  TriangleMesh with_duplicate = sphere;
  with_duplicate.triangles.push_back(sphere.triangles[5]);
  EXPECT_EQ(simplify_with_bound(with_duplicate, within(0.01)).estimated.performed, 0u);
}

}  // namespace
}  // namespace meshbound::cgal
