// SPDX-License-Identifier: GPL-3.0-or-later
// Both drivers, the core's own queue and CGAL's edge_collapse, hold the same bound with about as many faces; and what
// is quadratic in CGAL's loop is left to the queue.
#include "cgal/edge_collapse_driver.h"

#include <CGAL/boost/graph/helpers.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <span>
#include <tuple>

#include "cgal/region_mesh.h"
#include "datasets/analytic_meshes.h"
#include "decimation_states.h"
#include "meshbound/cgal/lod_chain.h"
#include "numeric/no_index.h"
#include "reference/small_meshes.h"
#include "simplify_options.h"

namespace meshbound::cgal {
namespace edge_collapse_driver_test {

using test::within;

/// Counts what it passes on.
class CountingDriver : public CollapseDriver {
 public:
  void collapse(RegionCollapses& collapses) const override {
    ++regions;
    driver_->collapse(collapses);
  }
  mutable std::atomic<int> regions = 0;

 private:
  std::shared_ptr<const CollapseDriver> driver_ = edge_collapse_driver();
};

struct Shape {
  const char* name;
  TriangleMesh mesh;
  double tolerance;
};

/// A third of the triangles turned over, 100 duplicates, and 20 without area.
TriangleMesh untidy() {
  TriangleMesh mesh = datasets::torus(1, 0.3, 60, 24);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  for (std::size_t t = 0; t < 100; ++t) mesh.triangles.push_back(mesh.triangles[5 * t]);
  for (std::uint32_t t = 0; t < 20; ++t) mesh.triangles.push_back({t, t, t + 1});
  return mesh;
}

std::vector<Shape> shapes() {
  return {{"sphere", datasets::icosphere(1, 4), 0.01},
          {"torus", datasets::torus(1, 0.3, 80, 32), 0.01},
          {"large torus, several regions", datasets::torus(1, 0.3, 300, 100), 0.002},
          {"open terrain", datasets::terrain(1, 50, 3), 0.01},
          {"cube", datasets::cube(1, 12), 0.01},
          {"thin sheet, tolerance below its thickness", datasets::thin_sheet(1, 0.02, 20), 0.01},
          {"thin sheet, tolerance above its thickness", datasets::thin_sheet(1, 0.005, 20), 0.01},
          {"plane with spikes", datasets::spiked_plane(1, 0.1, 24, 6), 0.01},
          {"gear", datasets::gear(1, 0.4, 12, 12, 4), 0.01},
          {"untidy torus", untidy(), 0.01},
          {"separate triangles", reference::random_soup(1, 200, 0.3), 0.02}};
}

TEST(EdgeCollapseDriver, HoldsTheBoundWithAboutAsManyFacesAsTheQueueOfTheCore) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const SimplifiedLevel own = meshbound::simplify_with_bound(shape.mesh, within(shape.tolerance)).last();
    const SimplifiedLevel cgal = cgal::simplify_with_bound(shape.mesh, within(shape.tolerance)).last();
    for (const SimplifiedLevel& level : {own, cgal}) {
      EXPECT_EQ(level.verdict, Verdict::Within);
      EXPECT_EQ(check_tolerance(Bvh(shape.mesh), Bvh(level.mesh), shape.tolerance).verdict, Verdict::Within);
    }
    const auto faces = static_cast<double>(own.faces());
    EXPECT_NEAR(static_cast<double>(cgal.faces()), faces, std::max(20.0, 0.05 * faces));
  }
}

TEST(EdgeCollapseDriver, IsAskedByDefaultAndOnlyWhereNoOtherIsGiven) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  const auto counting = std::make_shared<CountingDriver>();
  const SimplifiedLevel counted = cgal::simplify_with_bound(torus, within(0.01, counting)).last();
  EXPECT_GT(counting->regions, 0);
  EXPECT_EQ(counted.mesh.triangles, cgal::simplify_with_bound(torus, within(0.01)).last().mesh.triangles);
  EXPECT_EQ(counted.mesh.triangles,
            cgal::simplify_with_bound(to_surface_mesh(torus), within(0.01)).last().mesh.triangles);
}

