// SPDX-License-Identifier: MIT
#include "meshbound/deviation_tracker.h"

#include <algorithm>
#include <cmath>

#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "simplify/tracker_impl.h"

namespace meshbound {

DeviationTracker::Impl::Impl(const MeshView& original, const Bvh& tree)
    : bvh(tree),
      vertices(positions_of(original)),
      triangles(triangles_of(original)),
      proximity(tree),
      cover(triangles.size()),
      forward(vertices, triangles),
      degree(vertices, triangles),
      deviation(vertices, triangles),
      minimax(vertices, triangles) {
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) {
      const Vec3 p = vertices[v];
      magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
  }
  affected_marks.reserve(triangles.size());
}

DeviationTracker::DeviationTracker(const MeshView& original, const Bvh& bvh, double tolerance)
    : impl_(std::make_unique<Impl>(original, bvh)) {
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) throw InvalidInput("the tolerance must be a length, 0 or more");
  if (bvh.triangle_count() != original.triangle_count())
    throw InvalidInput("the tree and the original it is said to be of have different numbers of triangles");
  impl_->set_tolerance(tolerance);
}
DeviationTracker::DeviationTracker(DeviationTracker&&) noexcept = default;
DeviationTracker& DeviationTracker::operator=(DeviationTracker&&) noexcept = default;
DeviationTracker::~DeviationTracker() = default;

void DeviationTracker::limit_triangles(std::span<const double> tolerances) {
  if (tolerances.size() != impl_->triangles.size())
    throw InvalidInput("tolerances of triangles must be given for every triangle of the original");
  if (std::any_of(tolerances.begin(), tolerances.end(), [](double t) { return !(t >= 0); }))
    throw InvalidInput("the tolerance of a triangle must be a length, 0 or more");
  if (impl_->covered_with_room)
    throw InvalidInput("some triangles without a face are covered with the tolerance for all already");
  std::vector<Eigen::AlignedBox3d> boxes(tolerances.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const std::uint32_t v : impl_->triangles[t]) {
      const Vec3 p = impl_->vertices[v];
      boxes[t].extend(Eigen::Vector3d(p.x, p.y, p.z));
    }
  }
  impl_->around.known = false;
  impl_->local.emplace(std::move(boxes), tolerances);
}

bool DeviationTracker::admits(const SurfaceChange& change) {
  impl_->uncovered = SurfaceChange::no_triangle;
  impl_->refusal = impl_->examine(change);
  impl_->pending.admitted = impl_->refusal == Refusal::None;
  if (impl_->pending.admitted)
    ++impl_->stats.admitted;
  else
    ++impl_->stats.refused[static_cast<std::size_t>(impl_->refusal)];
  return impl_->pending.admitted;
}

void DeviationTracker::commit() {
  Impl::Pending& pending = impl_->pending;
  if (!pending.admitted) throw Error("commit without an admitted change");
  pending.admitted = false;
  impl_->around.known = false;
  for (std::size_t k = 0; k < pending.added.size(); ++k) {
    const TrackedFace& face = pending.added[k];
    impl_->put_face(face.id, corners_of(face), pending.nearest[k]);
  }
  std::size_t begin = 0;
  for (std::size_t i = 0; i < pending.affected.size(); ++i) {
    const std::size_t end = pending.cover_end[i];
    impl_->cover.assign(pending.affected[i], std::span(pending.covers).subspan(begin, end - begin));
    begin = end;
  }
}

std::uint32_t DeviationTracker::Impl::gather_for_samples(std::span<const std::uint32_t> removed) {
  deviation_faces.clear();
  for (const std::uint32_t face : removed) deviation_faces.push_back(corners[face]);
  return removed.empty() ? 0 : nearest[removed.back()];
}

void DeviationTracker::Impl::gather_moved(std::span<const TrackedFace> added,
                                          std::span<const std::size_t> moved_corner) {
  deviation_faces.clear();
  for (std::size_t i = 0; i < added.size(); ++i) {
    const auto corner = [&](std::size_t k) { return to_vec3(added[i].corners[(moved_corner[i] + k) % 3]); };
    deviation_faces.push_back({corner(0), corner(1), corner(2)});
  }
}

void DeviationTracker::sample(std::span<const std::uint32_t> removed) {
  const std::uint32_t hint = impl_->gather_for_samples(removed);
  impl_->deviation.begin(impl_->tolerance, impl_->originals_of(removed), impl_->deviation_faces, hint);
}

void DeviationTracker::sample_heights(std::span<const std::uint32_t> removed) {
  const std::uint32_t hint = impl_->gather_for_samples(removed);
  impl_->minimax.begin(impl_->tolerance, impl_->originals_of(removed), impl_->deviation_faces, hint);
}

HeightStep DeviationTracker::height_step(std::span<const TrackedFace> added,
                                         std::span<const std::size_t> moved_corner) {
  impl_->gather_moved(added, moved_corner);
  const MinimaxPlacement::Step step = impl_->minimax.step(impl_->deviation_faces, impl_->proximity);
  return {step.here, step.there, {step.move.x, step.move.y, step.move.z}};
}

SampledDeviation DeviationTracker::sampled_deviation(std::span<const TrackedFace> added,
                                                     std::span<const std::size_t> moved_corner) {
  impl_->gather_moved(added, moved_corner);
  const SlopeSums sums = impl_->deviation.of(impl_->deviation_faces, impl_->proximity);
  SampledDeviation result{sums.sum, std::sqrt(sums.worst_squared), {}, {}};
  const double scale = 1 / impl_->tolerance;
  const auto& c = sums.curvature;
  result.gradient = scale * Eigen::Vector3d(sums.gradient[0], sums.gradient[1], sums.gradient[2]);
  result.curvature << c[0], c[3], c[5], c[3], c[1], c[4], c[5], c[4], c[2];
  result.curvature *= scale * scale;
  return result;
}

void DeviationTracker::grow_tolerance(double tolerance) {
  if (!(tolerance >= impl_->tolerance) || !std::isfinite(tolerance))
    throw InvalidInput("the tolerance of a tracker can only grow: its proofs hold for the smaller one only");
  impl_->set_tolerance(tolerance);
}
double DeviationTracker::tolerance() const { return impl_->tolerance; }
Refusal DeviationTracker::last_refusal() const { return impl_->refusal; }
std::uint32_t DeviationTracker::last_uncovered() const { return impl_->uncovered; }
const TrackerStats& DeviationTracker::stats() const {
  impl_->stats.originals_split = impl_->forward.splits;
  impl_->stats.cuts = impl_->forward.cuts;
  return impl_->stats;
}

}  // namespace meshbound
