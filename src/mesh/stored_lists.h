// SPDX-License-Identifier: MIT
/// Lists of numbers that may be larger than memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/item_store.h"
#include "mesh/number_lists.h"

namespace meshbound {

/// As `NumberLists`: lists that are appended one after the other. Any number of threads may read while none appends.
class StoredLists {
 public:
  explicit StoredLists(const StoreSpace& space) : begin_(space), numbers_(space) { begin_.append(0); }

  [[nodiscard]] std::size_t size() const { return begin_.size() - 1; }
  void append(std::span<const std::uint32_t> list) {
    numbers_.append(list);
    begin_.append(numbers_.size());
  }
  [[nodiscard]] std::size_t size_of(std::size_t list) const {
    std::uint64_t ends[2];
    begin_.read(list, ends);
    return static_cast<std::size_t>(ends[1] - ends[0]);
  }
  [[nodiscard]] std::vector<std::uint32_t> operator[](std::size_t list) const { return range(list, list + 1).numbers; }
  /// The lists [first, end) in memory.
  [[nodiscard]] NumberLists range(std::size_t first, std::size_t end) const;
  /// The lists with these numbers, in this order, in memory. Numbers near one another are best given one after the
  /// other.
  [[nodiscard]] NumberLists at(std::span<const std::uint32_t> lists) const;

 private:
  ItemStore<std::uint64_t> begin_;  ///< by list: where it starts in `numbers_`; one more for the end
  ItemStore<std::uint32_t> numbers_;
};

/// Reads lists from one of them on, in order.
class ListReader {
 public:
  /// `lists` must outlive this and not change.
  explicit ListReader(const StoredLists& lists, std::size_t first = 0) : lists_(&lists), next_(first) {}
  /// The next list; it must be there. Holds until the next call.
  [[nodiscard]] std::span<const std::uint32_t> next() {
    if (read_ == block_.size()) {
      constexpr std::size_t block_size = 2048;
      const std::size_t end = std::min(lists_->size(), next_ + block_size);
      block_ = lists_->range(next_, end);
      next_ = end;
      read_ = 0;
    }
    return block_[read_++];
  }

 private:
  const StoredLists* lists_;
  std::size_t next_;      ///< first list that is not in the block
  NumberLists block_;     ///< some lists
  std::size_t read_ = 0;  ///< lists of it that have been given
};

/// Lists of which each grows by itself. Any number of threads may read while none appends.
class GrowingLists {
 public:
  GrowingLists(const StoreSpace& space, std::size_t lists) : lists_(lists), numbers_(space) {}

  [[nodiscard]] std::size_t size() const { return lists_.size(); }
  void append(std::size_t list, std::uint32_t number);
  [[nodiscard]] std::size_t size_of(std::size_t list) const {
    return lists_[list].extents.size() * extent_size + lists_[list].last.size();
  }
  [[nodiscard]] std::vector<std::uint32_t> operator[](std::size_t list) const;

 private:
  static constexpr std::size_t extent_size = 512;  ///< numbers that are written together
  struct List {
    std::vector<std::uint64_t> extents;  ///< where each begins in `numbers_`
    std::vector<std::uint32_t> last;     ///< the numbers after those of the extents
  };
  std::vector<List> lists_;
  ItemStore<std::uint32_t> numbers_;
};

}  // namespace meshbound
