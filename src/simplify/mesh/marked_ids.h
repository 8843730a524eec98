// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meshbound {

/// Marks for sets of ids that are emptied in O(1).
class MarkedIds {
 public:
  /// For ids below `count`.
  explicit MarkedIds(std::size_t count) : stamps_(count, 0) {}
  void clear() { ++current_; }
  /// False when it was in already.
  bool insert(std::uint32_t id) {
    if (stamps_[id] == current_) return false;
    stamps_[id] = current_;
    return true;
  }
  [[nodiscard]] bool contains(std::uint32_t id) const { return stamps_[id] == current_; }

 private:
  std::vector<std::uint32_t> stamps_;
  std::uint32_t current_ = 1;
};

}  // namespace meshbound
