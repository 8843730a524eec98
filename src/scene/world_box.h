// SPDX-License-Identifier: MIT
#pragma once
#include "geometry/vec3.h"
#include "meshbound/bvh.h"

namespace meshbound {

/// The smallest box of a placed model along the axes of the world: each side touches the model, up to `error`.
struct WorldBox {
  Vec3 lo, hi;       ///< world coordinates
  double error = 0;  ///< largest distance of a side from its true place, world units
};

/// Throws `InvalidInput` for a pose that is no rigid motion. Expected O(log n).
[[nodiscard]] WorldBox world_box(const PlacedModel& model);

/// A lower bound of the Hausdorff distance of two models by their boxes: a side of one box touches a point of its
/// model, and no point of the other model is beyond its own box. Rounded down; 0 or more.
[[nodiscard]] double distance_at_least(const WorldBox& a, const WorldBox& b);

/// Whether models with these boxes may be within `margin` of each other along every axis; true for all that are,
/// rounding included.
[[nodiscard]] bool may_be_near(const WorldBox& a, const WorldBox& b, double margin);

}  // namespace meshbound
