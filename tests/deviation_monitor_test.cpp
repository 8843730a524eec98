// SPDX-License-Identifier: GPL-3.0-or-later
// The hooks of the monitor in a plain edge_collapse call of CGAL.
#include "meshbound/cgal/deviation_monitor.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "datasets/analytic_meshes.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/face_tolerances.h"
#include "reference/small_meshes.h"

namespace meshbound::cgal {
namespace deviation_monitor_test {

namespace SMS = CGAL::Surface_mesh_simplification;
using Place = std::array<double, 3>;

/// Collapses edges in an order of its own.
struct LastEdgeFirst {
  template <class Profile, class OptionalPoint>
  auto operator()(const Profile& profile, const OptionalPoint& placement) const {
    auto cost = SMS::Edge_length_cost<SurfaceMesh>()(profile, placement);
    if (cost) *cost = -static_cast<double>(static_cast<std::size_t>(profile.v0_v1()));
    return cost;
  }
};

std::set<Place> places(const TriangleMesh& mesh) {
  std::set<Place> all;
  for (const Eigen::Vector3d& p : mesh.vertices) all.insert({p.x(), p.y(), p.z()});
  return all;
}

TEST(DeviationMonitor, BoundsAPlainEdgeCollapseCallUnderAStackedFilter) {
  const TriangleMesh original = datasets::torus(1, 0.3, 60, 24);
  SurfaceMesh mesh = to_surface_mesh(original);
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.02);
  using Filter = SMS::Bounded_normal_change_filter<DeviationMonitor<SurfaceMesh>::Filter>;
  const int removed = SMS::edge_collapse(mesh, monitor.stop_predicate(),
                                         CGAL::parameters::get_cost(SMS::LindstromTurk_cost<SurfaceMesh>())
                                             .get_placement(SMS::LindstromTurk_placement<SurfaceMesh>())
                                             .filter(Filter(monitor.filter()))
                                             .visitor(monitor.visitor()));
  EXPECT_GT(removed, 1000);
  mesh.collect_garbage();
  EXPECT_EQ(monitor.faces(), mesh.number_of_faces());
  EXPECT_EQ(check_tolerance(Bvh(original), Bvh(to_triangle_mesh(mesh)), 0.02).verdict, Verdict::Within);
}

/// One placement of one's own leaves few collapses; the monitor finds others. Coordinates of another kernel.
TEST(DeviationMonitor, FindsOtherPlacementsWhereTheBaseBreaksTheBound) {
  using Exact = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
  const TriangleMesh original = datasets::icosphere(1, 3);
  const auto faces_left = [&](bool wraps) {
    Exact mesh;
    for (const auto& p : original.vertices) mesh.add_vertex({p.x(), p.y(), p.z()});
    for (const auto& t : original.triangles)
      mesh.add_face(Exact::Vertex_index(t[0]), Exact::Vertex_index(t[1]), Exact::Vertex_index(t[2]));
    DeviationMonitor<Exact> monitor(mesh, 0.02);
    const SMS::Edge_length_cost<Exact> cost;
    const SMS::Midpoint_placement<Exact> middle;
    const auto run = [&](const auto& placement) {
      return SMS::edge_collapse(mesh, monitor.stop_predicate(),
                                CGAL::parameters::get_cost(cost)
                                    .get_placement(placement)
                                    .filter(monitor.filter())
                                    .visitor(monitor.visitor()));
    };
    wraps ? run(monitor.placement(middle)) : run(middle);
    mesh.collect_garbage();
    EXPECT_EQ(check_tolerance(Bvh(original), Bvh(to_triangle_mesh(mesh)), 0.02).verdict, Verdict::Within);
    EXPECT_EQ(monitor.counts().performed, (original.triangles.size() - mesh.number_of_faces()) / 2);
    return mesh.number_of_faces();
  };
  EXPECT_LT(2 * faces_left(true), faces_left(false));
}

/// One run of many levels, all against the mesh at the start.
TEST(DeviationMonitor, GoesOnWithALargerTolerance) {
  const TriangleMesh original = datasets::torus(1, 0.3, 60, 24);
  SurfaceMesh mesh = to_surface_mesh(original);
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.005);
  std::size_t faces = original.triangles.size();
  for (const double tolerance : {0.005, 0.02, 0.05}) {
    monitor.grow_tolerance(tolerance);
    SMS::edge_collapse(mesh, monitor.stop_predicate(),
                       CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor()));
    SurfaceMesh copy = mesh;
    copy.collect_garbage();
    EXPECT_EQ(check_tolerance(Bvh(original), Bvh(to_triangle_mesh(copy)), tolerance).verdict, Verdict::Within);
    EXPECT_LT(monitor.faces(), faces);
    faces = monitor.faces();
  }
  EXPECT_THROW(monitor.grow_tolerance(0.01), InvalidInput);
}

TEST(DeviationMonitor, EndsWhereItsUserSaysSo) {
  SurfaceMesh mesh = to_surface_mesh(datasets::icosphere(1, 3));
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.1);
  monitor.should_stop = [](std::size_t faces) { return faces <= 1000; };
  SMS::edge_collapse(mesh, monitor.stop_predicate(),
                     CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor()));
  EXPECT_EQ(mesh.number_of_faces(), 1000u);
}

