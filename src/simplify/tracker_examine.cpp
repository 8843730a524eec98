// SPDX-License-Identifier: MIT
/// Whether the bound survives a change: which original triangles need another cover, whether there is one, and whether
/// the added faces are near the original.
#include <algorithm>
#include <bit>
#include <cmath>

#include "numeric/rounding.h"
#include "simplify/tracker_fault.h"
#include "simplify/tracker_impl.h"

namespace meshbound {

double internal::tracker_fault = 1;

namespace {

/// Cuts spent on one added face before it counts as too far: an edit that needs more is refused, the next is cheaper.
constexpr std::uint64_t most_cuts_of_added_face = 300;

/// Candidates that covers use until now, from outside the ring: hardly ever more.
constexpr std::size_t room_for_far_faces = 8;

/// Affected triangles that are looked at for one near the moved vertex: a guess where to begin.
constexpr std::size_t most_looked_at = 16;

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
  around.known = false;
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
  pending.admitted = false;
  pending.covers.clear();
  pending.cover_end.clear();
  const bool same_faces = is_around(change.removed);
  if (!same_faces) mark_removed(change.removed);
  select_faces(change);
  const bool all_change = pending.added.size() == change.added.size();
  const bool same_affected = same_faces && all_change && around.all_change;
  const bool same_candidates =
      same_affected && std::equal(pending.added.begin(), pending.added.end(), around.added.begin(), around.added.end(),
                                  [](const TrackedFace& face, std::uint32_t id) { return face.id == id; });
  if (same_candidates) return;
  around.entered = false;
  around.added.clear();
  for (const TrackedFace& face : pending.added) around.added.push_back(face.id);
  if (!same_affected) select_affected(change.removed, all_change);
}

bool DeviationTracker::Impl::is_around(std::span<const std::uint32_t> removed) const {
  return around.known && std::equal(removed.begin(), removed.end(), around.removed.begin(), around.removed.end());
}

void DeviationTracker::Impl::mark_removed(std::span<const std::uint32_t> removed) {
  removed_marks.clear();
  for (const std::uint32_t face : removed) {
    removed_marks.reserve(face);
    removed_marks.insert(face);
  }
  around.known = true;
  around.removed.assign(removed.begin(), removed.end());
}

/// What the change that was examined last has found already, if that was one of these faces.
std::span<const std::uint32_t> DeviationTracker::Impl::originals_of(std::span<const std::uint32_t> removed) {
  if (!is_around(removed) || !around.all_change) {
    pending.admitted = false;
    mark_removed(removed);
    kept_marks.clear();
    around.entered = false;
    around.added.clear();
    select_affected(removed, true);
  }
  return pending.affected;
}

void DeviationTracker::Impl::select_faces(const SurfaceChange& change) {
  pending.added.clear();
  kept_marks.clear();
  for (const TrackedFace& face : change.added) {
    for (MarkedIds* marks : {&removed_marks, &kept_marks}) marks->reserve(face.id);
    const bool unchanged = face.id < corners.size() && removed_marks.contains(face.id) &&
                           same(corners[face.id][0], to_vec3(face.corners[0])) &&
                           same(corners[face.id][1], to_vec3(face.corners[1])) &&
                           same(corners[face.id][2], to_vec3(face.corners[2]));
    if (unchanged)
      kept_marks.insert(face.id);
    else
      pending.added.push_back(face);
  }
}

/// Of the faces that are not kept: of all where `all_change`.
void DeviationTracker::Impl::select_affected(std::span<const std::uint32_t> removed, bool all_change) {
  around.all_change = all_change;
  affected_marks.clear();
  pending.affected.clear();
  for (const std::uint32_t face : removed) {
    kept_marks.reserve(face);
    if (kept_marks.contains(face)) continue;
    for (const std::uint32_t t : cover.originals_of(face)) {
      if (!affected_marks.insert(t)) continue;
      pending.affected.push_back(t);
      __builtin_prefetch(&triangles[t]);
      cover.prefetch(t);
    }
  }
  around.near = SurfaceChange::no_triangle;
}

/// Of a few affected triangles the one with the corner nearest to p.
std::uint32_t DeviationTracker::Impl::affected_near(Vec3 p) const {
  std::uint32_t best = 0;
  double least = HUGE_VAL;
  const std::size_t stride = pending.affected.size() / most_looked_at + 1;
  for (std::size_t i = 0; i < pending.affected.size(); i += stride) {
    const std::uint32_t t = pending.affected[i];
    const double squared = squared_length(vertices[triangles[t][0]] - p);
    if (squared < least) least = squared, best = t;
  }
  return best;
}

/// No proof, but a cheap refusal: the faces at the vertex are compared with the original at last.
bool DeviationTracker::Impl::moved_vertex_near(const SurfaceChange& change) {
  if (!change.moved_vertex || pending.added.empty()) return true;
  const Vec3 p = to_vec3(*change.moved_vertex);
  if (around.near == SurfaceChange::no_triangle) around.near = affected_near(p);
  const Triangle& t = triangles[around.near];
  const CornerTriangle<double> near{vertices[t[0]], vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]};
  if (closest_on_triangle(near, p).squared_distance <= limit * limit) return true;
  return proximity.upper_distance(*change.moved_vertex, around.near, limit) <= limit;
}

