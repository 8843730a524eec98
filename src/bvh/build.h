// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "bvh/build_kernels.h"
#include "bvh/bvh_data.h"

namespace meshbound {

/// The steps of building `Bvh::Data`. Each fills the members that its comment names from those filled before, by tasks
/// for the team of threads that it is called in (numeric/tasks.h). Work that cannot be cut into small tasks is cut into
/// `runs`, one for each thread. Every step gives the same result for any number of threads and runs. Temporary memory
/// comes from the arena of the data: the arrays of later steps have room there.

/// Triangles or vertices that make one task: some ten microseconds of work.
inline constexpr std::size_t triangles_per_task = 4096;

/// Triangles below which a build is over before another thread has woken up.
inline constexpr std::size_t triangles_per_thread = 4096;

/// Threads for a build or a refit of so many triangles. `wanted`: as `BvhOptions::threads`.
std::size_t useful_threads(int wanted, std::size_t triangles);

/// Sets box, diagonal and frame, and a new serial number. `box`: of the vertices that triangles use, model units.
void set_frame(Bvh::Data& data, const Eigen::AlignedBox3d& box);

/// Fills `triangle_of_slot`: triangles by the Hilbert index of their centroids, ties by index, so the order is unique.
void hilbert_order(Bvh::Data& data, const MeshView& mesh, std::size_t runs);

/// The triangles of a mesh in the order of the slots of its tree, without the tree. Throws as a tree does.
std::vector<std::uint32_t> triangles_along_curve(const MeshView& mesh, const BvhOptions& options);

/// The first of n items that belongs to run `r`, where the items are divided into `runs` equal runs.
inline std::uint32_t run_begin(std::uint32_t n, std::uint32_t r, std::uint32_t runs) {
  return static_cast<std::uint32_t>(std::uint64_t{n} * r / runs);
}

/// Slots whose half-edges are matched at a time, a multiple of `triangles_at_once`. At most 2^16, few of whose
/// half-edges belong to another chunk (one in 120); fewer where each run is to have two, for which the arena has room.
inline std::uint32_t slots_per_chunk(std::size_t triangles, std::size_t runs) {
  constexpr std::size_t most = std::size_t{1} << 16;
  const std::size_t batches = (triangles / (2 * runs) + triangles_at_once - 1) / triangles_at_once;
  return static_cast<std::uint32_t>(std::clamp(batches * triangles_at_once, std::size_t{triangles_at_once}, most));
}

/// Fills `vertices`, `source_vertex`, `corners` with the longest edge first (as `closest_on_triangle` wants it), and
/// the frame's error. Vertices are numbered by first use along the slots, which are divided into `runs` equal runs.
/// Returns for each chunk of `slots_per_chunk` slots the first vertex that no chunk before it uses, and behind them the
/// number of all vertices.
std::vector<std::uint32_t> place_vertices(Bvh::Data& data, const MeshView& mesh, std::size_t runs);

/// By vertex: the first vertex at the same position (coordinates of the working frame that are equal, 0 and -0 too),
/// for the ends of edges that `neighbours` gives one triangle only and for all other vertices at such positions;
/// `no_index` for the rest. Empty when no two vertices share a position. Expected O(n), by one thread.
Array<std::uint32_t> seam_positions(const Bvh::Data& data);

/// Fills `neighbours`. `first_vertex`: as `place_vertices` returned it.
void build_adjacency(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, std::size_t runs);
/// Returns whether all triangles have an area.
bool build_nodes_and_normals(Bvh::Data& data);

/// Adds to `neighbours` what follows at the ends of triangles that are segments. Needs the normals. Takes O(n), and
/// O(m log m) for m segments.
void link_segments(Bvh::Data& data);

inline void extend(Box& box, const Vec3& p) {
  box.lo = {std::min(box.lo.x, p.x), std::min(box.lo.y, p.y), std::min(box.lo.z, p.z)};
  box.hi = {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y), std::max(box.hi.z, p.z)};
}

/// Box of a block's or node's children, for walking the tree top-down as a hierarchy over A.
Box node_box(const Bvh::Data& data, std::uint32_t level, std::uint32_t index);

/// The first slot below a node and the one after the last: nodes are runs of the Hilbert order.
std::pair<std::uint32_t, std::uint32_t> slots_below(const Bvh::Data& data, std::uint32_t level, std::uint32_t index);

}  // namespace meshbound
