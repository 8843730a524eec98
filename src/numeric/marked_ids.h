// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace meshbound {

/// A set of numbers that is emptied in O(1), in memory for as many as it has held at a time. Linear probing, at most
/// half full.
class MarkedIds {
 public:
  MarkedIds() : entries_(entries_at_first) {}

  void clear() {
    count_ = 0;
    if (++round_ != 0) return;
    std::fill(entries_.begin(), entries_.end(), 0);
    round_ = 1;
  }
  /// False when it was in already. Expected O(1).
  bool insert(std::uint32_t id) {
    std::uint64_t& entry = entries_[find(id)];
    if (entry == mark(id)) return false;
    entry = mark(id);
    if (2 * ++count_ > entries_.size()) grow();
    return true;
  }
  [[nodiscard]] bool contains(std::uint32_t id) const { return entries_[find(id)] == mark(id); }

 private:
  /// Entries at first, a power of two: enough for a hundred faces around a collapse.
  static constexpr std::size_t entries_at_first = 256;

  [[nodiscard]] std::uint64_t mark(std::uint32_t id) const { return std::uint64_t{round_} << 32 | id; }
  /// Where the number is, or else may be put: an entry of an earlier round is free.
  [[nodiscard]] std::size_t find(std::uint32_t id) const {
    constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15;  // its fraction, times 2^64: spreads numbers in a row
    const std::size_t last = entries_.size() - 1;
    std::size_t at = (id * golden_ratio >> 32) & last;
    while (entries_[at] >> 32 == round_ && entries_[at] != mark(id)) at = (at + 1) & last;
    return at;
  }
  void grow() {
    std::vector<std::uint64_t> before(2 * entries_.size());
    std::swap(before, entries_);
    for (const std::uint64_t entry : before)
      if (entry >> 32 == round_) entries_[find(static_cast<std::uint32_t>(entry))] = entry;
  }

  std::vector<std::uint64_t> entries_;  ///< the round of a number, and the number
  std::uint32_t round_ = 1;
  std::size_t count_ = 0;
};

}  // namespace meshbound
