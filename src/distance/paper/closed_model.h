// SPDX-License-Identifier: MIT
/// The termination rule for closed models. Paper, section 5.1, Lemma 4, in a form that is sound.
///
/// As printed, the lemma asks only that the triangle T of A, moved by a vector w with |w| = lower bound + epsilon, be
/// enclosed by B, and concludes d(p, B) <= |w| for every p of T. Its proof follows p to p + w through the surface of B,
/// which needs p outside. Counter-example (tests/paper_test.cpp): B is a large cube with three small bubbles, T has
/// each corner in a bubble, near its floor. Moved through the floors T is enclosed, yet its centroid, inside the solid
/// before and after, is far from every wall.
///
/// Sound form. Let B be closed in the sense that each edge has two triangles, so that the parity of crossings tells
/// inside from outside. If neither T nor its translate T' meets B, all of T is on one side and all of T' on one side;
/// if one point of T and its image are on different sides, every segment from p to its image crosses B, and d(p, B) is
/// at most its length. It does not matter which side is inside, whether A is closed, or where w points.
#pragma once
#include <span>

#include "bvh/bvh_data.h"
#include "geometry/triangle_corners.h"

namespace meshbound {

/// Every edge has exactly two triangles, by vertex index, and no triangle repeats a vertex. O(n).
[[nodiscard]] bool is_closed(const Bvh::Data& data);

/// Proves that all points of `from` are on one side of the closed model B, and their images in the translate `to` on
/// the other. `slots` holds the triangles of B that meet `from`, `to` or a segment between a point and its image, and
/// perhaps more. False also where rounding leaves it open. O(slots).
[[nodiscard]] bool crosses_surface(const Bvh::Data& b, const TriangleCorners& from, const TriangleCorners& to,
                                   std::span<const std::uint32_t> slots);

}  // namespace meshbound
