// SPDX-License-Identifier: MIT
/// Whether the bound survives a change: which original triangles need another cover, whether there is one, and whether
/// the added faces are near the original.
#include <algorithm>
#include <bit>

#include "numeric/rounding.h"
#include "simplify/tracker_fault.h"
#include "simplify/tracker_impl.h"

namespace meshbound {

double internal::tracker_fault = 1;

namespace {

/// Cuts spent on one added face before it counts as too far: an edit that needs more is refused, the next is cheaper.
constexpr std::uint64_t most_cuts_of_added_face = 300;

bool same(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

}  // namespace

/// What must be proven in doubles so that `value` holds in real arithmetic.
double DeviationTracker::Impl::provable(double value) const {
  // New vertices lie within the tolerance of old ones. The slack of a distance, and of the cuts above a piece:
  const double size = magnitude + tolerance;
  const double slack = CandidateFaces::rounding_slack(size) + ForwardCover::deepest_cut * cut_error * size;
  return value * tracking_share * (1 - 2 * CandidateFaces::plane_slack) - slack;
}

void DeviationTracker::Impl::set_tolerance(double value) {
  tolerance = value;
  working_tolerance = provable(value) * internal::tracker_fault;
}

double DeviationTracker::Impl::limit_around(const Eigen::AlignedBox3d& box) const {
  return local ? provable(local->sufficient_around(box, tolerance)) : working_tolerance;
}

/// The box holds all that the change touches, the original triangles that need another cover included.
double DeviationTracker::Impl::limit_of_change() const {
  if (!local) return working_tolerance;
  Eigen::AlignedBox3d box;
  for (const TrackedFace& face : pending.added) {
    for (const Eigen::Vector3d& p : face.corners) box.extend(p);
  }
  for (const std::uint32_t t : pending.affected) {
    for (const std::uint32_t v : triangles[t]) box.extend(Eigen::Vector3d(vertices[v].x, vertices[v].y, vertices[v].z));
  }
  return limit_around(box);
}

/// Which faces really change, and which original triangles lose a face of their cover by that. Faces that keep id and
/// corners, as around the fixed end of an edge that collapses onto it, keep their proofs.
void DeviationTracker::Impl::select(const SurfaceChange& change) {
  const auto make_room = [&](std::uint32_t id) {
    for (MarkedIds* marks : {&removed_marks, &kept_marks}) marks->reserve(id);
  };
  removed_marks.clear();
  for (const std::uint32_t face : change.removed) {
    make_room(face);
    removed_marks.insert(face);
  }
  pending.admitted = false;
  pending.added.clear();
  kept_marks.clear();
  for (const TrackedFace& face : change.added) {
    make_room(face.id);
    const bool unchanged = face.id < corners.size() && removed_marks.contains(face.id) &&
                           same(corners[face.id][0], to_vec3(face.corners[0])) &&
                           same(corners[face.id][1], to_vec3(face.corners[1])) &&
                           same(corners[face.id][2], to_vec3(face.corners[2]));
    if (unchanged)
      kept_marks.insert(face.id);
    else
      pending.added.push_back(face);
  }
  affected_marks.clear();
  pending.affected.clear();
  for (const std::uint32_t face : change.removed) {
    if (kept_marks.contains(face)) continue;
    for (const std::uint32_t t : cover.originals_of(face)) {
      if (affected_marks.insert(t)) pending.affected.push_back(t);
    }
  }
  if (pending.covers.size() < pending.affected.size()) pending.covers.resize(pending.affected.size());
}

bool DeviationTracker::Impl::moved_vertex_near(const SurfaceChange& change) {
  if (!change.moved_vertex || pending.added.empty()) return true;
  std::uint32_t hint = pending.affected.empty() ? 0 : pending.affected.front();
  return proximity.upper_distance(*change.moved_vertex, hint, limit) <= limit;
}

Refusal DeviationTracker::Impl::examine(const SurfaceChange& change) {
  select(change);
  if (pending.added.empty() && pending.affected.empty()) return Refusal::None;
  limit = limit_of_change();
  if (!(limit > 0)) return Refusal::ToleranceBelowRounding;
  if (pending.added.size() > most_added_faces) return Refusal::TooManyFaces;
  if (!moved_vertex_near(change)) return Refusal::MovedVertexTooFar;
  const Refusal forward_refusal = cover_affected(change);
  if (forward_refusal != Refusal::None) return forward_refusal;
  return added_faces_near() ? Refusal::None : Refusal::NewFaceTooFar;
}

/// Index of the face among the candidates; they are entered as they are needed.
FaceMask DeviationTracker::Impl::candidate_bit(std::uint32_t face) {
  Candidate& candidate = candidates[face];
  if (candidate.round != candidate_round) candidate = {candidate_round, forward.add(corners[face], face)};
  return candidate.index == ForwardCover::no_room ? 0 : FaceMask{1} << candidate.index;
}

void DeviationTracker::Impl::enter_added_faces() {
  forward.begin(limit);
  ++candidate_round;
  pending.nearest.clear();
  for (const TrackedFace& face : pending.added) {
    if (face.id >= candidates.size()) candidates.resize(std::size_t{face.id} + 1);
    candidates[face.id] = {candidate_round, forward.add(corners_of(face), face.id)};
    pending.nearest.push_back(face.id < nearest.size() ? nearest[face.id] : 0);
  }
  added_bits = ForwardCover::first(forward.size());
  ring_known = false;
}

Refusal DeviationTracker::Impl::cover_affected(const SurfaceChange& change) {
  enter_added_faces();
  const auto fails = [&](std::size_t i) {
    if (cover_one(i, change)) return false;
    uncovered = pending.affected[i];
    return true;
  };
  std::size_t first = pending.affected.size();
  if (change.try_first < triangles.size() && affected_marks.contains(change.try_first)) {
    first = static_cast<std::size_t>(std::find(pending.affected.begin(), pending.affected.end(), change.try_first) -
                                     pending.affected.begin());
    if (fails(first)) return Refusal::OriginalUncovered;
  }
  for (std::size_t i = 0; i < pending.affected.size(); ++i) {
    if (i != first && fails(i)) return Refusal::OriginalUncovered;
  }
  return Refusal::None;
}

/// Candidates beyond the added faces and those that covers use already: the faces around the change.
void DeviationTracker::Impl::find_ring(const SurfaceChange& change) {
  ring_known = true;
  ++stats.ring_searches;
  ring.clear();
  if (change.ring) change.ring(ring);
  for (const std::uint32_t t : pending.affected) relied_on(t);
  for (const std::uint32_t face : ring) {
    if (is_current(face)) candidate_bit(face);
  }
}

/// The faces beyond the added ones that the cover of an original triangle uses until now.
FaceMask DeviationTracker::Impl::relied_on(std::uint32_t t) {
  FaceMask bits = 0;
  for (const std::uint32_t face : cover.faces_of(t)) {
    if (is_current(face)) bits |= candidate_bit(face);
  }
  return bits;
}

FaceMask DeviationTracker::Impl::added_of(std::uint32_t t) const {
  FaceMask bits = 0;
  for (const std::uint32_t face : cover.faces_of(t)) {
    const Candidate& candidate = candidates[face];
    if (candidate.round == candidate_round && candidate.index != ForwardCover::no_room)
      bits |= FaceMask{1} << candidate.index;
  }
  return bits & added_bits;
}

bool DeviationTracker::Impl::cover_one(std::size_t i, const SurfaceChange& change) {
  const std::uint32_t t = pending.affected[i];
  ++stats.originals_tested;
  const FaceMask preferred = added_of(t);
  FaceMask used = forward.cover_whole(t, added_bits, preferred);
  if (used == 0) used = forward.cover(t, added_bits | relied_on(t), preferred);
  if (used == 0) {
    if (!ring_known) find_ring(change);
    used = forward.cover(t, ForwardCover::first(forward.size()), preferred);
  }
  CoverAssignment::Ids& ids = pending.covers[i];
  ids.clear();
  for (FaceMask rest = used; rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    ids.push_back(forward.face(k));
    if ((added_bits >> k) & 1) pending.nearest[static_cast<std::size_t>(k)] = t;
  }
  return used != 0;
}

bool DeviationTracker::Impl::added_faces_near() {
  for (std::size_t k = 0; k < pending.added.size(); ++k) {
    const auto& at = pending.added[k].corners;
    std::uint32_t& hint = pending.nearest[k];
    ++stats.faces_tested;
    const FaceCorners face = corners_of(pending.added[k]);
    if (degree.covers(face, limit, magnitude, hint)) {
      ++stats.faces_by_degree;
      continue;
    }
    if (proximity.triangle_within(at, limit, hint, most_cuts_of_added_face) != Verdict::Within) return false;
  }
  return true;
}

}  // namespace meshbound
