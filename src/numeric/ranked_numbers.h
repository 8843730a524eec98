// SPDX-License-Identifier: MIT
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "numeric/no_index.h"

namespace meshbound {

/// A set of numbers in ascending order, which finds the index of each: a bit for each number, in pages of 4096, of
/// which only those with a number of the set exist. O(n + max / 4096) for n numbers up to `max`, sorted or not.
class RankedNumbers {
 public:
  void add(std::uint32_t number) {
    const std::size_t page = number / numbers_of_page;
    if (page >= first_word_.size()) first_word_.resize(page + 1, no_index);
    if (first_word_[page] == no_index) {
      first_word_[page] = static_cast<std::uint32_t>(words_.size());
      words_.resize(words_.size() + words_of_page);
    }
    words_[word_of(number)] |= bit_of(number);
  }
  /// Each number once, ascending. To be called once all have been added.
  [[nodiscard]] std::vector<std::uint32_t> ranked() {
    std::vector<std::uint32_t> ascending;
    before_.resize(words_.size());
    for (std::size_t page = 0; page < first_word_.size(); ++page) {
      if (first_word_[page] == no_index) continue;
      for (std::size_t k = 0; k < words_of_page; ++k) {
        const std::size_t word = first_word_[page] + k, first = page * numbers_of_page + k * bits;
        before_[word] = static_cast<std::uint32_t>(ascending.size());
        for (std::uint64_t left = words_[word]; left != 0; left &= left - 1)
          ascending.push_back(static_cast<std::uint32_t>(first + static_cast<std::size_t>(std::countr_zero(left))));
      }
    }
    return ascending;
  }
  /// The index of a number of the set in `ranked`, which must have been called.
  [[nodiscard]] std::uint32_t index_of(std::uint32_t number) const {
    const std::size_t word = word_of(number);
    return before_[word] + static_cast<std::uint32_t>(std::popcount(words_[word] & (bit_of(number) - 1)));
  }

 private:
  static constexpr std::size_t bits = 64, words_of_page = 64, numbers_of_page = bits * words_of_page;

  [[nodiscard]] std::size_t word_of(std::uint32_t number) const {
    return first_word_[number / numbers_of_page] + number % numbers_of_page / bits;
  }
  [[nodiscard]] static std::uint64_t bit_of(std::uint32_t number) { return std::uint64_t{1} << number % bits; }

  std::vector<std::uint32_t> first_word_;  ///< by page: where its words begin, or `no_index`
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;  ///< by word: smaller numbers in words before it
};

}  // namespace meshbound
