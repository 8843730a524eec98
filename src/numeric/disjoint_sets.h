// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "numeric/numbers_below.h"

namespace meshbound {

/// Disjoint sets of the numbers 0, 1, ..., with path halving (Tarjan, van Leeuwen, "Worst-case analysis of set union
/// algorithms", J. ACM 31(2), 1984). A set is named by its smallest number, which keeps paths short where numbers that
/// are united lie near each other. Not thread-safe.
class DisjointSets {
 public:
  DisjointSets() = default;
  /// The numbers below `count`, each a set of its own.
  explicit DisjointSets(std::size_t count) : parent_(numbers_below(count)) {}

  void clear() { parent_.clear(); }
  /// Adds the next number as a set of its own.
  void add() { parent_.push_back(static_cast<std::uint32_t>(parent_.size())); }

  /// The smallest number in the set of i.
  [[nodiscard]] std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    parent_[i < j ? j : i] = i < j ? i : j;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace meshbound
