// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/quadrics.h"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_profile.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <gtest/gtest.h>

#include <cmath>

namespace {

namespace SMS = CGAL::Surface_mesh_simplification;
using meshbound::cgal::Kernel;
using meshbound::cgal::Quadric;
using meshbound::cgal::Quadrics;
using meshbound::cgal::SurfaceMesh;

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

const Quadrics::Collapse& of_edge(Quadrics& quadrics, const SurfaceMesh& mesh, SurfaceMesh::Edge_index e) {
  const auto v0 = mesh.vertex(e, 0), v1 = mesh.vertex(e, 1);
  return quadrics.of_edge(e, v0, v1, mesh.point(v0), mesh.point(v1));
}

TEST(Quadrics, AreCgalsWithTheBorderIncluded) {
  SurfaceMesh mesh = waves(12);
  const auto points = mesh.points();
  const SMS::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel> cgal(mesh);
  cgal.initialize(mesh, points, Kernel());
  Quadrics ours(mesh);
  using Points = std::decay_t<decltype(points)>;
  using Profile = SMS::Edge_profile<SurfaceMesh, Points, Kernel>;
  int optima = 0;
  for (const auto e : mesh.edges()) {
    const Profile profile(mesh.halfedge(e), mesh, Kernel(), 0, points, 0, true);
    const boost::optional<Kernel::Point_3> somewhere = Kernel::Point_3(0.3, 0.2, 0.1);
    EXPECT_NEAR(ours.cost(profile.v0(), profile.v1(), *somewhere), *cgal(profile, somewhere), 1e-12);
    const auto optimum = cgal(profile);
    const auto& collapse = of_edge(ours, mesh, e);
    EXPECT_NEAR(collapse.cost, ours.cost(profile.v0(), profile.v1(), collapse.placement), 1e-15);
    if (CGAL::squared_distance(*optimum, profile.p0()) > 0.01) continue;
    EXPECT_NEAR(std::sqrt(CGAL::squared_distance(collapse.placement, *optimum)), 0, 1e-6);
    ++optima;
  }
  EXPECT_GT(optima, 200);
}

TEST(Quadrics, OfFlatSurroundingsGiveAPointOfTheEdge) {
  EXPECT_FALSE(Quadric::of_plane({0, 0, 1}, {0, 0, 2}, 3).minimum());
  SurfaceMesh flat = waves(12);
  for (const auto v : flat.vertices()) {
    const auto& p = flat.point(v);
    flat.point(v) = Kernel::Point_3(p.x(), p.y(), 0.25 + 0.5 * p.x());
  }
  Quadrics quadrics(flat);
  for (const auto e : flat.edges()) {
    const auto& p = flat.point(flat.vertex(e, 0));
    const auto& q = flat.point(flat.vertex(e, 1));
    const auto& collapse = of_edge(quadrics, flat, e);
    EXPECT_LT(CGAL::squared_distance(collapse.placement, p), 25 * CGAL::squared_distance(p, q));
    EXPECT_LT(CGAL::squared_distance(collapse.placement, q), 25 * CGAL::squared_distance(p, q));
    EXPECT_NEAR(collapse.cost, 0, 1e-12);
  }
}

TEST(Quadrics, OfEdgesAtACollapseAreFoundAgain) {
  SurfaceMesh mesh = waves(12);
  Quadrics quadrics(mesh);
  const SurfaceMesh::Vertex_index kept(84), gone(85);
  const auto between = mesh.edge(mesh.halfedge(kept, gone));
  for (const auto e : mesh.edges()) of_edge(quadrics, mesh, e);
  const Kernel::Point_3 anywhere(0.4, 0.7, 0.2);
  const double both = quadrics.cost(kept, gone, anywhere);
  quadrics.collapsed(kept, gone, kept, mesh);
  int at_vertex = 0;
  for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(kept), mesh)) {
    const auto e = mesh.edge(h);
    const auto w = mesh.source(h);
    if (e == between) continue;
    const double alone = quadrics.cost(w, w, anywhere) / 2;
    EXPECT_NEAR(quadrics.cost(kept, w, anywhere), both + alone, 1e-12);
    const auto& collapse = of_edge(quadrics, mesh, e);
    EXPECT_NEAR(collapse.cost, quadrics.cost(kept, w, collapse.placement), 1e-15);
    ++at_vertex;
  }
  EXPECT_EQ(at_vertex, 5);
}

TEST(Quadrics, OfEdgesAreFoundAgainAfterEditsWhenTold) {
  SurfaceMesh mesh = waves(12);
  for (const auto v : mesh.vertices()) mesh.point(v) = Kernel::Point_3(mesh.point(v).x(), mesh.point(v).y(), 0);
  Quadrics quadrics(mesh);
  const auto e = mesh.edge(mesh.halfedge(SurfaceMesh::Vertex_index(84), SurfaceMesh::Vertex_index(85)));
  const Kernel::Point_3 before = of_edge(quadrics, mesh, e).placement;
  mesh.point(SurfaceMesh::Vertex_index(84)) = Kernel::Point_3(0.1, 0.2, 0);
  EXPECT_EQ(of_edge(quadrics, mesh, e).placement, before);
  quadrics.forget_edges();
  EXPECT_NE(of_edge(quadrics, mesh, e).placement, before);
}

}  // namespace
