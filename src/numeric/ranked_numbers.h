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
  /// Takes the numbers of some lists, which may be in any order and come more than once.
  template <class Lists>
  explicit RankedNumbers(const Lists& lists) {
    for (const auto& list : lists)
      for (const std::uint32_t number : list) add(number);
    rank();
  }
  /// Each number once, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& ascending() const { return ascending_; }
  [[nodiscard]] bool contains(std::uint32_t number) const {
    const std::size_t page = number / numbers_of_page;
    return page < first_word_.size() && first_word_[page] != no_index &&
           (words_[word_of(number)] & bit_of(number)) != 0;
  }
  /// The index of a number of the set in `ascending`.
  [[nodiscard]] std::uint32_t index_of(std::uint32_t number) const {
    const std::size_t word = word_of(number);
    return before_[word] + static_cast<std::uint32_t>(std::popcount(words_[word] & (bit_of(number) - 1)));
  }

 private:
  static constexpr std::size_t bits = 64, words_of_page = 64, numbers_of_page = bits * words_of_page;

  void add(std::uint32_t number) {
    const std::size_t page = number / numbers_of_page;
    if (page >= first_word_.size()) first_word_.resize(page + 1, no_index);
    if (first_word_[page] == no_index) {
      first_word_[page] = static_cast<std::uint32_t>(words_.size());
      words_.resize(words_.size() + words_of_page);
    }
    words_[word_of(number)] |= bit_of(number);
  }

  void rank() {
    before_.resize(words_.size());
    for (std::size_t page = 0; page < first_word_.size(); ++page) {
      if (first_word_[page] == no_index) continue;
      for (std::size_t k = 0; k < words_of_page; ++k) {
        const std::size_t word = first_word_[page] + k, first = page * numbers_of_page + k * bits;
        before_[word] = static_cast<std::uint32_t>(ascending_.size());
        for (std::uint64_t left = words_[word]; left != 0; left &= left - 1)
          ascending_.push_back(static_cast<std::uint32_t>(first + static_cast<std::size_t>(std::countr_zero(left))));
      }
    }
  }

  [[nodiscard]] std::size_t word_of(std::uint32_t number) const {
    return first_word_[number / numbers_of_page] + number % numbers_of_page / bits;
  }
  [[nodiscard]] static std::uint64_t bit_of(std::uint32_t number) { return std::uint64_t{1} << number % bits; }

  std::vector<std::uint32_t> first_word_;  ///< by page: where its words begin, or `no_index`
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;  ///< by word: smaller numbers in words before it
  std::vector<std::uint32_t> ascending_;
};

}  // namespace meshbound
