// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace meshbound {

/// Lists of numbers, one after the other in one array: `[k]` is list k.
struct NumberLists {
  std::vector<std::uint32_t> begin{0};  ///< by list: where it starts in `numbers`; one more for the end
  std::vector<std::uint32_t> numbers;

  [[nodiscard]] std::size_t size() const { return begin.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t k) const {
    return std::span(numbers).subspan(begin[k], begin[k + 1] - begin[k]);
  }
  /// Ends the current list: the numbers appended since the last call form it.
  void end_list() { begin.push_back(static_cast<std::uint32_t>(numbers.size())); }
};

}  // namespace meshbound
