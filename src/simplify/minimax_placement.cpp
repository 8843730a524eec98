// SPDX-License-Identifier: MIT
#include "simplify/minimax_placement.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "geometry/point_triangle.h"

namespace meshbound {
namespace {

/// Enough to see the shape of a neighbourhood; more only cost time.
constexpr std::size_t most_samples = 192;
/// Fewer corners of the original leave too much between them: middles of its edges are sampled as well, up to this many
/// samples.
constexpr std::size_t most_with_middles = 384;
/// One sample in this many tells for most edges that there is nothing to gain.
constexpr std::size_t coarseness = 6;

/// A move that makes the largest height smaller than this, in tolerances, is good enough.
constexpr float low_height = 0.9F;
/// No proof is expected where some height stays above this, in tolerances: closest points move, by which a tenth may
/// be gained.
constexpr float hopeless_height = 1.1F;

/// Two steps for each p = 4, 8, 16, 32, 64 and two more: then the p-norm is within a few percent of the maximum.
constexpr int most_steps = 12;
constexpr int most_doublings = 5;
/// Where all slopes are parallel nothing is known across them; this share of the mean curvature is added to all.
constexpr float damping = 1e-3F;
/// Of p - 1 for the p above: Newton's step on the p-norm is 1 / (p - 1) of the one that solves the weighted equations,
/// and shares between the two are tried in equal ratios.
constexpr std::array<float, most_doublings> sixth_roots = {1.20094F, 1.38309F, 1.57042F, 1.77250F, 1.99477F};

std::array<float, HeightKernel::shares> shares_of_step(int doublings) {
  const float ratio = sixth_roots[static_cast<std::size_t>(doublings - 1)];
  std::array<float, HeightKernel::shares> shares = {};
  shares[0] = 1 / (static_cast<float>((2 << doublings) - 1) * ratio);
  for (std::size_t k = 1; k < shares.size(); ++k) shares[k] = shares[k - 1] * ratio;
  return shares;
}

HeightKernel::Move solve(const WeightedSums& sums, float mean_curvature) {
  const auto& m = sums.matrix;
  Eigen::Matrix3f matrix;
  matrix << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  matrix.diagonal().array() += damping * mean_curvature;
  const Eigen::Vector3f step = matrix.ldlt().solve(Eigen::Vector3f(sums.right[0], sums.right[1], sums.right[2]));
  return {step[0], step[1], step[2]};
}

std::size_t stride_of(std::size_t points, std::size_t room) { return (points + room - 1) / room; }

}  // namespace

void MinimaxPlacement::begin(double tolerance, std::span<const std::uint32_t> originals, std::span<const Corners> faces,
                             std::uint32_t hint) {
  by_tolerance_ = 1 / tolerance;
  hint_ = hint;
  few_.clear();
  if (faces.empty()) return;
  origin_ = faces.front()[0];
  set_faces(faces, removed_);
  corners_of_originals_ = corners_.of(originals);
  originals_ = originals;
  take_samples(coarseness, few_);
  only_few_ = true;
}

void MinimaxPlacement::set_faces(std::span<const Corners> faces, std::vector<SampleFace>& to) const {
  to.clear();
  for (const Corners& c : faces) to.emplace_back(c[0] - origin_, c[1] - origin_, c[2] - origin_);
}

/// One in `coarseness` of the corners and middles that there is room for.
void MinimaxPlacement::take_samples(std::size_t coarseness, SamplePoints& to) const {
  const std::size_t stride = stride_of(corners_of_originals_.size(), most_samples);
  std::size_t next = 0, at = 0;  // of all samples
  for (std::size_t i = 0; i < corners_of_originals_.size(); i += stride, ++at) {
    if (at != next) continue;
    to.add(vertices_[corners_of_originals_[i]] - origin_);
    next += coarseness;
  }
  if (stride <= 1) take_middles(coarseness, next, at, to);
  // Triangles that reach over the rim of the change have corners that other faces answer for.
  slope_kernel_.drop_far(to, removed_, static_cast<float>(1 / by_tolerance_));
}

void MinimaxPlacement::take_middles(std::size_t coarseness, std::size_t next, std::size_t at, SamplePoints& to) const {
  const std::size_t step = stride_of(3 * originals_.size() / 2, most_with_middles - at);
  std::size_t skip = 0;
  for (const std::uint32_t t : originals_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t u = triangles_[t][k], v = triangles_[t][(k + 1) % 3];
      if (u > v) continue;  // seen from the other side
      if (skip-- > 0) continue;
      skip = step - 1;
      if (at++ != next) continue;
      to.add(0.5 * (vertices_[u] + vertices_[v]) - origin_);
      next += coarseness;
    }
  }
}

