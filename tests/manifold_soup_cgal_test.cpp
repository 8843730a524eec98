// SPDX-License-Identifier: GPL-3.0-or-later
// What `manifold_soup` makes of any triangles is a polygon mesh for CGAL too.
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "manifold_soup_cases.h"
#include "meshbound/cgal/surface_mesh.h"
#include "numeric/no_index.h"
#include "simplify/mesh/manifold_soup.h"

namespace manifold_soup_cgal_test {

using meshbound::ManifoldSoup;
using meshbound::TriangleMesh;

/// Faces in their order, each vertex at its place; the borders of the half-edge structure are those without a twin.
testing::AssertionResult cgal_agrees(const TriangleMesh& soup) {
  const ManifoldSoup manifold = meshbound::manifold_soup(soup);
  std::vector<std::array<std::size_t, 3>> polygons;
  for (const auto& face : manifold.faces) polygons.push_back({face[0], face[1], face[2]});
  if (!CGAL::Polygon_mesh_processing::is_polygon_soup_a_polygon_mesh(polygons))
    return testing::AssertionFailure() << "not a polygon mesh";
  TriangleMesh copy;
  copy.triangles = manifold.faces;
  for (const std::uint32_t v : manifold.vertex_of) copy.vertices.push_back(soup.vertices[v]);
  const meshbound::cgal::SurfaceMesh mesh = meshbound::cgal::to_surface_mesh(copy);
  if (!mesh.is_valid(false)) return testing::AssertionFailure() << "not a valid Surface_mesh";
  std::size_t borders = 0, without_twin = 0;
  for (const auto h : mesh.halfedges()) borders += mesh.is_border(h) ? 1 : 0;
  for (const auto& twins : manifold.twin)
    without_twin += static_cast<std::size_t>(std::count(twins.begin(), twins.end(), meshbound::no_index));
  if (borders != without_twin) return testing::AssertionFailure() << borders << " borders, not " << without_twin;
  return testing::AssertionSuccess();
}

TEST(ManifoldSoupInCgal, IsAPolygonMeshForAnyTriangles) {
  for (std::uint32_t seed = 0; seed < 3000; ++seed) {
    const TriangleMesh soup = meshbound::test::tangled_soup(seed);
    if (soup.triangles.size() > 1) {
      ASSERT_TRUE(cgal_agrees(soup)) << "seed " << seed;
    }
  }
}

TEST(ManifoldSoupInCgal, IsAPolygonMeshForTheSharedMeshes) {
  const auto meshes = meshbound::test::readable_meshes({"broken", "../cases"});
  if (meshes.empty()) GTEST_SKIP() << "no datasets folder with broken/ (set MESHBOUND_DATASETS)";
  for (const auto& [path, soup] : meshes) {
    try {
      EXPECT_TRUE(cgal_agrees(soup)) << path;
    } catch (const meshbound::InvalidInput&) {  // no surface, see manifold_soup_test
    }
  }
}

}  // namespace manifold_soup_cgal_test
