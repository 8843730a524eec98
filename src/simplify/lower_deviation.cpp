// SPDX-License-Identifier: MIT
#include "simplify/lower_deviation.h"

#include <Eigen/Dense>

#include "geometry/triangle_corners.h"

namespace meshbound {
namespace {

/// The curvature across the normal vanishes where the surface is flat; this share of the mean one is added to all.
constexpr double newton_damping = 1e-3;
constexpr double shorter_step = 0.35;
/// Longest step, as a share of the mean length of the edges.
constexpr double max_step = 0.5;

double mean_edge(std::span<const TriangleCorners> faces) {
  double sum = 0;
  for (const TriangleCorners& c : faces) sum += length(c[1] - c[0]);
  return sum / static_cast<double>(faces.size());
}

/// In tolerances; zero where the sums tell nothing.
Vec3 newton_step(const DeviationSums& sums) {
  const double* c = sums.curvature;
  Eigen::Matrix3d curvature;
  curvature << c[0], c[3], c[5], c[3], c[1], c[4], c[5], c[4], c[2];
  const double mean = curvature.trace() / 3;
  if (!(mean > 0)) return {0, 0, 0};
  curvature.diagonal().array() += newton_damping * mean;
  const Eigen::Vector3d step =
      -curvature.ldlt().solve(Eigen::Vector3d(sums.gradient[0], sums.gradient[1], sums.gradient[2]));
  return {step.x(), step.y(), step.z()};
}

}  // namespace

LoweredDeviation lower_deviation(LocalEdit& edit, Vec3 start, double tolerance, const DeviationSearch& search) {
  LoweredDeviation result{start, 0, edit.deviation()};
  result.before = result.lowest.sum;
  const double reach = max_step * mean_edge(edit.faces());
  bool gains = true;
  for (int k = 0; k < search.max_steps && gains && result.lowest.worst_squared > search.enough_squared; ++k) {
    gains = false;
    Vec3 step = tolerance * newton_step(result.lowest);
    const double way = length(step);
    if (!(way > 0)) break;
    if (way > reach) step = (reach / way) * step;
    for (int attempt = 0; attempt < search.max_attempts; ++attempt, step = shorter_step * step) {
      if (!edit.place(result.point + step)) continue;
      const DeviationSums there = edit.deviation(result.lowest.sum);
      if (!(there.sum < result.lowest.sum)) continue;
      gains = there.sum < (1 - search.min_gain) * result.lowest.sum;
      result.point = result.point + step;
      result.lowest = there;
      break;
    }
  }
  (void)edit.place(result.point);
  return result;
}

}  // namespace meshbound
