// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/position_table.h"

namespace meshbound {

/// Gives points with exactly equal coordinates (-0.0 equals 0.0) the same index, counted from 0 in the order of first
/// appearance. Expected O(1) a point. NaNs of the same bits are equal here.
class Welder {
 public:
  Welder();

  [[nodiscard]] std::uint32_t index_of(const Eigen::Vector3d& p);

  /// Number of different points so far.
  [[nodiscard]] std::size_t size() const { return keys_.size(); }

 private:
  void grow();
  [[nodiscard]] std::size_t slot_of(const PositionKey& key) const;

  std::vector<PositionKey> keys_;     ///< by index
  std::vector<std::uint32_t> slots_;  ///< open addressing; a power of two, at most half full
};

}  // namespace meshbound
