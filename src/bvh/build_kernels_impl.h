// SPDX-License-Identifier: MIT
/// The functions of `BuildKernels`. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <algorithm>

#include "bvh/build_kernels.h"
#include "bvh/match_half_edges.h"
#include "bvh/nearest.h"
#include "bvh/node_boxes.h"
#include "geometry/hilbert.h"
#include "geometry/hilbert_lanes.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// Lanes of 128 bits are slower than the table.
inline void hilbert_indices(const Cells& cells, int bits, Batch<std::uint64_t>& indices) {
#if defined(__AVX2__)
  hilbert_indices_in_lanes(cells.x.data(), cells.y.data(), cells.z.data(), triangles_at_once, bits, indices.data());
#else
  for (std::size_t i = 0; i < triangles_at_once; ++i)
    indices[i] = hilbert_index(cells.x[i], cells.y[i], cells.z[i], bits);
#endif
}

/// Returns whether all triangles of the block have an area.
inline bool store_normals(Bvh::Data& data, std::uint32_t block, const CornerTriangle<Double4>& t) {
  const Vec<Double4> normal = cross(t.ab, t.ac);
  const Double4 norm = square_root(squared_length(normal)), scale = select(norm > 0.0, 1.0 / norm, Double4{});
  const Vec<Double4> unit = scale * normal;
  const std::uint32_t first = block * block_width, count = std::min(block_width, data.triangle_count() - first);
  for (std::uint32_t i = 0; i < count; ++i)
    data.normals[first + i] = {static_cast<float>(unit.x[i]), static_cast<float>(unit.y[i]),
                               static_cast<float>(unit.z[i])};
  return lane_bits(norm > 0.0) == (1U << block_width) - 1;
}

inline bool build_leaf(Bvh::Data& data, std::uint32_t block, BvhNode& node) {
  const std::array<std::uint32_t, block_width> slots = slots_of_block(data, block);
  std::array<std::array<Double4, block_width>, 3> corners;
  for (std::size_t i = 0; i < block_width; ++i)
    for (std::size_t k = 0; k < 3; ++k) corners[k][i] = coordinates(data.vertices[data.corners[slots[i]][k]]);
  Double4 lo = corners[0][0], hi = lo;
  for (const auto& of_triangles : corners) {
    for (const Double4& corner : of_triangles) {
      lo = minimum(lo, corner);
      hi = maximum(hi, corner);
    }
  }
  set_child(node, block % node_width, lo, hi);
  const Vec<Double4> a = lanes(corners[0]);
  return store_normals(data, block, {a, lanes(corners[1]) - a, lanes(corners[2]) - a});
}

inline bool build_leaves(Bvh::Data& data, std::size_t begin, std::size_t end) {
  bool all_have_area = true;
  for (std::size_t i = begin; i < end; ++i) {
    BvhNode& node = data.nodes[data.level_begin[1] + i];
    for (std::uint32_t k = 0; k < node_width; ++k) {
      const auto block = static_cast<std::uint32_t>(i) * node_width + k;
      if (block < data.block_count())
        all_have_area &= build_leaf(data, block, node);
      else
        set_empty(node, k);
    }
  }
  return all_have_area;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
