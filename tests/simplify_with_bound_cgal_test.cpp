// SPDX-License-Identifier: GPL-3.0-or-later
// What simplify_with_bound returns holds by the measure of CGAL too, whose function shares no code with ours, with
// every driver and cost; and it takes the graphs of CGAL.
#include <CGAL/Kernel/global_functions.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <gtest/gtest.h>

#include "drivers.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/error.h"
#include "shapes.h"

namespace meshbound {
namespace simplify_with_bound_cgal_test {

/// CGAL's symmetric Hausdorff distance: a number at most its error bound away from the truth.
double cgal_distance(const TriangleMesh& a, const TriangleMesh& b, double error_bound) {
  return CGAL::Polygon_mesh_processing::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(
      cgal::to_surface_mesh(a), cgal::to_surface_mesh(b), error_bound);
}

std::vector<test::NamedDriver> drivers_and_costs() {
  std::vector<test::NamedDriver> all = test::drivers();
  all.push_back({"lindstrom_turk", cgal::edge_collapse_driver(cgal::CollapseCost::LindstromTurk)});
  return all;
}

class SimplifyWithBoundByCgal : public testing::TestWithParam<test::NamedDriver> {};

TEST_P(SimplifyWithBoundByCgal, HoldsItsToleranceByTheMeasureOfCgal) {
  for (const test::Shape& shape : test::manifold_shapes()) {
    SCOPED_TRACE(shape.name);
    SimplifyOptions options;
    options.tolerance = shape.tolerance;
    options.threads = 1;
    options.driver = GetParam().driver;
    const SimplifiedLevel level = simplify_with_bound(shape.mesh, options).last();
    EXPECT_EQ(level.verdict, Verdict::Within);
    EXPECT_LE(static_cast<double>(level.faces()), shape.max_left * static_cast<double>(shape.mesh.triangles.size()));
    const double error_bound = 0.02 * shape.tolerance;
    EXPECT_LE(cgal_distance(shape.mesh, level.mesh, error_bound), shape.tolerance + error_bound);
  }
}

INSTANTIATE_TEST_SUITE_P(With, SimplifyWithBoundByCgal, testing::ValuesIn(drivers_and_costs()),
                         [](const auto& driver) { return driver.param.name; });

TEST(SimplifyWithBoundOfGraphs, GivesWhatItGivesForTheirTriangles) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options;
  options.tolerance = 0.01;
  const SimplifiedLevel of_graph = cgal::simplify_with_bound(cgal::to_surface_mesh(torus), options).last();
  const SimplifiedLevel of_triangles = cgal::simplify_with_bound(torus, options).last();
  EXPECT_EQ(of_graph.verdict, Verdict::Within);
  EXPECT_EQ(of_graph.faces(), of_triangles.faces());
}

}  // namespace simplify_with_bound_cgal_test
}  // namespace meshbound
