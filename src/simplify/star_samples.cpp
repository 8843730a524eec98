// SPDX-License-Identifier: MIT
#include "simplify/star_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/boxes.h"
#include "geometry/point_triangle.h"
#include "numeric/no_index.h"
#include "numeric/sort_keys.h"

namespace meshbound {
namespace {

/// Most samples that faces beside the star may hold: only few lie at its rim.
constexpr std::size_t max_outside = 8;

/// Samples of a star above which it is thinned out.
constexpr std::size_t max_samples = 96;
/// Cells along the curve that pairs them, as a power of two: a few thousand to an axis. What they leave of 64 bits is
/// for the index of a sample.
constexpr int curve_bits = 12, index_bits = 64 - 3 * curve_bits;

constexpr std::size_t lanes = 8;

/// Where only one point is looked at a walk costs more: with 1 a run executes 6% more instructions (seven meshes at
/// 0.1%).
constexpr int min_points_of_walk = 2;
/// It goes on where an edge is up to so many tolerances away, to find where it is farthest: a placement that is better
/// only at the first point that is too far away has to be tried again. With 1 a run executes 11% more instructions
/// (five meshes at 0.1%).
constexpr double reach_of_walk = 2;
/// Originals that it passes: where more lie below an edge, the rest is looked at point by point. With 64 a run executes
/// 0.6% more instructions (seven meshes at 0.1%).
constexpr int max_passes_to_look = 16;

/// Blocks of samples that are compared before it is looked whether they hold.
constexpr std::size_t blocks_at_a_time = 4;

}  // namespace

void StarSamples::begin(Vec3 origin) {
  origin_ = origin;
  points_.clear();
  ids_.clear();
}

/// Takes one sample of each list at a time: lists wait for memory at each sample, and so they wait together.
void StarSamples::add_faces(std::span<const std::uint32_t> faces) {
  const Samples& samples = state_.samples;
  next_.clear();
  for (const std::uint32_t face : faces) {
    if (samples.first(face) == no_index) continue;
    samples.prefetch(samples.first(face));
    next_.push_back(samples.first(face));
  }
  while (!next_.empty()) {
    std::size_t left = 0, place = ids_.size();
    ids_.resize(place + next_.size());
    for (const std::uint32_t s : next_) {
      ids_[place++] = s;
      points_.add(samples.at(s) - origin_);
      const std::uint32_t following = samples.following(s);
      if (following == no_index) continue;
      samples.prefetch(following);
      next_[left++] = following;
    }
    next_.resize(left);
  }
}

void StarSamples::compare(std::span<const SampleFace> faces) {
  faces_ = faces;
  compared_ = 0;
  offsets_.resize(points_.blocks.size());
}

void StarSamples::compare_blocks(std::size_t end) {
  const std::size_t count = end - compared_;
  kernel_.offsets(std::span(points_.blocks).subspan(compared_, count), faces_,
                  std::span(offsets_).subspan(compared_, count));
  compared_ = end;
}

std::span<const SampleOffsets> StarSamples::offsets() {
  compare_blocks(offsets_.size());
  return offsets_;
}

/// Most trials that fail do so at one of the first samples.
bool StarSamples::hold(std::span<const std::uint32_t> beside, double limit) {
  outside_.clear();
  const auto squared_limit = static_cast<float>(limit * limit);
  for (std::size_t b = 0; b < offsets_.size(); ++b) {
    if (b == compared_) compare_blocks(std::min(b + blocks_at_a_time, offsets_.size()));
    float largest = 0;
    for (std::size_t k = 0; k < lanes; ++k) {
      const float squared = points_.blocks[b].weight[k] * offsets_[b].squared[k];
      largest = squared > largest ? squared : largest;
    }
    if (largest <= squared_limit) continue;
    for (std::size_t k = 0; k < lanes && lanes * b + k < points_.size(); ++k) {
      if (offsets_[b].squared[k] <= squared_limit) continue;
      if (outside_.size() == max_outside) return false;
      const std::uint32_t face = face_beside(lanes * b + k, beside, squared_limit);
      if (face == no_index) return false;
      outside_.emplace_back(lanes * b + k, face);
    }
  }
  return true;
}

/// A face of those beside the star that is near the point, or none.
std::uint32_t StarSamples::face_beside(std::size_t i, std::span<const std::uint32_t> beside,
                                       float squared_limit) const {
  const Vec3 p = points_.at(i) + origin_;
  for (const std::uint32_t face : beside) {
    if (squared_distance(state_.mesh.triangle(face), p) <= squared_limit) return face;
  }
  return no_index;
}

/// `near` is an original triangle to start with, and the one found.
bool StarSamples::is_near(Vec3 point, std::uint32_t& near, double limit) {
  return proximity_.upper_distance({point.x, point.y, point.z}, near, limit) <= limit;
}

bool StarSamples::is_near_original(Vec3 point, double limit) {
  if (ids_.empty()) return true;
  near_ = triangle_near(point);
  return is_near(point, near_, limit);
}

StarSamples::Walked StarSamples::walk_below(Vec3 vertex, Vec3 end, std::uint32_t near, int max_passes) {
  Walked walked{0, near, std::nullopt};
  walk_.set_tolerance(reach_of_walk * state_.limit, state_.magnitude);
  if (!walk_.begin(near, vertex)) return walked;
  for (int k = 0; k < max_passes && walked.share < 1; ++k) {
    if (walk_.reaches(end)) {
      walked.share = 1;
    } else if (walk_.pass(end)) {
      walked.share = length(walk_.point() - vertex) / length(end - vertex), walked.near = walk_.face();
      if (!walked.farthest || walk_.squared_distance() > walked.farthest->squared)
        walked.farthest = {walk_.point(), walk_.face(), walk_.squared_distance()};
    } else {
      break;
    }
  }
  return walked;
}

/// As `stray_on_edge`, with what a walk has seen.
std::optional<double> StarSamples::stray_beyond(Vec3 vertex, Vec3 end, const Walked& walked, int points, double limit) {
  if (walked.farthest && walked.farthest->squared > limit * limit) {
    auto [point, near, squared] = *walked.farthest;
    if (!is_near(point, near, limit)) return length(point - vertex) / length(end - vertex);
  }
  std::uint32_t near = walked.near;
  for (int k = 1; k <= points; ++k) {
    const double share = static_cast<double>(k) / (points + 1);
    if (share > walked.share && !is_near(vertex + share * (end - vertex), near, limit)) return share;
  }
  return std::nullopt;
}

std::optional<double> StarSamples::stray_on_edge(Vec3 vertex, Vec3 end, int points, double limit) {
  if (ids_.empty()) return std::nullopt;
  const Walked walked = points >= min_points_of_walk ? walk_below(vertex, end, near_, max_passes_to_look)
                                                     : Walked{0, near_, std::nullopt};
  return stray_beyond(vertex, end, walked, points, limit);
}

bool StarSamples::is_edge_near(Vec3 vertex, Vec3 end, std::uint32_t& near, int points, double limit) {
  return is_near(vertex, near, limit) &&
         !stray_beyond(vertex, end, walk_below(vertex, end, near, max_passes_to_look), points, limit);
}

Vec3 StarSamples::offset_from_original(Vec3 point) {
  (void)proximity_.upper_distance({point.x, point.y, point.z}, near_);
  const auto& v = state_.triangles[near_];
  const Vec3 a = state_.vertices[v[0]], b = state_.vertices[v[1]], c = state_.vertices[v[2]];
  return closest_on_triangle(CornerTriangle<double>{a, b - a, c - a}, point).offset;
}

/// The original triangle of the sample nearest to a point.
std::uint32_t StarSamples::triangle_near(Vec3 point) const {
  const Vec3 here = point - origin_;
  std::size_t best = 0;
  double min_squared = HUGE_VAL;
  const std::size_t stride = ids_.size() / 32 + 1;
  for (std::size_t i = 0; i < ids_.size(); i += stride) {
    const double squared = squared_length(points_.at(i) - here);
    if (squared < min_squared) min_squared = squared, best = i;
  }
  return state_.samples.triangle_near(ids_[best]);
}

/// Which of the changed faces is nearest to a point.
std::size_t StarSamples::nearest(std::size_t i) const {
  return static_cast<std::size_t>(offsets_[i / lanes].face[i % lanes]);
}

void StarSamples::give(std::span<const std::uint32_t> numbers) {
  if (ids_.size() > max_samples && outside_.empty()) {
    thin_out(numbers);
    return;
  }
  auto outside = outside_.begin();
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    const bool is_outside = outside != outside_.end() && outside->first == i;
    state_.samples.give_to(ids_[i], is_outside ? (outside++)->second : numbers[nearest(i)]);
  }
}

