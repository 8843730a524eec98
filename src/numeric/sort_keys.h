// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace meshbound {

/// Sorts some hundred keys that differ in their highest bits, such as places along a space-filling curve: first by
/// these bits into as many parts as a grid of three bits to an axis has cells, then each part. O(n log n), and faster
/// than one `std::sort` where parts are small. What `scratch` has does not matter; it keeps its memory.
inline void sort_keys(std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>& scratch) {
  constexpr int part_bits = 9;
  const auto part = [](std::uint64_t key) { return static_cast<std::size_t>(key >> (64 - part_bits)); };
  std::array<std::uint32_t, std::size_t{1} << part_bits> end{};  // the begin of each part until its keys are put in
  for (const std::uint64_t key : keys) ++end[part(key)];
  std::uint32_t sum = 0;
  for (std::uint32_t& count : end) sum += std::exchange(count, sum);
  scratch.resize(keys.size());
  for (const std::uint64_t key : keys) scratch[end[part(key)]++] = key;
  keys.swap(scratch);
  for (auto first = keys.begin(); first != keys.end();) {
    const auto last = keys.begin() + end[part(*first)];
    std::sort(first, last);
    first = last;
  }
}

}  // namespace meshbound
