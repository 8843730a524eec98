// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace meshbound {

/// The numbers 0, 1, ... below `count`, which must be at most 2^32. O(count).
[[nodiscard]] inline std::vector<std::uint32_t> numbers_below(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

}  // namespace meshbound
