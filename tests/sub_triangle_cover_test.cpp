// SPDX-License-Identifier: MIT
// Covers of triangles that lie near many faces.
#include "simplify/cover/sub_triangle_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/boxes.h"
#include "numeric/no_index.h"
#include "reference/small_meshes.h"
#include "simplify/mesh/indexed_manifold.h"

namespace meshbound {
namespace sub_triangle_cover_test {

using Corners = std::array<Vec3, 3>;

constexpr double limit = 0.01;

/// A disc of radius 1 in the plane z = 0: needles around its middle.
TriangleMesh disc(std::uint32_t corners) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0});
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % corners});
  }
  return mesh;
}

struct Covered {
  explicit Covered(const TriangleMesh& of) : mesh(indexed_manifold(of)), all(mesh.face_count()) {
    std::iota(all.begin(), all.end(), 0U);
  }
  [[nodiscard]] bool covers(const Corners& corners) {
    faces.assign(1, no_index);  // what was there before goes
    const bool is_covered = sub_triangles.covers(corners, all, limit, faces);
    EXPECT_TRUE(std::ranges::all_of(faces, [&](std::uint32_t f) { return f < mesh.face_count(); }));
    return is_covered;
  }
  /// The largest distance of 5,151 points of a triangle from the faces found.
  [[nodiscard]] double distance(const Corners& corners) const {
    double largest = 0;
    for (int i = 0; i <= 100; ++i) {
      for (int j = 0; i + j <= 100; ++j) {
        const Vec3 p = (i / 100.0) * corners[0] + (j / 100.0) * corners[1] + ((100 - i - j) / 100.0) * corners[2];
        double least = HUGE_VAL;
        for (const std::uint32_t f : faces) least = std::min(least, squared_distance(mesh.triangle(f), p));
        largest = std::max(largest, std::sqrt(least));
      }
    }
    return largest;
  }
  ArrayMesh mesh;
  std::vector<std::uint32_t> all;
  std::vector<Vec3> no_vertices;
  std::vector<Triangle> no_triangles;
  ForwardCover cover{no_vertices, no_triangles};
  SubTriangleCover sub_triangles{mesh, cover};
  std::vector<std::uint32_t> faces;
};

/// A disc with a round hole of this radius in the middle.
TriangleMesh disc_with_hole(std::uint32_t corners, double radius) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    for (const double r : {radius / std::cos(std::numbers::pi / corners), 1.0})
      mesh.vertices.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    const std::uint32_t at = 2 * i, next = 2 * ((i + 1) % corners);
    mesh.triangles.insert(mesh.triangles.end(), {{at, at + 1, next + 1}, {at, next + 1, next}});
  }
  return mesh;
}

/// Far more faces than one set of candidates can have.
TEST(SubTriangleCover, CoversATriangleByHundredsOfFaces) {
  Covered it(reference::unit_square(20));
  const Corners corners{{{0.02, 0.03, 0.5 * limit}, {0.97, 0.02, 0.2 * limit}, {0.1, 0.95, -0.5 * limit}}};
  ASSERT_TRUE(it.covers(corners));
  EXPECT_GT(it.faces.size(), 300U);
  EXPECT_LE(it.distance(corners), limit * (1 + CandidateFaces::plane_slack));
}

/// All of them touch the middle, and the boxes of most meet that of the triangle.
TEST(SubTriangleCover, CoversANeedleByNeedles) {
  Covered it(disc(2000));
  const Corners corners{{{0.01, 0.012, 0.5 * limit}, {0.7, 0.7, 0}, {0.705, 0.702, 0.2 * limit}}};
  ASSERT_TRUE(it.covers(corners));
  EXPECT_LT(it.faces.size(), 200U);
  EXPECT_LE(it.distance(corners), limit * (1 + CandidateFaces::plane_slack));
}

/// Beyond the border, above the faces, and with a hole below.
TEST(SubTriangleCover, FindsNoCoverWhereAPartIsTooFarAway) {
  Covered it(reference::unit_square(20));
  const Corners corners{{{0.02, 0.03, 0}, {0.97, 0.02, 0}, {0.1, 0.95, 0}}};
  ASSERT_TRUE(it.covers(corners));
  for (const Vec3 third : {Vec3{0.1, 1 + 1.5 * limit, 0}, Vec3{0.1, 0.95, 1.1 * limit}}) {
    EXPECT_FALSE(it.covers({{corners[0], corners[1], third}}));
    EXPECT_TRUE(it.faces.empty());
  }
  std::erase_if(it.all, [&](std::uint32_t f) {
    return squared_distance(it.mesh.triangle(f), {0.31, 0.33, 0}) < 4 * limit * limit;
  });
  EXPECT_FALSE(it.covers(corners));
  EXPECT_TRUE(it.faces.empty());
}

/// Only points within a ten-thousandth of the limit from the middle of the hole are too far away.
TEST(SubTriangleCover, FindsNoCoverWhereHardlyAnythingIsTooFarAway) {
  const Corners corners{{{-0.5, -0.41, 0}, {0.53, -0.4, 0}, {0.03, 0.61, 0}}};
  for (const double share : {0.5, 1.0001}) {
    Covered it(disc_with_hole(60, share * limit));
    EXPECT_EQ(it.covers(corners), share < 1) << share;
  }
}

/// Sheets above one another, at most a tenth of the limit apart in all. The lowest is first.
TriangleMesh stack(int sheets, int squares) {
  TriangleMesh mesh = reference::unit_square(squares);
  for (int i = 1; i < sheets; ++i)
    mesh = reference::both(mesh, reference::moved(reference::unit_square(squares), {0, 0, 0.1 * limit * i / sheets}));
  return mesh;
}

TEST(SubTriangleCover, CoversATriangleAmongThousandsOfNearFaces) {
  Covered it(stack(40, 8));
  const FaceBoxes boxes(it.mesh);
  Corners corners{{{0.02, 0.03, -0.1 * limit}, {0.97, 0.02, 0.1 * limit}, {0.1, 0.95, 0}}};
  ASSERT_TRUE(it.sub_triangles.covers(corners, boxes, limit, it.faces));
  EXPECT_TRUE(std::ranges::is_sorted(it.faces));
  EXPECT_LT(it.faces.size(), 300U);
  EXPECT_LE(it.distance(corners), limit * (1 + CandidateFaces::plane_slack));
  corners[2] = {0.1, 1 + 1.1 * limit, 0};
  EXPECT_FALSE(it.sub_triangles.covers(corners, boxes, limit, it.faces));
  EXPECT_TRUE(it.faces.empty());
}

/// All sheets but one have a hole at the same place.
TEST(SubTriangleCover, FindsTheOneSheetThatHasNoHole) {
  const Corners corners{{{0.02, 0.03, 0}, {0.97, 0.02, 0}, {0.1, 0.95, 0}}};
  for (const bool has_one : {true, false}) {
    Covered it(stack(40, 8));
    std::vector<std::uint32_t> gone;
    for (std::uint32_t f = has_one ? 128 : 0; f < it.mesh.face_count(); ++f)
      if (squared_distance(it.mesh.triangle(f), {0.31, 0.33, 0}) < 4 * limit * limit) gone.push_back(f);
    it.mesh.remove_component(gone);
    EXPECT_EQ(it.sub_triangles.covers(corners, FaceBoxes(it.mesh), limit, it.faces), has_one);
    EXPECT_EQ(it.faces.empty(), !has_one);
  }
}

}  // namespace sub_triangle_cover_test
}  // namespace meshbound
