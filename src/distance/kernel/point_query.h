// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bvh/bvh_data.h"
#include "bvh/nearest.h"

namespace meshbound {

/// What a search finds out about a point, in the working frame of the tree.
struct PointDistance {
  Nearest nearest;       ///< the least squared distance of all triangles, and the first slot that has it
  Vec3 offset;           ///< from the closest point of that triangle to the query
  double separated = 0;  ///< proven lower bound of the distance to the mesh, but for `dual_error`
};

/// How exact the computed distances are, in working units; both depend on the magnitude of the coordinates.
struct PointRoundings {
  double primal = 0;  ///< computed distances may be less than this below the true ones (numeric/rounding.h)
  double allowed =
      0;  ///< how far the lower bound may stay below the nearest distance before it is computed in extended precision
};

/// The nearest triangle to p, and a lower bound at most `allowed` below its distance wherever doubles can tell. `hint`
/// is any slot, or `no_slot` for none: a near one saves time, and the answer is the same to the last bit for all of
/// them. Expected O(log n), without allocation.
using MeasurePoint = PointDistance (*)(const Bvh::Data& data, const Vec3& p, const PointRoundings& roundings,
                                       std::uint32_t hint);

/// The most queries that any kernel measures together.
inline constexpr std::size_t max_group_width = 16;

struct GroupQuery {
  Vec3 point;
  PointRoundings roundings;
};

/// `MeasurePoint` for up to `PointKernel::group_width` queries (at least one) at once, with the same answers to the
/// last bit. Fast where they are near one another beside their distances or the triangles; false, and no answer, where
/// so many triangles are near that they are asked sooner one by one. `hint`: a slot near the group, or `no_slot`.
using MeasureGroup = bool (*)(const Bvh::Data& data, std::span<const GroupQuery> queries, std::uint32_t hint,
                              std::span<PointDistance> answers);

/// An implementation of point queries.
struct PointKernel {
  MeasurePoint one;
  MeasureGroup group;
  std::size_t group_width;
};

/// The fastest implementation that this machine runs.
PointKernel point_kernel();

/// All that this machine runs. They give the same bits.
std::vector<PointKernel> point_kernels();

}  // namespace meshbound
