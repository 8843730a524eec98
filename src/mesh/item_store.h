// SPDX-License-Identifier: MIT
/// Arrays that may be larger than memory: appended once, then read from the start or by ranges.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "mesh/byte_store.h"

namespace meshbound {

/// Calls use(index, item) for items [first, end), which read(first, items) reads by blocks.
template <class T, class Read, class Use>
void for_each_in_blocks(std::size_t first, std::size_t end, const Read& read, const Use& use) {
  constexpr std::size_t block_size = 4096;
  std::vector<T> block(std::min(block_size, end - std::min(first, end)));
  for (; first < end; first += block.size()) {
    block.resize(std::min(block.size(), end - first));
    read(first, std::span<T>(block));
    for (std::size_t i = 0; i < block.size(); ++i) use(first + i, block[i]);
  }
}

/// The items with these numbers, in this order, of an array of `size` items that read(first, items) reads. Numbers near
/// one another are best given one after the other.
template <class T, class Read>
[[nodiscard]] std::vector<T> gathered(std::span<const std::uint32_t> numbers, std::size_t size, const Read& read) {
  constexpr std::size_t block_size = 256;
  std::vector<T> items, block;
  items.reserve(numbers.size());
  std::size_t first = 0;
  for (const std::uint32_t number : numbers) {
    if (number < first || number >= first + block.size()) {
      first = number - number % block_size;
      block.resize(std::min(block_size, size - first));
      read(first, std::span<T>(block));
    }
    items.push_back(block[number - first]);
  }
  return items;
}

/// Items of one type. Any number of threads may read while none appends.
template <class T>
class ItemStore {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  explicit ItemStore(const StoreSpace& space) : bytes_(space) {}
  ItemStore(const StoreSpace& space, const SharedBytes& shared) : bytes_(space, shared) {}

  void append(const T& item) { bytes_.append(&item, sizeof(T)); }
  void append(std::span<const T> items) { bytes_.append(items.data(), items.size_bytes()); }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(bytes_.size() / sizeof(T)); }
  [[nodiscard]] SharedBytes share() { return bytes_.share(); }
  void read(std::size_t first, std::span<T> to) const {
    bytes_.read(static_cast<std::uint64_t>(first) * sizeof(T), to.data(), to.size_bytes());
  }
  /// Calls use(index, item) for all items, in order.
  template <class Use>
  void for_each(const Use& use) const {
    for_each_in_blocks<T>(
        0, size(), [&](std::size_t first, std::span<T> to) { read(first, to); }, use);
  }

 private:
  ByteStore bytes_;
};

}  // namespace meshbound
