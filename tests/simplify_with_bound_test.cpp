// SPDX-License-Identifier: GPL-3.0-or-later
// simplify_with_bound as a library: what it returns holds, measured by our engine and by CGAL's own function, over
// closed, open, thin, flat and broken meshes; and the hooks work in a plain edge_collapse call.
#include "meshbound/cgal/simplify_with_bound.h"

#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "datasets/analytic_meshes.h"
#include "meshbound/cgal/deviation_monitor.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "reference/small_meshes.h"

namespace meshbound::cgal {
namespace {

namespace SMS = CGAL::Surface_mesh_simplification;

SimplifyOptions within(double tolerance) {
  SimplifyOptions options;
  options.tolerance = tolerance;
  options.threads = 1;
  return options;
}

/// CGAL's symmetric Hausdorff distance: a number at most its error bound away from the truth.
double cgal_distance(const TriangleMesh& a, const TriangleMesh& b, double error_bound) {
  return CGAL::Polygon_mesh_processing::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(
      to_surface_mesh(a), to_surface_mesh(b), error_bound);
}

/// Measured afresh, not taken from the result.
void expect_within(const TriangleMesh& original, const SimplifiedLevel& level) {
  EXPECT_EQ(check_symmetric(Bvh(original), Bvh(level.mesh), level.tolerance).verdict, Verdict::Within);
  EXPECT_EQ(level.verdict, Verdict::Within);
}

struct Shape {
  const char* name;
  TriangleMesh mesh;
  double tolerance;
  double most_left;  ///< share of the faces
};

std::vector<Shape> manifold_shapes() {
  return {{"sphere", datasets::icosphere(1, 4), 0.01, 0.1},
          {"torus", datasets::torus(1, 0.3, 60, 24), 0.01, 0.25},
          {"terrain", datasets::terrain(1, 40, 3), 0.01, 0.3},
          {"cube", datasets::cube(1, 12), 0.01, 0.03},
          {"thin sheet, tolerance below its thickness", datasets::thin_sheet(1, 0.02, 20), 0.01, 0.1},
          {"thin sheet, tolerance above its thickness", datasets::thin_sheet(1, 0.005, 20), 0.01, 0.1},
          {"plane with spikes", datasets::spiked_plane(1, 0.1, 24, 6), 0.01, 0.5},
          {"gear", datasets::gear(1, 0.4, 12, 12, 4), 0.01, 0.5},
          {"flat square", reference::unit_square(20), 0.01, 0.05}};
}

TEST(SimplifyWithBound, HoldsItsToleranceByOurMeasureAndByCgals) {
  for (const Shape& shape : manifold_shapes()) {
    SCOPED_TRACE(shape.name);
    const SimplifyResult result = simplify_with_bound(shape.mesh, within(shape.tolerance));
    expect_within(shape.mesh, result.last());
    EXPECT_LE(static_cast<double>(result.last().mesh.triangles.size()),
              shape.most_left * static_cast<double>(shape.mesh.triangles.size()));
    const double error_bound = 0.02 * shape.tolerance;
    EXPECT_LE(cgal_distance(shape.mesh, result.last().mesh, error_bound), shape.tolerance + error_bound);
  }
}

TEST(SimplifyWithBound, HoldsForBothCosts) {
  SimplifyOptions options = within(0.01);
  options.cost = CollapseCost::LindstromTurk;
  for (const Shape& shape : manifold_shapes()) {
    SCOPED_TRACE(shape.name);
    const SimplifyResult result = simplify_with_bound(shape.mesh, options);
    expect_within(shape.mesh, result.last());
    EXPECT_LT(result.last().mesh.triangles.size(), shape.mesh.triangles.size());
  }
}

TEST(SimplifyWithBound, HoldsForSoupsThatAreNotManifold) {
  TriangleMesh duplicated = datasets::icosphere(1, 3);
  for (std::size_t t = 0; t < 200; ++t) duplicated.triangles.push_back(duplicated.triangles[3 * t]);
  TriangleMesh turned = datasets::icosphere(1, 3);
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3)
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  TriangleMesh unwelded = datasets::icosphere(1, 3);
  std::vector<std::array<Eigen::Vector3d, 3>> corners;
  for (const Triangle& t : unwelded.triangles)
    corners.push_back({unwelded.vertices[t[0]], unwelded.vertices[t[1]], unwelded.vertices[t[2]]});
  // A second square stands on the edge x = 0 of a first, and a third hangs below: three faces at an edge.
  TriangleMesh fins = reference::both(reference::unit_square(16), reference::unit_square(16));
  fins = reference::both(fins, reference::unit_square(16));
  for (std::size_t v = 289; v < 578; ++v) fins.vertices[v] = {0, fins.vertices[v].y(), fins.vertices[v].x()};
  for (std::size_t v = 578; v < 867; ++v) fins.vertices[v] = {0, fins.vertices[v].y(), -fins.vertices[v].x()};
  const std::vector<Shape> shapes = {{"duplicated faces", duplicated, 0.02, 0.2},
                                     {"a third of the faces turned over", turned, 0.02, 0.2},
                                     {"every triangle with vertices of its own", reference::soup(corners), 0.02, 0.2},
                                     {"three squares at one edge", fins, 0.02, 0.2},
                                     {"separate triangles", reference::random_soup(1, 200, 0.3), 0.02, 1}};
  for (const Shape& shape : shapes) {
    SCOPED_TRACE(shape.name);
    const SimplifyResult result = simplify_with_bound(shape.mesh, within(shape.tolerance));
    expect_within(shape.mesh, result.last());
    EXPECT_LE(static_cast<double>(result.last().mesh.triangles.size()),
              shape.most_left * static_cast<double>(shape.mesh.triangles.size()));
  }
}

TEST(SimplifyWithBound, HoldsAndSavesFacesWithHighEffort) {
  SimplifyOptions options = within(0.01);
  for (const Shape& shape : manifold_shapes()) {
    if (shape.mesh.triangles.size() > 3000) continue;  // for the time it takes
    SCOPED_TRACE(shape.name);
    options.effort = Effort::Normal;
    const std::size_t normal = simplify_with_bound(shape.mesh, options).last().mesh.triangles.size();
    options.effort = Effort::High;
    const SimplifyResult result = simplify_with_bound(shape.mesh, options);
    expect_within(shape.mesh, result.last());
    EXPECT_LE(result.last().mesh.triangles.size(), normal);
    EXPECT_LE(cgal_distance(shape.mesh, result.last().mesh, 2e-4), shape.tolerance + 2e-4);
  }
}

TEST(SimplifyWithBound, KeepsDegenerateTrianglesThatLieOnNoOther) {
  TriangleMesh mesh = datasets::icosphere(1, 3);
  mesh.vertices.emplace_back(3, 0, 0);
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  mesh.triangles.push_back({0, tip, tip});  // an antenna
  mesh.triangles.push_back({0, 0, 0});      // a point of the sphere
  const SimplifyResult result = simplify_with_bound(mesh, within(0.02));
  EXPECT_EQ(result.kept_triangles, 1u);
  EXPECT_EQ(result.dropped_triangles, 1u);
  expect_within(mesh, result.last());
}

TEST(SimplifyWithBound, SkipLeavesFewerFacesThanStop) {
  const TriangleMesh terrain = datasets::terrain(1, 40, 3);
  SimplifyOptions options = within(0.01);
  const SimplifyResult skip = simplify_with_bound(terrain, options);
  options.on_exceed = OnExceed::Stop;
  const SimplifyResult stop = simplify_with_bound(terrain, options);
  EXPECT_EQ(skip.last().ended_by, EndedBy::NothingFits);
  EXPECT_EQ(stop.last().ended_by, EndedBy::Tolerance);
  EXPECT_LT(skip.last().mesh.triangles.size(), stop.last().mesh.triangles.size());
  EXPECT_LT(stop.last().mesh.triangles.size(), terrain.triangles.size());
  expect_within(terrain, stop.last());
}

TEST(SimplifyWithBound, LevelsGrowCoarserAndEachHoldsAgainstTheOriginal) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = within(0.04);
  options.levels = {0.01, 0.0025};
  const SimplifyResult result = simplify_with_bound(torus, options);
  ASSERT_EQ(result.levels.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    expect_within(torus, result.levels[i]);
    if (i == 0) continue;
    EXPECT_LT(result.levels[i - 1].tolerance, result.levels[i].tolerance);
    EXPECT_GT(result.levels[i - 1].mesh.triangles.size(), result.levels[i].mesh.triangles.size());
  }
}

