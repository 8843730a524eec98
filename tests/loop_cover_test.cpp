// SPDX-License-Identifier: MIT
// Covers by the faces along the edges of a triangle.
#include "simplify/cover/loop_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "geometry/boxes.h"
#include "reference/small_meshes.h"
#include "sheets.h"
#include "simplify/mesh/indexed_manifold.h"

namespace meshbound {
namespace loop_cover_test {

using Eigen::Vector3d;
using test::bumpy_sheet;
using test::nearest_at;
using Corners = std::array<Vec3, 3>;

constexpr auto every_face = [](std::uint32_t) { return true; };

/// Triangles of an original and a mesh, with what covers by loops need of them.
struct Covered {
  Covered(const TriangleMesh& of, const Corners& triangle)
      : Covered(of, {triangle.begin(), triangle.end()}, {{0, 1, 2}}) {}
  Covered(const TriangleMesh& of, std::vector<Vec3> points, std::vector<Triangle> of_points)
      : vertices(std::move(points)), triangles(std::move(of_points)), mesh(indexed_manifold(of)) {}

  [[nodiscard]] LoopCover::Start start_at(std::uint32_t vertex) const {
    return {nearest_at(MeshSoup{mesh}, mesh.face_count(), vertices[vertex]), false};
  }
  void forget() {
    prepared.forget();
    loops.forget();
  }
  [[nodiscard]] bool covers(double tolerance, std::uint32_t t = 0) {
    loops.set_tolerance(tolerance, 1);
    return loops.covers(
        t, [&](std::uint32_t from, std::uint32_t) { return start_at(from); }, every_face, faces);
  }
  /// The largest distance of 861 points of a triangle from the faces found.
  [[nodiscard]] double distance(std::uint32_t t = 0) const {
    const Vec3 a = vertices[triangles[t][0]], b = vertices[triangles[t][1]], c = vertices[triangles[t][2]];
    double largest = 0;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; i + j <= 40; ++j) {
        const Vec3 p = (i / 40.0) * a + (j / 40.0) * b + ((40 - i - j) / 40.0) * c;
        double least = HUGE_VAL;
        for (const std::uint32_t f : faces) least = std::min(least, squared_distance(mesh.triangle(f), p));
        largest = std::max(largest, std::sqrt(least));
      }
    }
    return largest;
  }
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  ArrayMesh mesh;
  PreparedFaces<MeshSoup> prepared{MeshSoup{mesh}};
  LoopCover loops{vertices, triangles, prepared};
  std::vector<std::uint32_t> faces;
};

constexpr double tolerance = 1.0 / 40;
constexpr double proven = tolerance * (1 + CandidateFaces::plane_slack);

TEST(LoopCover, CoversATriangleByTheFacesAlongItsEdges) {
  std::mt19937 random(7);
  const Corners triangle{{{0.23, 0.12, 0}, {0.53, 0.16, 0}, {0.25, 0.45, 0}}};
  int covered = 0;
  for (int round = 0; round < 100; ++round) {
    Covered it(bumpy_sheet(5, 0.6 * tolerance, random), triangle);
    if (!it.covers(tolerance)) continue;
    ++covered;
    EXPECT_GT(it.faces.size(), 4U);
    ASSERT_LE(it.distance(), proven) << "round " << round;
  }
  EXPECT_EQ(covered, 100);
}

/// Triangles and sheets of all sizes: whatever is covered is near the faces named, each of them once.
TEST(LoopCover, NeverCoversWhatIsTooFarAway) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0.1, 0.9), height(-tolerance, tolerance), size(0.05, 1);
  int covered = 0, by_many = 0, refused = 0;
  for (int round = 0; round < 6000; ++round) {
    const Vec3 middle{unit(random), unit(random), 0};
    const double scale = size(random);
    Corners triangle;
    for (Vec3& p : triangle) p = middle + scale * (Vec3{unit(random), unit(random), height(random)} - middle);
    Covered it(bumpy_sheet(1 + round % 9, 1.4 * tolerance * size(random), random), triangle);
    if (!it.covers(tolerance)) {
      ++refused;
      continue;
    }
    ++covered;
    by_many += it.faces.size() > 2 ? 1 : 0;
    ASSERT_LE(it.distance(), proven) << "round " << round;
    EXPECT_EQ(std::set(it.faces.begin(), it.faces.end()).size(), it.faces.size()) << "a face is named twice";
  }
  EXPECT_GT(covered, 1000);
  EXPECT_GT(by_many, 300);
  EXPECT_GT(refused, 1000);
}