/// Levels go on from a mesh that CGAL has left.
TEST(EdgeCollapseDriver, GoesOnFromLevelToLevel) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 80, 32);
  LodOptions options;
  options.threads = 1;
  LodChain chain(torus, options);
  std::size_t faces = torus.triangles.size();
  for (const double tolerance : {0.002, 0.008, 0.03}) {
    const LodLevel level = chain.next(tolerance);
    EXPECT_EQ(level.verdict, Verdict::Within);
    EXPECT_LT(level.faces(), faces);
    faces = level.faces();
  }
}

TEST(EdgeCollapseDriver, GivesTheSameMeshForAnyNumberOfThreads) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 300, 100);
  SimplifyOptions options = within(0.001);
  const SimplifiedLevel one = cgal::simplify_with_bound(torus, options).last();
  options.threads = 3;
  const SimplifiedLevel three = cgal::simplify_with_bound(torus, options).last();
  EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
}

TEST(EdgeCollapseDriver, EndsWhereItIsTold) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  SimplifyOptions options = within(0.02);
  options.target_faces = 500;
  const SimplifiedLevel target = cgal::simplify_with_bound(torus, options).last();
  EXPECT_EQ(target.ended_by, EndedBy::Target);
  EXPECT_NEAR(static_cast<double>(target.faces()), 499, 1);
  options.target_faces.reset();
  options.on_exceed = OnExceed::Stop;
  const SimplifiedLevel stop = cgal::simplify_with_bound(torus, options).last();
  EXPECT_EQ(stop.ended_by, EndedBy::Tolerance);
  EXPECT_EQ(stop.verdict, Verdict::Within);
}

/// At a vertex with thousands of edges CGAL asks for thousands of costs after each collapse beside it.
TEST(Hubs, KeepTheBoundAndFewFacesWithBothDrivers) {
  for (const auto& [mesh, tolerance, max_faces] :
       {std::tuple{reference::fan(1000), 0.003, 50u}, std::tuple{datasets::cylinder(1, 2, 360), 0.003, 180u},
        std::tuple{datasets::cylinder(1, 2, 4000), 0.003, 220u},
        std::tuple{datasets::uv_sphere(1, 20, 400), 0.01, 700u}}) {
    for (const bool by_cgal : {false, true}) {
      const SimplifyOptions options = within(tolerance, by_cgal ? edge_collapse_driver() : nullptr);
      const SimplifiedLevel level = meshbound::simplify_with_bound(mesh, options).last();
      SCOPED_TRACE(std::to_string(mesh.triangles.size()) + (by_cgal ? " by CGAL" : " by the core"));
      EXPECT_EQ(level.verdict, Verdict::Within);
      EXPECT_LE(level.faces(), max_faces);
    }
  }
}

TEST(EdgeCollapseDriver, CollapsesForBothCosts) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  const auto by = [&](CollapseCost cost) {
    return cgal::simplify_with_bound(torus, within(0.01, edge_collapse_driver(cost))).last();
  };
  const SimplifiedLevel quadrics = by(CollapseCost::GarlandHeckbert), volume = by(CollapseCost::LindstromTurk);
  EXPECT_EQ(volume.verdict, Verdict::Within);
  EXPECT_LT(volume.faces(), torus.triangles.size() / 4);
  EXPECT_NE(volume.mesh.triangles, quadrics.mesh.triangles);
}

/// Whether a vertex at the rim has several fans of faces.
bool has_several_fans(const RegionMesh& region) {
  std::set<std::uint32_t> ends;
  return std::ranges::any_of(region.mesh.halfedges(), [&](const auto h) {
    return region.mesh.is_border(h) && !ends.insert(region.mesh.target(h)).second;
  });
}