TEST(SimplifyWithBound, EndsAtTheTargetOrTheToleranceWhicheverComesFirst) {
  const TriangleMesh sphere = datasets::icosphere(1, 4);
  SimplifyOptions options = within(0.01);
  options.target_faces = 2000;
  const SimplifyResult target = simplify_with_bound(sphere, options);
  EXPECT_EQ(target.last().ended_by, EndedBy::Target);
  EXPECT_LE(target.last().mesh.triangles.size(), 2000u);
  EXPECT_GE(target.last().mesh.triangles.size(), 1998u);
  options.target_faces = 10;
  const SimplifyResult tolerance = simplify_with_bound(sphere, options);
  EXPECT_EQ(tolerance.last().ended_by, EndedBy::NothingFits);
  EXPECT_GT(tolerance.last().mesh.triangles.size(), 10u);
  expect_within(sphere, tolerance.last());
  options.target_faces.reset();
  options.target_ratio = 0.5;
  EXPECT_NEAR(static_cast<double>(simplify_with_bound(sphere, options).last().mesh.triangles.size()), 2560, 2);
}

std::set<std::array<double, 3>> border_points(const TriangleMesh& mesh) {
  const SurfaceMesh graph = to_surface_mesh(mesh);
  std::set<std::array<double, 3>> points;
  for (const auto v : graph.vertices()) {
    if (graph.is_border(v)) points.insert({graph.point(v).x(), graph.point(v).y(), graph.point(v).z()});
  }
  return points;
}

