// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/marked_ids.h"

namespace meshbound {

/// The corners that some triangles have, each once, in the order in which they are met.
class DistinctCorners {
 public:
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;

  /// `triangles` must outlive this; their corners are below `vertices`.
  DistinctCorners(const Triangles& triangles, std::size_t vertices) : triangles_(triangles) {
    if (vertices > 0) seen_.reserve(vertices - 1);
  }

  /// Valid until the next call. O(size of `which`).
  [[nodiscard]] std::span<const std::uint32_t> of(std::span<const std::uint32_t> which) {
    seen_.clear();
    found_.clear();
    for (const std::uint32_t t : which) {
      for (const std::uint32_t v : triangles_[t]) {
        if (seen_.insert(v)) found_.push_back(v);
      }
    }
    return found_;
  }

 private:
  const Triangles& triangles_;
  MarkedIds seen_;
  std::vector<std::uint32_t> found_;
};

}  // namespace meshbound
