// SPDX-License-Identifier: MIT
// What is found out from the surroundings of a refused collapse is what the whole mesh says, wherever the vertex goes.
#include "simplify/exceed_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "datasets/analytic_meshes.h"
#include "decimation_fixture.h"
#include "reference/small_meshes.h"
#include "sheets.h"
#include "simplify/change_prover.h"
#include "simplify/proof_workers.h"
#include "simplify/region_collapses.h"
#include "simplify/regions.h"
#include "simplify/repair.h"

namespace meshbound {
namespace exceed_check_test {

struct Case {
  const char* name;
  TriangleMesh mesh;
  double tolerance;
};

/// A wheel with teeth that are closer than the tolerance, and a vertex in the middle of each cap.
TriangleMesh gear(std::uint32_t corners) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 0.3}};
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners, radius = i % 2 == 0 ? 1 : 0.97;
    for (const double z : {0.0, 0.3}) mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    const std::uint32_t at = 2 + 2 * i, next = 2 + 2 * ((i + 1) % corners);
    mesh.triangles.insert(mesh.triangles.end(),
                          {{at, next, next + 1}, {at, next + 1, at + 1}, {0, next, at}, {1, at + 1, next + 1}});
  }
  return mesh;
}

std::vector<Case> cases() {
  std::mt19937 random(1);
  const TriangleMesh rough = test::bumpy_sheet(12, 0.012, random);
  return {{"terrain", datasets::terrain(1, 16, 7), 0.01},
          {"thin sheet", datasets::thin_sheet(1, 0.01, 10), 0.02},
          {"two sheets within the tolerance",
           reference::both(datasets::terrain(1, 12, 7), reference::moved(datasets::terrain(1, 12, 7), {0, 0, 0.004})),
           0.01},
          {"box", datasets::cube(1, 5), 0.05},
          {"large faces in a rough sheet", reference::both(reference::unit_square(2), rough), 0.02},
          {"hubs", gear(100), 0.02}};
}

/// The distance of the whole mesh after the collapse, in one piece.
bool whole_exceeds(DecimationFixture& fixture, const TriangleMesh& original, Region& region, Proposer& proposer,
                   Vec3 placement, double tolerance) {
  proposer.collapse(region, placement);
  const TriangleMesh mesh = fixture.result();
  undo_last(fixture.state, region);
  return check_tolerance(Bvh(original), Bvh(mesh), tolerance).verdict != Verdict::Within;
}

TEST(ExceedCheck, SaysWhatTheWholeMeshSays) {
  std::size_t exceeds = 0, holds = 0, holds_elsewhere = 0;
  for (const Case& shape : cases()) {
    DecimationFixture fixture(shape.mesh, shape.tolerance);
    DecimationState& state = fixture.state;
    ProofWorkers workers(state, 1);
    Proposer proposer(state);
    ChangeProver prover(state, workers, 0);
    ExceedCheck check(state);
    Split split = whole(state);
    Region& region = split.regions.front();
    proposer.enter(split, region);
    RegionCollapses::Limits limits{1, [](std::size_t) { return false; }, nullptr};
    limits.ends_at_refusal = [&] {
      const bool here = check.exceeds(region, proposer, shape.tolerance, {});
      const Corner edge = proposer.star().edge;
      const Vec3 start = state.mesh.position(state.mesh.start(edge)), end = state.mesh.position(state.mesh.end(edge));
      const auto holds_at = [&](Vec3 placement) {
        return !whole_exceeds(fixture, shape.mesh, region, proposer, placement, shape.tolerance);
      };
      const bool as_refused = holds_at(proposer.refused_placement());
      const bool elsewhere = holds_at(start) || holds_at(end) || holds_at(0.5 * (start + end));
      EXPECT_EQ(here, !as_refused && !elsewhere) << shape.name;
      (here ? exceeds : as_refused ? holds : holds_elsewhere) += 1;
      return false;
    };
    limits.made = [&](std::uint32_t kept) { check.note_change(kept); };
    RegionCollapses(state, split, region, proposer, &prover, std::move(limits)).collapse_all();
    EXPECT_LT(fixture.result().triangles.size(), shape.mesh.triangles.size()) << shape.name;
  }
  EXPECT_GT(exceeds, 20U);
  EXPECT_GT(holds, 3U);
  EXPECT_GT(holds_elsewhere, 3U);
}

}  // namespace exceed_check_test
}  // namespace meshbound
