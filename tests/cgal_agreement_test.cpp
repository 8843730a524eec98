// SPDX-License-Identifier: GPL-3.0-or-later
// The engine against CGAL on real meshes and their decimations, both directions: never below CGAL's sampled lower
// estimate, and within both error bounds of its bounded-error distance. The one heavy user of CGAL among these tests.
#include <CGAL/Kernel/global_functions.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <gtest/gtest.h>

#include <optional>

#include "datasets.h"
#include "meshbound/cgal/surface_mesh.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace cgal_agreement_test {

namespace SMS = CGAL::Surface_mesh_simplification;
namespace PMP = CGAL::Polygon_mesh_processing;
using cgal::SurfaceMesh;

/// CGAL's error bound, as a fraction of the diagonal: tighter ones take it minutes on pairs that nearly coincide.
constexpr double cgal_error_bound = 1e-3;

/// What CGAL's plain double arithmetic may be off, as a fraction of the diagonal.
constexpr double cgal_rounding = 1e-12;

SurfaceMesh decimated(SurfaceMesh mesh, double ratio) {
  const SMS::GarlandHeckbert_plane_policies<SurfaceMesh, cgal::Kernel> policies(mesh);
  SMS::Count_ratio_stop_predicate<SurfaceMesh> stop(ratio);
  SMS::edge_collapse(mesh, stop,
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(SMS::Bounded_normal_change_filter<>()));
  mesh.collect_garbage();
  return mesh;
}

void expect_agreement(const SurfaceMesh& a, const SurfaceMesh& b, double diagonal) {
  const Bvh tree_a(cgal::to_triangle_mesh(a)), tree_b(cgal::to_triangle_mesh(b));
  const Bounds ours = one_sided_hausdorff_distance(tree_a, tree_b).bounds;
  EXPECT_LE(ours.upper - ours.lower, 2e-6 * diagonal);

  const double sampled = PMP::approximate_Hausdorff_distance<CGAL::Sequential_tag>(
      a, b, CGAL::parameters::number_of_points_on_faces(20000));
  EXPECT_GE(ours.upper, sampled - cgal_rounding * diagonal) << "a sample is further than our upper bound";

  const double bound = cgal_error_bound * diagonal;
  const double theirs = PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(a, b, bound);
  EXPECT_LE(ours.lower, theirs + bound);
  EXPECT_GE(ours.upper, theirs - bound);
}

void expect_agreement_with_decimations(const TriangleMesh& mesh) {
  const double diagonal = bounding_box_diagonal(mesh);
  const SurfaceMesh original = cgal::to_surface_mesh(mesh);
  for (const double ratio : {0.5, 0.1}) {
    SCOPED_TRACE(ratio);
    const SurfaceMesh simplified = decimated(original, ratio);
    ASSERT_LT(simplified.number_of_faces(), original.number_of_faces());
    expect_agreement(original, simplified, diagonal);
    expect_agreement(simplified, original, diagonal);
  }
}

class CgalAgreement : public testing::TestWithParam<const char*> {};

TEST_P(CgalAgreement, OnARealMeshAndItsDecimations) {
  const auto path = test::dataset(GetParam());
  if (!path) GTEST_SKIP() << GetParam() << " is not on this machine (set MESHBOUND_DATASETS or run datasets/fetch)";
  expect_agreement_with_decimations(read_mesh(*path).mesh);
}

std::string test_name(const testing::TestParamInfo<const char*>& test) {
  std::string name = test.param;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Datasets, CgalAgreement,
                         testing::Values("cad/igl_3holes.off", "cad/igl_screwdriver.off", "cad/igl_fandisk.off",
                                         "cad/abc_00016513.ply", "cad/thingi_472042.stl", "game/gltf_CesiumMan.obj",
                                         "game/gltf_Duck.obj", "game/gltf_Monster.obj", "organic/c3d_spot.obj",
                                         "organic/igl_cow.off", "organic/c3d_homer.obj", "scan/igl_bunny.off"),
                         test_name);

// What datasets/fetch brings, so that a machine without the other folders compares ten real meshes too.
INSTANTIATE_TEST_SUITE_P(Fetched, CgalAgreement,
                         testing::Values("cgal/anchor_dense.off", "cgal/bull.off", "cgal/camel.off", "cgal/cheese.off",
                                         "cgal/couplingdown.off", "cgal/cow.off", "cgal/elephant.off",
                                         "cgal/fandisk.off", "cgal/knot2.off", "cgal/lion-head.off"),
                         test_name);

TEST(CgalAgreementOnGeneratedMeshes, OnASphereAndItsDecimations) {
  expect_agreement_with_decimations(reference::icosphere(4));
}

TEST(CgalAgreementOnGeneratedMeshes, OnACubeAndItsDecimations) {
  TriangleMesh cube = reference::cube(1);
  for (int i = 0; i < 4; ++i) cube = reference::subdivided(cube);
  expect_agreement_with_decimations(cube);
}

TEST(CgalAgreementOnGeneratedMeshes, OnDifferentShapes) {
  const SurfaceMesh sphere = cgal::to_surface_mesh(reference::icosphere(3));
  const SurfaceMesh cube = cgal::to_surface_mesh(reference::cube(0.75));
  expect_agreement(sphere, cube, 3.0);
  expect_agreement(cube, sphere, 3.0);
}

}  // namespace cgal_agreement_test
}  // namespace meshbound
