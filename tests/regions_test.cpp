// SPDX-License-Identifier: GPL-3.0-or-later
// Large meshes are cut into regions that threads decimate side by side: the result is the same for any number of
// threads, holds its bound, and no seam is left; every kind of input and every way to end comes through.
#include "simplify/regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <thread>

#include "bvh/bvh_data.h"
#include "datasets/analytic_meshes.h"
#include "decimation_states.h"
#include "drivers.h"
#include "levels/level_run.h"
#include "meshbound/lod_chain.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/simplify.h"
#include "numeric/no_index.h"
#include "reference/small_meshes.h"
#include "simplify/change_prover.h"
#include "simplify/region_collapses.h"
#include "simplify_options.h"

namespace meshbound {
namespace regions_test {

SimplifyOptions within(double tolerance) {
  SimplifyOptions options = test::within(tolerance);
  options.threads = 2;
  return options;
}

TriangleMesh sphere() { return datasets::icosphere(1, 5); }      // 10,242 vertices: two regions
TriangleMesh terrain() { return datasets::terrain(1, 100, 3); }  // 10,201 vertices

void expect_within(const TriangleMesh& original, const SimplifiedLevel& level) {
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_EQ(check_tolerance(Bvh(original), Bvh(level.mesh), level.tolerance).verdict, Verdict::Within);
}

constexpr std::size_t min_vertices = 4000;

std::vector<std::size_t> sizes(const Split& split) {
  std::vector<std::size_t> sizes(split.regions.size(), 0);
  for (const std::uint32_t r : split.region_of) {
    if (r != no_index) ++sizes[r];
  }
  return sizes;
}

TEST(Split, CutsLargeMeshesIntoRegionsOfEqualSizeAndLeavesSmallOnesWhole) {
  const test::StateOf small(datasets::icosphere(1, 4));
  EXPECT_EQ(split(*small, 0, min_vertices).regions.size(), 1u);
  const test::StateOf large(datasets::icosphere(1, 6));
  const Split halved = split(*large, 0, min_vertices);
  ASSERT_GT(halved.regions.size(), 2u);
  const double even = static_cast<double>(large->mesh.vertex_count()) / static_cast<double>(halved.regions.size());
  for (const std::size_t vertices : sizes(halved)) EXPECT_NEAR(static_cast<double>(vertices), even, 4);
}

/// An edge at a seam of both splits would never be tried.
TEST(Split, CutsElsewhereWhereItIsShifted) {
  const test::StateOf state(datasets::icosphere(1, 6));
  const auto is_seam = [&](const Split& of, Corner c) {
    return of.region_of[state->mesh.start(c)] != of.region_of[state->mesh.end(c)];
  };
  for (int shift = 0; shift < shifts_of_split; ++shift) {
    const Split one = split(*state, shift, min_vertices);
    const Split other = split(*state, (shift + 1) % shifts_of_split, min_vertices);
    std::size_t at_a_seam_of_one = 0, at_seams_of_both = 0;
    for (Corner c = 0; c < 3 * state->mesh.face_count(); ++c) {
      at_a_seam_of_one += is_seam(one, c) ? 1 : 0;
      at_seams_of_both += is_seam(one, c) && is_seam(other, c) ? 1 : 0;
    }
    EXPECT_GT(at_a_seam_of_one, 0u);
    EXPECT_LT(20 * at_seams_of_both, at_a_seam_of_one);
  }
}

/// Each of two threads takes the next region once it has done one.
TEST(Split, KeepsTwoThreadsAtWork) {
  const test::StateOf state(datasets::icosphere(1, 6));
  for (const std::size_t regions : {2, 4, 8}) {
    for (int shift = 0; shift < shifts_of_split; ++shift) {
      const Split parts = split(*state, shift, state->mesh.vertex_count() / (2 * regions) + 1);
      EXPECT_GE(parts.regions.size(), regions / 2);
      std::array<std::size_t, 2> done{};  // by thread, vertices
      for (const std::size_t vertices : sizes(parts)) *std::ranges::min_element(done) += vertices;
      EXPECT_LE(9 * std::ranges::max(done), 5 * state->mesh.vertex_count()) << regions << ", " << shift;
    }
  }
}

TEST(Split, DependsOnTheMeshAlone) {
  const test::StateOf state(terrain());
  for (int shift = 0; shift < shifts_of_split; ++shift) {
    const Split one = split(*state, shift, 300), three = split(*state, shift, 300, 3);
    EXPECT_GT(one.regions.size(), 8u);
    EXPECT_EQ(one.region_of, three.region_of);
    EXPECT_EQ(one.region_of_face, three.region_of_face);
  }
}

/// Along its axis, where it is longest, a wall is one edge high: a cut across would leave no face in a region.
TEST(Split, CutsWhereItMeetsFewEdges) {
  constexpr std::uint32_t segments = 4000;
  TriangleMesh wall;
  for (std::uint32_t i = 0; i < segments; ++i) {
    const double angle = i * 6.28 / segments;
    const std::uint32_t low = 2 * i, next = 2 * ((i + 1) % segments);
    for (const double z : {0.0, 5.0}) wall.vertices.emplace_back(std::cos(angle), std::sin(angle), z);
    wall.triangles.push_back({low, next, next + 1});
    wall.triangles.push_back({low, next + 1, low + 1});
  }
  const test::StateOf state(wall);
  const Split parts = split(*state, 0, 500);
  std::size_t between = 0;
  for (std::uint32_t f = 0; f < state->mesh.face_count(); ++f) between += parts.region_of_face[f] == no_index ? 1 : 0;
  EXPECT_GE(parts.regions.size(), 8u);
  EXPECT_LT(100 * between, state->mesh.face_count());
}

/// A ruled hyperboloid: two rings, and triangles that lead from one to the other across the middle.
TriangleMesh hyperboloid(std::uint32_t segments) {
  TriangleMesh mesh;
  for (const double z : {-1.0, 1.0}) {
    for (std::uint32_t i = 0; i < segments; ++i) {
      const double angle = i * 2 * std::numbers::pi / segments + 1.1 * z;
      mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), z);
    }
  }
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::uint32_t next = (i + 1) % segments;
    mesh.triangles.push_back({i, next, next + segments});
    mesh.triangles.push_back({i, next + segments, i + segments});
  }
  return mesh;
}