TEST(SimplifyWithBound, LeavesTheBoundaryAsItIsWhenAsked) {
  const TriangleMesh terrain = datasets::terrain(1, 24, 3);
  SimplifyOptions options = within(0.02);
  EXPECT_NE(border_points(simplify_with_bound(terrain, options).last().mesh), border_points(terrain));
  options.preserve_boundary = true;
  const SimplifyResult result = simplify_with_bound(terrain, options);
  EXPECT_EQ(border_points(result.last().mesh), border_points(terrain));
  EXPECT_LT(result.last().mesh.triangles.size(), terrain.triangles.size());
  expect_within(terrain, result.last());
}

TEST(SimplifyWithBound, LeavesTheBoundaryAsItIsWithHighEffort) {
  SimplifyOptions options = within(0.02);
  options.preserve_boundary = true;
  options.effort = Effort::High;
  const TriangleMesh terrain = datasets::terrain(1, 30, 3);
  const SimplifyResult result = simplify_with_bound(terrain, options);
  expect_within(terrain, result.last());
  EXPECT_EQ(border_points(result.last().mesh), border_points(terrain));
}

TEST(SimplifyWithBound, GivesTheSameMeshEveryTime) {
  const TriangleMesh terrain = datasets::terrain(1, 40, 3);
  SimplifyOptions options = within(0.01);
  const SimplifyResult one = simplify_with_bound(terrain, options);
  options.threads = 2;
  const SimplifyResult two = simplify_with_bound(terrain, options);
  EXPECT_EQ(one.last().mesh.triangles, two.last().mesh.triangles);
  EXPECT_EQ(one.last().mesh.vertices, two.last().mesh.vertices);
  EXPECT_EQ(one.last().distance->bounds.upper, two.last().distance->bounds.upper);
}

