// SPDX-License-Identifier: MIT
// The generated meshes are what their names say: face counts, closedness, orientation, vertices on the surface.
#include "datasets/analytic_meshes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "meshbound/error.h"
#include "meshbound/mesh_view.h"

namespace meshbound::datasets {
namespace analytic_meshes_test {

/// How often each directed edge occurs.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++count[{t[i], t[(i + 1) % 3]}];
  return count;
}

/// Every edge has two triangles that run through it in opposite directions.
bool is_closed_and_oriented(const TriangleMesh& mesh) {
  const auto edges = directed_edges(mesh);
  return std::all_of(edges.begin(), edges.end(), [&](const auto& entry) {
    const auto& [edge, count] = entry;
    return count == 1 && edge.first != edge.second && edges.contains({edge.second, edge.first});
  });
}

/// Vertices - edges + faces of a closed mesh: 2 for a sphere, 0 for a torus.
std::ptrdiff_t euler_characteristic(const TriangleMesh& mesh) {
  return static_cast<std::ptrdiff_t>(mesh.vertices.size() + mesh.triangles.size()) -
         static_cast<std::ptrdiff_t>(directed_edges(mesh).size() / 2);
}

/// Volume inside a closed mesh, positive when the faces look outward.
double signed_volume(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six_volumes += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]));
  return six_volumes / 6;
}

double smallest_doubled_area(const TriangleMesh& mesh) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    smallest =
        std::min(smallest, (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm());
  return smallest;
}

TEST(AnalyticMeshes, IcosphereQuartersAnIcosahedronOnTheSphere) {
  const TriangleMesh mesh = icosphere(2, 3);
  EXPECT_EQ(mesh.triangles.size(), 20U * 64U);
  EXPECT_TRUE(is_closed_and_oriented(mesh));
  EXPECT_EQ(euler_characteristic(mesh), 2);
  for (const Eigen::Vector3d& v : mesh.vertices) EXPECT_NEAR(v.norm(), 2, 1e-15);
  EXPECT_NEAR(signed_volume(mesh), 32 * std::numbers::pi / 3, 0.4);
}

TEST(AnalyticMeshes, UvSphereIsClosedAtItsPoles) {
  const TriangleMesh mesh = uv_sphere(3, 5, 7);
  EXPECT_EQ(mesh.triangles.size(), 2U * 7U * 4U);
  EXPECT_TRUE(is_closed_and_oriented(mesh));
  EXPECT_EQ(euler_characteristic(mesh), 2);
  for (const Eigen::Vector3d& v : mesh.vertices) EXPECT_NEAR(v.norm(), 3, 1e-15);
  EXPECT_GT(signed_volume(mesh), 0);
}

TEST(AnalyticMeshes, TorusVerticesLieOnTheTube) {
  const TriangleMesh mesh = torus(2, 0.5, 40, 20);
  EXPECT_EQ(mesh.triangles.size(), 1600U);
  EXPECT_TRUE(is_closed_and_oriented(mesh));
  EXPECT_EQ(euler_characteristic(mesh), 0);
  for (const Eigen::Vector3d& v : mesh.vertices) EXPECT_NEAR(std::hypot(v.head<2>().norm() - 2, v.z()), 0.5, 1e-15);
  EXPECT_NEAR(signed_volume(mesh), 2 * std::numbers::pi * std::numbers::pi * 2 * 0.25, 0.3);
}

TEST(AnalyticMeshes, CubeSharesVerticesAlongItsEdges) {
  const TriangleMesh mesh = cube(2, 5);
  EXPECT_EQ(mesh.triangles.size(), 12U * 25U);
  EXPECT_EQ(mesh.vertices.size(), 6U * 25U + 2U);
  EXPECT_TRUE(is_closed_and_oriented(mesh));
  EXPECT_NEAR(signed_volume(mesh), 8, 1e-13);
}

TEST(AnalyticMeshes, ThinSheetIsTwoParallelSheetsClosedByAWall) {
  const TriangleMesh mesh = thin_sheet(1, 0.25, 8);
  EXPECT_EQ(mesh.triangles.size(), 4U * 64U + 8U * 8U);
  EXPECT_TRUE(is_closed_and_oriented(mesh));
  EXPECT_TRUE(std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                          [](const auto& v) { return v.z() == 0 || v.z() == 0.25; }));
  EXPECT_NEAR(signed_volume(mesh), 0.25, 1e-15);
}

