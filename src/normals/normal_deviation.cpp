// SPDX-License-Identifier: MIT
#include "meshbound/normal_deviation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/boxes.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "normals/normal_comparison.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"

namespace meshbound {
namespace {

constexpr double tie_share = 1e-9;          ///< of the diagonal of A: distances that differ by less are equal
constexpr double rounding_share = 0x1p-40;  ///< of the largest coordinate: likewise
constexpr std::size_t grain = 1024;         ///< faces that a thread takes at once

/// Distances from a point to faces that differ by less than this count as equal.
double tie_of(const MeshView& mesh) {
  Eigen::AlignedBox3d box;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) box.extend(box_of(corners_of(mesh, t)));
  if (box.isEmpty()) return 0;
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  return std::max(tie_share * box.diagonal().stableNorm(), rounding_share * largest);
}

}  // namespace

NormalDeviation NormalComparison::measure(const MeshView& a, const MeshView& b, const NormalDeviationOptions& options) {
  validate(a);
  validate(b);
  if (options.tolerance && !(*options.tolerance >= 0))
    throw InvalidInput("the normal tolerance must be an angle in degrees, 0 or more");
  const int threads = thread_count(options.threads);
  auto stand_ins = std::make_unique<const StandIns>(b, tie_of(a), threads);
  near_.resize(a.triangle_count());
  if (before_) forget_changed(a, *stand_ins, threads);
  std::vector<std::vector<FaceTurn>> turns(a.triangle_count() / grain + 1);  // by range
  with_team(threads, [&] {
    for_each_range(a.triangle_count(), grain, [&](std::size_t begin, std::size_t end) {
      const std::span<NearStandIns> near = std::span(near_).subspan(begin, end - begin);
      stand_ins->complete(a, begin, near);
      turns[begin / grain] = stand_ins->turns(a, begin, near, options.tolerance.value_or(180));
    });
  });
  before_ = std::move(stand_ins);
  NormalDeviation result;
  for (const std::vector<FaceTurn>& of_range : turns) {
    for (const FaceTurn& turn : of_range) {
      if (!result.worst || turn.degrees > result.degrees) {
        result.degrees = turn.degrees;
        result.worst = turn;
      }
      if (options.tolerance && turn.degrees > *options.tolerance) result.exceeding.push_back(turn);
    }
  }
  return result;
}

/// Forgets what stands for the faces near which one has come or gone.
void NormalComparison::forget_changed(const MeshView& a, const StandIns& now, int threads) {
  std::vector<StandIns::Corners> changed;
  before_->add_others(now, changed);
  now.add_others(*before_, changed);
  std::vector<Eigen::AlignedBox3d> boxes(changed.size());
  for (std::size_t i = 0; i < changed.size(); ++i)
    for (const Eigen::Vector3d& p : changed[i]) boxes[i].extend(p);
  const BoxTree tree(boxes);
  with_team(threads, [&] {
    for_each_range(a.triangle_count(), grain, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> found;
      for (std::size_t t = begin; t < end; ++t) {
        if (!near_[t].is_known()) continue;
        const Eigen::Vector3d middle = middle_of(a, t).position, around = Eigen::Vector3d::Constant(near_[t].reach);
        found.clear();
        tree.find({middle - around, middle + around}, found);
        const auto is_near = [&](std::uint32_t i) { return is_within(changed[i], middle, near_[t].reach); };
        if (std::any_of(found.begin(), found.end(), is_near)) near_[t] = {};
      }
    });
  });
}

NormalDeviation normal_deviation(const MeshView& a, const MeshView& b, const NormalDeviationOptions& options) {
  return NormalComparison().measure(a, b, options);
}

}  // namespace meshbound
