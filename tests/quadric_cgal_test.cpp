// SPDX-License-Identifier: GPL-3.0-or-later
// The quadrics of the core are those of CGAL's Garland-Heckbert policies, with the border, and give the same
// placements.
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_profile.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>

#include "datasets/analytic_meshes.h"
#include "geometry/unit.h"
#include "meshbound/cgal/surface_mesh.h"
#include "simplify/mesh/indexed_manifold.h"
#include "simplify/mesh/quadric.h"

namespace meshbound::cgal {
namespace quadric_cgal_test {

namespace SMS = CGAL::Surface_mesh_simplification;

/// A square of waves, with a border.
SurfaceMesh waves(unsigned n) {
  SurfaceMesh mesh;
  for (unsigned i = 0; i <= n; ++i) {
    for (unsigned j = 0; j <= n; ++j) {
      const double x = double(i) / n, y = double(j) / n;
      mesh.add_vertex(Kernel::Point_3(x, y, 0.1 * std::sin(7 * x + 0.3) * std::cos(5 * y)));
    }
  }
  const auto at = [&](unsigned i, unsigned j) { return SurfaceMesh::Vertex_index(i * (n + 1) + j); };
  for (unsigned i = 0; i < n; ++i) {
    for (unsigned j = 0; j < n; ++j) {
      mesh.add_face(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      mesh.add_face(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return mesh;
}

std::vector<Quadric> quadrics_of(const SurfaceMesh& mesh) {
  return vertex_quadrics(indexed_manifold(to_triangle_mesh(mesh)), PlaneWeights::Equal);
}

Vec3 to_vec3(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }
Kernel::Point_3 to_point(Vec3 p) { return {p.x, p.y, p.z}; }

/// Three faces of area 1/2 meet at the origin; the fourth one has the area sqrt(3) / 2.
TEST(Quadric, CountsFacesByTheirAreaInMeanAreas) {
  TriangleMesh corner;
  corner.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  corner.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const std::vector<Quadric> quadrics = vertex_quadrics(indexed_manifold(corner), PlaneWeights::Area);
  const double mean = (3 + std::sqrt(3)) / 4;
  EXPECT_NEAR(quadrics[0].planes(), 3 / mean, 1e-12);
  for (const std::size_t v : {1, 2, 3}) EXPECT_NEAR(quadrics[v].planes(), (2 + std::sqrt(3)) / mean, 1e-12);
  EXPECT_NEAR(quadrics[0].at({1, 1, 1}), 3 / mean, 1e-12);

  corner.triangles = {{0, 2, 1}};  // planes through two border edges of length 1, and of length 1 and sqrt(2)
  const std::vector<Quadric> open = vertex_quadrics(indexed_manifold(corner), PlaneWeights::Area);
  EXPECT_NEAR(open[0].planes(), 1 + 1 + 1, 1e-12);
  EXPECT_NEAR(open[1].planes(), 1 + 1 + 2, 1e-12);
}

TEST(Quadric, IsCgalsWithTheBorderIncluded) {
  SurfaceMesh mesh = waves(12);
  const auto points = mesh.points();
  const SMS::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel> cgal(mesh);
  cgal.initialize(mesh, points, Kernel());
  const std::vector<Quadric> ours = quadrics_of(mesh);
  using Points = std::decay_t<decltype(points)>;
  using Profile = SMS::Edge_profile<SurfaceMesh, Points, Kernel>;
  int optima = 0;
  for (const auto e : mesh.edges()) {
    const Profile profile(mesh.halfedge(e), mesh, Kernel(), 0, points, 0, true);
    auto optimum = cgal(profile);
    auto somewhere = optimum;
    *somewhere = Kernel::Point_3(0.3, 0.2, 0.1);
    const Quadric &p = ours[profile.v0()], &q = ours[profile.v1()];
    Quadric sum = p;
    sum += q;
    EXPECT_NEAR(sum.at({0.3, 0.2, 0.1}), *cgal(profile, somewhere), 1e-12);
    const Placement best = best_placement(p, q, to_vec3(profile.p0()), to_vec3(profile.p1()));
    EXPECT_NEAR(best.cost, sum.at(best.point), 1e-15);
    if (CGAL::squared_distance(*optimum, profile.p0()) > 0.01) continue;
    EXPECT_NEAR(std::sqrt(CGAL::squared_distance(to_point(best.point), *optimum)), 0, 1e-6);
    ++optima;
  }
  EXPECT_GT(optima, 200);
}

void expect_equal(const std::vector<Quadric>& one, const std::vector<Quadric>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t v = 0; v < one.size(); ++v) {
    const Quadric &p = one[v], &q = other[v];
    EXPECT_EQ(std::tie(p.xx, p.xy, p.xz, p.yy, p.yz, p.zz), std::tie(q.xx, q.xy, q.xz, q.yy, q.yz, q.zz));
    EXPECT_EQ(std::tie(p.x, p.y, p.z, p.constant), std::tie(q.x, q.y, q.z, q.constant));
  }
}

/// Without a border. Bit by bit.
void expect_planes_in_order(const TriangleMesh& sphere) {
  const ArrayMesh mesh = indexed_manifold(sphere);
  std::vector<Quadric> expected(mesh.vertex_count());
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    const auto [p, q, r] = mesh.triangle(f);
    for (const std::uint32_t v : mesh.corners(f)) expected[v] += Quadric::of_plane(unit(cross(q - p, r - p)), p, 1);
  }
  for (const int threads : {1, 3}) expect_equal(vertex_quadrics(mesh, PlaneWeights::Equal, threads), expected);
}

/// Threads share the work face by face: of vertices that are numbered in rows, as the faces come, few belong to several
/// threads; where faces come in any order, most do. Any corner of a face may be such a vertex.
TEST(Quadric, HasItsPlanesAddedInTheOrderOfTheFaces) {
  TriangleMesh in_rows = datasets::uv_sphere(1, 100, 100);
  for (std::size_t t = 0; t < in_rows.triangles.size(); ++t) {
    Triangle& corners = in_rows.triangles[t];
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(t % 3), corners.end());
  }
  expect_planes_in_order(in_rows);
  TriangleMesh in_any_order = datasets::icosphere(1, 5);
  std::shuffle(in_any_order.triangles.begin(), in_any_order.triangles.end(), std::mt19937(5));
  expect_planes_in_order(in_any_order);
}

TEST(Quadric, IsTheSameForAnyNumberOfThreads) {
  const ArrayMesh mesh = indexed_manifold(to_triangle_mesh(waves(100)));
  for (const PlaneWeights weights : {PlaneWeights::Equal, PlaneWeights::Area}) {
    std::vector<Quadric> used(7, Quadric{1, 2, 3});
    expect_equal(vertex_quadrics(mesh, weights, 3, std::move(used)), vertex_quadrics(mesh, weights));
  }
}

TEST(Quadric, OfFlatSurroundingsGivesAPointNearTheEdge) {
  EXPECT_FALSE(Quadric::of_plane({0, 0, 1}, {0, 0, 2}, 3).minimum());
  SurfaceMesh flat = waves(12);
  for (const auto v : flat.vertices()) {
    const auto& p = flat.point(v);
    flat.point(v) = Kernel::Point_3(p.x(), p.y(), 0.25 + 0.5 * p.x());
  }
  const std::vector<Quadric> quadrics = quadrics_of(flat);
  for (const auto e : flat.edges()) {
    const auto v = flat.vertex(e, 0), w = flat.vertex(e, 1);
    const Vec3 p = to_vec3(flat.point(v)), q = to_vec3(flat.point(w));
    const Placement best = best_placement(quadrics[v], quadrics[w], p, q);
    EXPECT_LT(squared_length(best.point - p), 25 * squared_length(p - q));
    EXPECT_LT(squared_length(best.point - q), 25 * squared_length(p - q));
    EXPECT_NEAR(best.cost, 0, 1e-12);
  }
}

}  // namespace quadric_cgal_test
}  // namespace meshbound::cgal
