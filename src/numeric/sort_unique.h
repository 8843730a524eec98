// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace meshbound {

/// Sorts the numbers and leaves one of each. O(n log n), or O(n) where they are sorted.
inline void sort_unique(std::vector<std::uint32_t>& numbers) {
  if (!std::is_sorted(numbers.begin(), numbers.end())) std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace meshbound
