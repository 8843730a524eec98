// SPDX-License-Identifier: MIT
#pragma once
#include "geometry/vec3.h"
#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// A triangle as corner and edge vectors: a, a + ab, a + ac. Zero-area triangles are segments or points.
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
Real clamped_ratio(Real numerator, Real denominator) {
  const Real ratio = select(numerator < denominator, numerator / denominator, Real{} + 1.0);
  return select(numerator > 0.0, ratio, Real{});
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

/// Best of four candidates that all lie on the triangle: the closest points of its edges, and the foot of the
/// perpendicular where that falls inside. A sliver whose foot cannot be computed well still has its edges, which are
/// then as close as the sliver is thin; so neither accuracy nor soundness depends on the shape. Without branches, so
/// that the same source serves one triangle and four lanes, with the same result to the last bit.
template <class Real>
TriangleOffset<Real> closest_on_triangle(const CornerTriangle<Real>& t, const Vec<Real>& p) {
  const Vec<Real> ap = p - t.a;
  const Real d1 = dot(t.ab, ap), d2 = dot(t.ac, ap);
  const Real aa = dot(t.ab, t.ab), bb = dot(t.ac, t.ac), ab = dot(t.ab, t.ac);
  const Vec<Real> from_ab = ap - detail::clamped_ratio(d1, aa) * t.ab;
  TriangleOffset<Real> best{from_ab, squared_length(from_ab)};
  const Vec<Real> from_ac = ap - detail::clamped_ratio(d2, bb) * t.ac;
  detail::keep_nearer(best, from_ac, squared_length(from_ac));
  const Real s = detail::clamped_ratio((d2 - d1) + (aa - ab), (aa - ab) + (bb - ab));
  const Vec<Real> from_bc = (ap - (1.0 - s) * t.ab) - s * t.ac;
  detail::keep_nearer(best, from_bc, squared_length(from_bc));
  const Real v = bb * d1 - ab * d2, w = aa * d2 - ab * d1, det = aa * bb - ab * ab;
  const auto inside = (v >= 0.0) & (w >= 0.0) & (v + w <= det) & (det > 0.0);
  const Real scale = 1.0 / select(inside, det, Real{} + 1.0);
  const Vec<Real> from_foot = (ap - (v * scale) * t.ab) - (w * scale) * t.ac;
  detail::keep_nearer(best, from_foot, select(inside, squared_length(from_foot), best.squared_distance));
  return best;
}

/// A proven lower bound (but for `dual_error`) of the distance from p to the triangle, by the plane that separates them
/// with normal `direction`: min over the corners c of direction . (p - c) / |direction|. Tight when `direction` is the
/// offset from the true closest point. 0 where that plane does not separate.
inline double separation(const CornerTriangle<double>& t, Vec3 p, Vec3 direction) {
  const double norm = length(direction);
  if (!(norm > 0)) return 0;
  const Vec3 ap = p - t.a;
  const double at_a = dot(direction, ap), at_b = dot(direction, ap - t.ab), at_c = dot(direction, ap - t.ac);
  const double least = at_a < at_b ? (at_a < at_c ? at_a : at_c) : (at_b < at_c ? at_b : at_c);
  return least > 0 ? least / norm : 0;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