/// Each cut would meet all faces, and each collapse would be proven alone.
TEST(Split, LeavesMeshesWholeWhoseFacesSpanThem) {
  const test::StateOf state(hyperboloid(5000));
  EXPECT_EQ(split(*state, 0, min_vertices / 4).regions.size(), 1u);
  EXPECT_EQ(split(*state, 1, min_vertices / 4).regions.size(), 1u);
}

/// A thread asks for faces of other regions, whose corners may change meanwhile.
TEST(Split, KnowsTheRegionOfAFaceWithoutItsCorners) {
  const test::StateOf state(datasets::icosphere(1, 6));
  for (int shift = 0; shift < shifts_of_split; ++shift) {
    const Split cut = split(*state, shift, min_vertices);
    std::size_t between = 0;
    for (std::uint32_t f = 0; f < state->mesh.face_count(); ++f) {
      const auto [a, b, c] = state->mesh.corners(f);
      std::size_t owners = 0;
      for (const Region& region : cut.regions) {
        const bool owns_corners = cut.owns(region.id, a) && cut.owns(region.id, b) && cut.owns(region.id, c);
        EXPECT_EQ(cut.owns_face(region.id, f), owns_corners);
        owners += owns_corners ? 1 : 0;
      }
      between += owners == 0 ? 1 : 0;
    }
    EXPECT_GT(between, 0u);
  }
  EXPECT_TRUE(whole(*state).owns_face(0, 0));
}

TEST(Split, NumbersOfChangesOfRegionsNeverMeet) {
  const test::StateOf state(datasets::icosphere(1, 6));
  const Split parts = split(*state, 0, min_vertices);
  std::vector<std::uint32_t> faces(parts.regions.size(), 0);
  for (std::uint32_t f = 0; f < state->mesh.face_count(); ++f) ++faces[parts.region_of[state->mesh.vertex(3 * f)]];
  for (std::size_t r = 0; r + 1 < parts.regions.size(); ++r)
    EXPECT_LE(parts.regions[r].log.before + faces[r], parts.regions[r + 1].log.before);
}

