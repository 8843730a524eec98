// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meshbound {

/// An array of which few entries are ever used: an entry that was not set since `clear` counts as absent, and `clear`
/// is O(1).
template <class T>
class SparseArray {
 public:
  void clear(std::size_t size) {
    if (++epoch_ == 0) stamps_.assign(stamps_.size(), 0), epoch_ = 1;
    if (stamps_.size() < size) stamps_.resize(size, 0), values_.resize(size);
  }
  [[nodiscard]] bool has(std::size_t i) const { return stamps_[i] == epoch_; }
  [[nodiscard]] T& operator[](std::size_t i) { return values_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return values_[i]; }
  T& set(std::size_t i, const T& value) {
    stamps_[i] = epoch_;
    return values_[i] = value;
  }

 private:
  std::uint32_t epoch_ = 0;
  std::vector<std::uint32_t> stamps_;
  std::vector<T> values_;
};

}  // namespace meshbound