/// Compares what CGAL gets of a region, all of whose edges are open, with the array mesh.
void look_at(const RegionCollapses& collapses) {
  const RegionMesh region(collapses);
  const ArrayMesh& mesh = collapses.mesh();
  std::size_t faces = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) faces += !mesh.is_removed(f) && collapses.owns_face(f);
  EXPECT_TRUE(CGAL::is_valid_polygon_mesh(region.mesh) || has_several_fans(region));
  EXPECT_EQ(region.mesh.number_of_faces(), faces);
  for (const auto h : region.mesh.halfedges())
    EXPECT_TRUE(!region.mesh.is_border(h) || region.mesh.is_border(region.mesh.target(h), false));
  for (const auto v : region.mesh.vertices()) {
    const Vec3 p = mesh.position(region.vertex[v]);
    EXPECT_EQ(region.mesh.point(v), Kernel::Point_3(p.x, p.y, p.z));
  }
  for (const auto e : region.mesh.edges())
    EXPECT_NE(corner_between(mesh, region.vertex[region.mesh.vertex(e, 0)], region.vertex[region.mesh.vertex(e, 1)]),
              no_index);
}

TEST(RegionMesh, IsThatOfTheArrayMeshWholeAndInRegions) {
  for (const TriangleMesh& mesh : {datasets::torus(1, 0.3, 300, 100), datasets::terrain(1, 150, 3)}) {
    test::StateOf state(mesh);
    Proposer proposer(*state);
    for (int shift = 0; shift <= shifts_of_split; ++shift) {
      Split cut = shift == shifts_of_split ? whole(*state) : split(*state, shift, 1000);
      EXPECT_EQ(cut.regions.size() > 2, shift < shifts_of_split);
      for (Region& region : cut.regions) look_at(RegionCollapses(*state, cut, region, proposer, nullptr, {}));
    }
  }
}

/// Closes all edges of a mesh but the given ones.
void leave_open(DecimationState& state, std::span<const Corner> edges) {
  state.refuse_all();
  for (const Corner e : edges) state.notes.open(state.mesh.edge(e));
}

/// Vertices within so many edges of the ends of an edge.
std::set<std::uint32_t> around(const ArrayMesh& mesh, Corner edge, int rings) {
  std::set<std::uint32_t> found = {mesh.start(edge), mesh.end(edge)};
  for (int ring = 0; ring < rings; ++ring)
    for (const std::uint32_t v : std::set(found))
      mesh.for_each_corner(v, [&](Corner c) {
        found.insert({mesh.end(c), mesh.apex(c)});
        return true;
      });
  return found;
}

TEST(RegionMesh, HasTheFacesAroundOpenEdgesWhereTheseAreFew) {
  test::StateOf state(datasets::torus(1, 0.3, 60, 24));
  const Corner edge = 1000;
  leave_open(*state, std::array{edge});
  Split split = whole(*state);
  Proposer proposer(*state);
  const RegionMesh region(RegionCollapses(*state, split, split.regions.front(), proposer, nullptr, {}));
  EXPECT_TRUE(CGAL::is_valid_polygon_mesh(region.mesh));
  std::set<std::uint32_t> inner, all;
  for (const auto v : region.mesh.vertices()) {
    all.insert(region.vertex[v]);
    if (region.is_inner[v] != 0) inner.insert(region.vertex[v]);
  }
  EXPECT_EQ(inner, around(state->mesh, edge, RegionMesh::rings_around_open));
  EXPECT_EQ(all, around(state->mesh, edge, RegionMesh::rings_around_open + 1));
}

/// What CGAL's loop must not be given: edges of no length, which it collapses without asking, and hubs.
TEST(RegionMesh, TellsOfEdgesOfNoLengthAndOfHubs) {
  const auto region_of = [](DecimationState& state) {
    Split split = whole(state);
    Proposer proposer(state);
    return RegionMesh(RegionCollapses(state, split, split.regions.front(), proposer, nullptr, {}));
  };
  test::StateOf square(reference::unit_square(4));
  const RegionMesh tidy = region_of(*square);
  EXPECT_FALSE(tidy.has_edge_of_no_length);
  EXPECT_EQ(tidy.max_edges_of_vertex, 6u);
  const Corner edge = 20;
  square->mesh.move(square->mesh.start(edge), square->mesh.position(square->mesh.end(edge)));
  EXPECT_TRUE(region_of(*square).has_edge_of_no_length);
  test::StateOf hub(reference::fan(500));
  EXPECT_EQ(region_of(*hub).max_edges_of_vertex, 500u);
}