/// Its corners and edges are near the base of a pyramid with six sides, its middle is a tolerance and a half below the
/// tip.
TEST(LoopCover, SeesAPeakInTheMiddle) {
  for (const double peak : {0.9, 1.5}) {
    TriangleMesh pyramid{{{0, 0, peak * tolerance}}, {}};
    for (int k = 0; k < 6; ++k) {
      pyramid.vertices.emplace_back(std::cos(k * M_PI / 3), std::sin(k * M_PI / 3), 0);
      pyramid.triangles.push_back({0, static_cast<std::uint32_t>(1 + k), static_cast<std::uint32_t>(1 + (k + 1) % 6)});
    }
    Covered it(pyramid, {{{-0.6, -0.5, 0.4 * tolerance}, {0.6, -0.5, 0.4 * tolerance}, {0, 0.7, 0.4 * tolerance}}});
    EXPECT_EQ(it.covers(tolerance), peak < 1) << peak;
    EXPECT_EQ(it.faces.empty(), peak > 1);
  }
}

/// A thin triangle over several faces in a row: where its ends are cannot be seen from its middle.
TEST(LoopCover, CrossesAStripOfFaces) {
  Covered it(reference::unit_square(4), {{{0.1, 0.3, 0}, {0.7, 0.32, 0}, {0.7, 0.36, 0}}});
  ASSERT_TRUE(it.covers(tolerance));
  EXPECT_GT(it.faces.size(), 3U);
  EXPECT_LE(it.distance(), proven);
}

TEST(LoopCover, WalksAlongASharedEdgeOnce) {
  const std::vector<Vec3> points{{0.1, 0.5, 0}, {0.9, 0.45, 0}, {0.6, 0.9, 0}, {0.4, 0.1, 0}};
  for (const Triangle& second : {Triangle{0, 1, 3}, Triangle{1, 0, 3}, Triangle{3, 1, 0}}) {
    Covered it(reference::unit_square(3), points, {{0, 1, 2}, second});
    it.loops.set_tolerance(tolerance, 1);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> asked;
    for (std::uint32_t t = 0; t < 2; ++t) {
      ASSERT_TRUE(it.loops.covers(
          t,
          [&](std::uint32_t from, std::uint32_t to) {
            asked.emplace_back(from, to);
            return it.start_at(from);
          },
          every_face, it.faces));
      EXPECT_LE(it.distance(t), proven);
    }
    EXPECT_EQ(asked.size(), 5U);
  }
}

/// The mesh sinks by more than the tolerance between two questions.
TEST(LoopCover, ForgetsWhatChanges) {
  Covered it(reference::unit_square(2), {{{0.1, 0.2, 0}, {0.9, 0.2, 0}, {0.5, 0.3, 0}}});
  ASSERT_TRUE(it.covers(tolerance));
  for (std::uint32_t v = 0; v < it.mesh.vertex_count(); ++v) {
    Vec3 p = it.mesh.position(v);
    p.z = -1.1 * tolerance;
    it.mesh.move(v, p);
  }
  it.forget();
  EXPECT_FALSE(it.covers(tolerance));
  EXPECT_TRUE(it.covers(1.2 * tolerance));
}

TEST(LoopCover, AsksAnewForAnotherTolerance) {
  Covered it(reference::unit_square(2), {{{0.1, 0.2, 0.02}, {0.9, 0.2, 0.02}, {0.5, 0.3, 0.02}}});
  EXPECT_FALSE(it.covers(0.019));
  EXPECT_TRUE(it.covers(0.021));
  EXPECT_FALSE(it.covers(0.019));
}

/// A face that is known to hold both ends is not asked again; a wrong one would be taken at its word.
TEST(LoopCover, TakesAFaceThatHoldsBothEndsAsItIs) {
  Covered it(reference::unit_square(5), {{{0.3, 0.22, 0.01}, {0.34, 0.22, 0.01}, {0.33, 0.24, 0.01}}});
  const std::uint32_t face = nearest_at(MeshSoup{it.mesh}, it.mesh.face_count(), it.vertices[0]);
  it.loops.set_tolerance(tolerance, 1);
  const auto both = [&](std::uint32_t, std::uint32_t) { return LoopCover::Start{face, true}; };
  ASSERT_TRUE(it.loops.covers(0, both, every_face, it.faces));
  EXPECT_EQ(it.faces, std::vector{face});
}

