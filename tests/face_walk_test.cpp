// SPDX-License-Identifier: MIT
// Covers found by walking over a mesh, and the faces that are prepared for it.
#include "simplify/cover/face_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "reference/small_meshes.h"
#include "simplify/mesh/face_box.h"
#include "simplify/mesh/indexed_manifold.h"

namespace meshbound {
namespace face_walk_test {

using Eigen::Vector3d;
using Corners = FaceWalk::Corners;

constexpr auto every_face = [](std::uint32_t) { return true; };

/// A mesh with what a walk over it needs.
struct Walked {
  explicit Walked(const TriangleMesh& of) : mesh(indexed_manifold(of)) {}
  [[nodiscard]] bool covers(const Corners& triangle, std::uint32_t start, double tolerance) {
    return walk.covers(triangle, start, tolerance, 1, every_face, faces);
  }
  /// The largest distance of 861 points of the triangle from the faces found.
  [[nodiscard]] double distance(const Corners& triangle) const {
    double largest = 0;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; i + j <= 40; ++j) {
        const Vec3 p = (i / 40.0) * triangle[0] + (j / 40.0) * triangle[1] + ((40 - i - j) / 40.0) * triangle[2];
        double least = HUGE_VAL;
        for (const std::uint32_t f : faces) least = std::min(least, squared_distance(mesh.triangle(f), p));
        largest = std::max(largest, std::sqrt(least));
      }
    }
    return largest;
  }
  ArrayMesh mesh;
  PreparedFaces prepared{mesh};
  FaceWalk walk{mesh, prepared};
  std::vector<std::uint32_t> faces;
};

/// 50 faces on the unit square, with vertices up to `height` above and below it.
TriangleMesh bumpy_sheet(double height, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-height, height);
  TriangleMesh sheet = reference::unit_square(5);
  for (Vector3d& p : sheet.vertices) p.z() = any(random);
  return sheet;
}

/// The face of a flat sheet under a point.
std::uint32_t face_at(const ArrayMesh& mesh, Vec3 p) {
  std::uint32_t best = 0;
  for (std::uint32_t f = 1; f < mesh.face_count(); ++f)
    if (squared_distance(mesh.triangle(f), p) < squared_distance(mesh.triangle(best), p)) best = f;
  return best;
}

constexpr double tolerance = 1.0 / 40;

TEST(FaceWalk, CoversATriangleByFacesThatAreSmaller) {
  std::mt19937 random(7);
  const Corners triangle{{{0.23, 0.12, 0}, {0.63, 0.16, 0}, {0.25, 0.55, 0}}};
  for (int round = 0; round < 100; ++round) {
    Walked it(bumpy_sheet(0.65 * tolerance, random));
    ASSERT_TRUE(it.covers(triangle, face_at(it.mesh, triangle[0]), tolerance)) << "round " << round;
    EXPECT_GT(it.faces.size(), 4U);
    ASSERT_LE(it.distance(triangle), tolerance * (1 + CandidateFaces::plane_slack)) << "round " << round;
  }
}

TEST(FaceWalk, NeverCoversWhatIsTooFarAway) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0.1, 0.9), height(-tolerance, tolerance);
  int covered = 0, refused = 0;
  for (int round = 0; round < 4000; ++round) {
    Walked it(bumpy_sheet(1.5 * tolerance, random));
    Corners triangle;
    for (Vec3& p : triangle) p = {unit(random), unit(random), height(random)};
    const auto start = static_cast<std::uint32_t>(random() % it.mesh.face_count());
    if (!it.covers(triangle, start, tolerance)) {
      ++refused;
      continue;
    }
    ++covered;
    ASSERT_LE(it.distance(triangle), tolerance * (1 + CandidateFaces::plane_slack)) << "round " << round;
    std::sort(it.faces.begin(), it.faces.end());
    EXPECT_EQ(std::adjacent_find(it.faces.begin(), it.faces.end()), it.faces.end()) << "a face is named twice";
  }
  EXPECT_GT(covered, 100);
  EXPECT_GT(refused, 1000);
}

TEST(FaceWalk, BeginsAtAnyFace) {
  Walked it(reference::unit_square(5));
  const Corners small{{{0.3, 0.22, 0.01}, {0.34, 0.22, 0.01}, {0.33, 0.24, 0.01}}};
  for (std::uint32_t start = 0; start < it.mesh.face_count(); ++start) {
    ASSERT_TRUE(it.covers(small, start, tolerance)) << start;
    EXPECT_EQ(it.faces, std::vector{face_at(it.mesh, small[0])}) << start;
  }
}

TEST(FaceWalk, GivesUpWhereTooManyFacesWouldBeNeeded) {
  Walked it(reference::unit_square(40));
  const Corners large{{{0.03, 0.02, 0}, {0.98, 0.04, 0}, {0.05, 0.95, 0}}};
  EXPECT_FALSE(it.covers(large, face_at(it.mesh, large[0]), tolerance / 10));
}

