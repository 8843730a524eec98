// SPDX-License-Identifier: MIT
#include "simplify/mesh/spatial_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "bvh/bvh_data.h"
#include "reference/small_meshes.h"
#include "spatially_ordered.h"

namespace spatial_order_test {

using meshbound::spatial_order;
using meshbound::SpatialOrder;
using meshbound::Triangle;
using meshbound::TriangleMesh;

/// A sphere whose triangles come in random order, with 5 vertices that none uses.
TriangleMesh shuffled_sphere(int levels) {
  TriangleMesh mesh = meshbound::reference::icosphere(levels);
  std::mt19937 random(3);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  for (int i = 0; i < 5; ++i) mesh.vertices.insert(mesh.vertices.begin(), Eigen::Vector3d(9, 9, 9));
  for (Triangle& corners : mesh.triangles)
    for (std::uint32_t& v : corners) v += 5;
  return mesh;
}

Eigen::Vector3d centroid(const TriangleMesh& mesh, std::size_t t) {
  const Triangle& corners = mesh.triangles[t];
  return (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]) / 3;
}

/// The length of the way through all triangles in their order.
double way(const TriangleMesh& mesh) {
  double length = 0;
  for (std::size_t t = 1; t < mesh.triangles.size(); ++t) length += (centroid(mesh, t) - centroid(mesh, t - 1)).norm();
  return length;
}

TEST(SpatialOrder, HasEveryTriangleAndUsedVertexOnce) {
  const TriangleMesh before = shuffled_sphere(3);
  const SpatialOrder after = spatial_order(before, {1});
  ASSERT_EQ(after.triangle.size(), before.triangles.size());
  ASSERT_EQ(after.vertex.size(), before.vertices.size() - 5);
  for (std::size_t t = 0; t < after.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(after.vertex[after.triangles[t][k]], before.triangles[after.triangle[t]][k]);
  for (std::vector<std::uint32_t> indices : {after.triangle, after.vertex}) {
    std::sort(indices.begin(), indices.end());
    EXPECT_EQ(std::adjacent_find(indices.begin(), indices.end()), indices.end());
  }
}

TEST(SpatialOrder, BringsNeighboursTogether) {
  const TriangleMesh before = shuffled_sphere(4);
  EXPECT_LT(way(meshbound::test::spatially_ordered(before)), 0.1 * way(before));
}

TEST(SpatialOrder, IsThatOfTheTree) {
  const TriangleMesh mesh = shuffled_sphere(5);
  const meshbound::Bvh tree(mesh, {1});
  const auto& of_tree = tree.data().triangle_of_slot;
  EXPECT_EQ(spatial_order(mesh, {1}).triangle, std::vector<std::uint32_t>(of_tree.begin(), of_tree.end()));
}

TEST(SpatialOrder, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh mesh = shuffled_sphere(5);
  const SpatialOrder one = spatial_order(mesh, {1}), four = spatial_order(mesh, {4});
  EXPECT_EQ(one.triangle, four.triangle);
  EXPECT_EQ(one.vertex, four.vertex);
}

TEST(SpatialOrder, ComparesPointsByTheirCoordinates) {
  using meshbound::is_before;
  EXPECT_TRUE(is_before({0, 5, 5}, {1, 0, 0}));
  EXPECT_TRUE(is_before({1, 0, 5}, {1, 1, 0}));
  EXPECT_TRUE(is_before({1, 1, -1}, {1, 1, 0}));
  EXPECT_FALSE(is_before({0, -0.0, 0}, {-0.0, 0, 0}));
  EXPECT_FALSE(is_before({-0.0, 0, 0}, {0, -0.0, 0}));
}

}  // namespace spatial_order_test