void StarSamples::give_to_nearest(std::span<const std::uint32_t> numbers) {
  (void)hold({}, HUGE_VAL);
  give(numbers);
}

/// The indices of samples in the order of a space-filling curve through their box: neighbours in it lie near each
/// other.
void StarSamples::sort_along_curve() {
  Eigen::AlignedBox3f box;
  for (const SamplePoints::Block& block : points_.blocks)
    for (std::size_t k = 0; k < lanes; ++k) box.extend(Eigen::Vector3f(block.x[k], block.y[k], block.z[k]));
  const float extent = box.sizes().maxCoeff();
  const float scale = extent > 0 ? static_cast<float>((1 << curve_bits) - 1) / extent : 0;
  const auto cell = [&](double x, int axis) {
    return static_cast<std::uint32_t>((static_cast<float>(x) - box.min()[axis]) * scale);
  };
  order_.clear();
  Cells cells;
  Batch<std::uint64_t> places;
  for (std::size_t begin = 0; begin < ids_.size(); begin += cells.x.size()) {
    const std::size_t count = std::min(cells.x.size(), ids_.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = points_.at(begin + i);
      cells.x[i] = cell(p.x, 0), cells.y[i] = cell(p.y, 1), cells.z[i] = cell(p.z, 2);
    }
    build_kernels_.hilbert_indices(cells, curve_bits, places);
    for (std::size_t i = 0; i < count; ++i) order_.push_back(places[i] << index_bits | (begin + i));
  }
  sort_keys(order_, scratch_);
}