/// Where nothing is known at one end of an edge, the walk begins at the other one.
TEST(LoopCover, BeginsAtEitherEnd) {
  Covered it(reference::unit_square(3), {{{0.1, 0.5, 0}, {0.9, 0.45, 0}, {0.6, 0.9, 0}}});
  it.loops.set_tolerance(tolerance, 1);
  for (std::uint32_t known = 0; known < 8; ++known) {
    it.forget();
    const auto some = [&](std::uint32_t from, std::uint32_t) {
      return (known >> from & 1U) != 0 ? it.start_at(from) : LoopCover::Start{};
    };
    const bool is_each_edge_known = known == 3 || known > 4;
    EXPECT_EQ(it.loops.covers(0, some, every_face, it.faces), is_each_edge_known) << known;
    if (is_each_edge_known) {
      EXPECT_LE(it.distance(), proven);
    }
  }
}

/// A strip above the left part of the square ends before the other end of each edge.
TEST(LoopCover, ForgetsAWalkThatEndsBeforeItsEdge) {
  TriangleMesh mesh = reference::unit_square(4);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size()),
             strip = static_cast<std::uint32_t>(mesh.triangles.size());
  const double above = tolerance / 2;
  mesh.vertices.insert(mesh.vertices.end(),
                       {{0, 0, above}, {0.2, 0, above}, {0.4, 0, above}, {0, 1, above}, {0.4, 1, above}});
  for (const Triangle& t : {Triangle{0, 1, 3}, Triangle{1, 4, 3}, Triangle{1, 2, 4}})
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  Covered it(mesh, {{{0.05, 0.3, 0}, {0.8, 0.3, 0}, {0.8, 0.36, 0}}});
  it.loops.set_tolerance(tolerance, 1);
  const auto on_strip_first = [&](std::uint32_t from, std::uint32_t) {
    return from == 0 ? LoopCover::Start{strip, false} : it.start_at(from);
  };
  ASSERT_TRUE(it.loops.covers(0, on_strip_first, every_face, it.faces));
  EXPECT_LE(it.distance(), proven);
  for (const std::uint32_t f : it.faces) EXPECT_LT(f, strip);
}

TEST(LoopCover, RefusesAStartThatIsTooFarAway) {
  Covered it(reference::unit_square(5), {{{0.3, 0.22, 0.01}, {0.34, 0.22, 0.01}, {0.33, 0.24, 0.01}}});
  it.loops.set_tolerance(tolerance, 1);
  const auto far_away = [&](std::uint32_t, std::uint32_t) {
    return LoopCover::Start{nearest_at(MeshSoup{it.mesh}, it.mesh.face_count(), {0.9, 0.9, 0}), false};
  };
  EXPECT_FALSE(it.loops.covers(0, far_away, every_face, it.faces));
}

/// Each column of the square has two faces, and a needle goes through both.
TEST(LoopCover, FollowsANeedleAcrossDozensOfFacesButNotMore) {
  for (const double end : {0.7, 0.98}) {
    Covered it(reference::unit_square(40), {{{0.03, 0.021, 0}, {end, 0.0211, 0}, {end, 0.0212, 0}}});
    EXPECT_EQ(it.covers(tolerance / 10), end < 0.8);
    EXPECT_EQ(it.faces.empty(), end > 0.8);
    if (!it.faces.empty()) {
      EXPECT_LE(it.distance(), tolerance / 10 * (1 + CandidateFaces::plane_slack));
    }
  }
}

