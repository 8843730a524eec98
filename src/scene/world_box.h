// SPDX-License-Identifier: MIT
#pragma once
#include "geometry/vec3.h"
#include "meshbound/bvh.h"

namespace meshbound {

/// The smallest box of a placed model along the axes of the world: each side touches the model, up to `error`.
struct WorldBox {
  Vec3 lo, hi;       ///< world coordinates
  double error = 0;  ///< how far each side may be off, either way
};

/// Throws `InvalidInput` for a pose that is no rigid motion. Expected O(log n).
[[nodiscard]] WorldBox world_box(const PlacedModel& model);

/// What the Hausdorff distance of two models is at least, by their boxes: a side of one touches a point that no point
/// of the other reaches beyond its own side. Rounded down, 0 or more.
[[nodiscard]] double distance_at_least(const WorldBox& a, const WorldBox& b);

/// Whether boxes may be within `margin` of each other along every axis, in the true sense: never false for models that
/// are.
[[nodiscard]] bool may_be_near(const WorldBox& a, const WorldBox& b, double margin);

}  // namespace meshbound