Refusal DeviationTracker::Impl::examine(const SurfaceChange& change) {
  select(change);
  if (pending.added.empty() && pending.affected.empty()) return Refusal::None;
  limit = limit_of_change();
  if (!(limit > 0)) return Refusal::ToleranceBelowRounding;
  if (pending.added.size() > most_added_faces) return Refusal::TooManyFaces;
  const bool again = around.entered && limit == around.limit;
  if (again) {
    replace_added_faces();
    if (!left_corners_held()) return Refusal::OriginalUncovered;
  }
  if (!moved_vertex_near(change)) return Refusal::MovedVertexTooFar;
  if (!again) enter_added_faces();
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

void DeviationTracker::Impl::take_added_corners() {
  added_corners.clear();
  pending.nearest.clear();
  for (const TrackedFace& face : pending.added) {
    added_corners.push_back(corners_of(face));
    pending.nearest.push_back(face.id < nearest.size() ? nearest[face.id] : 0);
  }
}

void DeviationTracker::Impl::enter_added_faces() {
  take_added_corners();
  forward.begin(limit);
  ++candidate_round;
  for (std::size_t k = 0; k < added_corners.size(); ++k) {
    const std::uint32_t id = pending.added[k].id;
    if (id >= candidates.size()) candidates.resize(std::size_t{id} + 1);
    candidates[id] = {candidate_round, forward.add(added_corners[k], id)};
  }
  added_bits = ForwardCover::first(forward.size());
  ring_known = false;
  around.entered = true;
  around.limit = limit;
  around.left_to_added.clear();
}

void DeviationTracker::Impl::replace_added_faces() {
  take_added_corners();
  forward.replace_first(added_corners);
}

/// Corners that had to be held by the added faces of an earlier placement must be held by those of this one.
bool DeviationTracker::Impl::left_corners_held() {
  for (const Around::Corner& corner : around.left_to_added) {
    if (forward.holds(corner.vertex, added_bits)) continue;
    uncovered = corner.triangle;
    return false;
  }
  return true;
}

/// What is cheap and likely to fail comes first: the triangle that failed the last time, then all corners, which most
/// triangles need to be looked at only, and pieces of triangles at last.
Refusal DeviationTracker::Impl::cover_affected(const SurfaceChange& change) {
  used.assign(pending.affected.size(), 0);
  const auto refuse = [&](std::size_t i) {
    uncovered = pending.affected[i];
    return Refusal::OriginalUncovered;
  };
  if (change.try_first < triangles.size() && affected_marks.contains(change.try_first)) {
    const auto at = std::find(pending.affected.begin(), pending.affected.end(), change.try_first);
    const auto first = static_cast<std::size_t>(at - pending.affected.begin());
    ++stats.originals_tested;
    const FaceMask likely = added_bits | relied_on(change.try_first);
    if (corner_out_of_reach(change.try_first, likely, change) || !cover_one(first, likely, change))
      return refuse(first);
  }
  in_pieces.clear();
  for (std::size_t i = 0; i < pending.affected.size(); ++i) {
    if (used[i] != 0) continue;
    const std::uint32_t t = pending.affected[i];
    ++stats.originals_tested;
    used[i] = forward.cover_whole(t, added_bits, added_of(t));
    if (used[i] != 0) continue;
    const FaceMask likely = added_bits | relied_on(t);
    if (corner_out_of_reach(t, likely, change)) return refuse(i);
    in_pieces.push_back({i, likely});
  }
  for (const InPieces& one : in_pieces) {
    if (!cover_one(one.affected, one.likely, change)) return refuse(one.affected);
  }
  list_covers();
  return Refusal::None;
}

/// Candidates beyond the added faces and those that covers use already: the faces around the change.
void DeviationTracker::Impl::find_ring(const SurfaceChange& change) {
  ring_known = true;
  ++stats.ring_searches;
  ring.clear();
  if (change.ring) change.ring(ring);
  // Faces that covers use may lie farther out, and must not find the room taken.
  const bool all_fit =
      static_cast<std::size_t>(forward.size()) + ring.size() + room_for_far_faces <= CandidateFaces::capacity;
  if (!all_fit) {
    for (const std::uint32_t t : pending.affected) relied_on(t);
  }
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

bool DeviationTracker::Impl::corner_out_of_reach(std::uint32_t t, FaceMask likely, const SurfaceChange& change) {
  if (!forward.corner_out_of_reach(t, likely)) return false;
  if (!ring_known) find_ring(change);
  const auto corner = forward.corner_out_of_reach(t, ForwardCover::first(forward.size()));
  if (corner) around.left_to_added.push_back({*corner, t});
  return corner.has_value();
}

/// By the candidates that are likely to hold it, or by all.
bool DeviationTracker::Impl::cover_one(std::size_t i, FaceMask likely, const SurfaceChange& change) {
  const std::uint32_t t = pending.affected[i];
  const FaceMask preferred = added_of(t);
  used[i] = forward.cover(t, likely, preferred);
  if (used[i] == 0) {
    if (!ring_known) find_ring(change);
    used[i] = forward.cover(t, ForwardCover::first(forward.size()), preferred);
  }
  return used[i] != 0;
}

void DeviationTracker::Impl::append_cover(FaceMask faces) {
  for (FaceMask rest = faces; rest != 0; rest &= rest - 1)
    pending.covers.push_back(forward.face(std::countr_zero(rest)));
  pending.cover_end.push_back(pending.covers.size());
}

void DeviationTracker::Impl::list_covers() {
  for (std::size_t i = 0; i < used.size(); ++i) {
    append_cover(used[i]);
    for (FaceMask rest = used[i] & added_bits; rest != 0; rest &= rest - 1)
      pending.nearest[static_cast<std::size_t>(std::countr_zero(rest))] = pending.affected[i];
  }
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
