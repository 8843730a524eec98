// SPDX-License-Identifier: MIT
// What is accepted as the boundary of a solid, and what the refusals say.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "meshbound/error.h"
#include "meshbound/penetration_depth.h"
#include "penetration/closed_model_data.h"
#include "penetration/contact.h"
#include "penetration/placed_pair.h"
#include "reference/point_triangle_cases.h"
#include "reference/small_meshes.h"
#include "solids.h"

namespace meshbound {
namespace closed_model_test {

using namespace reference;
using namespace solids;

/// The line that refuses a mesh; empty where it is accepted.
std::string refusal(const TriangleMesh& mesh) {
  try {
    const ClosedModel model(mesh);
    return {};
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

void expect_refused(const TriangleMesh& mesh, const std::string& reason) {
  const std::string line = refusal(mesh);
  EXPECT_NE(line.find(reason), std::string::npos) << "not refused for \"" << reason << "\": \"" << line << "\"";
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

const TriangleMesh unit = box({0, 0, 0}, {1, 1, 1});

TEST(ClosedModel, AcceptsSolids) {
  EXPECT_EQ(refusal(unit), "");
  EXPECT_EQ(refusal(icosphere(3)), "");
  EXPECT_EQ(refusal(subdivided(subdivided(unit))), "") << "many triangles in one plane";
  EXPECT_EQ(refusal(scaled(icosphere(2), 1e-160)), "");
  EXPECT_EQ(refusal(scaled(icosphere(2), 1e150)), "");
  EXPECT_EQ(refusal(moved(icosphere(2), {1e9, -1e9, 1e9})), "");
}

/// How many different planes the triangles of a mesh are said to lie in, once each is checked to lie in its own.
std::size_t planes_of(const TriangleMesh& mesh) {
  const ClosedModel model(mesh);
  const ClosedModel::Data& data = model.data();
  std::map<std::uint32_t, std::uint32_t> first_in;
  for (std::uint32_t t = 0; t < data.triangles.size(); ++t) {
    const std::uint32_t first = first_in.try_emplace(data.plane_of[t], t).first->second;
    const auto corner = [&](std::uint32_t triangle, std::size_t k) {
      return mesh.vertices[mesh.triangles[data.source_triangle[triangle]][k]];
    };
    const Vector3d o = corner(first, 0), normal = (corner(first, 1) - o).cross(corner(first, 2) - o);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(std::abs(normal.dot(corner(t, k) - o)), 1e-12 * normal.norm());
  }
  return first_in.size();
}

TEST(ClosedModel, KnowsWhichNeighboursLieInOnePlane) {
  EXPECT_EQ(planes_of(unit), 6U);
  EXPECT_EQ(planes_of(subdivided(subdivided(unit))), 6U);
  EXPECT_EQ(planes_of(icosphere(1)), 80U);
  EXPECT_EQ(planes_of(both(unit, box({1, 2, 0}, {2, 3, 1}))), 12U) << "of two components";
  TriangleMesh almost = subdivided(unit);
  for (Vector3d& p : almost.vertices)
    if (p == Vector3d(0.5, 0.5, 1)) p.z() = std::nextafter(1.0, 2.0);
  EXPECT_GT(planes_of(almost), 6U) << "one vertex is off by one rounding";
}

TEST(ClosedModel, AcceptsCavitiesAndSolidsWithinCavities) {
  const TriangleMesh hollow = both(unit, reversed(box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8})));
  EXPECT_EQ(refusal(hollow), "");
  const TriangleMesh filled = both(hollow, box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}));
  EXPECT_EQ(refusal(filled), "");
  EXPECT_EQ(ClosedModel(filled).component_count(), 3U);
}

TEST(ClosedModel, JoinsVerticesAtEqualPositions) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const Triangle& t : unit.triangles)
    triangles.push_back({unit.vertices[t[0]], unit.vertices[t[1]], unit.vertices[t[2]]});
  TriangleMesh separate = soup(triangles);
  separate.vertices[0].x() = -0.0;  // was 0
  EXPECT_EQ(refusal(separate), "");
}

TEST(ClosedModel, LeavesOutTrianglesThatRepeatAPosition) {
  TriangleMesh mesh = unit;
  mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 1});
  const ClosedModel model(mesh);
  EXPECT_EQ(model.triangle_count(), 13U);
  EXPECT_EQ(model.bvh().triangle_count(), 12U);
}

TEST(ClosedModel, EndsWhenItIsStopped) {
  const std::atomic<bool> cancel = true;
  EXPECT_THROW(ClosedModel(subdivided(subdivided(unit)), BvhOptions{.threads = 1, .stop = {.cancel = &cancel}}),
               Stopped);
}

TEST(ClosedModel, RefusesAHole) {
  TriangleMesh mesh = unit;
  mesh.triangles.pop_back();
  expect_refused(mesh, "the mesh is open: triangle 4 has no neighbour across the edge from (1 0 0) to (1 0 1)");
}

TEST(ClosedModel, RefusesATriangleThatIsTurned) {
  TriangleMesh mesh = unit;
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  expect_refused(mesh, "not consistently oriented: triangle 2 and triangle 3");
}