TEST(SimplifyWithBound, GivesTheSameMeshEveryTimeWithHighEffort) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = within(0.02);
  options.effort = Effort::High;
  const SimplifyResult one = simplify_with_bound(torus, options);
  options.threads = 2;
  const SimplifyResult two = simplify_with_bound(torus, options);
  EXPECT_EQ(one.last().mesh.triangles, two.last().mesh.triangles);
  EXPECT_EQ(one.last().mesh.vertices, two.last().mesh.vertices);
}

/// Fewer faces than normal effort can reach, yet not fewer than asked for.
TEST(SimplifyWithBound, EndsAtTheTargetWithHighEffort) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = within(0.01);
  options.target_faces = simplify_with_bound(torus, options).last().faces() - 10;
  options.effort = Effort::High;
  const SimplifyResult result = simplify_with_bound(torus, options);
  EXPECT_EQ(result.last().ended_by, EndedBy::Target);
  EXPECT_LE(result.last().faces(), *options.target_faces);
  EXPECT_GE(result.last().faces(), *options.target_faces - 2);
  expect_within(torus, result.last());
}

/// A speck on the surface, one beside it, a square that reaches out of it, and a shell.
TEST(Pruning, DropsComponentsThatTheRestStandsForAndNoOthers) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  const TriangleMesh speck = datasets::icosphere(0.004, 1);
  struct Case {
    const char* name;
    TriangleMesh part;
    std::size_t dropped;
  };
  const std::vector<Case> cases = {{"on the surface", reference::moved(speck, {0, 0, 1}), 1},
                                   {"beside it", reference::moved(speck, {0, 0, 1.03}), 0},
                                   {"reaches out", reference::moved(reference::unit_square(4), {0, 0, 0.995}), 0},
                                   {"a shell", datasets::icosphere(1.008, 3), 1},
                                   {"a shell too far", datasets::icosphere(1.05, 3), 0}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    for (const Effort effort : {Effort::Fast, Effort::Normal}) {
      const TriangleMesh both = reference::both(sphere, one.part);
      SimplifyOptions options = within(0.02);
      options.levels = {0.015};
      options.effort = effort;
      const SimplifyResult kept = simplify_with_bound(both, options);
      EXPECT_EQ(kept.pruned_components, 0u);
      options.prune = true;
      const SimplifyResult result = simplify_with_bound(both, options);
      EXPECT_EQ(result.pruned_components, one.dropped);
      EXPECT_EQ(result.pruned_faces > 0, one.dropped > 0);
      expect_within(both, result.levels.front());
      expect_within(both, result.last());
      EXPECT_EQ(summarise(result.last().mesh).components, 2 - one.dropped);
      // With pruning nothing is estimated, and other collapses are made.
      EXPECT_LT(static_cast<double>(result.last().faces()), 1.05 * static_cast<double>(kept.last().faces()));
    }
  }
}

/// All specks lie within the tolerance of another, and no order may drop the last of a chain.
TEST(Pruning, NeverDropsAllThatStandForOneAnother) {
  TriangleMesh chain = datasets::icosphere(0.01, 1);
  for (int i = 1; i < 12; ++i)
    chain = reference::both(chain, reference::moved(datasets::icosphere(0.01, 1), {0.015 * i, 0, 0}));
  SimplifyOptions options = within(0.02);
  options.prune = true;
  const SimplifyResult result = simplify_with_bound(chain, options);
  EXPECT_GT(result.pruned_components, 0u);
  EXPECT_LT(result.pruned_components, 11u);
  expect_within(chain, result.last());
}