/// The property map of a user's own graph, in a plain edge_collapse, with and without our placement.
TEST(DeviationMonitor, LocksVerticesOfAPropertyMap) {
  for (const bool with_placement : {false, true}) {
    SurfaceMesh mesh = to_surface_mesh(datasets::torus(1, 0.3, 40, 16));
    const auto locked = mesh.add_property_map<SurfaceMesh::Vertex_index, bool>("v:locked", false).first;
    std::set<Place> kept;
    for (const auto v : mesh.vertices()) {
      locked[v] = v.idx() % 13 == 0;
      if (locked[v]) kept.insert({mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()});
    }
    EXPECT_EQ(locked_vertices(mesh, locked)[13], true);
    DeviationMonitor<SurfaceMesh> monitor(mesh, 0.03);
    monitor.lock_vertices(locked);
    const SMS::LindstromTurk_cost<SurfaceMesh> cost;
    const SMS::LindstromTurk_placement<SurfaceMesh> placement;
    const auto run = [&](const auto& chosen) {
      return SMS::edge_collapse(
          mesh, monitor.stop_predicate(),
          CGAL::parameters::get_cost(cost).get_placement(chosen).filter(monitor.filter()).visitor(monitor.visitor()));
    };
    EXPECT_GT(with_placement ? run(monitor.placement(placement)) : run(placement), 100);
    mesh.collect_garbage();
    const std::set<Place> left = places(to_triangle_mesh(mesh));
    EXPECT_TRUE(std::includes(left.begin(), left.end(), kept.begin(), kept.end()));
  }
}

TEST(DeviationMonitor, LimitsFacesByAPropertyMap) {
  const TriangleMesh sphere = datasets::icosphere(1, 4);
  std::vector<double> limits;
  SurfaceMesh mesh = to_surface_mesh(sphere);
  const auto map = mesh.add_property_map<SurfaceMesh::Face_index, double>("f:tolerance", 0).first;
  for (const auto f : mesh.faces()) {
    limits.push_back(sphere.vertices[sphere.triangles[f][0]].x() > 0.3 ? 0.002 : 0.03);
    map[f] = limits.back();
  }
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.03);
  monitor.limit_faces(map);
  SMS::edge_collapse(mesh, monitor.stop_predicate(),
                     CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor()));
  mesh.collect_garbage();
  EXPECT_LT(mesh.number_of_faces(), sphere.triangles.size() / 2);
  EXPECT_EQ(check_face_tolerances(sphere, limits, 0.03, to_triangle_mesh(mesh)).verdict, Verdict::Within);
}

TEST(DeviationMonitor, RefusesAMeshWithAnEdgeOfNoLength) {
  TriangleMesh square = reference::unit_square(2);
  square.vertices[4] = square.vertices[3];
  SurfaceMesh mesh = to_surface_mesh(square);
  EXPECT_THROW(DeviationMonitor<SurfaceMesh>(mesh, 0.1), InvalidInput);
}

/// CGAL's own filters need no visitor, so a user may well leave out the monitor's.
TEST(DeviationMonitor, RefusesAFilterWithoutItsVisitor) {
  SurfaceMesh mesh = to_surface_mesh(datasets::icosphere(1, 2));
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.1);
  const auto without_visitor = [&] {
    return SMS::edge_collapse(mesh, monitor.stop_predicate(), CGAL::parameters::filter(monitor.filter()));
  };
  EXPECT_THROW(without_visitor(), InvalidInput);
  EXPECT_EQ(mesh.number_of_faces(), 320u);
  EXPECT_GT(SMS::edge_collapse(mesh, monitor.stop_predicate(),
                               CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor())),
            0);
  EXPECT_THROW(without_visitor(), InvalidInput) << "the visitor of an earlier run does not count";
  monitor.should_stop = [](std::size_t) -> bool { throw std::runtime_error("stopped by its user"); };
  EXPECT_THROW(SMS::edge_collapse(mesh, monitor.stop_predicate(),
                                  CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor())),
               std::runtime_error);
  monitor.should_stop = nullptr;
  const std::size_t faces = mesh.number_of_faces();
  const auto other_order = [&] {
    return SMS::edge_collapse(mesh, monitor.stop_predicate(),
                              CGAL::parameters::get_cost(LastEdgeFirst())
                                  .get_placement(SMS::Midpoint_placement<SurfaceMesh>())
                                  .filter(monitor.filter()));
  };
  monitor.grow_tolerance(0.5);
  EXPECT_THROW(other_order(), InvalidInput) << "nor that of a run that ended by an exception";
  EXPECT_EQ(mesh.number_of_faces(), faces);
}

/// The edge with which a run ended by an exception may be the first one of a run without the visitor: its collapse is
/// proven, but none after it would be.
TEST(DeviationMonitor, RefusesAMeshThatWasCollapsedWithoutIt) {
  SurfaceMesh mesh = to_surface_mesh(datasets::icosphere(1, 2));
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.1);
  CGAL::Euler::collapse_edge(*edges(mesh).begin(), mesh);
  EXPECT_THROW(SMS::edge_collapse(mesh, monitor.stop_predicate(),
                                  CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor())),
               InvalidInput);
  EXPECT_EQ(mesh.number_of_faces(), 318u);
}

TEST(DeviationMonitor, TakesLocksOfVerticesThatNoFaceHas) {
  SurfaceMesh mesh = to_surface_mesh(datasets::icosphere(1, 1));
  mesh.add_vertex({2, 2, 2});
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.1);
  monitor.lock_vertices(CGAL::Constant_property_map<SurfaceMesh::Vertex_index, bool>(true));
  EXPECT_EQ(SMS::edge_collapse(mesh, monitor.stop_predicate(),
                               CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor())),
            0);
}

TEST(DeviationMonitor, RefusesAVisitorWithoutItsFilter) {
  SurfaceMesh mesh = to_surface_mesh(datasets::icosphere(1, 2));
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.1);
  EXPECT_THROW(SMS::edge_collapse(mesh, monitor.stop_predicate(), CGAL::parameters::visitor(monitor.visitor())), Error);
}

}  // namespace deviation_monitor_test
}  // namespace meshbound::cgal
