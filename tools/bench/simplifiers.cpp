// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplifiers.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Polyhedral_envelope_filter.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "cgal_functions.h"
#include "measure.h"
#include "meshbound/bvh.h"
#include "meshbound/distance.h"

namespace meshbound::bench {
namespace {

namespace SMS = CGAL::Surface_mesh_simplification;

void finish(Simplified& result, const Stopwatch& watch) {
  const Times times = watch.elapsed();
  result.cpu = times.cpu;
  result.wall = times.wall;
}

Bounds measured(const TriangleMesh& a, const TriangleMesh& b, double tolerance, int threads) {
  DistanceOptions options;
  options.tolerance = tolerance;
  options.threads = threads;
  const auto [tree_a, tree_b] = build_trees(a, b, {threads});
  return symmetric_distance(tree_a, tree_b, options).bounds;
}

}  // namespace

Simplified bounded(const TriangleMesh& mesh, double tolerance, cgal::Effort effort, int threads) {
  cgal::SimplifyOptions options;
  options.tolerance = tolerance;
  options.effort = effort;
  options.threads = threads;
  options.measure = false;
  Simplified result;
  const Stopwatch watch;
  result.mesh = cgal::simplify_with_bound(mesh, options).last().mesh;
  const double before = watch.elapsed().cpu;
  (void)measured(mesh, result.mesh, tolerance, threads);
  finish(result, watch);
  result.certify_cpu = result.cpu - before;
  return result;
}

Simplified unbounded(const TriangleMesh& mesh, std::size_t faces) {
  using Policies = SMS::GarlandHeckbert_plane_policies<cgal::SurfaceMesh, cgal::Kernel>;
  Simplified result;
  const Stopwatch watch;
  cgal::SurfaceMesh copy = cgal::manifold_copy(mesh).mesh;
  const Policies policies(copy);
  const std::size_t edges = 3 * faces / 2;  // three for two faces of a closed surface
  SMS::edge_collapse(copy, SMS::Count_stop_predicate<cgal::SurfaceMesh>(edges),
                     CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  finish(result, watch);
  copy.collect_garbage();
  result.mesh = cgal::to_triangle_mesh(copy);
  return result;
}

Simplified in_envelope(const TriangleMesh& mesh, double tolerance) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;  // the filter needs its predicates
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  using Policies = SMS::GarlandHeckbert_plane_policies<Mesh, Kernel>;
  using Filter = SMS::Polyhedral_envelope_filter<Kernel, SMS::Bounded_normal_change_filter<>>;
  Simplified result;
  const Stopwatch watch;
  const cgal::SurfaceMesh copy = cgal::manifold_copy(mesh).mesh;
  Mesh exact;
  CGAL::copy_face_graph(copy, exact);
  const Policies policies(exact);
  SMS::edge_collapse(exact, SMS::Count_stop_predicate<Mesh>(0),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(Filter(tolerance, SMS::Bounded_normal_change_filter<>())));
  finish(result, watch);
  exact.collect_garbage();
  result.mesh = cgal::to_triangle_mesh(exact);
  return result;
}

Simplified by_bisection(const TriangleMesh& mesh, double tolerance) {
  constexpr double narrow_enough = 1.02;
  Simplified result;
  const Stopwatch watch;
  result.mesh = mesh;
  double holds = 1, breaks = 4.0 / static_cast<double>(mesh.triangles.size());
  while (holds > narrow_enough * breaks) {
    const double ratio = std::sqrt(holds * breaks);
    TriangleMesh candidate = decimated(mesh, ratio);
    if (measured(mesh, candidate, tolerance, 1).upper <= tolerance) {
      holds = ratio;
      result.mesh = std::move(candidate);
    } else {
      breaks = ratio;
    }
  }
  finish(result, watch);
  return result;
}

double share_of_tolerance(const TriangleMesh& mesh, const TriangleMesh& simplified, double tolerance) {
  DistanceOptions options;
  options.error_bound = 1e-4 * tolerance;
  options.threads = 1;
  const double upper = symmetric_distance(Bvh(mesh), Bvh(simplified), options).bounds.upper;
  return upper / tolerance;
}

}  // namespace meshbound::bench
