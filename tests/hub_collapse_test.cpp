// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices with very many edges, as in the caps of cylinders: what a collapse beside one costs does not depend on how
// many these are, and the bound holds.
#include "cgal/hub_collapse.h"

#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "datasets/analytic_meshes.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/distance.h"

namespace meshbound::cgal {
namespace {

using Point = Kernel::Point_3;

/// A cone of one hub without a base: the hub's faces are all there are, and the rim is a border.
TriangleMesh fan(std::uint32_t triangles) {
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0, 0, 0.5);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const double angle = 2 * std::numbers::pi * i / triangles;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % triangles});
  }
  return mesh;
}

/// Short edges first, counting how often it is asked.
struct CountingCost {
  std::uint64_t* asked;
  template <class Map>
  void initialize(const SurfaceMesh&, const Map&, const Kernel&) const {}
  template <class Profile, class Vertex>
  void update_after_collapse(const Profile&, Vertex) const {}
  template <class Profile>
  boost::optional<double> operator()(const Profile& edge, const boost::optional<Point>&) const {
    ++*asked;
    return CGAL::squared_distance(edge.p0(), edge.p1());
  }
};

struct Middle {
  template <class Profile>
  boost::optional<Point> operator()(const Profile& edge) const {
    return CGAL::midpoint(edge.p0(), edge.p1());
  }
};

struct AdmitAll {
  template <class Profile>
  boost::optional<Point> operator()(const Profile&, const boost::optional<Point>& placement) const {
    return placement;
  }
};

struct StopAt {
  std::size_t edges;
  template <class Cost, class Profile, class Size>
  bool operator()(const Cost&, const Profile&, Size, Size current) const {
    return current <= edges;
  }
};

struct NoConstraint {
  using key_type = SurfaceMesh::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;
  friend bool get(const NoConstraint&, key_type) { return false; }
};

TEST(HubCollapse, AsksForAFewCostsForEachCollapse) {
  std::uint64_t asked = 0;
  SurfaceMesh mesh = to_surface_mesh(fan(3000));
  collapse_edges(mesh, StopAt{400}, CountingCost{&asked}, Middle(), AdmitAll(),
                 SMS::Edge_collapse_visitor_base<SurfaceMesh>(), NoConstraint());
  EXPECT_LE(mesh.number_of_edges(), 400u);
  EXPECT_TRUE(CGAL::is_valid_polygon_mesh(mesh));
  EXPECT_LE(asked, 60'000u) << "CGAL's own loop asks about 9 million times";
}

/// A hub takes part again once it has few enough edges: nothing is left but what must be.
TEST(HubCollapse, GoesOnToTheLastFaces) {
  std::uint64_t asked = 0;
  SurfaceMesh mesh = to_surface_mesh(datasets::cylinder(1, 1, 300));
  collapse_edges(mesh, StopAt{6}, CountingCost{&asked}, Middle(), AdmitAll(),
                 SMS::Edge_collapse_visitor_base<SurfaceMesh>(), NoConstraint());
  EXPECT_TRUE(CGAL::is_valid_polygon_mesh(mesh));
  EXPECT_TRUE(CGAL::is_closed(mesh));
  EXPECT_LE(mesh.number_of_faces(), 60u);
}

TEST(HubCollapse, KeepsTheBoundAndFewFaces) {
  for (const auto& [mesh, tolerance, most_faces] :
       {std::tuple{fan(1000), 0.003, 50u}, std::tuple{datasets::cylinder(1, 2, 360), 0.003, 170u},
        std::tuple{datasets::cylinder(1, 2, 4000), 0.003, 220u},
        std::tuple{datasets::uv_sphere(1, 20, 400), 0.01, 700u}}) {
    SimplifyOptions options;
    options.tolerance = tolerance;
    const SimplifyResult result = simplify_with_bound(mesh, options);
    SCOPED_TRACE(mesh.triangles.size());
    EXPECT_EQ(result.last().verdict, Verdict::Within);
    EXPECT_LE(result.last().faces(), most_faces);
  }
}

}  // namespace
}  // namespace meshbound::cgal