TEST(ClosedModel, RefusesAnEdgeOfFourTriangles) {
  expect_refused(both(unit, box({1, 1, 0}, {2, 2, 1})), "not manifold: 4 triangles");
}

TEST(ClosedModel, RefusesAModelThatIsInsideOut) { expect_refused(reversed(unit), "inside out"); }

TEST(ClosedModel, RefusesACavityThatIsTurned) {
  expect_refused(both(unit, box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8})), "the component of triangle 12");
  expect_refused(both(unit, reversed(box({2, 0, 0}, {3, 1, 1}))), "the component of triangle 12");
}

TEST(ClosedModel, RefusesTrianglesThatCross) {
  expect_refused(both(unit, box({0.4, 0.4, 0.5}, {0.6, 0.6, 2})), "intersects itself: triangle ");
}

TEST(ClosedModel, RefusesComponentsThatTouch) {
  expect_refused(both(unit, box({0.25, 0.25, 1}, {0.75, 0.75, 2})), "intersects itself");
}

/// A tetrahedron whose apex touches a face of the cube from outside, from inside its interior, and misses it.
TEST(ClosedModel, RefusesAVertexOnAFace) {
  const auto spike = [](double tip) {
    TriangleMesh mesh;
    mesh.vertices = {{0.5, 0.4, tip}, {0.1, 0.1, 2}, {0.9, 0.1, 2}, {0.5, 0.9, 2}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
    return mesh;
  };
  EXPECT_EQ(refusal(both(unit, spike(1.0000001))), "");
  expect_refused(both(unit, spike(1)), "intersects itself");
  expect_refused(both(unit, spike(0.9999999)), "intersects itself");
}

/// Whole numbers, exact.
using Whole = Eigen::Matrix<long long, 3, 1>;

bool is_in_cone(const Whole& v, const Whole& a, const Whole& b) {
  const Whole normal = a.cross(b);
  return normal.dot(v) == 0 && normal.dot(a.cross(v)) >= 0 && normal.dot(v.cross(b)) >= 0;
}

/// Whether the cones between two ways each have a way in common: one that spans them, or one along both planes.
bool cones_meet(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
  const Whole along = a.cross(b).cross(c.cross(d));
  for (const Whole& way : {a, b, c, d, along, Whole(-along)})
    if (!way.isZero() && is_in_cone(way, a, b) && is_in_cone(way, c, d)) return true;
  return false;
}

/// Triangles between vertices of a grid on a cube touch, lie in one plane and cross in all ways.
TEST(ClosedModel, TellsWhetherTrianglesWithACommonCornerMeetBesides) {
  for (const double offset : {0.0, 1e6, 1e15}) {
    const ClosedModel model(moved(subdivided(subdivided(box({0, 0, 0}, {4, 4, 4}))), {offset, offset, offset}));
    const std::vector<Vec3>& positions = model.data().positions;
    PlacedPair pair;
    pair.place(model.data(), Eigen::Isometry3d::Identity(), model.data(), Eigen::Isometry3d::Identity());
    Random random(5);
    int meet = 0, apart = 0;
    while (meet + apart < 20000) {
      std::uint32_t vertex[5];
      Whole way[5];
      for (int k = 0; k < 5; ++k) {
        vertex[k] = static_cast<std::uint32_t>(random.below(static_cast<int>(positions.size())));
        const Vec3 from_first = positions[vertex[k]] - positions[vertex[0]];
        way[k] = Vector3d(from_first.x, from_first.y, from_first.z).cast<long long>();
      }
      if (way[1].cross(way[2]).isZero() || way[3].cross(way[4]).isZero()) continue;
      if (std::set<std::uint32_t>(vertex, vertex + 5).size() < 5) continue;
      const bool expected = cones_meet(way[1], way[2], way[3], way[4]);
      ASSERT_EQ(triangles_cross(pair, {vertex[0], vertex[1], vertex[2]}, {vertex[3], vertex[0], vertex[4]}), expected);
      ++(expected ? meet : apart);
    }
    EXPECT_GT(std::min(meet, apart), 2000);
  }
}

TEST(ClosedModel, RefusesAFoldedFlap) {
  // Two triangles back to back: closed and oriented, without content.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  expect_refused(mesh, "intersects itself");
}

TEST(ClosedModel, RefusesATriangleWithoutArea) {
  // The edge from (0 0 0) to (1 0 0) of the cube, where two triangles meet at both ends and a third at its middle.
  TriangleMesh mesh = unit;
  mesh.vertices.emplace_back(0.5, 0, 0);
  mesh.triangles[1] = {0, 3, 8};
  mesh.triangles.push_back({8, 3, 1});
  mesh.triangles.push_back({0, 8, 1});
  expect_refused(mesh, "triangle 13 has no area");
}

TEST(ClosedModel, RefusesWhatIsNoMesh) {
  EXPECT_THROW(ClosedModel{TriangleMesh{}}, InvalidInput);
  TriangleMesh mesh = unit;
  mesh.triangles[0][0] = 8;
  EXPECT_THROW(ClosedModel{mesh}, InvalidInput);
}

}  // namespace closed_model_test
}  // namespace meshbound
