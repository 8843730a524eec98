// SPDX-License-Identifier: MIT
// Memory that runs out in any thread of a team reaches the caller as std::bad_alloc: nothing hangs, nothing ends the
// process, and afterwards the library works as before.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

#include "meshbound/distance.h"
#include "reference/small_meshes.h"

namespace {

constexpr std::ptrdiff_t unlimited = std::numeric_limits<std::ptrdiff_t>::max() / 2;

/// How many more allocations succeed, of all threads together.
std::atomic<std::ptrdiff_t> allowed{unlimited};

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (allowed-- <= 0) throw std::bad_alloc();
  const std::size_t rounded = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
  if (void* const storage = std::aligned_alloc(alignment, rounded)) return storage;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* storage) noexcept { std::free(storage); }
void operator delete(void* storage, std::size_t) noexcept { std::free(storage); }
void operator delete(void* storage, std::align_val_t) noexcept { std::free(storage); }
void operator delete(void* storage, std::size_t, std::align_val_t) noexcept { std::free(storage); }

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
