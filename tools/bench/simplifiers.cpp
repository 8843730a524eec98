// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplifiers.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Polyhedral_envelope_filter.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "cgal_functions.h"
#include "levels/level_run.h"
#include "measure.h"
#include "meshbound/bvh.h"
#include "meshbound/distance.h"

namespace meshbound::bench {
namespace {

namespace SMS = CGAL::Surface_mesh_simplification;

std::shared_ptr<const CollapseDriver> chosen_driver = cgal::edge_collapse_driver();

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
  return hausdorff_distance(tree_a, tree_b, options).bounds;
}

/// `Count_stop_predicate` counts edges, of which a mesh with borders has more than three for two faces.
struct FaceCountStop {
  std::size_t faces;
  template <class Cost, class Profile>
  bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
    return profile.surface_mesh().number_of_faces() <= faces;
  }
};

}  // namespace

Simplified bounded(const TriangleMesh& mesh, const SimplifyOptions& options, std::optional<std::size_t> level) {
  Simplified result;
  const Stopwatch watch;
  SimplifyResult run = decimate_levels(mesh, options);
  finish(result, watch);
  result.mesh = std::move(run.levels[level.value_or(run.levels.size() - 1)].mesh);
  return result;
}

void choose_driver(const std::string& name) { chosen_driver = name == "core" ? nullptr : cgal::edge_collapse_driver(); }

SimplifyOptions within(double tolerance, Effort effort, int threads) {
  SimplifyOptions options;
  options.driver = chosen_driver;
  options.tolerance = tolerance;
  options.effort = effort;
  options.threads = threads;
  return options;
}

double seconds_of_measuring(const TriangleMesh& mesh, const TriangleMesh& simplified, double tolerance, int threads) {
  const Stopwatch watch;
  (void)measured(mesh, simplified, tolerance, threads);
  return watch.elapsed().cpu;
}

Simplified unbounded(const cgal::SurfaceMesh& mesh, std::size_t faces) {
  using Policies = SMS::GarlandHeckbert_plane_policies<cgal::SurfaceMesh, cgal::Kernel>;
  Simplified result;
  cgal::SurfaceMesh copy = mesh;
  const Stopwatch watch;
  const Policies policies(copy);
  SMS::edge_collapse(copy, FaceCountStop{faces},
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
  const double upper = hausdorff_distance(Bvh(mesh), Bvh(simplified), options).bounds.upper;
  return upper / tolerance;
}

}  // namespace meshbound::bench
