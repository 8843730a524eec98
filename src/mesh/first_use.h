// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "meshbound/triangle_mesh.h"
#include "numeric/no_index.h"

namespace meshbound {

/// Renumbers the vertices that triangles use, in the order in which the triangles first use them.
class FirstUse {
 public:
  explicit FirstUse(std::size_t vertices) : number_(vertices, no_index) {}

  std::uint32_t operator()(std::uint32_t vertex) {
    std::uint32_t& number = number_[vertex];
    if (number == no_index) {
      number = static_cast<std::uint32_t>(used_.size());
      used_.push_back(vertex);
    }
    return number;
  }
  Triangle operator()(const Triangle& t) {
    const std::uint32_t a = (*this)(t[0]), b = (*this)(t[1]), c = (*this)(t[2]);
    return {a, b, c};
  }

  /// Forgets the numbers. O(vertices used).
  void clear() {
    for (const std::uint32_t vertex : used_) number_[vertex] = no_index;
    used_.clear();
  }

  /// The old numbers of the vertices, by new number.
  [[nodiscard]] const std::vector<std::uint32_t>& used() const { return used_; }

 private:
  std::vector<std::uint32_t> number_, used_;
};

}  // namespace meshbound
