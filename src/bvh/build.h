// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "bvh/bvh_data.h"
#include "geometry/longest_edge.h"
#include "numeric/no_index.h"

namespace meshbound {

/// The steps of building `Bvh::Data`. Each fills the members that its comment names from those filled before, by tasks
/// for the team of threads that it is called in (numeric/tasks.h). Work that cannot be cut into small tasks is cut into
/// `runs`, one for each thread. Every step gives the same result for any number of threads and runs. Temporary memory
/// comes from `scratch`, which each step leaves cleared.

/// Triangles or vertices that make one task: some ten microseconds of work.
inline constexpr std::size_t triangles_per_task = 4096;

/// Triangles below which a build is over before another thread has woken up.
inline constexpr std::size_t triangles_per_thread = 4096;

/// Threads for a build or a refit of so many triangles. `wanted`: as `BvhOptions::threads`.
std::size_t useful_threads(int wanted, std::size_t triangles);

/// Sets box, diagonal and frame, and a new serial number. `box`: of the vertices that triangles use, model units.
void set_frame(Bvh::Data& data, const Eigen::AlignedBox3d& box);

/// Fills `triangle_of_slot`: triangles by the Hilbert index of their centroids, ties by index, so the order is unique.
void hilbert_order(Bvh::Data& data, const MeshView& mesh, Arena& scratch, std::size_t runs);

/// The triangles of a mesh in the order of the slots of its tree, without the tree. Throws as a tree does.
std::vector<std::uint32_t> triangles_along_curve(const MeshView& mesh, const BvhOptions& options);

/// The first of n items that belongs to run `r`, where the items are divided into `runs` equal runs.
inline std::uint32_t run_begin(std::uint32_t n, std::uint32_t r, std::uint32_t runs) {
  return static_cast<std::uint32_t>(std::uint64_t{n} * r / runs);
}

/// Fills `vertices`, `source_vertex`, `corners` with the longest edge first (as `closest_on_triangle` wants it), and
/// the frame's error. Vertices are numbered by first use along the slots, which are divided into `runs` equal runs.
/// Returns for each run the first vertex that no run before it uses, and behind them the number of all vertices.
std::vector<std::uint32_t> place_vertices(Bvh::Data& data, const MeshView& mesh, Arena& scratch, std::size_t runs);

/// By vertex: the first vertex at the same position (coordinates of the working frame that are equal, 0 and -0 too),
/// for the ends of edges that `neighbours` gives one triangle only and for all other vertices at such positions;
/// `no_index` for the rest. Empty when no two vertices share a position. Expected O(n), by one thread.
Array<std::uint32_t> seam_positions(const Bvh::Data& data);

/// Fills `neighbours`. `first_vertex`: as `place_vertices` returned it.
void build_adjacency(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, Arena& scratch);
/// Returns whether all triangles have an area.
bool build_nodes_and_normals(Bvh::Data& data);

/// Adds to `neighbours` what follows at the ends of triangles that are segments. Needs the normals. Takes O(n), and
/// O(m log m) for m segments.
void link_segments(Bvh::Data& data);

/// Box of a block's or node's children, for walking the tree top-down as a hierarchy over A.
Box node_box(const Bvh::Data& data, std::uint32_t level, std::uint32_t index);

/// The first slot below a node and the one after the last: nodes are runs of the Hilbert order.
std::pair<std::uint32_t, std::uint32_t> slots_below(const Bvh::Data& data, std::uint32_t level, std::uint32_t index);

}  // namespace meshbound
