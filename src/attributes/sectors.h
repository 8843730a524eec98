// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "meshbound/simplify.h"

namespace meshbound {

/// The edge with its smaller vertex first.
[[nodiscard]] inline Edge sorted(Edge edge) {
  std::sort(edge.begin(), edge.end());
  return edge;
}

/// Whether two corners at one vertex, of triangles with a common edge there, may be in one sector.
using MayJoin = std::function<bool(std::uint32_t, std::uint32_t)>;

/// Sets of corners, numbered 3 t + k, one after another.
class Sectors {
 public:
  /// `name_of` maps each corner to the number of its set, below the number of corners.
  explicit Sectors(std::span<const std::uint32_t> name_of);
  [[nodiscard]] std::size_t size() const { return end_.size(); }
  /// The corners of a sector, ascending.
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t sector) const {
    const std::size_t first = sector == 0 ? 0 : end_[sector - 1];
    return std::span(corners_).subspan(first, end_[sector] - first);
  }

 private:
  std::vector<std::uint32_t> corners_, end_;
};

/// Finds the corners around one vertex that are connected without crossing a line.
class SectorFinder {
 public:
  /// The level must outlive this. Expected O(n).
  explicit SectorFinder(const SimplifiedLevel& level);
  /// Sectors, ordered by their first corners. O(n).
  [[nodiscard]] Sectors find(const MayJoin& may_join = {}) const;

 private:
  const SimplifiedLevel& level_;
  /// Corners where an edge starts that is no line, and another one of the same edge: the first.
  std::vector<std::array<std::uint32_t, 2>> across_;
};

}  // namespace meshbound