TEST(Pruning, LeavesWhatIsToStay) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  const TriangleMesh shells = reference::both(sphere, datasets::icosphere(1.005, 2));
  SimplifyOptions options = within(0.05);
  options.prune = true;
  EXPECT_EQ(simplify_with_bound(shells, options).pruned_components, 1u);
  options.locked_vertices.assign(shells.vertices.size(), false);
  options.locked_vertices.front() = options.locked_vertices.back() = true;
  EXPECT_EQ(simplify_with_bound(shells, options).pruned_components, 0u);
  options.locked_vertices.clear();
  options.target_faces = shells.triangles.size() - 100;
  EXPECT_GE(simplify_with_bound(shells, options).last().faces(), *options.target_faces - 2);
  options.target_faces.reset();
  options.face_tolerances.assign(shells.triangles.size(), 1e-3);
  EXPECT_EQ(simplify_with_bound(shells, options).pruned_components, 0u);
  options.face_tolerances.clear();
  const TriangleMesh sheets =
      reference::both(reference::unit_square(8), reference::moved(reference::unit_square(4), {0, 0, 0.01}));
  EXPECT_EQ(simplify_with_bound(sheets, options).pruned_components, 1u);
  options.preserve_boundary = true;
  EXPECT_EQ(simplify_with_bound(sheets, options).pruned_components, 0u);
}

/// A vertex dragged over the edges around it turns faces over, within the plane and so within any bound.
TEST(DeviationMonitor, MovesNoVertexThroughTheNormalGuard) {
  SurfaceMesh mesh = to_surface_mesh(reference::unit_square(8));
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.1);
  const auto inner =
      std::find_if(mesh.vertices().begin(), mesh.vertices().end(), [&](auto v) { return !CGAL::is_border(v, mesh); });
  ASSERT_NE(inner, mesh.vertices().end());
  const Kernel::Point_3 p = mesh.point(*inner), beyond(p.x() + 0.2, p.y(), p.z());
  monitor.normal_guard = NormalGuard();
  EXPECT_FALSE(monitor.move_vertex(*inner, beyond));
  EXPECT_EQ(mesh.point(*inner), p);
  monitor.normal_guard.reset();
  EXPECT_TRUE(monitor.move_vertex(*inner, beyond));
}

/// Within a plane no triangulation is nearer than another.
TEST(DeviationMonitor, TurnsEdgesThatNoFlipWouldGainFrom) {
  SurfaceMesh mesh = to_surface_mesh(reference::unit_square(8));
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.1);
  monitor.normal_guard = NormalGuard();
  std::size_t flipped = 0, turned = 0;
  for (const auto e : mesh.edges()) flipped += monitor.flip_edge(e) ? 1 : 0;
  EXPECT_EQ(flipped, 0u);
  for (const auto e : mesh.edges()) turned += monitor.turn_edge(e) ? 1 : 0;
  EXPECT_GT(turned, 50u);
  const TriangleMesh after = to_triangle_mesh(mesh);
  double area = 0;
  for (const Triangle& t : after.triangles) {
    const Eigen::Vector3d &a = after.vertices[t[0]], &b = after.vertices[t[1]], &c = after.vertices[t[2]];
    area += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(area, 1, 1e-12);
}

/// Across a crease the other diagonal is off by its height.
TEST(DeviationMonitor, TurnsNoEdgeOutOfTheBound) {
  SurfaceMesh mesh = to_surface_mesh(datasets::cube(1, 4));
  DeviationMonitor<SurfaceMesh> monitor(mesh, 1e-3);
  for (const auto e : mesh.edges()) (void)monitor.turn_edge(e);
  const TriangleMesh after = to_triangle_mesh(mesh);
  EXPECT_EQ(check_symmetric(datasets::cube(1, 4), after, 1e-3).verdict, Verdict::Within);
}

TEST(SimplifyWithBound, ChangesNothingAtToleranceZero) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  const SimplifyResult result = simplify_with_bound(sphere, within(0));
  EXPECT_TRUE(result.tolerance_below_rounding);
  EXPECT_EQ(result.last().mesh.triangles.size(), sphere.triangles.size());
  EXPECT_EQ(result.last().verdict, Verdict::Within);
  EXPECT_EQ(result.last().distance->bounds.upper, 0);
}

