// SPDX-License-Identifier: MIT
/// Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <cmath>

#include "numeric/simd.h"
#include "simplify/kernel/sample_kernel.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline Float8 load8(const float (&lanes)[8]) { return *reinterpret_cast<const Float8*>(lanes); }
inline void store8(float (&lanes)[8], Float8 values) { *reinterpret_cast<Float8*>(lanes) = values; }

inline Float8 clamped(Float8 x, Float8 max) { return minimum(maximum(x, Float8{}), max); }

/// Offsets from closest points, by lane, and the share that corner a has of these.
struct Offset8 {
  Float8 x, y, z, share, squared;

  Offset8(Float8 ox, Float8 oy, Float8 oz, Float8 share_of_corner)
      : x(ox), y(oy), z(oz), share(share_of_corner), squared(ox * ox + oy * oy + oz * oz) {}
  [[nodiscard]] Offset8 or_nearer(const Offset8& other) const {
    const Mask8 nearer = other.squared < squared;
    Offset8 result = *this;
    result.x = nearer ? other.x : x;
    result.y = nearer ? other.y : y;
    result.z = nearer ? other.z : z;
    result.share = nearer ? other.share : share;
    result.squared = nearer ? other.squared : squared;
    return result;
  }
};

/// The least of the squared lengths of offsets, by lane.
struct LeastSquared8 {
  Float8 squared;

  explicit LeastSquared8(const Offset8& offset) : squared(offset.squared) {}
  [[nodiscard]] LeastSquared8 or_nearer(const Offset8& other) const {
    LeastSquared8 result = *this;
    result.squared = minimum(other.squared, squared);
    return result;
  }
};

/// What `Nearest` keeps of the offset from the closest point of a face. For any w the nearest point of the line through
/// w on ac and parallel to ab is found first: with the best w, that is the closest point unless it lies on ac or bc. A
/// shared side ac is left to the other face.
template <class Nearest>
inline Nearest nearest_on(const SampleFace& f, Float8 x, Float8 y, Float8 z) {
  const Float8 one = broadcast8(1);
  const Float8 px = x - f.a.x, py = y - f.a.y, pz = z - f.a.z;
  const Float8 on_ab = px * f.ab.x + py * f.ab.y + pz * f.ab.z;
  const Float8 on_ac = px * f.ac.x + py * f.ac.y + pz * f.ac.z;
  const Float8 w = clamped((f.ab_ab * on_ac - f.ab_ac * on_ab) * f.by_area, one);
  const Float8 v = clamped((on_ab - w * f.ab_ac) * f.by_ab, one - w);
  const Offset8 inside(px - v * f.ab.x - w * f.ac.x, py - v * f.ab.y - w * f.ac.y, pz - v * f.ab.z - w * f.ac.z,
                       one - v - w);
  const Float8 along = clamped((on_ac - on_ab - f.ab_ac + f.ab_ab) * f.by_bc, one), back = one - along;
  const Offset8 from_bc(px - back * f.ab.x - along * f.ac.x, py - back * f.ab.y - along * f.ac.y,
                        pz - back * f.ab.z - along * f.ac.z, Float8{});
  if (f.shares_ac) return Nearest(inside).or_nearer(from_bc);
  const Float8 on = clamped(on_ac * f.by_ac, one);
  const Offset8 from_ac(px - on * f.ac.x, py - on * f.ac.y, pz - on * f.ac.z, one - on);
  return Nearest(inside).or_nearer(from_ac).or_nearer(from_bc);
}

/// The offset from the nearest face so far, and which one it is.
struct Closest8 {
  Offset8 offset{Float8{}, Float8{}, broadcast8(HUGE_VALF), Float8{}};
  Float8 face{};

  void offer(const Offset8& other, Float8 index) {
    face = other.squared < offset.squared ? index : face;
    offset = offset.or_nearer(other);
  }
};

inline Closest8 closest_of(const SamplePoints::Block& points, std::span<const SampleFace> faces) {
  Closest8 at;
  const Float8 x = load8(points.x), y = load8(points.y), z = load8(points.z);
  for (std::size_t k = 0; k < faces.size(); ++k)
    at.offer(nearest_on<Offset8>(faces[k], x, y, z), broadcast8(static_cast<float>(k)));
  return at;
}

inline void offsets(std::span<const SamplePoints::Block> points, std::span<const SampleFace> faces,
                    std::span<SampleOffsets> offsets) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [at, face] = closest_of(points[i], faces);
    store8(offsets[i].x, at.x);
    store8(offsets[i].y, at.y);
    store8(offsets[i].z, at.z);
    store8(offsets[i].squared, at.squared);
    store8(offsets[i].share, at.share);
    store8(offsets[i].face, face);
  }
}

inline void distances(std::span<const SamplePoints::Block> points, std::span<const SampleFace> faces,
                      std::span<SampleDistances> distances) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Float8 x = load8(points[i].x), y = load8(points[i].y), z = load8(points[i].z);
    Float8 least = broadcast8(HUGE_VALF), face{};
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const Float8 squared = nearest_on<LeastSquared8>(faces[k], x, y, z).squared;
      face = squared < least ? broadcast8(static_cast<float>(k)) : face;
      least = minimum(squared, least);
    }
    store8(distances[i].squared, least);
    store8(distances[i].face, face);
  }
}

inline void add_deviations(const SamplePoints& points, std::span<const SampleFace> faces, float by_tolerance,
                           DeviationSums& sums) {
  Float8 sum{}, worst{}, gx{}, gy{}, gz{}, xx{}, yy{}, zz{}, xy{}, yz{}, zx{};
  for (const SamplePoints::Block& block : points.blocks) {
    const Offset8 at = closest_of(block, faces).offset;
    const Float8 weight = load8(block.weight);
    const Float8 square = weight * at.squared * (by_tolerance * by_tolerance);
    const Float8 ox = at.x * by_tolerance, oy = at.y * by_tolerance, oz = at.z * by_tolerance;
    const Float8 fourth = weight * square * square;
    const Float8 first = at.share * fourth, second = at.share * at.share * square;
    sum += fourth * square;
    worst = maximum(worst, square);
    gx += first * ox, gy += first * oy, gz += first * oz;
    xx += second * ox * ox, yy += second * oy * oy, zz += second * oz * oz;
    xy += second * ox * oy, yz += second * oy * oz, zx += second * oz * ox;
  }
  for (int k = 0; k < 8; ++k) {
    sums.sum += double{sum[k]};
    sums.worst_squared = std::fmax(sums.worst_squared, double{worst[k]});
    sums.gradient[0] -= 6 * double{gx[k]}, sums.gradient[1] -= 6 * double{gy[k]}, sums.gradient[2] -= 6 * double{gz[k]};
    sums.curvature[0] += 30 * double{xx[k]}, sums.curvature[1] += 30 * double{yy[k]};
    sums.curvature[2] += 30 * double{zz[k]}, sums.curvature[3] += 30 * double{xy[k]};
    sums.curvature[4] += 30 * double{yz[k]}, sums.curvature[5] += 30 * double{zx[k]};
  }
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