/// What a change may help is open at once within the region, and across a seam once the regions are merged.
TEST(Merge, OpensRefusedEdgesAcrossTheSeamsWhereSomethingHasChanged) {
  test::StateOf state(datasets::icosphere(1, 6));
  const ArrayMesh& mesh = state->mesh;
  Split parts = split(*state, 0, min_vertices);
  const auto edges_at = [&](std::uint32_t vertex, bool across) {
    std::vector<Corner> edges;
    mesh.for_each_edge(vertex, [&](Corner e) {
      if ((parts.region_of[mesh.start(e)] != parts.region_of[mesh.end(e)]) == across) edges.push_back(e);
    });
    return edges;
  };
  std::uint32_t vertex = 0;
  while (edges_at(vertex, true).empty() || edges_at(vertex, false).size() < 2) ++vertex;
  const std::vector<Corner> inside = edges_at(vertex, false), across = edges_at(vertex, true);
  const auto is_open = [&](Corner e) { return state->is_open(e); };
  state->refuse_all();
  state->refuse(inside.front(), 2 * far_beyond);
  state->refuse(across.front(), 2 * far_beyond);
  reopen_around(*state, parts, parts.regions[parts.region_of[vertex]], vertex);
  EXPECT_FALSE(is_open(inside.front()));
  EXPECT_TRUE(std::all_of(inside.begin() + 1, inside.end(), is_open));
  EXPECT_TRUE(std::none_of(across.begin(), across.end(), is_open));
  merge(*state, std::move(parts));
  EXPECT_FALSE(is_open(inside.front()));
  EXPECT_FALSE(is_open(across.front()));
  EXPECT_TRUE(std::all_of(across.begin() + 1, across.end(), is_open));
  Split all = whole(*state);
  state->refuse(inside.back(), 0);
  reopen_around(*state, all, all.regions.front(), vertex);
  EXPECT_TRUE(is_open(inside.back()));
}

TriangleMesh double_cone(std::uint32_t corners) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 0);
    const std::uint32_t j = (i + 1) % corners;
    mesh.triangles.push_back({i, j, corners});
    mesh.triangles.push_back({j, i, corners + 1});
  }
  mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 1}, {0, 0, -1}});
  return mesh;
}

/// Else each collapse at the rim of a cap opens all edges of its hub, and the time grows with the square of its corners
/// (52 s for two caps of 100,000).
TEST(Merge, LeavesTheEdgesOfAHubRefusedUntilItHasLostFaces) {
  constexpr auto corners = static_cast<std::uint32_t>(max_faces_of_star + 3);  // two faces of an edge go
  test::StateOf state(double_cone(corners));
  std::uint32_t hub = 0;
  while (state->mesh.position(hub).z != 1) ++hub;
  const auto open_edges = [&] {
    std::size_t open = 0;
    state->mesh.for_each_edge(hub, [&](Corner e) { open += state->is_open(e) ? 1 : 0; });
    return open;
  };
  const auto reopen = [&](bool in_region) {
    Split all = whole(*state);
    if (in_region)
      reopen_around(*state, all, all.regions.front(), hub);
    else
      state->reopen_at(hub);
    return open_edges();
  };
  for (const bool in_region : {true, false}) {
    state->refuse_all();
    EXPECT_EQ(reopen(in_region), 0u);
  }
  Corner rim = 0;
  while (state->mesh.apex(rim) != hub) ++rim;
  state->mesh.collapse(rim);
  EXPECT_EQ(reopen(true), corners - 1);
  state->refuse_all();
  EXPECT_EQ(reopen(false), corners - 1);
}

