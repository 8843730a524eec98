// SPDX-License-Identifier: MIT
// Memory that threads use again and again, and that several things share: none of them sees what another has left.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "bvh/bvh_data.h"
#include "meshbound/bvh.h"
#include "meshbound/proximity.h"
#include "numeric/marked_ids.h"
#include "numeric/sort_keys.h"
#include "reference/small_meshes.h"
#include "simplify/cover/forward_cover.h"
#include "simplify/mesh/edge_notes.h"
#include "simplify/mesh/edge_queue.h"
#include "spatially_ordered.h"

namespace meshbound {
namespace scratch_memory_test {

/// Keys that differ in their highest bits, in their lowest ones only, or not at all, and none.
TEST(SortKeys, SortsAsTheStandardLibraryDoes) {
  std::mt19937_64 random(6);
  std::vector<std::uint64_t> scratch{3, 1, 2};
  for (const std::size_t count : {0U, 1U, 2U, 97U, 3000U}) {
    for (const int shift : {0, 20, 55, 63}) {
      std::vector<std::uint64_t> keys(count);
      for (std::uint64_t& key : keys) key = random() >> shift;
      std::vector<std::uint64_t> expected = keys;
      std::sort(expected.begin(), expected.end());
      sort_keys(keys, scratch);
      EXPECT_EQ(keys, expected) << count << " keys, shifted by " << shift;
    }
  }
}

/// Few numbers and many, next to each other and far apart: multiples of a power of two would share their low bits.
TEST(MarkedIds, AreASetThatIsEmptiedAgainAndAgain) {
  std::mt19937 random(5);
  MarkedIds marked;
  for (const std::uint32_t step : {1U, 256U, 65536U, 0x9e3779b9U}) {
    for (int round = 0; round < 40; ++round) {
      marked.clear();
      std::set<std::uint32_t> expected;
      const auto numbers = static_cast<std::uint32_t>(1 + random() % 1000);
      for (std::uint32_t i = 0; i < numbers; ++i) {
        const std::uint32_t id = step * static_cast<std::uint32_t>(random() % numbers);
        ASSERT_EQ(marked.contains(id), expected.contains(id));
        ASSERT_EQ(marked.insert(id), expected.insert(id).second);
        ASSERT_TRUE(marked.contains(id));
      }
      for (std::uint32_t i = 0; i < numbers; ++i)
        ASSERT_EQ(marked.contains(step * i), expected.contains(step * i)) << step << " " << i;
    }
  }
}

/// Two vertices whose numbers differ by a power of two share a place in the cache.
TEST(ForwardCover, KeepsVerticesApartThatShareAPlace) {
  constexpr std::uint32_t vertices = 1 << 14;
  std::vector<Vec3> points;
  for (std::uint32_t v = 0; v < vertices; ++v) points.push_back({1.0 * v, 0, 0});
  const std::vector<Triangle> none;
  ForwardCover cover(points, none);
  for (const std::uint32_t near : {0U, 5U}) {
    cover.begin(0.1);
    cover.add({Vec3{near - 0.05, -1, 0}, Vec3{near + 0.05, -1, 0}, Vec3{1.0 * near, 1, 0}}, 0);
    for (int turn = 0; turn < 2; ++turn) {
      EXPECT_EQ(cover.holding(near, 1), 1U);
      for (std::uint32_t step = 64; step < vertices; step *= 2) EXPECT_EQ(cover.holding(near + step, 1), 0U) << step;
    }
  }
}

/// As where an exception of the caller's ends the collapses of a chain that goes on later.
TEST(EdgeQueue, LeavesOpenWhatIsInItAtItsEnd) {
  EdgeNotes notes(9);
  notes.refuse(0, 2);
  {
    EdgeQueue queue(notes);
    for (Corner e = 1; e < 9; ++e) queue.put(e, 1);
    notes.refuse(queue.pop(), 3);
  }
  for (Corner e = 0; e < 9; ++e) EXPECT_FALSE(notes.is_queued(e)) << e;
  EXPECT_EQ(notes.deviation(0), 2);
  EXPECT_EQ(notes.deviation(1), 3);
  EXPECT_FALSE(notes.is_refused(2));
}

TEST(EdgeQueue, GivesTheCheapestFirstAndSharesItsNotesWithDeviations) {
  constexpr Corner edges = 300;
  EdgeNotes notes(edges);
  for (Corner e = 0; e < edges; e += 2) notes.refuse(e, 1 + static_cast<float>(e));
  std::mt19937 random(2);
  EdgeQueue queue(notes);
  std::map<Corner, float> expected;
  for (int step = 0; step < 5000; ++step) {
    const Corner e = 2 * static_cast<Corner>(random() % (edges / 2)) + 1;
    if (random() % 3 != 0) {
      const auto cost = static_cast<float>(random() % 50);
      queue.put(e, cost);
      expected[e] = cost;
    } else {
      queue.erase(e);
      expected.erase(e);
    }
    ASSERT_EQ(notes.is_queued(e), expected.contains(e));
    ASSERT_EQ(notes.deviation(e), 0);
  }
  ASSERT_GT(expected.size(), 50U);
  while (!queue.empty()) {
    const auto least =
        std::ranges::min_element(expected, {}, [](const auto& item) { return std::pair(item.second, item.first); });
    ASSERT_EQ(queue.pop(), least->first);
    notes.refuse(least->first, 7);
    expected.erase(least);
  }
  EXPECT_TRUE(expected.empty());
  for (Corner e = 0; e < edges; e += 2) EXPECT_EQ(notes.deviation(e), 1 + static_cast<float>(e));
}

TEST(EdgeNotes, TakeWhateverADeviationIs) {
  EdgeNotes notes(1);
  const float infinite = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const float deviation : {1e-40F, 1.25F, infinite, 0.0F, -0.0F, nan, -nan}) {
    notes.refuse(0, deviation);
    EXPECT_EQ(notes.deviation(0), deviation > 0 ? deviation : std::numeric_limits<float>::denorm_min());
    EXPECT_FALSE(notes.is_queued(0));
    EXPECT_TRUE(notes.is_refused(0));
    notes.reopen(0);
    EXPECT_EQ(notes.is_refused(0), deviation == infinite);
    notes.open(0);
    EXPECT_FALSE(notes.is_refused(0));
  }
}

/// A mesh whose triangles have the order of the tree needs no table of them.
TEST(Proximity, IsTheSameWhateverTheOrderOfTheMesh) {
  TriangleMesh mesh = reference::icosphere(3);
  std::mt19937 random(1);
  std::ranges::shuffle(mesh.triangles, random);
  const SpatialOrder order = spatial_order(mesh, {});
  const Bvh tree(mesh), tree_in_order(test::spatially_ordered(mesh));
  ASSERT_TRUE(std::ranges::is_sorted(tree_in_order.data().triangle_of_slot));
  ASSERT_FALSE(std::ranges::is_sorted(tree.data().triangle_of_slot));
  Proximity proximity(tree), in_order(tree_in_order);
  std::uniform_real_distribution<double> unit(-1.2, 1.2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p(unit(random), unit(random), unit(random));
    const auto at = static_cast<std::uint32_t>(random() % order.triangle.size());
    std::uint32_t hint = order.triangle[at], hint_in_order = at;
    EXPECT_EQ(proximity.upper_distance(p, hint), in_order.upper_distance(p, hint_in_order));
    EXPECT_EQ(hint, order.triangle[hint_in_order]);
    EXPECT_EQ(proximity.nearby_triangle(p, order.triangle[at], HUGE_VAL),
              order.triangle[in_order.nearby_triangle(p, at, HUGE_VAL)]);
  }
}

}  // namespace scratch_memory_test
}  // namespace meshbound
