// SPDX-License-Identifier: MIT
// A change turns no face over: a thin one is compared with the face beside it.
#include "simplify/mesh/normal_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simplify/mesh/manifold_soup.h"

namespace meshbound {
namespace normal_guard_test {

/// A face over the x axis from 0 to 1 with its third corner at (0.5, height, 0), and one below the axis if wanted.
ArrayMesh over_axis(double height, bool has_face_below = true) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {0.5, -1, 0}}, {{0, 1, 2}}};
  if (has_face_below) mesh.triangles.push_back({1, 0, 3});
  const ManifoldSoup soup = manifold_soup(mesh);
  std::vector<Vec3> positions;
  for (const std::uint32_t v : soup.vertex_of)
    positions.push_back({mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z()});
  return ArrayMesh(std::move(positions), soup.faces, soup.twin);
}

/// Whether the guard of the face over the axis lets its third corner go to (0.5, y, z).
bool allows(const ArrayMesh& mesh, double y, double z, bool may_look = true) {
  constexpr Corner third = 2;
  const GuardedFace guard(mesh, third, [may_look](std::uint32_t) { return may_look; });
  return guard.allows({Vec3{0.5, y, z}, Vec3{0, 0, 0}, Vec3{1, 0, 0}});
}

constexpr double thin = 2e-4, as_thin = 5e-4;

TEST(GuardedFace, WithANormalIsNotTurnedByNinetyDegrees) {
  const ArrayMesh mesh = over_axis(0.5);
  EXPECT_TRUE(allows(mesh, 0.3, 0.3));
  EXPECT_FALSE(allows(mesh, 0, 0.5));
  EXPECT_FALSE(allows(mesh, -0.3, 0));
  EXPECT_FALSE(allows(mesh, 1e-5, 0)) << "a sliver";
}

TEST(GuardedFace, ThatIsThinMayTurnButNotFoldBack) {
  const ArrayMesh mesh = over_axis(thin);
  EXPECT_TRUE(allows(mesh, 0.5, 0));
  EXPECT_TRUE(allows(mesh, 0, 0.5));
  EXPECT_TRUE(allows(mesh, 0, -0.5));
  EXPECT_TRUE(allows(mesh, -0.2, 0.5)) << "111.8 degrees from flat";
  EXPECT_FALSE(allows(mesh, -0.5, 0.5)) << "135 degrees";
  EXPECT_FALSE(allows(mesh, -0.5, 0));
  EXPECT_TRUE(allows(mesh, -as_thin, 0)) << "without a normal before and after";
}

/// As needles around a narrow tube do: the third corners of two over one edge, which enclose this angle.
TEST(GuardedFace, ThatIsANeedleMayEncloseTheAngleThatItDoes) {
  const auto corner = [](double degrees, double height) {
    const double angle = degrees / 180 * std::numbers::pi;
    return Eigen::Vector3d(0.5, -height * std::cos(angle), height * std::sin(angle));
  };
  const auto may_become = [&](double before, double after) {
    const Eigen::Vector3d third = corner(before, as_thin), moved = corner(after, 0.5);
    const ManifoldSoup soup =
        manifold_soup(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, third, {0.5, -as_thin, 0}}, {{0, 1, 2}, {1, 0, 3}}});
    std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {third.x(), third.y(), third.z()}, {0.5, -as_thin, 0}};
    return allows(ArrayMesh(std::move(positions), soup.faces, soup.twin), moved.y(), moved.z());
  };
  EXPECT_TRUE(may_become(40, 41));
  EXPECT_FALSE(may_become(40, 30));
  EXPECT_FALSE(may_become(100, 50));
  EXPECT_FALSE(may_become(10, 11)) << "a flap";
}

TEST(GuardedFace, ThatIsThinStaysThinBesideAFaceThatIsNotLookedAt) {
  const ArrayMesh mesh = over_axis(thin);
  EXPECT_FALSE(allows(mesh, 0.5, 0, false));
  EXPECT_TRUE(allows(mesh, as_thin, 0, false));
  EXPECT_TRUE(allows(over_axis(0.5), 0.3, 0, false)) << "not thin";
}

TEST(GuardedFace, ThatIsThinAtABorderMayTurn) {
  const ArrayMesh mesh = over_axis(thin, false);
  EXPECT_TRUE(allows(mesh, -0.5, 0, false));
}

}  // namespace normal_guard_test
}  // namespace meshbound
