// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/position_table.h"
#include "meshbound/triangle_mesh.h"
#include "numeric/no_index.h"

namespace meshbound {

/// Finds the triangles of a mesh that another mesh has too, bit for bit, however the two number their vertices: by the
/// three corners in any order. Vertices at one position count as one, the first of them. Any number of threads may ask.
class TriangleTable {
 public:
  /// `positions` is of `vertices`. O(n), but for the sorting of the triangles at each vertex.
  TriangleTable(std::span<const Triangle> triangles, std::span<const Vec3> vertices, const PositionTable& positions);

  /// A triangle with these corners, which are vertices that `PositionTable::find` gave; or `no_index`.
  [[nodiscard]] std::uint32_t find(const Triangle& corners) const;

 private:
  struct Entry {
    Triangle corners;  ///< sorted
    std::uint32_t index;
    bool operator<(const Entry& other) const { return corners < other.corners; }
  };
  std::vector<std::uint32_t> begin_;  ///< by smallest corner
  std::vector<Entry> entries_;
};

}  // namespace meshbound
