// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/cut_axes.h"
#include "simplify/decimation_state.h"

namespace meshbound {

/// Which vertices belong together while several threads decimate one mesh, each a region of its own.
///
/// A change belongs to a region when all vertices of the faces around it do. So a face whose vertices belong to several
/// regions stays as it is, a face of one region is read and changed by its thread alone, and regions need no locks.
/// Which region a face belongs to is noted at the split: its corners may be read by the thread of that region only.
struct Split {
  std::vector<std::uint32_t> region_of;  ///< by vertex; empty: all belong to one region
  std::vector<std::uint32_t>
      region_of_face;  ///< by face: region of all its vertices, `no_index` if they differ; or empty
  std::vector<Region> regions;

  [[nodiscard]] bool owns(std::uint32_t region, std::uint32_t vertex) const {
    return region_of.empty() || region_of[vertex] == region;
  }
  [[nodiscard]] bool owns_face(std::uint32_t region, std::uint32_t face) const {
    return region_of_face.empty() || region_of_face[face] == region;
  }
};

/// Whether all faces that cover an original belong to the region: else no change there can be proven, as the faces of
/// other regions, and what is known of them, may not be touched.
[[nodiscard]] inline bool is_covered_in(const Split& split, std::uint32_t region, const CoverAssignment& cover,
                                        std::uint32_t original) {
  return std::ranges::all_of(cover.faces_of(original), [&](std::uint32_t f) { return split.owns_face(region, f); });
}

/// Number of ways in which `split` can cut a mesh.
inline constexpr int shifts_of_split = cut_directions;

/// Cuts a mesh into regions of about equal numbers of vertices, each between planes, and none of fewer than
/// `min_vertices`. The number depends on the mesh alone. Cuts of another `shift`, less than `shifts_of_split`, run in
/// other directions, so that few vertices lie at seams of all of them. All vertices around one with
/// many faces are of one region. A mesh that no cut leaves mostly in regions stays whole. O(n log n).
[[nodiscard]] Split split(const DecimationState& state, int shift, std::size_t min_vertices, int threads = 1);
/// The split into a single region.
[[nodiscard]] Split whole(const DecimationState& state);
/// As `DecimationState::reopen_at` for a vertex of the region, but leaves edges that lead to other regions to `merge`.
void reopen_around(DecimationState& state, const Split& split, Region& region, std::uint32_t vertex);
/// Takes over what was changed in the regions, in their order.
void merge(DecimationState& state, Split split);

}  // namespace meshbound
