// SPDX-License-Identifier: MIT
/// The faces that a tracker begins with.
#include <algorithm>
#include <bit>

#include "meshbound/error.h"
#include "simplify/approximation_proof.h"
#include "simplify/tracker_impl.h"

namespace meshbound {

void DeviationTracker::Impl::put_face(std::uint32_t id, const FaceCorners& at, std::uint32_t near) {
  if (id >= corners.size()) {
    corners.resize(std::size_t{id} + 1);
    nearest.resize(std::size_t{id} + 1, 0);
    candidates.resize(std::max(candidates.size(), std::size_t{id} + 1));
  }
  cover.reserve_face(id);
  for (MarkedIds* marks : {&removed_marks, &kept_marks}) marks->reserve(id);
  corners[id] = at;
  nearest[id] = near;
  around.known = false;
}

void DeviationTracker::start(std::uint32_t id, std::uint32_t triangle) {
  const Triangle& t = impl_->triangles[triangle];
  impl_->put_face(id, {impl_->vertices[t[0]], impl_->vertices[t[1]], impl_->vertices[t[2]]}, triangle);
  CoverAssignment::Ids itself{id};
  impl_->cover.assign(triangle, itself);
}

Unproven DeviationTracker::start_from(std::span<const TrackedFace> faces, int threads, const StopToken& stop) {
  std::vector<std::uint32_t> ids;
  for (const TrackedFace& face : faces) ids.push_back(face.id);
  std::sort(ids.begin(), ids.end());
  if (std::adjacent_find(ids.begin(), ids.end()) != ids.end())
    throw InvalidInput("two faces that a tracker is to start from have the same id");
  const ProofOriginal original{impl_->vertices,
                               impl_->triangles,
                               impl_->bvh,
                               impl_->degree,
                               impl_->magnitude,
                               impl_->tolerance,
                               [this](const Eigen::AlignedBox3d& box) { return impl_->limit_around(box); }};
  ApproximationProof proof(original, faces, threads, stop);
  proof.run();
  if (!proof.unproven().empty()) return proof.unproven();
  for (std::size_t i = 0; i < faces.size(); ++i) impl_->put_face(faces[i].id, corners_of(faces[i]), proof.nearest()[i]);
  proof.for_each_cover([&](std::uint32_t t, std::span<const std::uint32_t> cover) { impl_->cover.assign(t, cover); });
  impl_->pending.admitted = false;
  impl_->forward.splits += proof.splits;
  impl_->forward.cuts += proof.cuts;
  impl_->stats.originals_tested += impl_->triangles.size();
  impl_->stats.faces_tested += faces.size();
  impl_->stats.faces_by_degree += proof.faces_by_degree;
  return {};
}

std::vector<std::uint32_t> DeviationTracker::cover_the_rest() {
  std::vector<std::uint32_t> rest;
  for (std::uint32_t t = 0; t < impl_->triangles.size(); ++t) {
    if (impl_->cover.faces_of(t).empty()) rest.push_back(t);
  }
  if (rest.empty()) return rest;
  impl_->covered_with_room = impl_->working_tolerance > 0;
  std::vector<std::vector<std::uint32_t>> faces_at(impl_->vertices.size());
  MarkedIds wanted;
  wanted.reserve(impl_->vertices.size());
  wanted.clear();
  for (const std::uint32_t t : rest) {
    for (const std::uint32_t v : impl_->triangles[t]) wanted.insert(v);
  }
  for (std::uint32_t t = 0; t < impl_->triangles.size(); ++t) {
    for (const std::uint32_t v : impl_->triangles[t]) {
      if (!impl_->cover.faces_of(t).empty() && wanted.contains(v)) faces_at[v].push_back(impl_->cover.faces_of(t)[0]);
    }
  }
  std::vector<std::uint32_t> uncovered;
  for (const std::uint32_t t : rest) {
    impl_->around.known = false;
    impl_->forward.begin(std::max(impl_->working_tolerance, 0.0));
    ++impl_->candidate_round;
    for (const std::uint32_t v : impl_->triangles[t]) {
      for (const std::uint32_t face : faces_at[v]) impl_->candidate_bit(face);
    }
    CoverAssignment::Ids ids;
    const FaceMask all = ForwardCover::first(impl_->forward.size());
    for (FaceMask used = impl_->forward.cover(t, all, 0); used != 0; used &= used - 1)
      ids.push_back(impl_->forward.face(std::countr_zero(used)));
    if (ids.empty())
      uncovered.push_back(t);
    else
      impl_->cover.assign(t, ids);
  }
  return uncovered;
}

}  // namespace meshbound