/// A shape and the same one tiny, huge, or far away for its size, are simplified alike.
/// Inside, meshes are sorted along a curve.
TEST(SimplifyWithBound, KeepsTheOrderOfTheInput) {
  TriangleMesh shuffled = datasets::icosphere(1, 3);
  std::mt19937 random(7);
  std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), random);
  const TriangleMesh same = simplify_with_bound(shuffled, within(0)).last().mesh;
  EXPECT_EQ(same.vertices, shuffled.vertices);
  ASSERT_EQ(same.triangles.size(), shuffled.triangles.size());
  for (std::size_t t = 0; t < same.triangles.size(); ++t)
    EXPECT_TRUE(std::is_permutation(same.triangles[t].begin(), same.triangles[t].end(), shuffled.triangles[t].begin()));
}

TEST(SimplifyWithBound, HoldsAtExtremeScalesAndFarFromTheOrigin) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 40, 16);
  for (const double scale : {1e-160, 1e-30, 1e30, 1e155}) {
    SCOPED_TRACE(scale);
    const TriangleMesh mesh = reference::scaled(torus, scale);
    const SimplifyResult result = simplify_with_bound(mesh, within(0.02 * scale));
    expect_within(mesh, result.last());
    EXPECT_LT(result.last().mesh.triangles.size(), torus.triangles.size() / 2);
  }
  const TriangleMesh far = reference::moved(torus, {1e6, -1e6, 1e6});
  const SimplifyResult result = simplify_with_bound(far, within(0.02));
  expect_within(far, result.last());
  EXPECT_LT(result.last().mesh.triangles.size(), torus.triangles.size() / 2);
}

TEST(SimplifyWithBound, LeavesRoomForTheRoundingOfTheOutput) {
  const TriangleMesh sphere = datasets::icosphere(1, 4);
  SimplifyOptions options = within(0.01);
  options.output_rounding = 0.004;
  EXPECT_LE(simplify_with_bound(sphere, options).last().distance->bounds.upper, 0.006);
}

TEST(SimplifyWithBound, EndsWhenItIsToldTo) {
  const TriangleMesh sphere = datasets::icosphere(1, 4);
  SimplifyOptions options = within(0.01);
  options.time_limit = 0;
  EXPECT_EQ(simplify_with_bound(sphere, options).last().ended_by, EndedBy::TimeLimit);
  const std::atomic<bool> cancel = true;
  options.cancel = &cancel;
  options.measure = false;
  EXPECT_EQ(simplify_with_bound(sphere, options).last().ended_by, EndedBy::Cancelled);
}

TEST(SimplifyWithBound, RefusesOptionsAndInputThatMakeNoSense) {
  const TriangleMesh sphere = datasets::icosphere(1, 1);
  EXPECT_THROW((void)simplify_with_bound(sphere, SimplifyOptions()), InvalidInput);
  EXPECT_THROW((void)simplify_with_bound(sphere, within(-1)), InvalidInput);
  SimplifyOptions options = within(0.1);
  options.levels = {0.2};
  EXPECT_THROW((void)simplify_with_bound(sphere, options), InvalidInput);
  options.levels.clear();
  options.target_ratio = 1.5;
  EXPECT_THROW((void)simplify_with_bound(sphere, options), InvalidInput);
  EXPECT_THROW((void)simplify_with_bound(TriangleMesh(), within(0.1)), InvalidInput);
  const TriangleMesh point = {{Eigen::Vector3d::Zero()}, {{0, 0, 0}}};
  EXPECT_THROW((void)simplify_with_bound(point, within(0.1)), InvalidInput);
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
  EXPECT_LE(symmetric_distance(Bvh(original), Bvh(to_triangle_mesh(mesh))).bounds.upper, 0.02);
}

