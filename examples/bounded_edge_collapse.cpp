// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's edge_collapse with a cost and a placement of one's own, and the two-sided bound plugged into it.
// Usage: bounded_edge_collapse IN.off OUT.off TOLERANCE
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <meshbound/cgal/deviation_monitor.h>
#include <meshbound/distance.h>
#include <meshbound/error.h>
#include <meshbound/io.h>

#include <cstdio>
#include <cstdlib>

namespace SMS = CGAL::Surface_mesh_simplification;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

// Short edges first.
struct OwnCost {
  template <class Profile>
  boost::optional<double> operator()(const Profile& edge, const boost::optional<Point>&) const {
    return CGAL::squared_distance(edge.p0(), edge.p1());
  }
};

// A third of the way: nobody else's placement.
struct OwnPlacement {
  template <class Profile>
  boost::optional<Point> operator()(const Profile& edge) const {
    return edge.p0() + (edge.p1() - edge.p0()) / 3;
  }
};

int main(int argc, char** argv) try {
  Mesh mesh;
  if (argc != 4 || !CGAL::IO::read_OFF(argv[1], mesh)) return 2;
  const double tolerance = std::atof(argv[3]);
  const meshbound::Bvh original(meshbound::cgal::to_triangle_mesh(mesh));

  meshbound::cgal::DeviationMonitor<Mesh> monitor(mesh, tolerance);
  SMS::edge_collapse(mesh, monitor.stop_predicate(),
                     CGAL::parameters::get_cost(OwnCost())
                         .get_placement(monitor.placement(OwnPlacement()))  // others where this one breaks the bound
                         .filter(monitor.filter())
                         .visitor(monitor.visitor()));

  // The monitor has proven each collapse; what is written is measured all the same.
  mesh.collect_garbage();
  const meshbound::TriangleMesh result = meshbound::cgal::to_triangle_mesh(mesh);
  const auto check = meshbound::check_tolerance(original, meshbound::Bvh(result), tolerance);
  std::printf("%zu -> %zu faces, H <= %.9g\n", original.triangle_count(), result.triangles.size(), check.bounds.upper);
  if (check.verdict != meshbound::Verdict::Within) return 1;
  meshbound::write_mesh(argv[2], result);
  return 0;
} catch (const meshbound::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
