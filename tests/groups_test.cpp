// SPDX-License-Identifier: MIT
// Objects, groups and smoothing groups keep their borders, as materials do. One name for a whole mesh has none.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meshbound/attributes.h"
#include "meshbound/simplify.h"
#include "simplify_options.h"

namespace meshbound {
namespace groups_test {

using Labels = TriangleLabels MeshAttributes::*;
const std::vector<Labels> kinds = {&MeshAttributes::objects, &MeshAttributes::groups,
                                   &MeshAttributes::smoothing_groups};

/// n x n squares of the unit square.
TriangleMesh plate(std::uint32_t n) {
  TriangleMesh result;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x)
      result.vertices.emplace_back(x / static_cast<double>(n), y / static_cast<double>(n), 0);
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      result.triangles.push_back({a, b, d});
      result.triangles.push_back({a, d, c});
    }
  return result;
}

Eigen::Vector3d middle(const TriangleMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

/// A disc in the middle of a plate is the pad, the rest the plate.
TriangleLabels pad_on(const TriangleMesh& mesh) {
  TriangleLabels result;
  result.names = {"plate", "pad"};
  for (const Triangle& t : mesh.triangles)
    result.index.push_back((middle(mesh, t) - Eigen::Vector3d(0.5, 0.5, 0)).norm() < 0.3 ? 1 : 0);
  return result;
}

double area_of_pad(const TriangleMesh& mesh, const TriangleLabels& labels) {
  double doubled = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3d& p = mesh.vertices[a];
    if (labels.index[t] == 1) doubled += (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).norm();
  }
  return doubled / 2;
}

TEST(Groups, KeepTheirBordersInAPlane) {
  const TriangleMesh mesh = plate(40);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    MeshAttributes attributes;
    attributes.*kinds[kind] = pad_on(mesh);
    SimplifyOptions options = test::within(0.0014);
    options.feature_edges = seams(mesh, attributes);
    options.looks = looks(mesh, attributes);
    const SimplifiedLevel level = simplify_with_bound(mesh, options).last();
    EXPECT_LT(level.faces(), mesh.triangles.size() / 10);
    const TriangleLabels labels = transferred_attributes(mesh, attributes, level).*kinds[kind];
    EXPECT_NEAR(area_of_pad(level.mesh, labels), area_of_pad(mesh, pad_on(mesh)), 0.002) << "kind " << kind;
  }
}

TEST(Groups, MakeNoLinesWhereOneNameIsThatOfAll) {
  const TriangleMesh mesh = plate(4);
  MeshAttributes attributes;
  for (const Labels labels : kinds) {
    (attributes.*labels).names = {"all"};
    (attributes.*labels).index.assign(mesh.triangles.size(), 0);
  }
  EXPECT_TRUE(seams(mesh, attributes).empty());
}

/// A wall of two objects that both list it: each keeps its own.
TEST(Groups, AreLayersWhereTheyHaveTheSameTriangles) {
  TriangleMesh mesh = plate(4);
  const std::size_t count = mesh.triangles.size();
  mesh.triangles.insert(mesh.triangles.end(), mesh.triangles.begin(),
                        mesh.triangles.begin() + static_cast<std::ptrdiff_t>(count));
  MeshAttributes attributes;
  attributes.groups.names = {"left", "right"};
  for (std::size_t t = 0; t < 2 * count; ++t) attributes.groups.index.push_back(t < count ? 0 : 1);
  EXPECT_EQ(looks(mesh, attributes), attributes.groups.index);
  attributes.groups = {};
  attributes.smoothing_groups.names = {"1", "2"};
  for (std::size_t t = 0; t < 2 * count; ++t) attributes.smoothing_groups.index.push_back(t < count ? 0 : 1);
  EXPECT_EQ(looks(mesh, attributes), std::vector<std::uint32_t>(2 * count, 0)) << "how a surface is shaded is no layer";
}

}  // namespace groups_test
}  // namespace meshbound
