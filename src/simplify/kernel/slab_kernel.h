// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "geometry/vec3.h"

namespace meshbound {

/// Eight nodes of a `SlabTree`, lane by lane. Lanes without a node have the radius -inf: nothing meets them.
struct alignas(32) SlabBlock {
  static constexpr int lanes = 8;
  double x[lanes], y[lanes], z[lanes];                       ///< centres
  double normal_x[lanes], normal_y[lanes], normal_z[lanes];  ///< unit normals; 0 where the triangles face all ways
  double radius[lanes], half_thickness[lanes];
};

/// The sine of an angle is computed from its cosine. Near 0 this much is missing from its square at most: the cosine of
/// two vectors of unit length carries five roundings, and those of the lengths.
inline constexpr double squared_sine_error = 0x1p-48;

/// The prism over a triangular window, in world coordinates.
struct SlabView {
  Vec3 middle, up;                         ///< of the window: a point inside, and its unit normal
  std::array<Vec3, 3> side;                ///< outward unit normals
  std::array<double, 3> side_offset = {};  ///< from `middle`
  double height_limit = 0, rim = 0;        ///< rim: room for rounding
};

/// What is known of nodes, a bit for each lane.
struct SlabsSeen {
  unsigned meets;  ///< may reach into the prism below its top and above its bottom
  /// Among those that meet it: has no height beyond the limit, and nothing above or below the middle of the window.
  unsigned within;
};

/// Where a vertex lies, by more than the rim but for `too_high`.
struct VertexSeen {
  static constexpr unsigned first_side = 1, beyond_side = 7 * first_side;  ///< a bit for each side of the window
  static constexpr unsigned too_high = 8;
  static constexpr unsigned above = 16, below = 32;  ///< the prism
  /// Beyond and before the line through the middle that runs along a side of the window, a bit for each side.
  static constexpr unsigned first_beyond_middle = 64, first_before_middle = 512;
  static constexpr unsigned beside_middle = 7 * (first_beyond_middle | first_before_middle);
};

/// What is asked of nodes and of vertices, see `SimplifyKernels`.
struct SlabKernel {
  SlabsSeen (*look)(const SlabBlock& block, const SlabView& view);
  /// Sets the bits of `VertexSeen` of vertices by their indices; `seen` has room for a multiple of four.
  void (*look_at_vertices)(const Vec3* vertices, std::span<const std::uint32_t> indices, const SlabView& view,
                           std::uint64_t* seen);
};

}  // namespace meshbound