/// Lets one sample stand for two that lie near each other in one plane: the one that is farther from the mesh.
void StarSamples::thin_out(std::span<const std::uint32_t> numbers) {
  const auto squared = [&](std::size_t i) { return offsets_[i / lanes].squared[i % lanes]; };
  const auto give = [&](std::size_t i) { state_.samples.give_to(ids_[i], numbers[nearest(i)]); };
  sort_along_curve();
  const auto in_order = [&](std::size_t k) {
    return static_cast<std::size_t>(order_[k] & ((std::uint64_t{1} << index_bits) - 1));
  };
  const auto around = [&](std::size_t k) { return state_.samples.around(ids_[in_order(k)], state_.tolerance); };
  Samples::Surroundings here = around(0);
  std::size_t k = 0;
  while (k + 1 < order_.size()) {
    const std::size_t i = in_order(k), j = in_order(k + 1);
    const Samples::Surroundings there = around(k + 1);
    if (!here.are_alike(there)) {
      give(i);
      here = there, ++k;
      continue;
    }
    const std::size_t farther = squared(j) > squared(i) ? j : i;
    give(farther);
    state_.samples.go_with(ids_[i + j - farther], ids_[farther]);
    k += 2;
    if (k < order_.size()) here = around(k);
  }
  if (k < order_.size()) give(in_order(k));
}

}  // namespace meshbound