TEST(Merge, CountsTheFacesThatAreGoneAndKeepsTheLogsInTheirOrder) {
  test::StateOf state(datasets::icosphere(1, 6));
  Split parts = split(*state, 0, min_vertices);
  const std::size_t faces = state->faces;
  for (Region& region : parts.regions) {
    region.removed_faces = 2 + region.id;
    if (region.id != 1) region.log.edits.emplace_back();
  }
  std::size_t removed = 0;
  for (const Region& region : parts.regions) removed += region.removed_faces;
  const std::size_t regions = parts.regions.size();
  merge(*state, std::move(parts));
  EXPECT_EQ(state->faces, faces - removed);
  ASSERT_EQ(state->logs.size(), regions - 1) << "that of a region without a change is no use";
  for (std::size_t i = 1; i < state->logs.size(); ++i)
    EXPECT_LT(state->logs[i - 1].last_number(), state->logs[i].last_number());
}

/// No change of a face can be proven here that covers an original together with one of another region.
TEST(RegionCollapses, LeaveEdgesForLaterWhoseFacesShareCoversWithOtherRegions) {
  test::StateOf state(reference::unit_square(50));
  state->grow_tolerance(0.01);
  state->set_samples(0.01);
  Split parts = split(*state, 0, 1000);
  ASSERT_EQ(parts.regions.size(), 2u);
  ProofWorkers workers(*state, 1);
  Proposer proposer(*state);
  ChangeProver prover(*state, workers, 0);
  RegionCollapses collapses(*state, parts, parts.regions[0], proposer, &prover,
                            {1, [](std::size_t) { return false; }, nullptr});
  const auto& open = collapses.open_edges();
  const auto edge = std::find_if(open.begin(), open.end(), [&](Corner e) { return proposer.is_inside(e); });
  ASSERT_NE(edge, open.end());
  std::uint32_t beyond = 0;
  while (!parts.owns_face(1, beyond)) ++beyond;
  const std::uint32_t face = *edge / 3, original = state->source_triangle[face];
  state->cover.assign(original, std::vector<std::uint32_t>{face, beyond});
  EXPECT_FALSE(collapses.collapse(*edge));
  EXPECT_TRUE(collapses.is_open(*edge));
  EXPECT_EQ(proposer.counts.tried, 0u);
  state->cover.assign(original, {&face, 1});
  EXPECT_TRUE(collapses.collapse(*edge));
  EXPECT_EQ(proposer.counts.tried, 1u);
}

class Regions : public testing::TestWithParam<test::NamedDriver> {
 protected:
  static SimplifyOptions options(double tolerance) {
    SimplifyOptions options = within(tolerance);
    options.driver = GetParam().driver;
    return options;
  }
};

TEST_P(Regions, TheResultIsTheSameForAnyNumberOfThreads) {
  const TriangleMesh original = datasets::icosphere(1, 6);
  std::vector<TriangleMesh> results;
  for (const int threads : {1, 2, 5}) {
    SimplifyOptions with = options(0.01);
    with.threads = threads;
    results.push_back(simplify_with_bound(original, with).last().mesh);
  }
  for (const TriangleMesh& result : results) {
    EXPECT_EQ(result.vertices, results.front().vertices);
    EXPECT_EQ(result.triangles, results.front().triangles);
  }
}

/// Were seams left as they are, hundreds of faces would stay at each: on the sphere of 81,920 at least 8 times 100.
TEST_P(Regions, LeaveNoSeams) {
  EXPECT_LT(simplify_with_bound(datasets::icosphere(1, 6), options(0.01)).last().faces(), 450u);
  EXPECT_EQ(simplify_with_bound(datasets::cube(1, 60), options(0.01)).last().faces(), 12u);
}

/// A thin face at an edge of the outline that folds back onto a flat face would leave vertices which nothing removes.
TEST_P(Regions, LeaveNoFlaps) {
  for (const std::uint32_t cells : {55, 65})
    for (const double tolerance : {0.0017, 0.00035})
      EXPECT_EQ(simplify_with_bound(datasets::cube(1, cells), options(tolerance)).last().faces(), 12u)
          << cells << ", " << tolerance;
}

