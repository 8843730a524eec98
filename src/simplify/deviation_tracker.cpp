// SPDX-License-Identifier: MIT
#include "meshbound/deviation_tracker.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "meshbound/proximity.h"
#include "numeric/rounding.h"
#include "simplify/box_tree.h"
#include "simplify/cover_assignment.h"
#include "simplify/degree_cover.h"
#include "simplify/forward_cover.h"
#include "simplify/local_deviation.h"
#include "simplify/local_tolerance.h"
#include "simplify/tracker_fault.h"

namespace meshbound {

double internal::tracker_fault = 1;

namespace {

/// Cuts spent on one added face before it counts as too far: an edit that needs more is refused, the next is cheaper.
constexpr std::uint64_t most_cuts_of_added_face = 300;

using Corners = std::array<Vec3, 3>;

Vec3 to_vec3(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
Corners corners_of(const TrackedFace& face) {
  return {to_vec3(face.corners[0]), to_vec3(face.corners[1]), to_vec3(face.corners[2])};
}
Eigen::AlignedBox3d box_of(const Corners& corners) {
  Eigen::AlignedBox3d box;
  for (const Vec3 p : corners) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  return box;
}
bool same(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// Marks for sets of ids that are emptied in O(1).
class MarkedIds {
 public:
  void reserve(std::size_t id) {
    if (id >= stamps_.size()) stamps_.resize(id + 1, 0);
  }
  void clear() { ++current_; }
  /// False when it was in already.
  bool insert(std::uint32_t id) {
    if (stamps_[id] == current_) return false;
    stamps_[id] = current_;
    return true;
  }
  [[nodiscard]] bool contains(std::uint32_t id) const { return stamps_[id] == current_; }

 private:
  std::vector<std::uint32_t> stamps_;
  std::uint32_t current_ = 1;
};

}  // namespace

struct DeviationTracker::Impl {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  Proximity proximity;
  double tolerance = 0;
  double working_tolerance = 0;         ///< what is proven, see `set_tolerance`
  double magnitude = 0;                 ///< largest coordinate seen
  std::optional<LocalTolerance> local;  ///< where triangles have tolerances of their own
  double limit = 0;                     ///< what must be proven for the change under test
  bool covered_with_room = false;       ///< `cover_the_rest` has used a tolerance above 0

  CoverAssignment cover;
  std::vector<Corners> corners;        ///< of current faces, by id
  std::vector<std::uint32_t> nearest;  ///< original triangle near each current face: hint of the backward check

  ForwardCover forward;
  DegreeCover degree;
  LocalDeviation deviation;
  std::vector<Corners> deviation_faces;
  std::vector<std::uint32_t> deviation_originals;
  MarkedIds removed_marks, kept_marks, affected_marks;

  /// Where a face is among the candidates of `forward` in the present round.
  struct Candidate {
    std::uint32_t round = 0;
    int index = ForwardCover::no_room;
  };
  std::vector<Candidate> candidates;  ///< by face id
  std::uint32_t candidate_round = 0;
  FaceMask added_bits = 0;

  std::optional<BoxTree> face_boxes;        ///< at the last `begin_removals`
  std::vector<std::uint32_t> boxed, found;  ///< faces of the boxes; indices of boxes

  struct Pending {
    bool admitted = false;
    std::vector<TrackedFace> added;            ///< those that differ from the current face of their id
    std::vector<std::uint32_t> nearest;        ///< original triangle near each of `added`
    std::vector<std::uint32_t> affected;       ///< original triangles that lost a face
    std::vector<CoverAssignment::Ids> covers;  ///< new cover of each of `affected`; grows, never shrinks
  } pending;
  std::vector<std::uint32_t> ring;
  bool ring_known = false;

  Refusal refusal = Refusal::None;
  std::uint32_t uncovered = SurfaceChange::no_triangle;
  TrackerStats stats;

  Impl(const MeshView& original, const Bvh& bvh)
      : vertices(positions_of(original)),
        triangles(triangles_of(original)),
        proximity(bvh),
        cover(triangles.size()),
        forward(vertices, triangles),
        degree(vertices, triangles),
        deviation(vertices, triangles) {
    for (const Triangle& t : triangles) {
      for (const std::uint32_t v : t) {
        const Vec3 p = vertices[v];
        magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      }
    }
    affected_marks.reserve(triangles.size());
  }
  void set_tolerance(double value);
  [[nodiscard]] double provable(double value) const;
  [[nodiscard]] double limit_of_change() const;
  void put_face(std::uint32_t id, const Corners& at, std::uint32_t near);

  void select(const SurfaceChange& change);
  [[nodiscard]] Refusal examine(const SurfaceChange& change);
  [[nodiscard]] bool moved_vertex_near(const SurfaceChange& change);
  [[nodiscard]] Refusal cover_affected(const SurfaceChange& change);
  [[nodiscard]] bool is_current(std::uint32_t face) const {
    return !removed_marks.contains(face) || kept_marks.contains(face);
  }
  FaceMask candidate_bit(std::uint32_t face);
  void enter_added_faces();
  [[nodiscard]] FaceMask added_of(std::uint32_t t) const;
  FaceMask relied_on(std::uint32_t t);
  [[nodiscard]] bool cover_one(std::size_t i, const SurfaceChange& change);
  void find_ring(const SurfaceChange& change);
  [[nodiscard]] bool added_faces_near();
  [[nodiscard]] Refusal examine_removal();
  [[nodiscard]] bool cover_by_others(std::size_t i);
};

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
  return provable(local->sufficient_around(box, tolerance));
}

void DeviationTracker::Impl::put_face(std::uint32_t id, const Corners& at, std::uint32_t near) {
  if (id >= corners.size()) {
    corners.resize(std::size_t{id} + 1);
    nearest.resize(std::size_t{id} + 1, 0);
    candidates.resize(std::max(candidates.size(), std::size_t{id} + 1));
  }
  cover.reserve_face(id);
  for (MarkedIds* marks : {&removed_marks, &kept_marks}) marks->reserve(id);
  corners[id] = at;
  nearest[id] = near;
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
    const Corners face = corners_of(pending.added[k]);
    if (degree.covers(face, limit, magnitude, hint)) {
      ++stats.faces_by_degree;
      continue;
    }
    if (proximity.triangle_within(at, limit, hint, most_cuts_of_added_face) != Verdict::Within) return false;
  }
  return true;
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

void DeviationTracker::start(std::uint32_t id, std::uint32_t triangle) {
  const Triangle& t = impl_->triangles[triangle];
  impl_->put_face(id, {impl_->vertices[t[0]], impl_->vertices[t[1]], impl_->vertices[t[2]]}, triangle);
  CoverAssignment::Ids itself{id};
  impl_->cover.assign(triangle, itself);
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
  impl_->select(change);
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
  CoverAssignment::Ids& ids = pending.covers[i];
  ids.clear();
  for (FaceMask used = forward.cover(pending.affected[i], ForwardCover::first(forward.size()), 0); used != 0;
       used &= used - 1)
    ids.push_back(forward.face(std::countr_zero(used)));
  return !ids.empty();
}

void DeviationTracker::commit() {
  Impl::Pending& pending = impl_->pending;
  if (!pending.admitted) throw Error("commit without an admitted change");
  pending.admitted = false;
  for (std::size_t k = 0; k < pending.added.size(); ++k) {
    const TrackedFace& face = pending.added[k];
    impl_->put_face(face.id, corners_of(face), pending.nearest[k]);
  }
  for (std::size_t i = 0; i < pending.affected.size(); ++i) impl_->cover.assign(pending.affected[i], pending.covers[i]);
}

void DeviationTracker::sample(std::span<const std::uint32_t> removed) {
  std::vector<Corners>& faces = impl_->deviation_faces;
  std::vector<std::uint32_t>& originals = impl_->deviation_originals;
  faces.clear();
  originals.clear();
  std::uint32_t hint = 0;
  for (const std::uint32_t face : removed) {
    faces.push_back(impl_->corners[face]);
    hint = impl_->nearest[face];
    const auto of_face = impl_->cover.originals_of(face);
    originals.insert(originals.end(), of_face.begin(), of_face.end());
  }
  impl_->deviation.begin(impl_->tolerance, originals, faces, hint);
}

SampledDeviation DeviationTracker::sampled_deviation(std::span<const TrackedFace> added,
                                                     std::span<const std::size_t> moved_corner) {
  impl_->deviation_faces.clear();
  for (std::size_t i = 0; i < added.size(); ++i) {
    const auto corner = [&](std::size_t k) { return to_vec3(added[i].corners[(moved_corner[i] + k) % 3]); };
    impl_->deviation_faces.push_back({corner(0), corner(1), corner(2)});
  }
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
