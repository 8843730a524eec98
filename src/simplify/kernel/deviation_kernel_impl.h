// SPDX-License-Identifier: MIT
/// Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <bit>
#include <cmath>
#include <span>

#include "simplify/kernel/deviation_kernel.h"
#include "simplify/kernel/sample_kernel_impl.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// Nearer than this share of the tolerance, the way to the closest point is rounding: the normal of the face is not.
constexpr float min_way = 0.02F;

inline Vec<float> unit_normal(const SampleFace& face) {
  const Vec<float> n = cross(face.ab, face.ac);
  const float squared = dot(n, n);
  return squared > 0 ? (1 / std::sqrt(squared)) * n : n;
}

inline void linearise(const SamplePoints& points, std::span<const SampleFace> faces,
                      std::span<const SampleOffsets> offsets, float by_tolerance, LinearDeviations& deviations) {
  deviations.blocks.resize(offsets.size());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const SampleOffsets& at = offsets[i];
    const Float8 x = load8(at.x) * by_tolerance, y = load8(at.y) * by_tolerance, z = load8(at.z) * by_tolerance;
    Float8 deviation = square_root(x * x + y * y + z * z);
    const Float8 by_deviation = 1.0F / deviation;
    Float8 way_x = by_deviation * x, way_y = by_deviation * y, way_z = by_deviation * z;
    for (unsigned on_face = lane_bits(~(deviation > min_way)); on_face != 0; on_face &= on_face - 1) {
      const int k = std::countr_zero(on_face);
      const Vec<float> normal = unit_normal(faces[static_cast<std::size_t>(at.face[k])]);
      way_x[k] = normal.x, way_y[k] = normal.y, way_z[k] = normal.z;
      deviation[k] = dot(normal, {x[k], y[k], z[k]});
    }
    const Float8 weight = load8(points.blocks[i].weight), share = weight * load8(at.share);
    LinearDeviations::Block& block = deviations.blocks[i];
    store8(block.deviation, weight * deviation);
    store8(block.x, share * way_x);
    store8(block.y, share * way_y);
    store8(block.z, share * way_z);
  }
}

/// Weights below 2^-60 of the largest one are left out: sums in single precision would lose them, and arithmetic with
/// numbers below 2^-126 takes some hundred times as long. By doublings k, the square whose power 2^k - 1 is 2^-60.
constexpr float min_squares[] = {1, 0x1p-60F, 0x1p-20F, 0.002629F, 0x1p-4F, 0.2614F};

/// Deviations of one block or of two after a move, with their slopes.
struct MovedLanes {
  Floats x, y, z, deviation;

  MovedLanes(std::span<const LinearDeviations::Block> blocks, std::size_t i, const DeviationKernel::Move& move)
      : x(load<Floats>(blocks, i, &LinearDeviations::Block::x)),
        y(load<Floats>(blocks, i, &LinearDeviations::Block::y)),
        z(load<Floats>(blocks, i, &LinearDeviations::Block::z)),
        deviation(load<Floats>(blocks, i, &LinearDeviations::Block::deviation) - x * move[0] - y * move[1] -
                  z * move[2]) {}
};

/// The sums of `WeightedSums`, by lane.
struct WeightedLanes {
  Floats weight{}, square{}, rx{}, ry{}, rz{}, xx{}, yy{}, zz{}, xy{}, yz{}, zx{};

  /// The weight of a deviation h is (scale h)^2 to the power of 2^doublings - 1.
  void add(const MovedLanes& moved, float scale, int doublings) {
    const auto& [x, y, z, h] = moved;
    Floats power = (h * scale) * (h * scale);
    power = power < broadcast_floats(min_squares[doublings]) ? Floats{} : power;
    Floats w = power;  // to the power of 2^k - 1 after k rounds
    for (int k = 1; k < doublings; ++k) power = power * power, w = w * power;
    const Floats wx = w * x, wy = w * y, wz = w * z;
    weight += w, square += w * h * h;
    rx += wx * h, ry += wy * h, rz += wz * h;
    xx += wx * x, yy += wy * y, zz += wz * z;
    xy += wx * y, yz += wy * z, zx += wz * x;
  }
};

inline WeightedSums weighted_sums(const LinearDeviations& deviations, const DeviationKernel::Move& move, float scale,
                                  int doublings) {
  using L = WeightedLanes;
  const EvenAndOdd<WeightedLanes> lanes(deviations.blocks.size(), [&](L& into, std::size_t i) {
    into.add(MovedLanes(deviations.blocks, i, move), scale, doublings);
  });
  const auto sum = [&](Floats L::*of) {
    float all = 0;
    for (int k = 0; k < 8; ++k) all += lanes.of(of)[k];
    return all;
  };
  return {sum(&L::weight),
          sum(&L::square),
          {sum(&L::rx), sum(&L::ry), sum(&L::rz)},
          {sum(&L::xx), sum(&L::yy), sum(&L::zz), sum(&L::xy), sum(&L::yz), sum(&L::zx)}};
}

inline std::array<float, DeviationKernel::shares> largest_along(
    const LinearDeviations& deviations, const DeviationKernel::Move& move, const DeviationKernel::Move& step,
    const std::array<float, DeviationKernel::shares>& share) {
  Floats largest[DeviationKernel::shares] = {};
  for (std::size_t i = 0; i < deviations.blocks.size(); i += blocks_of<Floats>) {
    const MovedLanes at(deviations.blocks, i, move);
    const Floats change = at.x * step[0] + at.y * step[1] + at.z * step[2];
    for (std::size_t k = 0; k < DeviationKernel::shares; ++k) {
      const Floats after = at.deviation - change * share[k];
      largest[k] = maximum(maximum(after, -after), largest[k]);  // what is no number counts for nothing
    }
  }
  std::array<float, DeviationKernel::shares> result = {};
  for (std::size_t k = 0; k < DeviationKernel::shares; ++k) result[k] = largest_lane(largest[k]);
  return result;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