TEST_P(Regions, KeepTheTopologyOfTheOriginal) {
  for (const TriangleMesh& original : {sphere(), terrain(), datasets::torus(1, 0.3, 180, 60)}) {
    const TriangleMesh result = simplify_with_bound(original, options(0.005)).last().mesh;
    EXPECT_EQ(summarise(result).closed, summarise(original).closed);
    const auto euler = [](const TriangleMesh& mesh) {
      std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
      for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax({t[k], t[(k + 1) % 3]}));
      }
      return static_cast<std::ptrdiff_t>(mesh.vertices.size() + mesh.triangles.size()) -
             static_cast<std::ptrdiff_t>(edges.size());
    };
    EXPECT_EQ(euler(result), euler(original));
  }
}

TEST_P(Regions, TheReportAddsUp) {
  const TriangleMesh original = sphere();
  const SimplifyResult result = simplify_with_bound(original, options(0.01));
  // A closed surface of genus 0 has 2 vertices less than half its faces, and loses one by each collapse.
  EXPECT_EQ(result.last().collapses_performed, (original.triangles.size() - result.last().faces()) / 2);
  EXPECT_GT(result.last().collapses_refused, 0u);
  EXPECT_EQ(result.counts.proven_together + result.counts.proven_alone, result.last().collapses_performed);
  EXPECT_EQ(result.last().ended_by, EndedBy::NothingFits);
}

TEST_P(Regions, TakeSoupsThatAreNoManifolds) {
  TriangleMesh soup = reference::both(sphere(), reference::moved(sphere(), {0.5, 0, 0}));
  for (std::uint32_t t = 0; t < 20000; t += 7) std::swap(soup.triangles[t][0], soup.triangles[t][1]);
  const auto second = static_cast<std::uint32_t>(soup.vertices.size() / 2);
  for (std::uint32_t t = 0; t < 20000; t += 100) {
    soup.triangles.push_back(soup.triangles[t]);
    const std::uint32_t a = soup.triangles[t][0], b = soup.triangles[t][1];
    soup.triangles.push_back({a, b, second + soup.triangles[t][2]});  // a third face at an edge
    soup.triangles.push_back({a, a, b});
  }
  const SimplifyResult result = simplify_with_bound(soup, options(0.01));
  expect_within(soup, result.last());
  EXPECT_TRUE(result.split);
  EXPECT_EQ(result.dropped_triangles + result.kept_triangles, 400u);
  EXPECT_LT(result.last().faces(), soup.triangles.size() / 10);
}

TEST_P(Regions, KeepTrianglesThatTheMeshHasNoFaceNear) {
  TriangleMesh soup = sphere();
  const auto far = static_cast<std::uint32_t>(soup.vertices.size());
  soup.vertices.emplace_back(3, 0, 0);
  soup.triangles.push_back({0, 0, far});
  const SimplifyResult result = simplify_with_bound(soup, options(0.01));
  expect_within(soup, result.last());
  EXPECT_EQ(result.kept_triangles, 1u);
  EXPECT_LT(result.last().faces(), soup.triangles.size() / 10);
}

TEST_P(Regions, KeepLocksAndBordersOnBothSidesOfASeam) {
  const TriangleMesh original = terrain();
  SimplifyOptions with = options(0.01);
  with.locked_vertices.assign(original.vertices.size(), false);
  for (std::size_t v = 0; v < original.vertices.size(); v += 50) with.locked_vertices[v] = true;
  with.preserve_boundary = true;
  const SimplifyResult result = simplify_with_bound(original, with);
  expect_within(original, result.last());
  EXPECT_LT(result.last().faces(), original.triangles.size() / 2);
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  const std::set<Eigen::Vector3d, decltype(less)> left(result.last().mesh.vertices.begin(),
                                                       result.last().mesh.vertices.end(), less);
  for (std::size_t v = 0; v < original.vertices.size(); ++v) {
    const auto is_end = [](double x) { return x == 0 || x == 1; };
    const bool on_border = is_end(original.vertices[v].x()) || is_end(original.vertices[v].y());
    EXPECT_TRUE(left.count(original.vertices[v]) > 0 || !(with.locked_vertices[v] || on_border))
        << original.vertices[v].transpose() << " locked " << with.locked_vertices[v];
  }
}

