// SPDX-License-Identifier: GPL-3.0-or-later
// Which edges are tried, and which are passed over because nothing could come of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "cgal/edge_collapse_driver.h"
#include "datasets/analytic_meshes.h"
#include "decimation_states.h"
#include "reference/small_meshes.h"
#include "simplify/decimate.h"
#include "simplify/minimax_step.h"
#include "simplify/region_collapses.h"

namespace meshbound {
namespace open_edges_test {

void set_tolerance(DecimationState& state, double tolerance) {
  state.grow_tolerance(tolerance);
  state.set_samples(tolerance);
}

/// A square on which every collapse fits, and a sphere on which none does.
constexpr double tolerance_of_square = 0.1, tolerance_of_sphere = 1e-6;

std::size_t edges_of(const DecimationState& state) { return 3 * state.mesh.face_count() / 2; }

TEST(EdgeCost, IsRefusedWherePlanesAreFarApart) {
  test::StateOf square(reference::unit_square(4)), sphere(datasets::icosphere(1, 2));
  set_tolerance(*square, tolerance_of_square);
  set_tolerance(*sphere, tolerance_of_sphere);
  for (Corner c = 0; c < 3 * sphere->mesh.face_count(); ++c) {
    const EdgeCost cost = edge_cost(*sphere, c, 1);
    ASSERT_TRUE(cost.refused_with);
    EXPECT_TRUE(is_far_beyond(*cost.refused_with));
  }
  for (Corner c = 0; c < 3 * square->mesh.face_count(); ++c) EXPECT_FALSE(edge_cost(*square, c, 1).refused_with);
}

/// Where the vertex can only stand at an end, its planes say nothing of the other places.
TEST(EdgeCost, IsNotRefusedByPlanesWhereAVertexIsLocked) {
  test::StateOf sphere(datasets::icosphere(1, 2));
  set_tolerance(*sphere, tolerance_of_sphere);
  const Corner edge = 30;
  sphere->locked[sphere->mesh.start(edge)] = 1;
  EXPECT_FALSE(edge_cost(*sphere, edge, 1).refused_with);
}

/// Between what a share of the tolerance and all of it allow, an edge is left for later.
TEST(EdgeCost, IsRefusedForAShareOfTheTolerance) {
  test::StateOf sphere(datasets::icosphere(1, 2));
  const Corner edge = 30;
  bool was_for_later = false;
  for (double tolerance = 1e-3; tolerance < 1; tolerance *= 1.05) {
    set_tolerance(*sphere, tolerance);
    const auto together = edge_cost(*sphere, edge, 0.5).refused_with, alone = edge_cost(*sphere, edge, 1).refused_with;
    EXPECT_TRUE(together || !alone);
    was_for_later = was_for_later || (together && !alone && *together == 0);
  }
  EXPECT_TRUE(was_for_later);
}

/// What a driver makes of a state without proofs.
struct Outcome {
  std::uint64_t tried = 0, refused = 0;
};
Outcome collapsed(DecimationState& state, const CollapseDriver* driver, RegionCollapses::Limits limits) {
  Split split = whole(state);
  Proposer proposer(state);
  RegionCollapses collapses(state, split, split.regions.front(), proposer, nullptr, std::move(limits));
  driver != nullptr ? driver->collapse(collapses) : collapses.collapse_all();
  return {proposer.counts.tried, proposer.counts.refused};
}
RegionCollapses::Limits no_limits() {
  return {1, [](std::size_t) { return false; }, nullptr};
}

TEST(Queue, NeverHasEdgesThatTheirPlanesRefuse) {
  const auto by_cgal = cgal::edge_collapse_driver();
  for (const CollapseDriver* driver : {static_cast<const CollapseDriver*>(nullptr), by_cgal.get()}) {
    test::StateOf sphere(datasets::icosphere(1, 3));
    set_tolerance(*sphere, tolerance_of_sphere);
    const Outcome outcome = collapsed(*sphere, driver, no_limits());
    EXPECT_EQ(outcome.tried, 0u);
    EXPECT_EQ(outcome.refused, edges_of(*sphere));
    for (Corner c = 0; c < 3 * sphere->mesh.face_count(); ++c) EXPECT_FALSE(sphere->is_open(c));
  }
}

/// The cheapest edge that is refused ends such a run, and it must have been tried: its star is looked at again.
TEST(Queue, HasAllEdgesWhereARefusalEndsTheCollapses) {
  test::StateOf sphere(datasets::icosphere(1, 3));
  set_tolerance(*sphere, tolerance_of_sphere);
  RegionCollapses::Limits limits = no_limits();
  limits.ends_at_refusal = [] { return true; };
  const Outcome outcome = collapsed(*sphere, nullptr, std::move(limits));
  EXPECT_EQ(outcome.tried, 1u);
  EXPECT_EQ(outcome.refused, 1u);
}

/// They are open still, and not refused: another cut comes to them.
TEST(Queue, LeavesEdgesThatCostMoreAsTheyAre) {
  test::StateOf sphere(datasets::icosphere(1, 3));
  const double tolerance = 0.02;
  set_tolerance(*sphere, tolerance);
  RegionCollapses::Limits limits = no_limits();
  limits.max_cost = static_cast<float>(0.5 * tolerance * tolerance);
  const std::size_t vertices = sphere->mesh.face_count() / 2;
  const Outcome outcome = collapsed(*sphere, nullptr, limits);
  EXPECT_GT(outcome.tried, vertices / 20);
  std::size_t left = 0;
  for (Corner c = 0; c < 3 * sphere->mesh.face_count(); ++c) {
    if (sphere->mesh.is_removed(c / 3) || sphere->mesh.edge(c) != c || !sphere->is_open(c)) continue;
    ++left;
    EXPECT_GT(edge_cost(*sphere, c, 1).cost, limits.max_cost);
  }
  EXPECT_GT(left, vertices / 10);
  EXPECT_GT(collapsed(*sphere, nullptr, no_limits()).tried, 0u);
}

/// More of the tolerance helps where a distance was too large, and nowhere else.
TEST(Proposer, TellsWhetherMoreOfTheToleranceMayHelp) {
  test::StateOf square(reference::unit_square(4));
  set_tolerance(*square, tolerance_of_square);
  std::fill(square->locked.begin(), square->locked.end(), 1);
  const Split split = whole(*square);
  Proposer proposer(*square);
  proposer.enter(split, split.regions.front());
  const Corner edge = 20;
  EXPECT_FALSE(proposer.placement(edge, 1, {}));
  EXPECT_GT(proposer.deviation(), hopeless_deviation);
  EXPECT_FALSE(is_far_beyond(proposer.deviation())) << "a change around it may help";

  test::StateOf ball(datasets::icosphere(1, 1));
  Proposer of_ball(*ball);
  of_ball.enter(split, split.regions.front());
  bool was_near = false;
  for (double tolerance = 1e-2; tolerance < 1; tolerance *= 1.05) {
    set_tolerance(*ball, tolerance);
    if (!of_ball.placement(edge, 0.5, {})) was_near = was_near || of_ball.deviation() <= hopeless_deviation;
  }
  EXPECT_TRUE(was_near);
}

/// A vertex a little more than the tolerance above a plane: its faces, which are slanted, are within it of the samples.
TEST(Proposer, AsksWhereTheVertexIsUnlessItLooksAtSamplesAlone) {
  test::StateOf square(reference::unit_square(4));
  set_tolerance(*square, tolerance_of_square);
  const ArrayMesh& mesh = square->mesh;
  Corner edge = 0;
  while (mesh.is_border(mesh.start(edge)) || mesh.is_border(mesh.end(edge))) ++edge;
  const Split split = whole(*square);
  Proposer proposer(*square);
  const Vec3 above = mesh.position(mesh.start(edge)) + Vec3{0, 0, 1.02 * tolerance_of_square};
  proposer.enter(split, split.regions.front(), Proposer::Looks::AtSamples);
  const auto at_samples = proposer.placement(edge, 0.999, above);
  ASSERT_TRUE(at_samples);
  EXPECT_EQ(at_samples->z, above.z);
  proposer.enter(split, split.regions.front());
  const auto around = proposer.placement(edge, 0.999, above);
  EXPECT_TRUE(!around || around->z < tolerance_of_square);
}

/// The vertex of a bay lies within the faces that a border across the bay would leave.
TEST(Proposer, AlwaysLooksAlongBorders) {
  TriangleMesh mesh = reference::unit_square(4);
  const auto bay = std::find(mesh.vertices.begin(), mesh.vertices.end(), Eigen::Vector3d(0.5, 0, 0));
  ASSERT_NE(bay, mesh.vertices.end());
  bay->y() = 0.22;
  test::StateOf square(mesh);
  set_tolerance(*square, tolerance_of_square);
  square->line_limit = 1;
  const ArrayMesh& faces = square->mesh;
  const auto is_at = [&](std::uint32_t v, double x, double y) { return same_position(faces.position(v), {x, y, 0}); };
  Corner edge = 0;
  while (!is_at(faces.start(edge), 0.25, 0) || !is_at(faces.end(edge), 0.5, 0.22)) ++edge;
  square->locked[faces.start(edge)] = 1;  // it is the one that stays
  const Split split = whole(*square);
  Proposer proposer(*square);
  for (const auto looks : {Proposer::Looks::AtSamples, Proposer::Looks::Around}) {
    proposer.enter(split, split.regions.front(), looks);
    EXPECT_FALSE(proposer.placement(edge, 0.999, {}));
    EXPECT_TRUE(proposer.refused_for_distance());
  }
}

/// Counts the regions that it is asked for, and leaves them as they are.
class CountingDriver : public CollapseDriver {
 public:
  void collapse(RegionCollapses& collapses) const override {
    ++regions;
    open += collapses.open_edges().size();
  }
  mutable std::atomic<std::size_t> regions = 0, open = 0;
};

TEST(Regions, AreNotCutWhereFewEdgesAreOpen) {
  for (const std::size_t every : {std::size_t{10}, std::size_t{1000}}) {
    test::StateOf torus(datasets::torus(1, 0.3, 120, 60));
    set_tolerance(*torus, 0.01);
    torus->tried_tolerance = 0.01;  // together
    for (Corner e = 0; e < torus->notes.size(); ++e) torus->notes.refuse(e, 2 * far_beyond);
    for (Corner e = 0; e < torus->notes.size(); e += static_cast<Corner>(every)) torus->notes.open(torus->mesh.edge(e));
    const CountingDriver driver;
    DecimationThreads threads(*torus, 1);
    DecimationGoal goal;
    goal.tolerance = 0.01;
    goal.driver = &driver;
    EXPECT_EQ(decimate(*torus, goal, threads), EndedBy::NothingFits);
    EXPECT_GT(driver.open, 0u);
    if (every == 1000) {
      EXPECT_EQ(driver.regions, 1u);
    } else {
      EXPECT_GT(driver.regions, 2u);
    }
  }
}

}  // namespace open_edges_test
}  // namespace meshbound