/// Every vertex is far above or below its neighbours, so that no edge can be collapsed. A vertex that moves gives the
/// edges that end there another chance, not those around it.
TEST(DeviationMonitor, TriesAHopelessEdgeAgainOnlyWhenAnEndHasMoved) {
  TriangleMesh rough = reference::unit_square(8);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> height(-1, 1);
  for (Eigen::Vector3d& p : rough.vertices) p.z() = height(random);
  SurfaceMesh mesh = to_surface_mesh(rough);
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.01);
  const auto pass = [&] {
    const std::uint64_t before = monitor.counts().refused;
    monitor.begin_pass();
    const SMS::Midpoint_placement<SurfaceMesh> middle;
    EXPECT_EQ(SMS::edge_collapse(mesh, monitor.stop_predicate(),
                                 CGAL::parameters::get_cost(SMS::Edge_length_cost<SurfaceMesh>())
                                     .get_placement(monitor.placement(middle))
                                     .filter(monitor.filter())
                                     .visitor(monitor.visitor())),
              0);
    return monitor.counts().refused - before;
  };
  EXPECT_GT(pass(), 100u);
  EXPECT_EQ(pass(), 0u);
  const auto inner =
      std::find_if(mesh.vertices().begin(), mesh.vertices().end(), [&](auto v) { return !CGAL::is_border(v, mesh); });
  ASSERT_NE(inner, mesh.vertices().end());
  const Kernel::Point_3 p = mesh.point(*inner);
  ASSERT_TRUE(monitor.move_vertex(*inner, Kernel::Point_3(p.x(), p.y(), p.z() + 0.004)));
  EXPECT_EQ(pass(), mesh.degree(*inner));
}

/// Made elsewhere, without a bound, and unrelated to the original but by its place.
TEST(DeviationMonitor, GoesOnFromAnApproximation) {
  const TriangleMesh original = datasets::torus(1, 0.3, 120, 48);
  SurfaceMesh mesh = to_surface_mesh(datasets::torus(1, 0.3, 70, 30));
  DeviationMonitor<SurfaceMesh> monitor(mesh, original, Bvh(original), 0.02, get(CGAL::vertex_point, mesh), 2);
  ASSERT_TRUE(monitor.unproven().empty());
  const int removed = SMS::edge_collapse(mesh, monitor.stop_predicate(),
                                         CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor()));
  EXPECT_GT(removed, 500);
  mesh.collect_garbage();
  EXPECT_LE(symmetric_distance(Bvh(original), Bvh(to_triangle_mesh(mesh))).bounds.upper, 0.02);
}

TEST(DeviationMonitor, AdmitsNothingFromAnApproximationThatItCouldNotProve) {
  const TriangleMesh original = datasets::torus(1, 0.3, 120, 48);
  SurfaceMesh mesh = to_surface_mesh(datasets::torus(1, 0.3, 30, 12));
  DeviationMonitor<SurfaceMesh> monitor(mesh, original, Bvh(original), 0.002, get(CGAL::vertex_point, mesh));
  EXPECT_FALSE(monitor.unproven().empty());
  EXPECT_THROW(SMS::edge_collapse(mesh, monitor.stop_predicate(),
                                  CGAL::parameters::filter(monitor.filter()).visitor(monitor.visitor())),
               Error);
  EXPECT_THROW((void)monitor.drop_components(), Error);
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
}

TEST(DeviationMonitor, RefusesAVisitorWithoutItsFilter) {
  SurfaceMesh mesh = to_surface_mesh(datasets::icosphere(1, 2));
  DeviationMonitor<SurfaceMesh> monitor(mesh, 0.1);
  EXPECT_THROW(SMS::edge_collapse(mesh, monitor.stop_predicate(), CGAL::parameters::visitor(monitor.visitor())), Error);
}

}  // namespace
}  // namespace meshbound::cgal
