// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "numeric/no_index.h"

namespace meshbound {

/// Triangles, each corner so many numbers, found by these, in whatever order the corners come. -0 and 0 are equal.
/// Immutable, safe to share.
template <std::size_t Numbers>
class SameTriangles {
 public:
  using Corners = std::array<std::array<double, Numbers>, 3>;

  /// O(n).
  explicit SameTriangles(std::vector<Corners> triangles)
      : triangles_(std::move(triangles)),
        shift_(63 - static_cast<int>(std::bit_width(triangles_.size()))),
        first_(std::size_t{1} << (64 - shift_), no_index),
        next_(triangles_.size()) {
    keys_.reserve(triangles_.size());
    for (Corners& corners : triangles_) {
      std::sort(corners.begin(), corners.end());
      keys_.push_back(key(corners));
    }
    for (auto i = static_cast<std::uint32_t>(triangles_.size()); i-- > 0;)
      next_[i] = std::exchange(first_[keys_[i] >> shift_], i);
  }

  /// The smallest index of such a triangle; `no_index` if there is none. Expected O(1).
  [[nodiscard]] std::uint32_t find(Corners corners) const {
    std::sort(corners.begin(), corners.end());
    const std::uint64_t wanted = key(corners);
    for (std::uint32_t i = first_[wanted >> shift_]; i != no_index; i = next_[i])
      if (keys_[i] == wanted && triangles_[i] == corners) return i;
    return no_index;
  }
  [[nodiscard]] bool has(const Corners& corners) const { return find(corners) != no_index; }

 private:
  /// Equal for equal triangles, rarely for others: a sum over the corners, as sorting may leave -0 and 0 either way.
  static std::uint64_t key(const Corners& corners) {
    constexpr std::uint64_t odd = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
    std::uint64_t sum = 0;
    for (const auto& corner : corners) {
      std::uint64_t of_corner = 0;
      for (const double x : corner) of_corner = (std::rotl(of_corner, 5) ^ std::bit_cast<std::uint64_t>(x + 0.0)) * odd;
      sum += of_corner ^ (of_corner >> 32);
    }
    return sum * odd;
  }

  std::vector<Corners> triangles_;    ///< the corners of each ascend
  int shift_;                         ///< the highest bits of a key are the number of its list
  std::vector<std::uint32_t> first_;  ///< by list
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> next_;  ///< by triangle: the next one of its list, with a larger index
};

}  // namespace meshbound
