// SPDX-License-Identifier: MIT
// Walks over a surface: the faces that are prepared for them, and edges that are compared with the original.
#include "simplify/cover/surface_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "decimation_states.h"
#include "geometry/boxes.h"
#include "reference/small_meshes.h"
#include "sheets.h"
#include "simplify/cover/mesh_soup.h"
#include "simplify/mesh/indexed_manifold.h"
#include "simplify/star_samples.h"

namespace meshbound {
namespace surface_walk_test {

using Eigen::Vector3d;
using test::bumpy_sheet;
using test::nearest_at;

constexpr double tolerance = 1.0 / 40;

TEST(SurfaceWalk, IsNearAFaceAllTheWay) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.05, 0.95), height(-tolerance / 2, tolerance / 2);
  int arrived = 0, stopped = 0;
  for (int round = 0; round < 3000; ++round) {
    const ArrayMesh mesh = indexed_manifold(bumpy_sheet(2 + round % 7, 1.2 * tolerance, random));
    const MeshSoup soup{mesh};
    PreparedFaces faces(soup);
    SurfaceWalk walk(faces);
    walk.set_tolerance(tolerance, 1);
    const Vec3 start{unit(random), unit(random), height(random)}, end{unit(random), unit(random), height(random)};
    if (!walk.begin(nearest_at(soup, mesh.face_count(), start), start)) continue;
    std::vector<Vec3> points{start};
    std::vector<std::uint32_t> met{walk.face()};
    bool reaches = walk.reaches(end);
    while (!reaches && walk.pass(end)) {
      points.push_back(walk.point());
      met.push_back(walk.face());
      reaches = walk.reaches(end);
    }
    points.push_back(reaches ? end : points.back());
    (reaches ? arrived : stopped) += 1;
    for (std::size_t i = 0; i < met.size(); ++i) {
      for (const double share : {0.0, 0.3, 0.7, 1.0}) {
        const Vec3 p = points[i] + share * (points[i + 1] - points[i]);
        ASSERT_LE(squared_distance(mesh.triangle(met[i]), p), tolerance * tolerance * (1 + 1e-5)) << round;
      }
      EXPECT_NEAR(length(cross(points[i + 1] - start, end - start)), 0, 1e-12) << "off the straight way";
    }
  }
  EXPECT_GT(arrived, 1000);
  EXPECT_GT(stopped, 500);
}

TEST(SurfaceWalk, EndsAtABorder) {
  const ArrayMesh mesh = indexed_manifold(reference::unit_square(1));
  PreparedFaces faces(MeshSoup{mesh});
  SurfaceWalk walk(faces);
  walk.set_tolerance(tolerance, 1);
  const Vec3 start{0.1, 0.4, 0}, beyond{1.5, 0.5, 0};
  ASSERT_TRUE(walk.begin(nearest_at(MeshSoup{mesh}, 2, start), start));
  EXPECT_FALSE(walk.reaches(beyond));
  ASSERT_TRUE(walk.pass(beyond));
  EXPECT_FALSE(walk.reaches(beyond));
  EXPECT_FALSE(walk.pass(beyond));
}

