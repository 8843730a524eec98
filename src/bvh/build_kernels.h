// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bvh/bvh_data.h"

namespace meshbound {

/// Triangles whose corners are fetched before any of them is worked on: the processor then waits for many at a time.
inline constexpr std::uint32_t triangles_at_once = 64;

/// A value for each of so many triangles.
template <class Value>
using Batch = std::array<Value, triangles_at_once>;

/// Cells of the 2^bits grid.
struct Cells {
  Batch<std::uint32_t> x{}, y{}, z{};
};

/// Half-edges of triangles, by buckets: those of a vertex follow each other, in the order of their ids.
struct HalfEdges {
  const std::uint32_t* far;    ///< the vertex at the other end
  const std::uint32_t* id;     ///< 4 slot + edge
  const std::uint8_t* upward;  ///< 1: runs from the vertex of the bucket to `far`; 0: the other way
};

/// Half-edges of a bucket from which they are sorted instead of compared with each other, which is done by the bits of
/// a word: ten times what a vertex of a scan has.
inline constexpr std::uint32_t max_compared = 64;

/// They are compared so many at a time: what lies behind a bucket is read too.
inline constexpr std::uint32_t compared_at_once = 16;

/// The inner loops of a build.
struct BuildKernels {
  /// `hilbert_index` of each cell.
  void (*hilbert_indices)(const Cells& cells, int bits, Batch<std::uint64_t>& indices);
  /// Links the half-edges of each edge that stand in the buckets from `begin` to below `end`, but for buckets with more
  /// than `max_compared`. They form a ring in the order of their ids: a pair on a manifold edge, more where more
  /// triangles meet, nothing on a border. `bucket_end`: by bucket; the first begins at 0. `neighbours`: by slot.
  void (*match_half_edges)(const HalfEdges& edges, const std::uint32_t* bucket_end, std::size_t begin, std::size_t end,
                           EdgeNeighbours* neighbours);
  /// Fills the lowest nodes of a tree from `begin` to below `end`, and the normals of the triangles in their blocks:
  /// each corner is fetched once for both. Returns whether all of these triangles have an area.
  bool (*build_leaves)(Bvh::Data& data, std::size_t begin, std::size_t end);
};

/// The fastest implementation that this machine runs, and all that it runs. They give the same bits.
[[nodiscard]] BuildKernels build_kernels();
[[nodiscard]] std::vector<BuildKernels> all_build_kernels();

}  // namespace meshbound