/// The vertex that moves, against the original.
void MinimaxPlacement::add_vertex(Vec3 p, Proximity& original) {
  (void)original.upper_distance({p.x, p.y, p.z}, hint_);
  const auto& t = triangles_[hint_];
  const CornerTriangle<double> nearest{vertices_[t[0]], vertices_[t[1]] - vertices_[t[0]],
                                       vertices_[t[2]] - vertices_[t[0]]};
  const Vec3 offset = by_tolerance_ * closest_on_triangle(nearest, p).offset;
  const double height = std::sqrt(squared_length(offset));
  if (!(height > 0)) return;
  // It is the vertex that moves here, not the closest point.
  const auto slope = [&](double component) { return static_cast<float>(-component / height); };
  heights_.add(static_cast<float>(height), slope(offset.x), slope(offset.y), slope(offset.z));
}

MinimaxPlacement::Step MinimaxPlacement::step(std::span<const Corners> faces, Proximity& original) {
  if (faces.empty()) return {};
  set_faces(faces, faces_);
  if (only_few_) {
    const Step step = step_by(few_, faces.front()[0], original);
    if (step.there > hopeless_height) return step;
    only_few_ = false;
    samples_.clear();
    take_samples(1, samples_);
  }
  return step_by(samples_, faces.front()[0], original);
}

MinimaxPlacement::Step MinimaxPlacement::step_by(const SamplePoints& samples, Vec3 vertex, Proximity& original) {
  kernel_.linearise(samples, faces_, static_cast<float>(by_tolerance_), heights_);
  add_vertex(vertex, original);
  return lowered();
}

MinimaxPlacement::Step MinimaxPlacement::lowered() const {
  HeightKernel::Move move = {};
  float largest = kernel_.largest_along(heights_, move, {}, {})[0];
  Step result{largest, largest, {}};
  for (int k = 0; k < most_steps && largest > low_height; ++k) {
    const int doublings = std::min(1 + k / 2, most_doublings);
    const WeightedSums sums = kernel_.weighted_sums(heights_, move, 1 / largest, doublings);
    const float mean = (sums.matrix[0] + sums.matrix[1] + sums.matrix[2]) / 3;
    if (!(mean > 0)) break;
    const HeightKernel::Move step = solve(sums, mean);
    // A weighted mean of squares is no larger than the largest one, wherever the vertex is: Lawson's bound.
    const float least_mean =
        (sums.square - step[0] * sums.right[0] - step[1] * sums.right[1] - step[2] * sums.right[2]) / sums.weight;
    if (least_mean > hopeless_height * hopeless_height) {
      result.there = std::sqrt(least_mean);
      return result;
    }
    const auto shares = shares_of_step(doublings);
    const auto after = kernel_.largest_along(heights_, move, step, shares);
    const auto least = std::min_element(after.begin(), after.end());
    if (!(*least < largest)) {
      if (doublings == most_doublings) break;
      continue;
    }
    largest = *least;
    const float share = shares[static_cast<std::size_t>(least - after.begin())];
    for (std::size_t i = 0; i < 3; ++i) move[i] += share * step[i];
  }
  result.there = largest;
  result.move = (1 / by_tolerance_) * Vec3{move[0], move[1], move[2]};
  return result;
}

}  // namespace meshbound
