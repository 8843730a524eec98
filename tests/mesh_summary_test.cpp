// SPDX-License-Identifier: MIT
#include "meshbound/mesh_summary.h"

#include <gtest/gtest.h>

#include <limits>

#include "reference/small_meshes.h"

namespace meshbound {
namespace mesh_summary_test {

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

TEST(MeshSummary, DescribesATetrahedron) {
  const MeshSummary summary = summarise(tetrahedron());
  EXPECT_EQ(summary.vertices, 4u);
  EXPECT_EQ(summary.faces, 4u);
  EXPECT_EQ(summary.components, 1u);
  EXPECT_TRUE(summary.closed);
  EXPECT_EQ(summary.bbox_diagonal, std::sqrt(3.0));
}

TEST(MeshSummary, CountsComponentsThroughSharedVertices) {
  EXPECT_EQ(summarise(reference::both(tetrahedron(), tetrahedron())).components, 2u);
  const TriangleMesh bow_tie = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(summarise(bow_tie).components, 1u);
  EXPECT_EQ(summarise(reference::random_soup(1, 50, 0.1)).components, 50u);
}

TEST(MeshSummary, JoinsAComponentHoweverItsTrianglesAreOrdered) {
  TriangleMesh strip;
  constexpr std::uint32_t count = 1000;
  for (std::uint32_t i = 0; i < count + 2; ++i) strip.vertices.emplace_back(i, i % 2, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t k = i * 617 % count;  // 617 is prime to 1000: each once
    strip.triangles.push_back({k + 2, k, k + 1});
  }
  EXPECT_EQ(summarise(strip).components, 1u);
}

TEST(MeshSummary, IsClosedOnlyWhereEveryEdgeHasTwoTriangles) {
  EXPECT_TRUE(summarise(reference::icosphere(3)).closed);
  EXPECT_FALSE(summarise(reference::unit_square(4)).closed);
  TriangleMesh open = tetrahedron();
  open.triangles.pop_back();
  EXPECT_FALSE(summarise(open).closed);
  TriangleMesh doubled = reference::both(tetrahedron(), {});
  doubled.triangles.insert(doubled.triangles.end(), doubled.triangles.begin(), doubled.triangles.begin() + 4);
  EXPECT_FALSE(summarise(doubled).closed) << "four triangles at each edge";
  TriangleMesh flipped = tetrahedron();
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_TRUE(summarise(flipped).closed) << "orientation does not matter";
}

TEST(MeshSummary, IsNotClosedWhereATriangleRepeatsAVertex) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.push_back({1, 1, 1});
  EXPECT_FALSE(summarise(mesh).closed);
  mesh.triangles.back() = {0, 0, 1};
  EXPECT_FALSE(summarise(mesh).closed);
}

TEST(MeshSummary, MeasuresOnlyVerticesThatTrianglesUse) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.emplace_back(1e6, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(summarise(mesh).vertices, 5u);
  EXPECT_EQ(summarise(mesh).bbox_diagonal, std::sqrt(3.0));
  EXPECT_EQ(used_bounding_box(mesh).max(), Eigen::Vector3d(1, 1, 1));
}

TEST(MeshSummary, MeasuresTheDiagonalWithoutOverflowOrUnderflow) {
  for (const double scale : {0x1p-1060, 0x1p-600, 0x1p600, 0x1p1000}) {
    TriangleMesh mesh = {{{0, 0, 0}, {3 * scale / 4, 0, 0}, {0, scale, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(bounding_box_diagonal(mesh), 1.25 * scale);
  }
}

TEST(MeshSummary, OfNothingIsEmpty) {
  const MeshSummary summary = summarise(TriangleMesh{});
  EXPECT_EQ(summary.components, 0u);
  EXPECT_FALSE(summary.closed);
  EXPECT_EQ(summary.bbox_diagonal, 0);
  EXPECT_TRUE(used_bounding_box(TriangleMesh{}).isEmpty());
}

}  // namespace mesh_summary_test
}  // namespace meshbound
