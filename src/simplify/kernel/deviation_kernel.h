// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <span>
#include <vector>

#include "simplify/kernel/sample_kernel.h"

namespace meshbound {

/// Distances of sample points as linear functions of the motion d of one vertex: deviation - (x, y, z).d, in blocks of
/// eight. A point whose closest point lies on a moved face at the barycentric share s of the vertex, in direction n,
/// has the slope s n; the closest points stay where they are on their faces.
struct LinearDeviations {
  struct alignas(32) Block {
    float deviation[8] = {}, x[8] = {}, y[8] = {}, z[8] = {};
    bool operator==(const Block&) const = default;
  };
  std::vector<Block> blocks;

  /// Adds one deviation, in a block of its own.
  void add(float deviation, float slope_x, float slope_y, float slope_z) {
    Block& block = blocks.emplace_back();
    block.deviation[0] = deviation;
    block.x[0] = slope_x, block.y[0] = slope_y, block.z[0] = slope_z;
  }
};

/// Sums over deviations h with slopes g and weights w = |h|^(p - 2): the normal equations of the step that lowers them.
struct WeightedSums {
  float weight = 0, square = 0;      ///< sums of w and of w h^2
  std::array<float, 3> right = {};   ///< sum of w h g
  std::array<float, 6> matrix = {};  ///< sum of w g g: xx, yy, zz, xy, yz, zx
};

/// The inner loops over linear deviations, see `SimplifyKernels`.
struct DeviationKernel {
  static constexpr std::size_t shares = 4;
  using Move = std::array<float, 3>;

  /// The deviation of each point from the face nearest to it, linear in the motion of corner a of every face. Lengths
  /// are multiplied by `by_tolerance`.
  void (*linearise)(const SamplePoints& points, std::span<const SampleFace> faces,
                    std::span<const SampleOffsets> offsets, float by_tolerance, LinearDeviations& deviations);
  /// Sums after the move, for p = 2^(doublings + 1). `scale` times the largest deviation must be about 1 or less.
  WeightedSums (*weighted_sums)(const LinearDeviations& deviations, const Move& move, float scale, int doublings);
  /// The largest deviation after the move and each of some shares of a step beyond.
  std::array<float, shares> (*largest_along)(const LinearDeviations& deviations, const Move& move, const Move& step,
                                             const std::array<float, shares>& share);
};

}  // namespace meshbound