/// Needles side by side: their walks have more faces together than are kept.
TEST(LoopCover, CoversMoreNeedlesThanItRemembers) {
  constexpr std::uint32_t count = 250;
  std::vector<Vec3> points;
  std::vector<Triangle> needles;
  for (std::uint32_t i = 0; i <= count; ++i) {
    const double y = 0.2 + 0.6 * i / count;
    points.insert(points.end(), {{0.03, y, 0}, {0.7, y, 0}});
    if (i < count) needles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
  }
  Covered it(reference::unit_square(40), points, needles);
  for (std::uint32_t i = 0; i < 2 * count; ++i) {
    const std::uint32_t t = i % 2 == 0 ? i / 2 : i / 4;  // one that is new and one that was asked for before
    ASSERT_TRUE(it.covers(tolerance / 10, t)) << t;
    EXPECT_GE(it.faces.size(), 20U);
    EXPECT_LE(it.distance(t), tolerance / 10 * (1 + CandidateFaces::plane_slack));
  }
}

TEST(LoopCover, TakesUsableFacesOnly) {
  Covered it(reference::unit_square(2), {{{0.1, 0.2, 0}, {0.9, 0.2, 0}, {0.5, 0.3, 0}}});
  ASSERT_TRUE(it.covers(tolerance));
  ASSERT_GT(it.faces.size(), 1U);
  for (const std::uint32_t barred : std::vector(it.faces)) {
    it.forget();
    const auto start_at = [&](std::uint32_t from, std::uint32_t) { return it.start_at(from); };
    const auto is_usable = [&](std::uint32_t f) { return f != barred; };
    EXPECT_FALSE(it.loops.covers(0, start_at, is_usable, it.faces)) << barred;
  }
}

/// The square ends at x = 1.
TEST(LoopCover, ReachesBeyondABorderByTheToleranceOnly) {
  for (const double beyond : {0.3, 0.9, 1.1, 3.0}) {
    Covered it(reference::unit_square(1), {{{0.8, 0.3, 0}, {1 + beyond * tolerance, 0.4, 0}, {0.8, 0.5, 0}}});
    EXPECT_EQ(it.covers(tolerance), beyond < 1) << beyond;
  }
}

/// Two faces with slopes of 45 degrees that meet along y. A level triangle at height 1 is 0.71 away from both above the
/// edge; the plane through the edge that is perpendicular to one face meets it 1.41 away from that face.
TEST(LoopCover, PassesHalfwayBetweenTheFacesOfAValley) {
  Covered it(TriangleMesh{{{0, -30, 0}, {0, 30, 0}, {40, 0, 40}, {-40, 0, 40}}, {{0, 2, 1}, {0, 1, 3}}},
             {{{-1.9, -1, 1}, {1.9, -1, 1}, {0, 2, 1}}});
  EXPECT_TRUE(it.covers(0.75));
  EXPECT_EQ(it.faces.size(), 2U);
  EXPECT_FALSE(it.covers(0.7));
}

TEST(LoopCover, DoesNotRelyOnPlanesOfNeedles) {
  const TriangleMesh needle{{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-17, 0}}, {{0, 1, 2}}};
  Covered it(needle, {{{0.4, 0, 0}, {0.5, 0, 0}, {0.6, 0, 0}}});
  EXPECT_FALSE(it.prepared.planes(0, tolerance).are_accurate);
  EXPECT_FALSE(it.covers(tolerance));
}

/// The rounding of plane equations grows with the largest coordinate, which is taken to be 1 here.
TEST(LoopCover, NeedsAToleranceThatIsLargerThanRounding) {
  TriangleMesh tiny = reference::unit_square(1);
  for (Vector3d& p : tiny.vertices) p *= 1e-6;
  Covered it(tiny, {{{0.7e-6, 0.1e-6, 0}, {0.8e-6, 0.1e-6, 0}, {0.8e-6, 0.2e-6, 0}}});
  const double smallest = CandidateFaces::rounding_slack(1);
  EXPECT_TRUE(it.covers(2 * smallest));
  EXPECT_TRUE(it.prepared.planes(0, smallest).are_accurate);
  EXPECT_FALSE(it.covers(smallest));
}

TEST(LoopCover, CoversNothingThatIsNoNumber) {
  for (std::size_t k = 0; k < 3; ++k) {
    Corners triangle{{{0.1, 0.2, 0}, {0.9, 0.2, 0}, {0.5, 0.3, 0}}};
    triangle[k].x = std::nan("");
    Covered it(reference::unit_square(2), triangle);
    EXPECT_FALSE(it.covers(tolerance)) << k;
  }
}

}  // namespace loop_cover_test
}  // namespace meshbound
