// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>

#include "numeric/no_index.h"

namespace meshbound {

/// A list of numbers below 2^31 in 8 bytes. Two at most need no memory of their own; for more there is a block of the
/// next power of two, of words that are how many there are, and then the numbers.
class IdList {
 public:
  IdList() = default;
  IdList(IdList&& other) noexcept : words_(std::exchange(other.words_, none)) {}
  IdList& operator=(IdList&& other) noexcept {
    std::swap(words_, other.words_);
    return *this;
  }
  ~IdList() { free(); }

  [[nodiscard]] bool empty() const { return words_[0] == no_index; }
  [[nodiscard]] std::span<const std::uint32_t> ids() const {
    if (words_[1] == no_index) return {words_.data(), empty() ? 0U : 1U};
    if (words_[1] < many) return {words_.data(), 2};
    return {block() + 1, *block()};
  }
  /// `ids` must not be part of this list.
  void assign(std::span<const std::uint32_t> ids) { std::copy(ids.begin(), ids.end(), resize(ids.size())); }
  void add(std::uint32_t id) {
    const std::size_t size = ids().size();
    resize(size + 1)[size] = id;
  }
  template <class IsWanted>
  void keep_if(const IsWanted& is_wanted) {
    const std::span<std::uint32_t> all(begin(), ids().size());
    const auto end = std::remove_if(all.begin(), all.end(), [&](std::uint32_t id) { return !is_wanted(id); });
    (void)resize(static_cast<std::size_t>(end - all.begin()));
  }

 private:
  static constexpr std::size_t few = 2;
  static constexpr std::array<std::uint32_t, few> none{no_index, no_index};
  static constexpr std::uint32_t many = 0x80000000;  ///< in the second word: both hold the address of a block
  static constexpr int unused_bits = 2;              ///< of an address, 0 as it is a multiple of 8

  /// Words of the block for so many; 0: there is none.
  static std::size_t block_size(std::size_t size) { return size <= few ? 0 : std::bit_ceil(size + 1); }
  [[nodiscard]] bool is_many() const { return words_[1] >= many && words_[1] != no_index; }
  [[nodiscard]] std::uint32_t* block() const {
    const std::uint64_t number = std::uint64_t{words_[1] & ~many} << 32 | words_[0];
    return reinterpret_cast<std::uint32_t*>(static_cast<std::uintptr_t>(number << unused_bits));
  }
  void set_block(const std::uint32_t* block) {
    const std::uint64_t number = std::uint64_t{reinterpret_cast<std::uintptr_t>(block)} >> unused_bits;
    words_ = {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32) | many};
  }
  [[nodiscard]] std::uint32_t* begin() { return is_many() ? block() + 1 : words_.data(); }
  void free() {
    if (is_many()) delete[] block();
  }
  /// Keeps the numbers that there is room for, and returns the first.
  std::uint32_t* resize(std::size_t size) {
    const std::span<const std::uint32_t> before = ids();
    const std::size_t kept = std::min(size, before.size()), needed = block_size(size);
    if (needed != block_size(before.size())) {
      IdList other;
      if (needed > 0) other.set_block(new std::uint32_t[needed]);
      std::copy_n(before.begin(), kept, other.begin());
      std::swap(words_, other.words_);
    }
    if (needed > 0)
      *block() = static_cast<std::uint32_t>(size);
    else
      std::fill(words_.begin() + static_cast<std::ptrdiff_t>(size), words_.end(), no_index);
    return begin();
  }

  std::array<std::uint32_t, few> words_ = none;
};

}  // namespace meshbound
