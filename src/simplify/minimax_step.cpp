// SPDX-License-Identifier: MIT
#include "simplify/minimax_step.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace meshbound {
namespace {

/// Two steps for each p = 4, 8, 16, 32, 64 and two more: then the p-norm is within a few percent of the maximum.
constexpr int max_norm_steps = 12;
constexpr int max_doublings = 5;
/// Where all slopes are parallel nothing is known across them; this share of the mean curvature is added to all.
constexpr float damping = 1e-3F;
/// Cube roots of p - 1 for the p above: Newton's step on the p-norm is 1 / (p - 1) of the one that solves the weighted
/// equations, and four shares from the one to the other are tried in equal ratios.
constexpr std::array<float, max_doublings> cube_roots = {1.44225F, 1.91293F, 2.46621F, 3.14138F, 3.97906F};

std::array<float, DeviationKernel::shares> shares_of_step(int doublings) {
  const float ratio = cube_roots[static_cast<std::size_t>(doublings - 1)];
  std::array<float, DeviationKernel::shares> shares = {};
  shares[0] = 1 / static_cast<float>((2 << doublings) - 1);
  for (std::size_t k = 1; k < shares.size(); ++k) shares[k] = shares[k - 1] * ratio;
  return shares;
}

/// By cofactors: after damping the condition is at most some thousands.
DeviationKernel::Move solve(const WeightedSums& sums, float mean_curvature) {
  const auto& m = sums.matrix;
  Eigen::Matrix3d matrix;
  matrix << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  matrix.diagonal().array() += damping * mean_curvature;
  const Eigen::Vector3f step =
      (matrix.inverse() * Eigen::Vector3d(sums.right[0], sums.right[1], sums.right[2])).cast<float>();
  return {step[0], step[1], step[2]};
}

}  // namespace

MinimaxStep minimax_step(const LinearDeviations& deviations, const DeviationKernel& kernel, float low_deviation) {
  DeviationKernel::Move move = {};
  float largest = kernel.largest_along(deviations, move, {}, {})[0];
  MinimaxStep result{largest, largest, {}};
  for (int k = 0; k < max_norm_steps && largest > low_deviation; ++k) {
    const int doublings = std::min(1 + k / 2, max_doublings);
    const WeightedSums sums = kernel.weighted_sums(deviations, move, 1 / largest, doublings);
    const float mean = (sums.matrix[0] + sums.matrix[1] + sums.matrix[2]) / 3;
    if (!(mean > 0)) break;
    const DeviationKernel::Move step = solve(sums, mean);
    // A weighted mean of squares is no larger than the largest one, wherever the vertex is: Lawson's bound.
    const float min_mean =
        (sums.square - step[0] * sums.right[0] - step[1] * sums.right[1] - step[2] * sums.right[2]) / sums.weight;
    if (min_mean > hopeless_deviation * hopeless_deviation) {
      result.there = std::sqrt(min_mean);
      return result;
    }
    const auto shares = shares_of_step(doublings);
    const auto after = kernel.largest_along(deviations, move, step, shares);
    const auto best = std::min_element(after.begin(), after.end());
    if (!(*best < largest)) {
      if (doublings == max_doublings) break;
      continue;
    }
    largest = *best;
    const float share = shares[static_cast<std::size_t>(best - after.begin())];
    for (std::size_t i = 0; i < 3; ++i) move[i] += share * step[i];
  }
  result.there = largest;
  result.move = move;
  return result;
}

}  // namespace meshbound