TEST_P(Regions, EveryWayToRunEndsWithAProvenMesh) {
  const TriangleMesh original = terrain();
  SimplifyOptions with = options(0.01);
  with.levels = {0.001, 0.004};
  const SimplifyResult levels = simplify_with_bound(original, with);
  ASSERT_EQ(levels.levels.size(), 3u);
  for (const SimplifiedLevel& level : levels.levels) expect_within(original, level);
  EXPECT_LT(levels.levels[2].faces(), levels.levels[1].faces());
  EXPECT_LT(levels.levels[1].faces(), levels.levels[0].faces());
  LodOptions chained;
  chained.driver = GetParam().driver;
  LodChain chain(original, chained);
  for (const double tolerance : {1e-300, 0.002, 0.01}) expect_within(original, chain.next(tolerance));
}

TEST_P(Regions, ATimeLimitOrACancellationLeavesAProvenMesh) {
  // Small: a run that is cancelled proves what it has in 0.3 seconds or undoes it, also on a machine in heavy use.
  const TriangleMesh original = datasets::icosphere(1, 4);
  SimplifyOptions with = options(0.01);
  with.time_limit = 0;
  const SimplifyResult at_once = simplify_with_bound(original, with);
  expect_within(original, at_once.last());
  EXPECT_EQ(at_once.last().ended_by, EndedBy::TimeLimit);
  EXPECT_EQ(at_once.last().faces(), original.triangles.size());
  // In the middle: told so by the progress of the run itself.
  std::atomic<bool> cancel = false;
  with = options(0.01);
  with.threads = 1;
  with.cancel = &cancel;
  with.progress = [&](double fraction) { cancel = cancel || fraction > 0.3; };
  const SimplifiedLevel level = simplify_with_bound(original, with).last();
  EXPECT_EQ(level.ended_by, EndedBy::Cancelled);
  EXPECT_LT(level.faces(), original.triangles.size() * 9 / 10);
  EXPECT_GT(level.faces(), original.triangles.size() / 10);
  EXPECT_EQ(check_tolerance(Bvh(original), Bvh(level.mesh), 0.01).verdict, Verdict::Within);
}

/// The trees of a large mesh take seconds: trees are numbered, so the number of those that were built is known.
TEST_P(Regions, WithoutTimeNoTreeIsBuilt) {
  const TriangleMesh original = sphere(), small = datasets::icosphere(1, 0);
  SimplifyOptions with = options(0.01);
  with.time_limit = 0;
  const std::uint64_t before = Bvh(small).data().serial;
  EXPECT_EQ(decimate_levels(original, with).last().ended_by, EndedBy::TimeLimit);
  EXPECT_EQ(Bvh(small).data().serial, before + 1);
}

TEST_P(Regions, OneThatFailsEndsTheOthers) {
  SimplifyOptions with = options(0.01);
  with.threads = 1;
  int calls = 0;
  with.progress = [&](double) {
    ++calls;
    throw std::runtime_error("enough");
  };
  EXPECT_THROW((void)simplify_with_bound(datasets::icosphere(1, 6), with), std::runtime_error);
  EXPECT_EQ(calls, 1);
}

TEST_P(Regions, ShowTheirProgressInTheCallingThreadAndPassOnWhatItThrows) {
  SimplifyOptions with = options(0.01);
  double last = -1;
  const std::thread::id caller = std::this_thread::get_id();
  bool elsewhere = false;
  with.progress = [&](double fraction) {
    elsewhere = elsewhere || std::this_thread::get_id() != caller;
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    last = fraction;
  };
  (void)simplify_with_bound(sphere(), with);
  EXPECT_FALSE(elsewhere);
  EXPECT_EQ(last, 1);
  with.progress = [](double) { throw std::runtime_error("enough"); };
  EXPECT_THROW((void)simplify_with_bound(sphere(), with), std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(With, Regions, testing::ValuesIn(test::drivers()),
                         [](const auto& driver) { return driver.param.name; });

}  // namespace regions_test
}  // namespace meshbound