/// The triangles that a driver leaves of a mesh without proofs; null: the queue of the core.
std::vector<std::array<std::uint32_t, 3>> left_by(const CollapseDriver* driver, DecimationState& state,
                                                  std::span<const Corner> open = {}) {
  state.grow_tolerance(0.1);
  state.set_samples(0.1);
  if (!open.empty()) leave_open(state, open);
  Split split = whole(state);
  Proposer proposer(state);
  RegionCollapses collapses(state, split, split.regions.front(), proposer, nullptr,
                            {1, [](std::size_t) { return false; }, nullptr});
  driver != nullptr ? driver->collapse(collapses) : collapses.collapse_all();
  std::vector<std::array<std::uint32_t, 3>> left;
  for (std::uint32_t f = 0; f < state.mesh.face_count(); ++f)
    if (!state.mesh.is_removed(f)) left.push_back(state.mesh.corners(f));
  return left;
}

/// Collapses beside one another reach the rim of the faces that CGAL gets; what lies beyond waits.
TEST(EdgeCollapseDriver, CollapsesAroundOpenEdgesWhereTheseAreFew) {
  const TriangleMesh terrain = datasets::terrain(1, 60, 3);
  const auto driver = edge_collapse_driver();
  const Corner open = 9000;
  test::StateOf state(terrain), by_core(terrain);
  const ArrayMesh before = state->mesh;
  const std::size_t left = left_by(driver.get(), *state, std::array{open}).size();
  EXPECT_LT(left, terrain.triangles.size() - 10);
  EXPECT_LT(left_by(nullptr, *by_core, std::array{open}).size(), left) << "the queue of the core goes on beyond";
  const std::set<std::uint32_t> inner = around(before, open, RegionMesh::rings_around_open);
  for (std::uint32_t f = 0; f < before.face_count(); ++f) {
    const auto corners = before.corners(f);
    if (state->mesh.is_removed(f)) {
      EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return inner.contains(v); }));
    }
  }
}

/// The one open edge cannot be collapsed, so nothing opens the others, which CGAL has too.
TEST(EdgeCollapseDriver, TriesOpenEdgesOnly) {
  const TriangleMesh terrain = datasets::terrain(1, 60, 3);
  const auto driver = edge_collapse_driver();
  const Corner open = 9000;
  test::StateOf state(terrain);
  for (const std::uint32_t v : {state->mesh.start(open), state->mesh.end(open)}) state->locked[v] = 1;
  EXPECT_EQ(left_by(driver.get(), *state, std::array{open}).size(), terrain.triangles.size());
}

TEST(EdgeCollapseDriver, LeavesSuchRegionsToTheQueueOfTheCore) {
  const TriangleMesh terrain = datasets::terrain(1, 16, 3);
  const auto driver = edge_collapse_driver();
  const auto with_short_edge = [&](const CollapseDriver* by) {
    test::StateOf state(terrain);
    state->mesh.move(state->mesh.start(200), state->mesh.position(state->mesh.end(200)));
    return left_by(by, *state);
  };
  EXPECT_EQ(with_short_edge(driver.get()), with_short_edge(nullptr));
  const auto of_mesh = [](const CollapseDriver* by, const TriangleMesh& mesh) {
    test::StateOf state(mesh);
    return left_by(by, *state);
  };
  const TriangleMesh cylinder = datasets::cylinder(1, 2, 120);
  EXPECT_EQ(of_mesh(driver.get(), cylinder), of_mesh(nullptr, cylinder));
  EXPECT_NE(of_mesh(driver.get(), terrain), of_mesh(nullptr, terrain)) << "elsewhere the order differs a little";
}

}  // namespace edge_collapse_driver_test
}  // namespace meshbound::cgal