/// The way begins beyond two sides of the first face, and is far from the face across the first of them.
TEST(SurfaceWalk, PassesToFacesThatHoldItsPointOnly) {
  const TriangleMesh corner{{{-1, 0, 0}, {0, 0, 0}, {2, 1, 0}, {-0.5, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  const ArrayMesh mesh = indexed_manifold(corner);
  PreparedFaces faces(MeshSoup{mesh});
  SurfaceWalk walk(faces);
  walk.set_tolerance(0.6, 2);
  const Vec3 start{1.26, -0.02, 0}, end{-0.5, -0.9, 0};
  EXPECT_FALSE(walk.begin(1, start));
  ASSERT_TRUE(walk.begin(0, start));
  ASSERT_FALSE(walk.reaches(end));
  EXPECT_FALSE(walk.pass(end));
}

TEST(SurfaceWalk, TellsHowFarItsPointIs) {
  const ArrayMesh mesh = indexed_manifold(reference::unit_square(1));
  PreparedFaces faces(MeshSoup{mesh});
  SurfaceWalk walk(faces);
  walk.set_tolerance(tolerance, 1);
  const Vec3 above{0.1, 0.4, 0.02}, beside{-0.015, 0.5, 0.01};
  for (const Vec3 p : {above, beside}) {
    const std::uint32_t face = nearest_at(MeshSoup{mesh}, 2, p);
    ASSERT_TRUE(walk.begin(face, p));
    EXPECT_NEAR(walk.squared_distance(), squared_distance(mesh.triangle(face), p), 1e-15);
  }
}

/// The samples of one face, and an edge that begins at the origin.
struct Looked {
  explicit Looked(const TriangleMesh& mesh) : state(mesh), samples(*state) {
    state->grow_tolerance(tolerance);
    state->set_samples(tolerance);
    samples.begin({});
    for (std::uint32_t f = 0; f < state->mesh.face_count(); ++f) samples.add_face(f);
  }
  [[nodiscard]] std::optional<double> stray(Vec3 vertex, Vec3 end, int points) {
    EXPECT_TRUE(samples.is_near_original(vertex, tolerance));
    return samples.stray_on_edge(vertex, end, points, tolerance);
  }
  test::StateOf state;
  StarSamples samples;
};

/// A roof with its ridge at x = 0.5 and the slope 1: from eaves to eaves an edge is farthest from it below the ridge.
TriangleMesh roof(double height) {
  TriangleMesh mesh = reference::unit_square(2);
  for (Vector3d& p : mesh.vertices) p.z() = 2 * height * (0.5 - std::abs(p.x() - 0.5));
  return mesh;
}

TEST(StarSamples, FindTheFarthestPointOfAnEdge) {
  Looked low(roof(0.9 * tolerance)), high(roof(1.2 * tolerance));
  const Vec3 vertex{0.01, 0.3, 0}, end{0.99, 0.35, 0};
  for (const int points : {2, 7}) {
    EXPECT_FALSE(low.stray(vertex, end, points));
    const std::optional<double> stray = high.stray(vertex, end, points);
    ASSERT_TRUE(stray);
    EXPECT_NEAR(*stray, 0.5, 0.01);
  }
  EXPECT_FALSE(high.stray(vertex, end, 0));
}

/// The edge runs on over a hole, where there is nothing to walk over: points are looked at one by one there.
TEST(StarSamples, LookBeyondTheEndOfTheOriginal) {
  TriangleMesh sheet = reference::unit_square(6);
  std::erase_if(sheet.triangles, [&](const Triangle& t) {
    const Vector3d middle = (sheet.vertices[t[0]] + sheet.vertices[t[1]] + sheet.vertices[t[2]]) / 3;
    return middle.x() > 0.5 && middle.x() < 0.8;
  });
  Looked it(sheet);
  const std::optional<double> stray = it.stray({0.1, 0.3, 0}, {0.9, 0.3, 0}, 7);
  ASSERT_TRUE(stray);
  EXPECT_GT(0.1 + 0.8 * *stray, 0.5 + tolerance);
  EXPECT_LT(0.1 + 0.8 * *stray, 0.84);
}

/// More originals lie below the edge than a walk passes: what is left is looked at point by point.
TEST(StarSamples, LookBeyondTheLastPassageOfAWalk) {
  TriangleMesh sheet = reference::unit_square(40);
  for (Vector3d& p : sheet.vertices)
    if (p.x() > 0.8) p.z() = -3 * tolerance;
  Looked it(sheet);
  const std::optional<double> stray = it.stray({0.01, 0.31, 0}, {0.97, 0.32, 0}, 15);
  ASSERT_TRUE(stray);
  EXPECT_GT(*stray, 0.75);
}

/// Where a walk does not lead, here over a hole, nothing but the points is looked at.
TEST(StarSamples, TellEdgesThatAWalkFindsTooFar) {
  const Vec3 vertex{0.01, 0.3, 0}, end{0.99, 0.35, 0}, above{0.01, 0.3, 1.1 * tolerance};
  std::uint32_t near = 0;
  for (const double height : {0.9 * tolerance, 1.2 * tolerance}) {
    test::StateOf state(roof(height));
    state->grow_tolerance(tolerance);
    StarSamples samples(*state);
    EXPECT_EQ(samples.is_edge_near(vertex, end, near, 0, tolerance), height < tolerance);
    EXPECT_FALSE(samples.is_edge_near(above, end, near, 0, tolerance)) << "it begins too far away";
  }
  TriangleMesh two = reference::unit_square(6);
  std::erase_if(two.triangles, [&](const Triangle& t) { return std::abs(two.vertices[t[0]].x() - 0.5) < 0.2; });
  test::StateOf state(two);
  state->grow_tolerance(tolerance);
  StarSamples samples(*state);
  EXPECT_TRUE(samples.is_edge_near(vertex, end, near, 0, tolerance));
  EXPECT_FALSE(samples.is_edge_near(vertex, end, near, 7, tolerance));
}

TEST(StarSamples, WalkBelowAnEdge) {
  test::StateOf state(roof(1.2 * tolerance));
  state->grow_tolerance(tolerance);
  StarSamples samples(*state);
  const Vec3 vertex{0.01, 0.3, 0};
  std::uint32_t near = 0;
  EXPECT_TRUE(samples.is_edge_near(vertex, vertex, near, 0, tolerance));
  const StarSamples::Walked over_ridge = samples.walk_below(vertex, {0.99, 0.35, 0}, near, 9);
  EXPECT_EQ(over_ridge.share, 1);
  ASSERT_TRUE(over_ridge.farthest);
  EXPECT_NEAR(over_ridge.farthest->point.x, 0.5, 0.01);
  EXPECT_NEAR(std::sqrt(over_ridge.farthest->squared), 1.2 * tolerance, 0.01 * tolerance);
  const StarSamples::Walked short_way = samples.walk_below(vertex, {0.02, 0.305, 0}, near, 9);
  EXPECT_EQ(short_way.share, 1);
  EXPECT_FALSE(short_way.farthest) << "it stays over one original";
  const StarSamples::Walked too_high = samples.walk_below({0.01, 0.3, 3 * tolerance}, {0.99, 0.35, 0}, near, 9);
  EXPECT_EQ(too_high.share, 0);
  EXPECT_LT(samples.walk_below(vertex, {0.99, 0.35, 0}, near, 2).share, 1);
}

TEST(PreparedFaces, FollowTheMesh) {
  ArrayMesh mesh = indexed_manifold(reference::unit_square(1));
  PreparedFaces prepared(MeshSoup{mesh});
  const Vec3 above{0.9, 0.5, 2};
  for (std::uint32_t f = 0; f < 2; ++f) {
    EXPECT_DOUBLE_EQ(std::abs(prepared.planes(f, 0.1).at(0, above)), 2);
    EXPECT_TRUE(prepared.triangle(f).is_within({0.5, 0.5, 0.1}, 0.02));
  }
  for (std::uint32_t v = 0; v < 4; ++v) {
    Vec3 p = mesh.position(v);
    p.z = 1;
    mesh.move(v, p);
  }
  prepared.forget();
  for (std::uint32_t f = 0; f < 2; ++f) {
    EXPECT_DOUBLE_EQ(std::abs(prepared.planes(f, 0.1).at(0, above)), 1);
    EXPECT_FALSE(prepared.triangle(f).is_within({0.5, 0.5, 0.1}, 0.02));
  }
}

/// Faces whose numbers are the same modulo 128 take each other's place.
TEST(PreparedFaces, AreThoseAskedFor) {
  const ArrayMesh mesh = indexed_manifold(reference::unit_square(12));
  PreparedFaces prepared(MeshSoup{mesh});
  for (std::uint32_t f = 0; f < 128; ++f) {
    for (const std::uint32_t face : {f, f + 128, f}) {
      const auto [a, b, c] = mesh.triangle(face);
      const Vec3 middle = (1.0 / 3) * (a + b + c);
      const FacePlanes& planes = prepared.planes(face, 0.1);
      EXPECT_TRUE(planes.are_accurate);
      const FacePlanes::Values at = planes.at(middle);
      for (std::size_t k = 0; k < at.size(); ++k) EXPECT_EQ(at[k], planes.at(k, middle));
      EXPECT_LT(std::max({at[1], at[2], at[3]}), 0) << face;
      EXPECT_NEAR(planes.at(1, a), 0, 1e-12);
      EXPECT_NEAR(planes.at(2, b), 0, 1e-12);
      EXPECT_NEAR(planes.at(3, c), 0, 1e-12);
      EXPECT_TRUE(prepared.triangle(face).is_within(middle, 1e-20)) << face;
    }
  }
}

/// Whether planes are accurate enough depends on the tolerance.
TEST(PreparedFaces, KnowTheToleranceOfTheirPlanes) {
  const TriangleMesh thin{{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-8, 0}}, {{0, 1, 2}}};
  const ArrayMesh mesh = indexed_manifold(thin);
  PreparedFaces prepared(MeshSoup{mesh});
  EXPECT_TRUE(prepared.planes(0, 10).are_accurate);
  EXPECT_FALSE(prepared.planes(0, 1e-4).are_accurate);
  EXPECT_TRUE(prepared.planes(0, 10).are_accurate);
}

}  // namespace surface_walk_test
}  // namespace meshbound
