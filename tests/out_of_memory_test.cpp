// SPDX-License-Identifier: MIT
// Memory that runs out in any thread of a team reaches the caller as std::bad_alloc: nothing hangs, nothing ends the
// process, and afterwards the library works as before.
#include <gtest/gtest.h>

#include <new>

#include "failing_new.h"
#include "meshbound/distance.h"
#include "reference/small_meshes.h"

namespace {

using namespace meshbound;
using namespace meshbound::reference;

Bounds distance_between(const TriangleMesh& a, const TriangleMesh& b, const TriangleMesh& moved_b, int threads) {
  auto [tree_a, tree_b] = build_trees(a, b, {threads});
  tree_b.refit(moved_b, {threads});
  DistanceOptions options;
  options.threads = threads;
  return hausdorff_distance(tree_a, tree_b, options).bounds;
}

TEST(OutOfMemory, InAnyThreadReachesTheCaller) {
  const TriangleMesh a = icosphere(5), b = random_soup(13, 5000, 0.3), moved_b = scaled(b, 0.75);
  const Bounds expected = distance_between(a, b, moved_b, 1);
  for (const int threads : {1, 3}) {
    int failures = 0;
    for (std::ptrdiff_t count = 0;; count += 1 + count / 8) {
      ASSERT_LT(count, 10000000) << "memory is never enough";
      try {
        allowed = count;
        const Bounds found = distance_between(a, b, moved_b, threads);
        allowed = unlimited;
        EXPECT_EQ(found.lower, expected.lower);
        EXPECT_EQ(found.upper, expected.upper);
        break;
      } catch (const std::bad_alloc&) {
        allowed = unlimited;
        ++failures;
      }
    }
    EXPECT_GT(failures, 20);
  }
}

}  // namespace
