// SPDX-License-Identifier: MIT
#pragma once
#include "geometry/vec3.h"
#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// A triangle as corner and edge vectors: a, a + ab, a + ac, with ab its longest edge. Zero-area triangles are segments
/// or points.
template <class Real>
struct CornerTriangle {
  Vec<Real> a, ab, ac;
};

/// `offset` = query - q, where q = a + v ab + w ac with computed v, w >= 0, v + w <= 1 + 2u: q is on the triangle by
/// construction, and the closest point up to rounding. `squared_distance` is evaluated from the offset, so it errs
/// upward only, but for `primal_error` (numeric/rounding.h) in its root.
template <class Real>
struct TriangleOffset {
  Vec<Real> offset;
  Real squared_distance;
};

namespace detail {

template <class Real>
Real clamped(const Real& x, const Real& most) {
  const Real low = select(x < most, x, most);
  return select(low > 0.0, low, Real{});
}

/// 1 / x, or 0 where x is 0.
template <class Real>
Real reciprocal(const Real& x) {
  return select(x > 0.0, 1.0 / select(x > 0.0, x, Real{} + 1.0), Real{});
}

template <class Real>
void keep_nearer(TriangleOffset<Real>& best, const Vec<Real>& offset, const Real& squared) {
  const auto nearer = squared < best.squared_distance;
  best.offset.x = select(nearer, offset.x, best.offset.x);
  best.offset.y = select(nearer, offset.y, best.offset.y);
  best.offset.z = select(nearer, offset.z, best.offset.z);
  best.squared_distance = select(nearer, squared, best.squared_distance);
}

}  // namespace detail

/// The vector to p from the first candidate of `closest_on_triangle`, which is a point of the triangle.
template <class Real>
[[gnu::always_inline]] inline Vec<Real> offset_from_inside(const CornerTriangle<Real>& t, const Vec<Real>& p) {
  const Real one = Real{} + 1.0;
  const Vec<Real> ap = p - t.a;
  const Real along = detail::reciprocal(dot(t.ab, t.ab)), ab_ac = dot(t.ab, t.ac), ab_ap = dot(t.ab, ap);
  const Vec<Real> across = t.ac - (ab_ac * along) * t.ab;
  const Vec<Real> rest = ap - (ab_ap * along) * t.ab;
  const Real w = detail::clamped(dot(rest, across) * detail::reciprocal(dot(across, across)), one);
  const Real v = detail::clamped((ab_ap - w * ab_ac) * along, one - w);
  return (ap - v * t.ab) - w * t.ac;
}

/// The closest point of a triangle to p: the best of three candidates that all lie on the triangle. The first goes
/// along the longest edge to the foot of p, then across to the height of p, clamped into the triangle: exact for the
/// inside and for the longest edge. Crossing from the foot, not from a, keeps the error at a few u M for slivers too:
/// what the direction across is off (u M / height) acts on the remaining offset only. The other two are the closest
/// points of the other two edges; for a triangle so thin that "across" is noise they cover it. Without branches, so
/// that the same source serves one triangle and four lanes, with the same result to the last bit. Inlined, so that
/// callers who want only the distance do not pay for the offset.
template <class Real>
[[gnu::always_inline]] inline TriangleOffset<Real> closest_on_triangle(const CornerTriangle<Real>& t,
                                                                       const Vec<Real>& p) {
  const Real one = Real{} + 1.0;
  const Vec<Real> ap = p - t.a;
  const Vec<Real> from_inside = offset_from_inside(t, p);
  TriangleOffset<Real> best{from_inside, squared_length(from_inside)};
  const Vec<Real> from_ac = ap - detail::clamped(dot(t.ac, ap) * detail::reciprocal(dot(t.ac, t.ac)), one) * t.ac;
  detail::keep_nearer(best, from_ac, squared_length(from_ac));
  const Vec<Real> bp = ap - t.ab, bc = t.ac - t.ab;
  const Vec<Real> from_bc = bp - detail::clamped(dot(bc, bp) * detail::reciprocal(dot(bc, bc)), one) * bc;
  detail::keep_nearer(best, from_bc, squared_length(from_bc));
  return best;
}

/// A proven lower bound (but for `dual_error`) of the distance from p to the triangle, by the plane that separates them
/// with normal `direction`: min over the corners c of direction . (p - c) / |direction|. Tight when `direction` is the
/// offset from the true closest point. 0 where that plane does not separate.
template <class Real>
Real separation(const CornerTriangle<Real>& t, const Vec<Real>& p, const Vec<Real>& direction) {
  const Real norm = square_root(squared_length(direction));
  const Vec<Real> ap = p - t.a;
  const Real at_a = dot(direction, ap), at_b = dot(direction, ap - t.ab), at_c = dot(direction, ap - t.ac);
  const Real at_b_or_c = select(at_b < at_c, at_b, at_c), least = select(at_a < at_b_or_c, at_a, at_b_or_c);
  return select(norm > 0.0, select(least > 0.0, least / norm, Real{}), Real{});
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
