// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "meshbound/distance.h"

namespace meshbound {

/// The distance of two meshes whose triangles correspond one to one, in order, with corners that are at most `limit`
/// apart: a copy whose coordinates were rounded, a mesh that has moved a little, however vertices are numbered and
/// triangles turned. Absent when that is not so, which mostly the first triangle tells. By convexity a point of one
/// triangle is as near to the point of the same barycentric coordinates in the other as the corners are, so the largest
/// distance of corners bounds H; what the mesh with the furthest corner misses of it is measured there. Both meshes
/// must be sound (`validate`). O(n).
[[nodiscard]] std::optional<HausdorffDistance> distance_of_corresponding(const MeshView& a, const MeshView& b,
                                                                         double limit);

}  // namespace meshbound
