// SPDX-License-Identifier: MIT
// Changes that are undone, and what is known of the others.
#include "simplify/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "decimation_states.h"
#include "geometry/boxes.h"
#include "simplify/propose.h"
#include "simplify/region_collapses.h"
#include "simplify/regions.h"

namespace meshbound {
namespace repair_test {

/// Every change gives back the lines that it has found, not those of another one.
TEST(Repair, GivesTheLinesBackThatEachChangeHasFound) {
  test::StateOf state(datasets::terrain(1, 20, 3));
  state->lines = FeatureLines(state->mesh, std::vector<std::uint8_t>(3 * state->mesh.face_count(), 0));  // the border
  state->grow_tolerance(0.05);
  state->set_samples(0.05);
  const auto lines = [&] {
    std::vector<std::uint32_t> all;
    for (std::uint32_t v = 0; v < state->mesh.vertex_count(); ++v)
      all.push_back(state->mesh.is_vertex(v) ? state->lines.at(v) : 0);
    for (Corner c = 0; c < 3 * state->mesh.face_count(); ++c)
      all.push_back(!state->mesh.is_removed(c / 3) && state->lines.is_line(state->mesh, c) ? 1 : 0);
    return all;
  };
  const std::vector<std::uint32_t> before = lines();
  const std::size_t faces = state->faces;
  Proposer proposer(*state);
  Split split = whole(*state);
  RegionCollapses(*state, split, split.regions.front(), proposer, nullptr,
                  {1, [](std::size_t) { return false; }, nullptr})
      .collapse_all();
  merge(*state, std::move(split));
  EXPECT_LT(state->faces, faces / 4);
  EXPECT_NE(lines(), before);
  undo_all(*state);
  EXPECT_EQ(state->faces, faces);
  EXPECT_EQ(lines(), before);
}

TEST(EditLog, KeepsTheTexturesOfEachChangeWhenItIsAppended) {
  const Eigen::Vector2d corner(0.5, 0.25);
  const CornerCoordinates somewhere = {corner, corner, corner};
  const auto log_of = [&](std::vector<std::vector<std::uint32_t>> faces_of_edits) {
    EditLog log;
    for (const auto& faces : faces_of_edits) {
      log.edits.emplace_back();
      for (const std::uint32_t f : faces) log.textures.push_back({f, somewhere});
      log.textures_end.push_back(log.textures.size());
    }
    return log;
  };
  EditLog log = log_of({{1, 2}, {}, {3}});
  log.append(log_of({{4}, {5, 6, 7}}));
  const std::vector<std::vector<std::uint32_t>> expected = {{1, 2}, {}, {3}, {4}, {5, 6, 7}};
  ASSERT_EQ(log.edits.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    std::vector<std::uint32_t> faces;
    for (const EditLog::FaceTexture& before : log.textures_of(k)) faces.push_back(before.face);
    EXPECT_EQ(faces, expected[k]) << k;
  }
}

/// Collapses of a mesh, and by number the faces that each has altered or removed.
struct Collapsed {
  explicit Collapsed(const TriangleMesh& original) : state(original) {
    state->grow_tolerance(0.05);
    state->set_samples(0.05);
    Proposer proposer(*state);
    Split split = whole(*state);
    Region& region = split.regions.front();
    proposer.enter(split, region);
    std::vector<Corner> edges;
    for (Corner c = 0; c < 3 * state->mesh.face_count(); ++c) edges.push_back(c);
    std::shuffle(edges.begin(), edges.end(), std::mt19937(3));
    for (const Corner edge : edges) {
      if (state->mesh.is_removed(edge / 3)) continue;
      const std::optional<Vec3> point = proposer.placement(edge, 1, std::nullopt);
      if (!point) continue;
      proposer.collapse(region, *point);
      proposer.make_final(region);
      const auto faces = proposer.changed_faces();
      faces_of[region.log.last_number()] = {faces.begin(), faces.end()};
    }
    merge(*state, std::move(split));
  }
  /// By face: the last of the changes that are left.
  [[nodiscard]] std::map<std::uint32_t, std::uint32_t> last_changes() const {
    std::map<std::uint32_t, std::uint32_t> last;
    for (const auto& [number, faces] : faces_of)
      for (const std::uint32_t f : faces) last[f] = number;
    return last;
  }
  /// Removes a change, and those that have touched a face of one of them later. Returns the faces of all.
  std::set<std::uint32_t> remove(std::uint32_t first) {
    std::set<std::uint32_t> gone;
    for (auto change = faces_of.find(first); change != faces_of.end();) {
      const bool is_later = std::ranges::any_of(change->second, [&](std::uint32_t f) { return gone.contains(f); });
      if (change->first != first && !is_later) {
        ++change;
        continue;
      }
      gone.insert(change->second.begin(), change->second.end());
      change = faces_of.erase(change);
    }
    return gone;
  }
  void expect_known() const {
    auto last = last_changes();
    for (std::uint32_t f = 0; f < state->mesh.face_count(); ++f) {
      ASSERT_EQ(state->last_changes.of_face(state->mesh, f), last[f]) << "face " << f;
      ASSERT_EQ(state->is_unproven(f), last[f] != 0) << "face " << f;
    }
  }
  /// Samples in the lists of faces, each once; only those that others stand for are in none.
  [[nodiscard]] std::set<std::uint32_t> listed_samples() const {
    std::set<std::uint32_t> listed;
    for (std::uint32_t f = 0; f < state->mesh.face_count(); ++f) {
      for (std::uint32_t s = state->samples.first(f); s != no_index; s = state->samples.following(s)) {
        EXPECT_FALSE(state->mesh.is_removed(f));
        EXPECT_EQ(state->samples.face_of(s), f);
        EXPECT_TRUE(listed.insert(s).second) << "sample " << s;
      }
    }
    return listed;
  }
  test::StateOf state;
  std::map<std::uint32_t, std::vector<std::uint32_t>> faces_of;
};

/// The last changes of vertices tell those of all faces, removed ones too; what has touched the faces of a change later
/// is undone with it, and nothing else.
TEST(Repair, UndoesAChangeWithThoseThatHaveTouchedItsFacesLater) {
  for (const TriangleMesh& original : {datasets::icosphere(1, 4), datasets::terrain(1, 20, 3)}) {
    Collapsed it(original);
    it.expect_known();
    const std::size_t faces = it.state->mesh.face_count(), collapses = it.faces_of.size();
    const std::size_t samples = it.listed_samples().size();
    std::mt19937 random(5);
    std::size_t rounds = 0;
    for (; !it.faces_of.empty(); ++rounds) {
      auto last = it.last_changes();
      std::uint32_t face = 0;
      do face = static_cast<std::uint32_t>(random() % faces);
      while (last[face] == 0);
      const std::size_t before = it.faces_of.size();
      const std::set<std::uint32_t> changed = it.remove(last[face]);
      const Repair repaired = repair(*it.state, {{}, {face}});
      ASSERT_EQ(repaired.changes, before - it.faces_of.size());
      ASSERT_TRUE(std::ranges::equal(repaired.faces, changed));
      it.expect_known();
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_LT(rounds, collapses);
    EXPECT_EQ(it.state->faces, faces);
    const std::size_t left = it.listed_samples().size();
    EXPECT_LE(left, samples);
    EXPECT_GT(left, samples / 2) << "of many samples around a change, one may stand for two";
  }
}

/// Each sample comes to the nearest of the faces around the change that is undone, to single precision.
TEST(Repair, GivesSamplesToTheNearestFaces) {
  Collapsed it(datasets::terrain(1, 20, 3));
  DecimationState& state = *it.state;
  const std::vector<std::uint32_t> faces = it.faces_of.rbegin()->second;  // of the last change
  ASSERT_EQ(repair(state, {{}, {faces.front()}}).changes, 1U);
  std::size_t apart = 0;
  for (const std::uint32_t f : faces) {
    for (std::uint32_t s = state.samples.first(f); s != no_index; s = state.samples.following(s)) {
      const auto from = [&](std::uint32_t face) {
        return std::sqrt(squared_distance(state.mesh.triangle(face), state.samples.at(s)));
      };
      double least = HUGE_VAL;
      for (const std::uint32_t other : faces) least = std::min(least, from(other));
      EXPECT_NEAR(from(f), least, 1e-6);
      apart += least > 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(apart, faces.size());
}

}  // namespace repair_test
}  // namespace meshbound
