// SPDX-License-Identifier: MIT
/// Positions where a mesh may be torn: of vertices at the ends of edges with one triangle. A hash table holds one
/// vertex for each; a batch of vertices is hashed at a time, so that the processor waits for many entries at once.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "bvh/build.h"
#include "geometry/position_table.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

constexpr std::uint32_t hashed_at_once = 32;

/// The vertices at each position; only of those that are put in. Open addressing, at most three quarters full.
class TornPositions {
 public:
  TornPositions(const Bvh::Data& data, std::size_t positions)
      : vertices_(data.vertices), shift_(64 - static_cast<int>(std::bit_width(positions + positions / 3 + 1))) {
    first_at_.assign(std::size_t{1} << (64 - shift_), no_index);
  }

  /// Calls use(vertex, first entry to look at) for the vertices that `wanted` takes, in ascending order.
  template <class Wanted, class Use>
  void for_each_hashed(Wanted&& wanted, Use&& use) {
    const auto count = static_cast<std::uint32_t>(vertices_.size());
    std::array<std::uint32_t, hashed_at_once> vertex, entry;
    for (std::uint32_t v = 0; v < count;) {
      std::uint32_t size = 0;
      for (; v < count && size < hashed_at_once; ++v) {
        if (!wanted(v)) continue;
        vertex[size] = v;
        entry[size] = static_cast<std::uint32_t>(position_hash(position_key(vertices_[v])) >> shift_);
        __builtin_prefetch(&first_at_[entry[size++]]);
      }
      for (std::uint32_t i = 0; i < size; ++i) use(vertex[i], entry[i]);
    }
  }

  /// The entry of the position of a vertex, or the free one where it belongs.
  [[nodiscard]] std::uint32_t find(std::uint32_t vertex, std::uint32_t entry) const {
    while (first_at_[entry] != no_index && !same_position(vertices_[first_at_[entry]], vertices_[vertex]))
      entry = (entry + 1) & static_cast<std::uint32_t>(first_at_.size() - 1);
    return entry;
  }

  [[nodiscard]] std::uint32_t& first_at(std::uint32_t entry) { return first_at_[entry]; }

 private:
  const Array<Vec3>& vertices_;
  int shift_;
  Array<std::uint32_t> first_at_;  ///< by entry: the first vertex there, `no_index` where there is none
};

/// Sets the entries of the ends of edges with one triangle to 0. Returns their number.
std::size_t mark_torn_vertices(const Bvh::Data& data, Array<std::uint32_t>& position) {
  std::size_t torn = 0;
  for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
    const auto& across = data.neighbours[slot];
    for (std::size_t k = 0; k < 3; ++k) {
      if (across[k].slot != no_slot) continue;
      for (const std::uint32_t v : {data.corners[slot][k], data.corners[slot][(k + 1) % 3]})
        torn += std::exchange(position[v], 0) == 0 ? 0 : 1;
    }
  }
  return torn;
}

bool any_torn_edge(const Bvh::Data& data) {
  return std::any_of(data.neighbours.begin(), data.neighbours.end(), [](const std::array<Neighbour, 3>& across) {
    return across[0].slot == no_slot || across[1].slot == no_slot || across[2].slot == no_slot;
  });
}

}  // namespace

Array<std::uint32_t> seam_positions(const Bvh::Data& data) {
  Array<std::uint32_t> position;
  if (!any_torn_edge(data)) return position;
  position.assign(data.vertices.size(), no_index);
  const std::size_t torn = mark_torn_vertices(data, position);
  TornPositions table(data, torn);
  bool shared = false;
  table.for_each_hashed([&](std::uint32_t v) { return position[v] != no_index; },
                        [&](std::uint32_t v, std::uint32_t hashed) {
                          const std::uint32_t entry = table.find(v, hashed);
                          shared = shared || table.first_at(entry) != no_index;
                          table.first_at(entry) = std::min(table.first_at(entry), v);
                          position[v] = entry;
                        });
  // The other vertices, whose edges all have two triangles: those at such a position join it.
  table.for_each_hashed([&](std::uint32_t v) { return position[v] == no_index; },
                        [&](std::uint32_t v, std::uint32_t hashed) {
                          const std::uint32_t entry = table.find(v, hashed);
                          if (table.first_at(entry) == no_index) return;
                          shared = true;
                          table.first_at(entry) = std::min(table.first_at(entry), v);
                          position[v] = entry;
                        });
  if (!shared) return {};
  for (std::uint32_t& p : position)
    if (p != no_index) p = table.first_at(p);
  return position;
}

}  // namespace meshbound
