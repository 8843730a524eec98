// SPDX-License-Identifier: GPL-3.0-or-later
// Tolerances of single faces: both directions hold, seen by a check of our own and by points that share no code with
// it; the coarse part is simplified further than the fine one would allow.
#include "meshbound/face_tolerances.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "datasets/analytic_meshes.h"
#include "drivers.h"
#include "meshbound/error.h"
#include "meshbound/simplify.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace face_tolerances_test {

constexpr double fine = 0.002, coarse = 0.03;

/// Fine where the first corner lies beyond x = 0.3.
std::vector<double> half_fine(const TriangleMesh& mesh) {
  std::vector<double> tolerances;
  for (const Triangle& t : mesh.triangles) tolerances.push_back(mesh.vertices[t[0]].x() > 0.3 ? fine : coarse);
  return tolerances;
}

Eigen::Vector3d point_on(const TriangleMesh& mesh, std::size_t triangle, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  double a = share(random), b = share(random);
  if (a + b > 1) a = 1 - a, b = 1 - b;
  const Triangle& t = mesh.triangles[triangle];
  return mesh.vertices[t[0]] * (1 - a - b) + mesh.vertices[t[1]] * a + mesh.vertices[t[2]] * b;
}

/// Largest of distance / tolerance over random points of both meshes.
double worst_share(const TriangleMesh& original, const std::vector<double>& tolerances,
                   const TriangleMesh& simplified) {
  const Bvh from(original), to(simplified);
  std::mt19937 random(7);
  double worst = 0;
  for (std::size_t t = 0; t < original.triangles.size(); ++t)
    worst = std::max(worst, closest_point(to, point_on(original, t, random)).distance.lower / tolerances[t]);
  for (std::size_t i = 0; i < 20000; ++i) {
    const ClosestPoint nearest = closest_point(from, point_on(simplified, i % simplified.triangles.size(), random));
    worst = std::max(worst, nearest.distance.lower / tolerances[nearest.point.triangle]);
  }
  return worst;
}

SimplifyOptions options_for(const TriangleMesh& mesh) {
  SimplifyOptions options;
  options.tolerance = coarse;
  options.threads = 1;
  options.face_tolerances = half_fine(mesh);
  return options;
}

void expect_both_ways(const TriangleMesh& mesh, const SimplifyOptions& options) {
  const SimplifiedLevel level = simplify_with_bound(mesh, options).last();
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_EQ(check_face_tolerances(mesh, options.face_tolerances, coarse, level.mesh).verdict, Verdict::Within);
  EXPECT_LE(worst_share(mesh, options.face_tolerances, level.mesh), 1);
}

TEST(FaceTolerances, HoldBothWaysAndCostFacesOnlyWhereTheyAreFine) {
  for (const TriangleMesh& mesh :
       {datasets::icosphere(1, 4), datasets::torus(1, 0.3, 60, 24), datasets::terrain(1, 40, 3)}) {
    SimplifyOptions options = options_for(mesh);
    for (const test::NamedDriver& driver : test::drivers()) {
      options.driver = driver.driver;
      expect_both_ways(mesh, options);
    }
    const SimplifiedLevel level = simplify_with_bound(mesh, options).last();
    EXPECT_LE(level.distance->bounds.upper, coarse);
    const std::vector<double> limits = std::exchange(options.face_tolerances, {});
    const SimplifiedLevel loose = simplify_with_bound(mesh, options).last();
    EXPECT_NE(check_face_tolerances(mesh, limits, coarse, loose.mesh).verdict, Verdict::Within);
    options.tolerance = fine;
    EXPECT_LT(level.faces(), simplify_with_bound(mesh, options).last().faces());
    EXPECT_GT(level.faces(), loose.faces());
  }
}

/// Two sheets nearer to each other than the coarse tolerance, one fine and one coarse: no point of the result may lie
/// near the wrong one only.
TEST(FaceTolerances, HoldForAFineSheetAboveACoarseOne) {
  TriangleMesh sheets = reference::both(datasets::terrain(1, 40, 3), datasets::terrain(1, 40, 3));
  const std::size_t half = sheets.vertices.size() / 2;
  for (std::size_t v = half; v < sheets.vertices.size(); ++v) sheets.vertices[v].z() += 0.01;
  SimplifyOptions options = options_for(sheets);
  for (std::size_t t = 0; t < sheets.triangles.size(); ++t)
    options.face_tolerances[t] = sheets.triangles[t][0] < half ? fine : coarse;
  const SimplifiedLevel level = simplify_with_bound(sheets, options).last();
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_LE(worst_share(sheets, options.face_tolerances, level.mesh), 1);
  EXPECT_LT(level.faces(), sheets.triangles.size());
}

TEST(FaceTolerances, HoldWithHighEffort) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = options_for(torus);
  const std::size_t normal = simplify_with_bound(torus, options).last().faces();
  options.effort = Effort::High;
  const SimplifiedLevel level = simplify_with_bound(torus, options).last();
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_LE(worst_share(torus, options.face_tolerances, level.mesh), 1);
  EXPECT_LT(level.faces(), normal);
}

TEST(FaceTolerances, OfZeroKeepTheirFacesWhereTheyAre) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  SimplifyOptions options = options_for(sphere);
  for (double& tolerance : options.face_tolerances) tolerance = tolerance == fine ? 0 : coarse;
  const SimplifiedLevel level = simplify_with_bound(sphere, options).last();
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_LT(level.faces(), sphere.triangles.size());
}

TEST(FaceTolerances, HoldInLevelsAndWhenTheToleranceForAllIsSmaller) {
  const TriangleMesh sphere = datasets::icosphere(1, 4);
  SimplifyOptions options = options_for(sphere);
  options.levels = {fine / 2, 0.01};
  for (const SimplifiedLevel& level : simplify_with_bound(sphere, options).levels) {
    EXPECT_EQ(level.verdict, Verdict::Within);
    EXPECT_LE(worst_share(sphere, options.face_tolerances, level.mesh), 1);
  }
}

/// A vertex of the fine part moved too far is found, and one of the coarse part is not held against it.
TEST(FaceTolerances, CheckNamesTheTriangleThatDoesNotHold) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  const std::vector<double> limits = half_fine(sphere);
  for (const bool in_fine_part : {true, false}) {
    TriangleMesh moved = sphere;
    const auto side = [&](const Eigen::Vector3d& p) { return in_fine_part ? p.x() > 0.8 : p.x() < -0.8; };
    *std::find_if(moved.vertices.begin(), moved.vertices.end(), side) *= 1.01;
    const FaceToleranceCheck check = check_face_tolerances(sphere, limits, coarse, moved);
    EXPECT_EQ(check.verdict, in_fine_part ? Verdict::Exceeds : Verdict::Within);
    EXPECT_EQ(check.original_triangle.has_value(), in_fine_part);
  }
}

TEST(FaceTolerances, RefuseWrongNumbers) {
  const TriangleMesh sphere = datasets::icosphere(1, 1);
  SimplifyOptions options = options_for(sphere);
  options.face_tolerances.pop_back();
  EXPECT_THROW((void)simplify_with_bound(sphere, options), InvalidInput);
  options.face_tolerances.push_back(-1);
  EXPECT_THROW((void)simplify_with_bound(sphere, options), InvalidInput);
  EXPECT_THROW((void)check_face_tolerances(sphere, std::vector<double>{1}, 1, sphere), InvalidInput);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)check_face_tolerances(sphere, half_fine(sphere), infinity, sphere), InvalidInput);
}

}  // namespace face_tolerances_test
}  // namespace meshbound
