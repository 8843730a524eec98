// SPDX-License-Identifier: MIT
/// Compiled once per instruction set.
#pragma once
#include <bit>
#include <cmath>

#include "numeric/simd.h"
#include "simplify/sampled_slope.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline Float8 load8(const float (&lanes)[8]) { return *reinterpret_cast<const Float8*>(lanes); }
inline void store8(float (&lanes)[8], Float8 values) { *reinterpret_cast<Float8*>(lanes) = values; }

inline Float8 clamped(Float8 x) {
  x = x > 0.0F ? x : Float8{};
  return x < 1.0F ? x : broadcast8(1);
}

/// The nearest so far: squared distance, offset from the closest point, the share that corner a has of it, and the
/// face.
struct Closest8 {
  Float8 squared, x, y, z, share, face;

  void offer(Float8 ox, Float8 oy, Float8 oz, Float8 corner_share, Float8 index, Mask8 valid) {
    const Float8 square = ox * ox + oy * oy + oz * oz;
    const Mask8 nearer = (square < squared) & valid;
    squared = nearer ? square : squared;
    x = nearer ? ox : x;
    y = nearer ? oy : y;
    z = nearer ? oz : z;
    share = nearer ? corner_share : share;
    face = nearer ? index : face;
  }
};

constexpr Closest8 nothing_near = {
    {HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF}, {}, {}, {}, {}, {}};

inline void offer_face(const SampleFace& f, float index, Float8 x, Float8 y, Float8 z, Closest8& closest) {
  const Float8 px = x - f.a.x, py = y - f.a.y, pz = z - f.a.z;
  const Float8 on_ab = px * f.ab.x + py * f.ab.y + pz * f.ab.z;
  const Float8 on_ac = px * f.ac.x + py * f.ac.y + pz * f.ac.z;
  const auto offer = [&](Float8 v, Float8 w, Mask8 valid) {
    closest.offer(px - v * f.ab.x - w * f.ac.x, py - v * f.ab.y - w * f.ac.y, pz - v * f.ab.z - w * f.ac.z,
                  1.0F - v - w, broadcast8(index), valid);
  };
  const Mask8 all = Mask8{} == Mask8{};
  const Float8 zero{};
  offer(clamped(on_ab * f.by_ab), zero, all);
  offer(zero, clamped(on_ac * f.by_ac), all);
  const Float8 along = clamped((on_ac - on_ab - f.ab_ac + f.ab_ab) * f.by_bc);
  offer(1.0F - along, along, all);
  const Float8 v = (f.ac_ac * on_ab - f.ab_ac * on_ac) * f.by_area;
  const Float8 w = (f.ab_ab * on_ac - f.ab_ac * on_ab) * f.by_area;
  offer(v, w, (v >= 0.0F) & (w >= 0.0F) & (v + w <= 1.0F));
}

inline Closest8 closest_of(const SamplePoints::Block& points, std::span<const SampleFace> faces) {
  Closest8 at = nothing_near;
  const Float8 x = load8(points.x), y = load8(points.y), z = load8(points.z);
  for (std::size_t k = 0; k < faces.size(); ++k) offer_face(faces[k], static_cast<float>(k), x, y, z, at);
  return at;
}

inline void drop_far(SamplePoints& points, std::span<const SampleFace> faces, float tolerance) {
  constexpr unsigned all_lanes = 0xff;
  for (SamplePoints::Block& block : points.blocks) {
    const Float8 x = load8(block.x), y = load8(block.y), z = load8(block.z);
    Closest8 at = nothing_near;
    unsigned near = 0;
    for (std::size_t k = 0; k < faces.size() && near != all_lanes; ++k) {
      offer_face(faces[k], 0, x, y, z, at);
      near = lane_bits(at.squared <= tolerance * tolerance);
    }
    for (unsigned far = ~near & all_lanes; far != 0; far &= far - 1) block.weight[std::countr_zero(far)] = 0;
  }
}

inline void add_slope(const SamplePoints& points, std::span<const SampleFace> faces, float by_tolerance,
                      SlopeSums& sums) {
  Float8 sum{}, worst{}, gx{}, gy{}, gz{}, xx{}, yy{}, zz{}, xy{}, yz{}, zx{};
  for (const SamplePoints::Block& block : points.blocks) {
    const Closest8 at = closest_of(block, faces);
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
