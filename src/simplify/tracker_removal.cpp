// SPDX-License-Identifier: MIT
/// Faces that are taken away without a substitute.
#include <algorithm>

#include "simplify/tracker_impl.h"

namespace meshbound {

void DeviationTracker::begin_removals() {
  std::vector<Eigen::AlignedBox3d> boxes;
  impl_->boxed.clear();
  for (std::uint32_t face = 0; face < impl_->corners.size(); ++face) {
    if (impl_->cover.originals_of(face).empty()) continue;
    impl_->boxed.push_back(face);
    boxes.push_back(box_of(impl_->corners[face]));
  }
  impl_->face_boxes.emplace(std::move(boxes));
}

bool DeviationTracker::admits_removal(std::span<const std::uint32_t> removed) {
  SurfaceChange change;
  change.removed = removed;
  impl_->around.known = false;
  impl_->select(change);
  impl_->around.known = false;  // the candidates are going to be others
  impl_->uncovered = SurfaceChange::no_triangle;
  impl_->refusal = impl_->examine_removal();
  impl_->pending.admitted = impl_->refusal == Refusal::None;
  return impl_->pending.admitted;
}

/// Of the original triangles that `select` found.
Refusal DeviationTracker::Impl::examine_removal() {
  if (pending.affected.empty()) return Refusal::None;
  limit = limit_of_change();
  if (!(limit > 0)) return Refusal::ToleranceBelowRounding;
  for (std::size_t i = 0; i < pending.affected.size(); ++i) {
    if (cover_by_others(i)) continue;
    uncovered = pending.affected[i];
    return Refusal::OriginalUncovered;
  }
  return Refusal::None;
}

/// The faces nearest to the middle of the triangle where there are too many.
bool DeviationTracker::Impl::cover_by_others(std::size_t i) {
  const Triangle& t = triangles[pending.affected[i]];
  const Eigen::AlignedBox3d box = box_of({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  const Eigen::Vector3d middle = box.center();
  found.clear();
  if (face_boxes) face_boxes->find({box.min().array() - tolerance, box.max().array() + tolerance}, found);
  std::erase_if(found, [&](std::uint32_t k) { return !is_current(boxed[k]) || cover.originals_of(boxed[k]).empty(); });
  const auto distance = [&](std::uint32_t k) { return box_of(corners[boxed[k]]).squaredExteriorDistance(middle); };
  if (found.size() > CandidateFaces::capacity)
    std::stable_sort(found.begin(), found.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
  forward.begin(limit);
  ++candidate_round;
  for (const std::uint32_t k : found) candidate_bit(boxed[k]);
  const FaceMask faces = forward.cover(pending.affected[i], ForwardCover::first(forward.size()), 0);
  append_cover(faces);
  return faces != 0;
}

}  // namespace meshbound