TEST(AnalyticMeshes, SpikesStandOnTheInnerVerticesOnly) {
  const TriangleMesh mesh = spiked_plane(1, 0.5, 8, 2);
  EXPECT_EQ(mesh.triangles.size(), 128U);
  EXPECT_EQ(std::count_if(mesh.vertices.begin(), mesh.vertices.end(), [](const auto& v) { return v.z() == 0.5; }), 9);
  EXPECT_EQ(std::count_if(mesh.vertices.begin(), mesh.vertices.end(), [](const auto& v) { return v.z() == 0; }), 72);
  EXPECT_FALSE(is_closed_and_oriented(mesh));
}

TEST(AnalyticMeshes, CylinderHasACapOfOneFanAtEachEnd) {
  const TriangleMesh mesh = cylinder(2, 3, 360);
  EXPECT_EQ(mesh.triangles.size(), 1440U);
  EXPECT_EQ(mesh.vertices.size(), 722U);
  EXPECT_TRUE(is_closed_and_oriented(mesh));
  EXPECT_EQ(euler_characteristic(mesh), 2);
  EXPECT_NEAR(signed_volume(mesh), 12 * std::numbers::pi, 0.01);
}

TEST(AnalyticMeshes, GearStaysBetweenRootAndTip) {
  const TriangleMesh mesh = gear(8, 2, 12, 8, 3);
  EXPECT_EQ(mesh.triangles.size(), 2U * 96U * 4U);
  EXPECT_TRUE(is_closed_and_oriented(mesh));
  EXPECT_EQ(euler_characteristic(mesh), 2);
  EXPECT_GT(signed_volume(mesh), 2 * std::numbers::pi * 49 * 0.97);
  EXPECT_LT(signed_volume(mesh), 2 * std::numbers::pi * 64);
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const double distance = v.head<2>().norm();
    EXPECT_TRUE(distance == 0 || (distance > 7 - 1e-12 && distance < 8 + 1e-12)) << distance;
  }
}

TEST(AnalyticMeshes, TerrainIsTheSameOnEveryMachine) {
  const TriangleMesh mesh = terrain(1, 64, 7);
  EXPECT_EQ(mesh.triangles.size(), 2U * 64U * 64U);
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a over the bits of the heights
  for (const Eigen::Vector3d& v : mesh.vertices) hash = (hash ^ std::bit_cast<std::uint64_t>(v.z())) * 1099511628211U;
  EXPECT_EQ(hash, 4232191959194483423U);
  EXPECT_NE(terrain(1, 64, 8).vertices[100].z(), mesh.vertices[100].z());
}

class EveryKind : public testing::TestWithParam<Kind> {};

TEST_P(EveryKind, HasAboutTheFacesAskedForAndNoneWithoutArea) {
  const std::size_t max_quotient = GetParam().name == "icosphere" ? 4 : 2;
  for (const std::size_t faces : {1000U, 4321U, 20000U}) {
    const TriangleMesh mesh = mesh_of_size(GetParam().name, faces);
    EXPECT_LE(mesh.triangles.size(), faces);
    EXPECT_GE(mesh.triangles.size() * max_quotient, faces);
    EXPECT_GT(smallest_doubled_area(mesh), 0);
    EXPECT_NO_THROW(validate(mesh));
  }
}

TEST_P(EveryKind, IsTheSameEveryTime) {
  const TriangleMesh first = mesh_of_size(GetParam().name, 3000);
  const TriangleMesh second = mesh_of_size(GetParam().name, 3000);
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.triangles, second.triangles);
}

INSTANTIATE_TEST_SUITE_P(AnalyticMeshes, EveryKind, testing::ValuesIn(kinds().begin(), kinds().end()),
                         [](const auto& kind) {
                           std::string name(kind.param.name);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(AnalyticMeshes, ImpossibleShapesAreRefused) {
  EXPECT_THROW(icosphere(0, 1), InvalidInput);
  EXPECT_THROW(icosphere(1, -1), InvalidInput);
  EXPECT_THROW(uv_sphere(1, 1, 8), InvalidInput);
  EXPECT_THROW(torus(1, 1, 8, 8), InvalidInput);
  EXPECT_THROW(cube(-1, 3), InvalidInput);
  EXPECT_THROW(box({1, 1, std::numeric_limits<double>::quiet_NaN()}, {1, 1, 1}), InvalidInput);
  EXPECT_THROW(gear(1, 1, 2, 8, 1), InvalidInput);
  EXPECT_THROW(terrain(1, 0, 1), InvalidInput);
  EXPECT_THROW(mesh_of_size("cube", 10), InvalidInput);
  EXPECT_THROW(mesh_of_size("klein-bottle", 5000), InvalidInput);
}

}  // namespace analytic_meshes_test
}  // namespace meshbound::datasets
