// SPDX-License-Identifier: MIT
/// Triangles in single precision, each seen from several points at once, in coordinates around a centre nearby: bounds
/// of distances that tell which triangles need doubles. Compiled once per instruction set (numeric/isa.h).
///
/// Let u = 2^-24 and m be at least the magnitude of every coordinate. Corners and points are rounded to floats with an
/// error of u m a coordinate. Whatever o is, the distance of p from a triangle is at least the least o . (p - c) / |o|
/// over its corners c, as in numeric/rounding.h. As computed, by o . (p - a) - o . (c - a), that errs by 4um (corners
/// and points), 7um (the two differences), 21um (the products with o, 3u of at most 2 sqrt(3) m each) and 4um (the last
/// difference). The comparison of its square with r^2 o.o errs by 5u of at most 2 sqrt(3) m, less than 18um. Together
/// less than 64um, which is `float_error` m. For r >= 2^-30, and with o.o taken as 2^-62 at least, all numbers of the
/// comparison are normal or too small to pass it. None overflows while m < 2^14.
#pragma once
#include <cstddef>

#include "geometry/vec3.h"
#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline constexpr float float_error = 64 * 0x1p-24F;
inline constexpr float min_float_error = 0x1p-30F;

/// As `dot` and `squared_length`, with fewer roundings where the machine can do that.
inline Floats product(const Vec<Floats>& a, const Vec<Floats>& b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}
inline Floats squared_size(const Vec<Floats>& a) { return product(a, a); }
/// a - s b
inline Vec<Floats> less_times(const Vec<Floats>& a, const Floats& s, const Vec<Floats>& b) {
  return {multiply_add(-s, b.x, a.x), multiply_add(-s, b.y, a.y), multiply_add(-s, b.z, a.z)};
}

/// A point of a triangle that is nearly the closest to each of the points, by the vector o from there.
struct FloatOffset {
  Floats squared;  ///< o.o
  Floats along;    ///< the least o . (p - c) over the corners c

  /// A bit for each lane whose point is proven to be further away than `distance`, given `distance` + `float_error` m.
  [[nodiscard]] unsigned lanes_beyond(const Floats& distance_and_error) const {
    const Floats length_squared = maximum(squared, broadcast_floats(0x1p-62F));
    return less_bits(Floats{}, along) &
           less_bits((distance_and_error * distance_and_error) * length_squared, along * along);
  }
};

/// As many triangles as floats have lanes, and what of each does not depend on the points.
class FloatTriangles {
 public:
  static constexpr std::size_t width = floats_width;

  /// By their corners, lane by lane.
  FloatTriangles(const Vec<Floats>& a, const Vec<Floats>& b, const Vec<Floats>& c)
      : a_(a),
        ab_(b - a),
        ac_(c - a),
        bc_(c - b),
        lo_{minimum(a.x, minimum(b.x, c.x)), minimum(a.y, minimum(b.y, c.y)), minimum(a.z, minimum(b.z, c.z))},
        hi_{maximum(a.x, maximum(b.x, c.x)), maximum(a.y, maximum(b.y, c.y)), maximum(a.z, maximum(b.z, c.z))},
        per_ab_(reciprocal(product(ab_, ab_))),
        ab_ac_(product(ab_, ac_)),
        bc_ab_(product(bc_, ab_)),
        per_ac_(reciprocal(product(ac_, ac_))),
        per_bc_(reciprocal(product(bc_, bc_))) {
    across_ = ac_ - (ab_ac_ * per_ab_) * ab_;
    per_across_ = reciprocal(product(across_, across_));
  }

  /// The largest magnitude of a coordinate of each.
  [[nodiscard]] Floats magnitude() const {
    return maximum(maximum(maximum(hi_.x, -lo_.x), maximum(hi_.y, -lo_.y)), maximum(hi_.z, -lo_.z));
  }

  /// The squared distances from the points to the box of triangle i.
  [[nodiscard]] Floats box_squared(std::size_t i, const Vec<Floats>& p) const {
    const Vec<Floats> below = at(lo_, i) - p, above = p - at(hi_, i);
    const Floats x = maximum(maximum(below.x, above.x), Floats{}), y = maximum(maximum(below.y, above.y), Floats{}),
                 z = maximum(maximum(below.z, above.z), Floats{});
    return squared_size({x, y, z});
  }

  /// As `closest_on_triangle`, with less care for slivers: no bound depends on how near the point comes.
  [[nodiscard]] FloatOffset offset(std::size_t i, const Vec<Floats>& p) const {
    const Floats one = broadcast_floats(1.0F);
    const Vec<Floats> ab = at(ab_, i), ac = at(ac_, i), ap = p - at(a_, i);
    const Floats ab_ap = product(ab, ap), ac_ap = product(ac, ap);
    const Floats w = clamped(product(at(across_, i), ap) * broadcast_floats(per_across_[i]), one);
    const Floats v =
        clamped(multiply_add(-w, broadcast_floats(ab_ac_[i]), ab_ap) * broadcast_floats(per_ab_[i]), one - w);
    Vec<Floats> best = less_times(less_times(ap, v, ab), w, ac);
    Floats squared = squared_size(best);
    keep_nearer(best, squared, less_times(ap, clamped(ac_ap * broadcast_floats(per_ac_[i]), one), ac));
    const Floats along_bc = (ac_ap - ab_ap - broadcast_floats(bc_ab_[i])) * broadcast_floats(per_bc_[i]);
    keep_nearer(best, squared, less_times(ap - ab, clamped(along_bc, one), at(bc_, i)));
    const Floats at_a = product(best, ap);
    return {squared, minimum(at_a, minimum(at_a - product(best, ab), at_a - product(best, ac)))};
  }

 private:
  static Floats reciprocal(const Floats& x) {
    return x > 0.0F ? 1.0F / (x > 0.0F ? x : broadcast_floats(1.0F)) : Floats{};
  }
  static Floats clamped(const Floats& x, const Floats& max) { return maximum(minimum(x, max), Floats{}); }
  static void keep_nearer(Vec<Floats>& best, Floats& squared, const Vec<Floats>& offset) {
    const Floats other = squared_size(offset);
    const FloatsMask nearer = other < squared;
    best.x = nearer ? offset.x : best.x;
    best.y = nearer ? offset.y : best.y;
    best.z = nearer ? offset.z : best.z;
    squared = minimum(squared, other);
  }
  [[nodiscard]] static Vec<Floats> at(const Vec<Floats>& of_triangles, std::size_t i) {
    return {broadcast_floats(of_triangles.x[i]), broadcast_floats(of_triangles.y[i]),
            broadcast_floats(of_triangles.z[i])};
  }

  Vec<Floats> a_, ab_, ac_, bc_, lo_, hi_, across_;
  Floats per_ab_, ab_ac_, bc_ab_, per_ac_, per_bc_, per_across_;
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
