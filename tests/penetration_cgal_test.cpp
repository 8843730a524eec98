// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes and depths against CGAL's corefinement, on real closed meshes.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "datasets.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/penetration_depth.h"
#include "reference/small_meshes.h"
#include "solids.h"

namespace meshbound {
namespace penetration_cgal_test {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

CgalMesh to_cgal(const TriangleMesh& mesh) {
  CgalMesh result;
  for (const Eigen::Vector3d& p : mesh.vertices) result.add_vertex({p.x(), p.y(), p.z()});
  const auto vertex = [](std::uint32_t i) { return CgalMesh::Vertex_index(i); };
  for (const auto& [a, b, c] : mesh.triangles) result.add_face(vertex(a), vertex(b), vertex(c));
  return result;
}

TriangleMesh faces_of(const CgalMesh& mesh, const std::vector<CgalMesh::Face_index>& faces) {
  TriangleMesh result;
  for (const CgalMesh::Face_index face : faces) {
    Triangle triangle{};
    std::size_t k = 0;
    for (const CgalMesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(face))) {
      const Kernel::Point_3& p = mesh.point(v);
      triangle[k++] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.emplace_back(p.x(), p.y(), p.z());
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

/// What CGAL finds of one volume; its vertices on the curves are rounded.
struct CgalVolume {
  double content;
  Bounds depth;
};

/// Whether a face of the intersection comes from A: its middle is nearer to A than to B.
bool is_from(const TriangleMesh& face, const Bvh& a, const Bvh& b) {
  const Eigen::Vector3d middle = (face.vertices[0] + face.vertices[1] + face.vertices[2]) / 3;
  return closest_point(a, middle).distance.upper < closest_point(b, middle).distance.upper;
}

/// The volumes by CGAL, largest content first.
std::vector<CgalVolume> by_cgal(const TriangleMesh& a, const TriangleMesh& b, double error_bound) {
  CgalMesh mesh_a = to_cgal(a), mesh_b = to_cgal(b), common;
  EXPECT_TRUE(PMP::corefine_and_compute_intersection(mesh_a, mesh_b, common));
  PMP::triangulate_faces(common);
  auto component = common.add_property_map<CgalMesh::Face_index, std::size_t>("f:component", 0).first;
  std::vector<std::vector<CgalMesh::Face_index>> faces(PMP::connected_components(common, component));
  for (const CgalMesh::Face_index face : common.faces()) faces[component[face]].push_back(face);
  const Bvh tree_a(a), tree_b(b);
  std::vector<CgalVolume> volumes;
  for (const auto& of_volume : faces) {
    std::array<std::vector<CgalMesh::Face_index>, 2> parts;
    for (const CgalMesh::Face_index face : of_volume)
      parts[is_from(faces_of(common, {face}), tree_a, tree_b) ? 0 : 1].push_back(face);
    const TriangleMesh whole = faces_of(common, of_volume);
    double content = 0;
    for (const auto& [i, j, k] : whole.triangles)
      content += whole.vertices[i].dot(whole.vertices[j].cross(whole.vertices[k])) / 6;
    DistanceOptions options;
    options.error_bound = error_bound;
    const Bvh part_a(faces_of(common, parts[0])), part_b(faces_of(common, parts[1]));
    volumes.push_back({content, hausdorff_distance(part_a, part_b, options).bounds});
  }
  std::sort(volumes.begin(), volumes.end(), [](const auto& x, const auto& y) { return x.content > y.content; });
  return volumes;
}

void expect_agreement(const TriangleMesh& a, const TriangleMesh& b) {
  const double size = bounding_box_diagonal(a), rounding = 1e-9 * size;
  PenetrationOptions options;
  options.error_bound = 1e-5 * size;
  PenetrationDepth ours = penetration_depth(a, b, options);
  std::stable_sort(ours.volumes.begin(), ours.volumes.end(),
                   [](const auto& x, const auto& y) { return x.volume.upper > y.volume.upper; });
  const std::vector<CgalVolume> theirs = by_cgal(a, b, *options.error_bound);
  ASSERT_EQ(ours.volumes.size(), theirs.size());
  EXPECT_GE(theirs.size(), 1U);
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    EXPECT_LE(ours.volumes[i].volume.lower, theirs[i].content + rounding * size * size);
    EXPECT_GE(ours.volumes[i].volume.upper, theirs[i].content - rounding * size * size);
    EXPECT_LE(ours.volumes[i].volume.upper - ours.volumes[i].volume.lower, 10 * rounding * size * size);
    EXPECT_LE(ours.volumes[i].depth.lower, theirs[i].depth.upper + rounding);
    EXPECT_GE(ours.volumes[i].depth.upper, theirs[i].depth.lower - rounding);
    EXPECT_EQ(ours.volumes[i].outcome, Outcome::Converged);
  }
}

/// The mesh against itself, moved by a part of its size and turned.
void expect_agreement_at_poses(const TriangleMesh& mesh) {
  const double size = bounding_box_diagonal(mesh);
  const Eigen::Vector3d middle = used_bounding_box(mesh).center();
  for (const double shift : {0.1, 0.25}) {
    const auto pose = solids::motion(middle + size * shift * Eigen::Vector3d(1, 0.3, 0.2), 4 * shift, {1, 2, 3});
    expect_agreement(mesh, solids::mapped(reference::moved(mesh, -middle), pose));
  }
}

TEST(PenetrationByCgal, SpheresAndBoxes) {
  expect_agreement_at_poses(reference::icosphere(3));
  expect_agreement_at_poses(solids::box({0, 0, 0}, {1, 2, 3}));
  expect_agreement(reference::icosphere(2), solids::mapped(solids::box({-2, -0.3, -0.3}, {2, 0.3, 0.3}),
                                                           solids::motion({0.1, 0.2, 0.05}, 0.4, {1, 1, 0})));
}

class SlowPenetrationByCgal : public testing::TestWithParam<const char*> {};

TEST_P(SlowPenetrationByCgal, OnARealMesh) {
  const auto path = test::dataset(GetParam());
  if (!path) GTEST_SKIP() << GetParam() << " is not on this machine";
  expect_agreement_at_poses(read_mesh(*path).mesh);
}

INSTANTIATE_TEST_SUITE_P(Real, SlowPenetrationByCgal,
                         testing::Values("organic/npm_bunny.ply", "organic/igl_elephant.obj", "cad/c3d_rocker-arm.obj",
                                         "pairs/bunnyIRMB__bunny.obj", "scan/igl_armadillo.obj"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

}  // namespace penetration_cgal_test
}  // namespace meshbound
