// SPDX-License-Identifier: MIT
/// Vertices at equal positions: equal bit for bit, except that -0 and 0 are one coordinate.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec3.h"

namespace meshbound {

[[nodiscard]] inline bool same_position(const Vec3& p, const Vec3& q) { return p.x == q.x && p.y == q.y && p.z == q.z; }

/// The bits of a position, equal for equal positions: x + 0.0 turns -0 into 0 and leaves all other values as they are.
using PositionKey = std::array<std::uint64_t, 3>;

[[nodiscard]] inline PositionKey position_key(const Vec3& p) {
  return {std::bit_cast<std::uint64_t>(p.x + 0.0), std::bit_cast<std::uint64_t>(p.y + 0.0),
          std::bit_cast<std::uint64_t>(p.z + 0.0)};
}

/// Multiplication by odd constants (fractions of the golden ratio and of pi) with the high bits folded back, so that
/// both the low and the high bits of the result may be used: coordinates that were floats have nothing but zeros in the
/// low bits of a double.
[[nodiscard]] inline std::uint64_t position_hash(const PositionKey& key) {
  std::uint64_t h = 0;
  for (const std::uint64_t bits : key) {
    h = (h ^ bits) * 0x9e3779b97f4a7c15;
    h ^= h >> 32;
  }
  h *= 0x243f6a8885a308d3;
  return h ^ (h >> 29);
}

/// Finds the first vertex of a mesh at an exact position. Linear probing, at most half full. Any number of threads may
/// ask.
class PositionTable {
 public:
  /// `vertices` must outlive this. Expected O(n).
  explicit PositionTable(std::span<const Vec3> vertices);
  /// Sets `first` to what `first_at_position` returns.
  PositionTable(std::span<const Vec3> vertices, std::vector<std::uint32_t>& first);

  /// The index of the first vertex at p, or `no_index`. Expected O(1).
  [[nodiscard]] std::uint32_t find(const Vec3& p) const { return table_[entry_of(p)]; }

 private:
  std::uint32_t add(std::uint32_t vertex);
  [[nodiscard]] std::size_t entry_of(const Vec3& p) const;

  std::span<const Vec3> vertices_;
  std::vector<std::uint32_t> table_;
};

/// For each vertex the index of the first one at its position. Expected O(n).
[[nodiscard]] std::vector<std::uint32_t> first_at_position(std::span<const Vec3> vertices);

}  // namespace meshbound
