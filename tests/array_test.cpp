// SPDX-License-Identifier: MIT
// The memory of trees: arrays on large pages, arenas.
#include "bvh/array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace array_test {

using namespace meshbound;

TEST(Array, BeginsOnALargePageFromTheSizeOfOne) {
  constexpr std::size_t page = large_page / sizeof(double);
  for (const std::size_t n : {page - 1, page, page + 1, 3 * page + 5}) {
    // Several at once: by chance one may begin there anyway.
    std::vector<Array<double>> arrays(4, Array<double>(n));
    for (Array<double>& array : arrays) {
      EXPECT_TRUE(n < page || reinterpret_cast<std::uintptr_t>(array.data()) % large_page == 0) << n;
      for (std::size_t i = 0; i < n; ++i) array[i] = static_cast<double>(i);
      array.resize(2 * n);  // moves what is there
      EXPECT_EQ(array[n - 1], static_cast<double>(n - 1));
    }
  }
}

TEST(Arena, GivesOutApartWhatItHasAndNoMore) {
  Arena arena(large_page);
  Array<char> first = array_in<char>(arena), second = array_in<char>(arena), third = array_in<char>(arena);
  first.resize(100);
  second.resize(large_page / 2);
  EXPECT_TRUE(arena.owns(first.data()) && arena.owns(second.data()));
  EXPECT_GE(second.data() - first.data(), 100);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(second.data()) % 64, 0U);
  third.resize(large_page / 2);
  EXPECT_FALSE(arena.owns(third.data())) << "no room is left, so it comes from elsewhere";
  std::fill(third.begin(), third.end(), 'x');
  const Array<char> copy = first;
  EXPECT_NE(copy.data(), first.data());
}

TEST(Arena, TakesBackWhatItLent) {
  Arena arena(large_page);
  Array<char> kept = array_in<char>(arena), after = array_in<char>(arena);
  kept.resize(100);
  const char* lent = nullptr;
  {
    const Arena::Loan loan(arena);
    Array<char> array = array_in<char>(arena);
    array.resize(large_page / 2);
    lent = array.data();
    EXPECT_TRUE(arena.owns(lent));
  }
  after.resize(large_page / 2);
  EXPECT_EQ(after.data(), lent);
  EXPECT_GE(after.data() - kept.data(), 100);
}

}  // namespace array_test
