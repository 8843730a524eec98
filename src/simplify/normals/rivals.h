// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "numeric/buckets.h"
#include "simplify/normals/faced_triangle.h"

namespace meshbound {

/// Which triangles could become the nearest one to the middle of another, though they face elsewhere: those of other
/// sheets beside it, and across creases.
class Rivals {
 public:
  struct Rival {
    std::uint32_t triangle = 0;
    float squared = 0;  ///< distance from the middle
  };
  struct Limits {
    double reach = 0;       ///< largest distance of a rival
    double min_cosine = 0;  ///< of the angle between triangles that are no rivals
    int threads = 1;        ///< results are the same for every number
  };

  /// Finds up to `max_rivals` for each triangle, the nearest ones. O(n log n) where triangles beside each other have
  /// about the same size.
  Rivals(std::span<const FacedTriangle> triangles, const Limits& limits);

  static constexpr std::size_t max_rivals = 4;

  /// The rivals of a triangle, the nearest one first.
  [[nodiscard]] std::span<const Rival> of(std::uint32_t triangle) const {
    return std::span(rivals_[triangle].rivals).first(rivals_[triangle].count);
  }
  /// The triangles that have this one as a rival, ascending.
  [[nodiscard]] std::span<const std::uint32_t> with(std::uint32_t triangle) const { return (*with_)[triangle]; }

 private:
  struct Few {
    std::array<Rival, max_rivals> rivals{};
    std::uint32_t count = 0;
  };

  std::vector<Few> rivals_;                     ///< by triangle
  std::optional<Buckets<std::uint32_t>> with_;  ///< by triangle
};

}  // namespace meshbound
