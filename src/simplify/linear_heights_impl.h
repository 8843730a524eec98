// SPDX-License-Identifier: MIT
/// Compiled once per instruction set.
#pragma once
#include <cmath>

#include "simplify/linear_heights.h"
#include "simplify/sampled_slope_impl.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// Nearer than this share of the tolerance, the way to the closest point is rounding: the normal of the face is not.
constexpr float least_way = 0.02F;

inline Vec<float> unit_normal(const SampleFace& face) {
  const Vec<float> n = cross(face.ab, face.ac);
  const float squared = dot(n, n);
  return squared > 0 ? (1 / std::sqrt(squared)) * n : n;
}

inline void linearise(const SamplePoints& points, std::span<const SampleFace> faces, float by_tolerance,
                      LinearHeights& heights) {
  heights.resize(points.size());
  for (std::size_t i = 0; i < points.size(); i += 8) {
    const Closest8 at = closest_of(points, i, faces);
    for (int k = 0; k < 8; ++k) {
      const std::size_t j = i + static_cast<std::size_t>(k);
      const Vec<float> offset = {at.x[k] * by_tolerance, at.y[k] * by_tolerance, at.z[k] * by_tolerance};
      float height = std::sqrt(dot(offset, offset));
      Vec<float> way = offset;
      if (height > least_way) {
        way = (1 / height) * offset;
      } else {
        way = unit_normal(faces[static_cast<std::size_t>(at.face[k])]);
        height = dot(way, offset);
      }
      const float weight = points.weight[j], share = weight * at.share[k];
      heights.height[j] = weight * height;
      heights.x[j] = share * way.x, heights.y[j] = share * way.y, heights.z[j] = share * way.z;
    }
  }
}

inline float sum_of_lanes(Float8 eight) {
  float sum = 0;
  for (int k = 0; k < 8; ++k) sum += eight[k];
  return sum;
}

inline WeightedSums weighted_sums(const LinearHeights& heights, const HeightKernel::Move& move, float scale,
                                  int doublings) {
  Float8 weight{}, square{}, rx{}, ry{}, rz{}, xx{}, yy{}, zz{}, xy{}, yz{}, zx{};
  for (std::size_t i = 0; i < heights.height.size(); i += 8) {
    const Float8 x = load8(heights.x, i), y = load8(heights.y, i), z = load8(heights.z, i);
    const Float8 h = load8(heights.height, i) - x * move[0] - y * move[1] - z * move[2];
    Float8 power = (h * scale) * (h * scale), w = power;  // to the power of 2^k - 1 after k rounds
    for (int k = 1; k < doublings; ++k) power = power * power, w = w * power;
    const Float8 wx = w * x, wy = w * y, wz = w * z;
    weight += w, square += w * h * h;
    rx += wx * h, ry += wy * h, rz += wz * h;
    xx += wx * x, yy += wy * y, zz += wz * z;
    xy += wx * y, yz += wy * z, zx += wz * x;
  }
  return {sum_of_lanes(weight),
          sum_of_lanes(square),
          {sum_of_lanes(rx), sum_of_lanes(ry), sum_of_lanes(rz)},
          {sum_of_lanes(xx), sum_of_lanes(yy), sum_of_lanes(zz), sum_of_lanes(xy), sum_of_lanes(yz), sum_of_lanes(zx)}};
}

inline std::array<float, HeightKernel::shares> largest_along(const LinearHeights& heights,
                                                             const HeightKernel::Move& move,
                                                             const HeightKernel::Move& step,
                                                             const std::array<float, HeightKernel::shares>& share) {
  Float8 largest[HeightKernel::shares] = {};
  for (std::size_t i = 0; i < heights.height.size(); i += 8) {
    const Float8 x = load8(heights.x, i), y = load8(heights.y, i), z = load8(heights.z, i);
    const Float8 h = load8(heights.height, i) - x * move[0] - y * move[1] - z * move[2];
    const Float8 change = x * step[0] + y * step[1] + z * step[2];
    for (std::size_t k = 0; k < HeightKernel::shares; ++k) {
      const Float8 after = h - change * share[k];
      largest[k] = maximum(largest[k], maximum(after, -after));
    }
  }
  std::array<float, HeightKernel::shares> result = {};
  for (std::size_t k = 0; k < HeightKernel::shares; ++k) {
    for (int lane = 0; lane < 8; ++lane) result[k] = std::fmax(result[k], largest[k][lane]);
  }
  return result;
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
