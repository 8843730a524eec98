// SPDX-License-Identifier: MIT
// Sheets of which a part is wound the other way: turned over and counted, or kept on request.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/analytic_meshes.h"
#include "meshbound/simplify.h"
#include "meshbound/tiles.h"

namespace meshbound {
namespace kept_sides_test {

bool is_left(const TriangleMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]].x() + mesh.vertices[t[1]].x() + mesh.vertices[t[2]].x()) / 3 < 0.4;
}

/// A terrain over the unit square that shows its upper side, but for x < 0.4.
TriangleMesh half_turned() {
  TriangleMesh mesh = datasets::terrain(1, 20, 5);
  double left = mesh.vertices[0].x();
  for (const Eigen::Vector3d& p : mesh.vertices) left = std::min(left, p.x());
  for (Eigen::Vector3d& p : mesh.vertices) p = {p.x() - left, p.y(), p.z() / 20};
  for (Triangle& t : mesh.triangles)
    if (is_left(mesh, t)) std::swap(t[1], t[2]);
  return mesh;
}

/// Twice the area of a triangle as seen from above; negative where it shows its lower side.
double doubled_area(const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return (b - a).cross(c - a).z();
}

double area_that_shows_its_lower_side(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += std::max(0.0, -doubled_area(mesh, t)) / 2;
  return area;
}

/// Triangles that show another side than the one that they come from.
std::size_t turned_faces(const TriangleMesh& original, const SimplifiedLevel& level) {
  std::size_t turned = 0;
  for (std::size_t t = 0; t < level.faces(); ++t)
    if (doubled_area(level.mesh, level.mesh.triangles[t]) *
            doubled_area(original, original.triangles[level.source_triangle[t]]) <
        0)
      ++turned;
  return turned;
}

SimplifyOptions tolerance_of(double tolerance) {
  SimplifyOptions options;
  options.tolerance = tolerance;
  options.threads = 1;
  return options;
}

TEST(KeptSides, TurnedFacesAreCounted) {
  const TriangleMesh original = half_turned();
  ASSERT_NEAR(area_that_shows_its_lower_side(original), 0.4, 1e-9);
  SimplifyOptions options = tolerance_of(0.002);
  options.levels = {0.0001};
  const SimplifyResult result = simplify_with_bound(original, options);
  ASSERT_EQ(result.levels.size(), 2U);
  for (const SimplifiedLevel& level : result.levels) {
    EXPECT_EQ(area_that_shows_its_lower_side(level.mesh), 0);
    EXPECT_GT(level.turned_faces, 2U);
    EXPECT_EQ(level.turned_faces, turned_faces(original, level));
  }
  EXPECT_LT(result.levels[1].turned_faces, result.levels[0].turned_faces);
}

TEST(KeptSides, FacesShowTheSideOfTheirOriginalsOnRequest) {
  const TriangleMesh original = half_turned();
  SimplifyOptions options = tolerance_of(0.002);
  options.keep_sides = true;
  const SimplifiedLevel level = simplify_with_bound(original, options).last();
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_LT(level.faces(), original.triangles.size() / 2);
  EXPECT_EQ(level.turned_faces, 0U);
  EXPECT_EQ(turned_faces(original, level), 0U);
  EXPECT_NEAR(area_that_shows_its_lower_side(level.mesh), 0.4, 1e-9);
}

/// No line is made of the border, which would leave more faces.
TEST(KeptSides, NothingChangesWhereNoFaceIsTurned) {
  TriangleMesh original = half_turned();
  for (Triangle& t : original.triangles)
    if (is_left(original, t)) std::swap(t[1], t[2]);
  SimplifyOptions options = tolerance_of(0.002);
  const SimplifiedLevel level = simplify_with_bound(original, options).last();
  options.keep_sides = true;
  const SimplifiedLevel kept = simplify_with_bound(original, options).last();
  EXPECT_EQ(level.turned_faces, 0U);
  EXPECT_EQ(kept.mesh.triangles, level.mesh.triangles);
  EXPECT_EQ(kept.mesh.vertices, level.mesh.vertices);
}

TEST(KeptSides, TurnedFacesAreCountedOverAllPassesOfTiles) {
  const TriangleMesh original = half_turned();
  for (const double tolerance : {1e-9, 0.0001, 0.002}) {
    for (const std::size_t max_triangles : {60, 150, 300}) {
      const SimplifiedLevel level = simplify_in_tiles(original, tolerance_of(tolerance), {max_triangles}).last();
      EXPECT_GT(level.turned_faces, 0U);
      EXPECT_EQ(level.turned_faces, turned_faces(original, level)) << tolerance << ", " << max_triangles;
    }
  }
}

}  // namespace kept_sides_test
}  // namespace meshbound
