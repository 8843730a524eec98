// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal_functions.h"

#include <CGAL/Kernel/global_functions.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "meshbound/cgal/surface_mesh.h"

namespace meshbound::bench {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
namespace SMS = CGAL::Surface_mesh_simplification;
using cgal::SurfaceMesh;

}  // namespace

struct CgalPair::Meshes {
  SurfaceMesh a, b;
};

std::optional<CgalPair> CgalPair::make(const TriangleMesh& a, const TriangleMesh& b) {
  Meshes meshes;
  try {
    meshes = {cgal::to_surface_mesh(a), cgal::to_surface_mesh(b)};
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
  for (SurfaceMesh* mesh : {&meshes.a, &meshes.b}) {
    PMP::remove_isolated_vertices(*mesh);
    mesh->collect_garbage();
  }
  CgalPair pair;
  pair.meshes_ = std::make_shared<const Meshes>(std::move(meshes));
  return pair;
}

double CgalPair::bounded_error(double error_bound) const {
  return PMP::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(meshes_->a, meshes_->b, error_bound);
}

double CgalPair::one_sided_bounded_error(double error_bound) const {
  return PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(meshes_->a, meshes_->b, error_bound);
}

double CgalPair::approximate(double points_per_area) const {
  CGAL::get_default_random() = CGAL::Random(2009);  // the parameter random_seed does not reach every sampler
  if (points_per_area == 0)
    return PMP::approximate_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(meshes_->a, meshes_->b);
  const auto sampled = CGAL::parameters::number_of_points_per_area_unit(points_per_area);
  return PMP::approximate_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(meshes_->a, meshes_->b, sampled, sampled);
}

bool CgalPair::is_larger(double distance, double error_bound) const {
  return PMP::is_Hausdorff_distance_larger<CGAL::Sequential_tag>(meshes_->a, meshes_->b, distance, error_bound,
                                                                 CGAL::parameters::use_one_sided_hausdorff(false));
}

TriangleMesh decimated(const TriangleMesh& mesh, double ratio) {
  SurfaceMesh surface = cgal::manifold_copy(mesh).mesh;
  using Policies = SMS::GarlandHeckbert_plane_policies<SurfaceMesh, cgal::Kernel>;
  const Policies policies(surface);
  const SMS::Count_ratio_stop_predicate<SurfaceMesh> stop(ratio);
  SMS::edge_collapse(surface, stop,
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(SMS::Bounded_normal_change_filter<>()));
  surface.collect_garbage();
  return cgal::to_triangle_mesh(surface);
}

}  // namespace meshbound::bench
