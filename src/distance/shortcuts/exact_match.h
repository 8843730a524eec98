// SPDX-License-Identifier: MIT
/// Triangles of two meshes that are the same, bit for bit, however the meshes number them.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

inline constexpr std::uint32_t no_match = 0xffffffff;

/// Finds the first vertex of a mesh at an exact position; -0 and 0 are one position. Linear probing, at most half full.
class PositionTable {
 public:
  /// `vertices` must outlive this. O(n).
  explicit PositionTable(std::span<const Vec3> vertices);

  [[nodiscard]] std::uint32_t find(const Vec3& p) const { return table_[place(p)]; }  ///< or `no_match`

 private:
  [[nodiscard]] std::size_t place(const Vec3& p) const;

  std::span<const Vec3> vertices_;
  std::vector<std::uint32_t> table_;
};

/// Finds a triangle by its corners in any order. Vertices at one position count as one: the first of them.
class TriangleTable {
 public:
  TriangleTable(std::span<const Triangle> triangles, std::span<const Vec3> vertices, const PositionTable& positions);

  /// A triangle with these corners, which are vertices that `PositionTable::find` gave; or `no_match`.
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