TEST(FaceWalk, TakesUsableFacesOnly) {
  Walked it(reference::unit_square(2));
  const Corners across{{{0.1, 0.2, 0}, {0.9, 0.2, 0}, {0.5, 0.3, 0}}};
  const std::uint32_t start = face_at(it.mesh, across[0]);
  ASSERT_TRUE(it.covers(across, start, tolerance));
  ASSERT_GT(it.faces.size(), 1U);
  for (const std::uint32_t barred : std::vector(it.faces)) {
    const auto is_usable = [&](std::uint32_t f) { return f != barred; };
    EXPECT_FALSE(it.walk.covers(across, start, tolerance, 1, is_usable, it.faces)) << barred;
  }
}

/// The square ends at x = 1.
TEST(FaceWalk, ReachesBeyondABorderByTheToleranceOnly) {
  Walked it(reference::unit_square(1));
  for (const double beyond : {0.3, 0.9, 1.1, 3.0}) {
    const Corners triangle{{{0.8, 0.3, 0}, {1 + beyond * tolerance, 0.4, 0}, {0.8, 0.5, 0}}};
    EXPECT_EQ(it.covers(triangle, face_at(it.mesh, triangle[0]), tolerance), beyond < 1) << beyond;
  }
}

/// Two faces with slopes of 45 degrees that meet along y. A level triangle at height 1 is 0.71 away from both above the
/// edge; the plane through the edge that is perpendicular to one face meets it 1.41 away from that face.
TEST(FaceWalk, CutsHalfwayBetweenTheFacesOfAValley) {
  Walked it(TriangleMesh{{{0, -30, 0}, {0, 30, 0}, {40, 0, 40}, {-40, 0, 40}}, {{0, 2, 1}, {0, 1, 3}}});
  const Corners level{{{-1.9, -1, 1}, {1.9, -1, 1}, {0, 2, 1}}};
  for (const std::uint32_t start : {0U, 1U}) {
    EXPECT_TRUE(it.covers(level, start, 0.75));
    EXPECT_EQ(it.faces.size(), 2U);
    EXPECT_FALSE(it.covers(level, start, 0.7));
  }
}

TEST(FaceWalk, DoesNotRelyOnPlanesOfNeedles) {
  const TriangleMesh needle{{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-17, 0}}, {{0, 1, 2}}};
  Walked it(needle);
  EXPECT_FALSE(it.prepared.planes(0, tolerance).are_accurate);
  EXPECT_FALSE(it.covers({{{0.4, 0, 0}, {0.5, 0, 0}, {0.6, 0, 0}}}, 0, tolerance));
}

/// The rounding of plane equations grows with the largest coordinate, which is taken to be 1 here.
TEST(FaceWalk, NeedsAToleranceThatIsLargerThanRounding) {
  TriangleMesh tiny = reference::unit_square(1);
  for (Vector3d& p : tiny.vertices) p *= 1e-6;
  Walked it(tiny);
  const Corners inside{{{0.7e-6, 0.1e-6, 0}, {0.8e-6, 0.1e-6, 0}, {0.8e-6, 0.2e-6, 0}}};
  const double smallest = CandidateFaces::rounding_slack(1);
  for (const std::uint32_t start : {0U, 1U}) {
    EXPECT_TRUE(it.covers(inside, start, 2 * smallest));
    EXPECT_TRUE(it.prepared.planes(start, smallest).are_accurate);
    EXPECT_FALSE(it.covers(inside, start, smallest));
  }
}

TEST(FaceWalk, CoversNothingThatIsNoNumber) {
  Walked it(reference::unit_square(2));
  Corners triangle{{{0.1, 0.2, 0}, {0.9, 0.2, 0}, {0.5, 0.3, 0}}};
  triangle[1].x = std::nan("");
  for (std::uint32_t start = 0; start < it.mesh.face_count(); ++start)
    EXPECT_FALSE(it.covers(triangle, start, tolerance)) << start;
}

TEST(PreparedFaces, FollowTheMesh) {
  ArrayMesh mesh = indexed_manifold(reference::unit_square(1));
  PreparedFaces prepared(mesh);
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
  for (std::uint32_t f = 0; f < 2; ++f) {
    EXPECT_DOUBLE_EQ(std::abs(prepared.planes(f, 0.1).at(0, above)), 1);
    EXPECT_FALSE(prepared.triangle(f).is_within({0.5, 0.5, 0.1}, 0.02));
  }
}

/// Faces whose numbers are the same modulo 128 take each other's place.
TEST(PreparedFaces, AreThoseAskedFor) {
  const ArrayMesh mesh = indexed_manifold(reference::unit_square(12));
  PreparedFaces prepared(mesh);
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
  PreparedFaces prepared(mesh);
  EXPECT_TRUE(prepared.planes(0, 10).are_accurate);
  EXPECT_FALSE(prepared.planes(0, 1e-4).are_accurate);
  EXPECT_TRUE(prepared.planes(0, 10).are_accurate);
}

}  // namespace face_walk_test
}  // namespace meshbound
