// SPDX-License-Identifier: MIT
/// The nodes of a tree that are within a distance, level by level. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "bvh/nearest.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// By a word of bits: the lanes whose bits are set, in order; 0 behind them.
inline constexpr auto packed_lanes = [] {
  std::array<std::array<std::uint8_t, node_width>, 1U << node_width> table{};
  for (unsigned bits = 0; bits < table.size(); ++bits) {
    std::size_t count = 0;
    for (std::uint8_t lane = 0; lane < node_width; ++lane)
      if ((bits >> lane & 1U) != 0) table[bits][count++] = lane;
  }
  return table;
}();

inline Mask8 lanes_of(unsigned bits) {
  const auto& packed = packed_lanes[bits];
#if defined(__AVX2__)
  return reinterpret_cast<Mask8>(
      _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(packed.data()))));
#else
  Mask8 lanes;
  for (std::size_t i = 0; i < node_width; ++i) lanes[i] = packed[i];
  return lanes;
#endif
}

/// The block that one reaches by taking the nearest box of each node, from the root down.
template <class Query>
std::uint32_t block_by_boxes(const Bvh::Data& data, const Query& query) {
  std::uint32_t index = 0;
  for (std::uint32_t level = data.levels() - 1; level > 0; --level) {
    const Float8 squared = query.to_boxes(data.nodes[data.level_begin[level] + index]).squared;
    std::uint32_t nearest = 0;
    for (std::uint32_t lane = 1; lane < node_width; ++lane)
      if (squared[lane] < squared[nearest]) nearest = lane;
    index = index * node_width + nearest;
  }
  return std::min(index, data.block_count() - 1);
}

/// Nodes or blocks of one level, at most `capacity` of them; room for a whole node behind them.
struct Level {
  static constexpr std::uint32_t capacity = 128;  ///< a warm start leaves five of them, for a group of queries twenty
  std::uint32_t count = 0;
  std::uint32_t index[capacity + node_width];
};

/// The children of the members of a level of nodes whose boxes are within the limit, in no order and without branches.
/// False when there are too many.
template <class Query>
bool open_level(const Bvh::Data& data, const Query& query, float limit, std::uint32_t level, const Level& from,
                Level& children) {
  const BvhNode* const nodes = data.nodes.data() + data.level_begin[level];
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < from.count; ++i) {
    const unsigned hits = lane_bits(query.to_boxes(nodes[from.index[i]]).squared < broadcast8(limit));
    const Mask8 index = lanes_of(hits) + static_cast<std::int32_t>(from.index[i] * node_width);
    std::memcpy(&children.index[count], &index, sizeof index);
    count += static_cast<std::uint32_t>(std::popcount(hits));
    if (count > Level::capacity) return false;
  }
  children.count = count;
  return true;
}

/// The members of a level whose boxes, and those of all nodes above them, are within the limit: blocks at level 0. A
/// tree without that level has one block, which is returned. Null where a level has too many. `levels`: memory for the
/// walk, which the result lies in.
template <class Query>
Level* members_within(const Bvh::Data& data, const Query& query, float limit, std::uint32_t wanted_level,
                      Level (&levels)[2]) {
  levels[0].count = 1;
  levels[0].index[0] = 0;
  std::uint32_t now = 0;
  for (std::uint32_t level = data.levels() - 1; level > wanted_level; --level, now = 1 - now)
    if (!open_level(data, query, limit, level, levels[now], levels[1 - now])) return nullptr;
  return &levels[now];
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
