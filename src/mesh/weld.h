// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace meshbound {

/// Gives points with exactly equal coordinates (-0.0 equals 0.0) the same number, counted from 0 in the order of first
/// appearance. Expected O(1) a point. NaNs of the same bits are equal here.
class Welder {
 public:
  Welder();

  [[nodiscard]] std::uint32_t index_of(const Eigen::Vector3d& p);

  /// Number of different points so far.
  [[nodiscard]] std::size_t size() const { return keys_.size(); }

 private:
  using Key = std::array<std::uint64_t, 3>;

  void grow();
  [[nodiscard]] std::size_t slot_of(const Key& key) const;

  std::vector<Key> keys_;             // bits of the points, by number
  std::vector<std::uint32_t> slots_;  // open addressing; a power of two, at most half full
};

}  // namespace meshbound
