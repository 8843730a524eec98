// SPDX-License-Identifier: MIT
#include "simplify/proof_worker.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "geometry/boxes.h"
#include "numeric/sort_unique.h"

namespace meshbound {

ProofWorkers::Worker::Worker(const DecimationState& state)
    : state_(state),
      cover_(state.vertices, state.triangles),
      original_{state.vertices, state.triangles, state.neighbours},
      affected_members_(state.clustered.clusters.count(), 0),
      slab_proof_(original_, state.clustered.clusters, state.clustered.slabs),
      proximity_(state.tree),
      prepared_(MeshSoup{state.mesh}),
      loops_(state.vertices, state.triangles, prepared_),
      sub_triangles_(state.mesh, cover_) {}

void ProofWorkers::Worker::forget_faces() {
  prepared_.forget();
  loops_.forget();
}

std::span<const std::uint32_t> ProofWorkers::Worker::cover(std::uint32_t t) {
  drafted_.clear();
  const TriangleCorners corners = state_.original(t);
  const double limit = state_.limit_around(corners);
  if (!(limit > 0)) return {};
  std::array<std::uint32_t, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) at[k] = sample_face(state_.triangles[t][k]);
  for (std::size_t k = 0; k < 3; ++k) {
    if (at[k] == no_index || (k > 0 && at[k] == at[0]) || (k == 2 && at[2] == at[1])) continue;
    if (holds(at[k], corners, limit)) return draft(at[k]);
  }
  const auto known = std::find_if(at.begin(), at.end(), [](std::uint32_t f) { return f != no_index; });
  const auto is_usable = [](std::uint32_t) { return true; };
  if (known != at.end()) {
    const std::uint32_t under = face_under(centroid(corners), *known);
    if (holds(under, corners, limit)) return draft(under);
    loops_.set_tolerance(limit, state_.magnitude);
    const auto start_at = [&](std::uint32_t from, std::uint32_t) { return LoopCover::Start{sample_face(from), false}; };
    if (loops_.covers(t, start_at, is_usable, drafted_)) return drafted_;
  }
  if (const std::uint32_t f = across(at, corners, limit); f != no_index) return draft(f);
  if (find_around(at, {corners, state_.tolerance})) cover_by_found(t, corners, limit, is_usable);
  return drafted_;
}

std::span<const std::uint32_t> ProofWorkers::Worker::cover_anywhere(std::uint32_t t, const FaceBoxes& boxes) {
  drafted_.clear();
  const TriangleCorners corners = state_.original(t);
  const double limit = state_.limit_around(corners);
  if (!(limit > 0)) return {};
  found_.clear();
  const ReachOfTriangle reach(corners, state_.tolerance);
  if (!boxes.find_few(reach.box(), max_found, found_)) {
    (void)sub_triangles_.covers(corners, boxes, limit, drafted_);
    return drafted_;
  }
  std::erase_if(found_,
                [&](std::uint32_t f) { return state_.mesh.is_removed(f) || !reach.meets(state_.mesh.triangle(f)); });
  if (!sub_triangles_.is_near_one_of(found_, centroid(corners), limit)) return {};
  const auto one =
      std::find_if(found_.begin(), found_.end(), [&](std::uint32_t f) { return holds(f, corners, limit); });
  if (one != found_.end()) return draft(*one);
  (void)sub_triangles_.covers(corners, found_, limit, drafted_);
  return drafted_;
}

bool ProofWorkers::Worker::is_near(std::uint32_t face, std::uint32_t& near) {
  const TriangleCorners corners = state_.mesh.triangle(face);
  for (const Vec3 p : corners)
    if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= state_.magnitude + state_.tolerance)) return false;
  const double limit = state_.limit_around(corners);
  if (!(limit > 0)) return false;
  const bool is_large = has_room_for_clusters(corners, near);
  if (is_large && slab_proof_.covers(corners, limit, state_.magnitude, near)) return true;
  open_parts_.clear();
  original_patches_.cover(
      original_, {corners, 0}, limit, state_.magnitude,
      [&](const TriangleCorners& part) {
        (void)proximity_.upper_distance(to_eigen(centroid(part)), near, limit);
        return near;
      },
      is_large ? max_strips_of_large : 1, open_parts_);
  return std::all_of(open_parts_.begin(), open_parts_.end(), [&](const PatchCover::Part& part) {
    const auto& [a, b, c] = part.corners;
    return proximity_.triangle_within({to_eigen(a), to_eigen(b), to_eigen(c)}, limit, near) == Verdict::Within;
  });
}

bool ProofWorkers::Worker::cover_change(std::span<const std::uint32_t> changed, const Split& split,
                                        std::uint32_t region) {
  forget_faces();
  meets_seam_ = false;
  lost_point_.reset();
  find_affected(changed);
  const auto owned = [&](std::uint32_t face) { return split.owns_face(region, face); };
  if (!split.region_of.empty()) {
    for (const std::uint32_t t : affected_)
      if (!is_covered_in(split, region, state_.cover, t)) return meets_seam_ = true, false;
  }
  if (affected_.empty()) return true;
  Eigen::AlignedBox3d box;
  if (state_.local) {
    for (const std::uint32_t t : affected_) box.extend(box_of(state_.original(t)));
    for (const std::uint32_t face : changed)
      if (!state_.mesh.is_removed(face)) box.extend(box_of(state_.mesh.triangle(face)));
  }
  const double limit = state_.local ? state_.limit_in(box) : state_.limit;
  if (!(limit > 0)) return false;
  cover_.begin(limit);
  found_marks_.clear();
  found_.clear();
  for (const std::uint32_t face : changed) {
    found_marks_.insert(face);
    if (!state_.mesh.is_removed(face)) enter_face(face);
  }
  const FaceMask added = ForwardCover::first(cover_.size());
  const std::size_t added_count = found_.size();
  begin_covers();
  in_pieces_.clear();
  const bool has_large_faces = affected_.size() >= min_originals_of_face * added_count;
  for (std::size_t first = 0; first < affected_.size();) {
    const std::size_t end = has_large_faces ? end_of_cluster(first) : affected_.size();
    if (!has_large_faces || !cover_cluster(first, end, added)) cover_one_by_one(first, end, added);
    first = end;
  }
  loops_.set_tolerance(limit, state_.magnitude);
  bool has_ring = false;
  for (const std::size_t i : in_pieces_) {
    const std::uint32_t t = affected_[i];
    const auto start_at = [&](std::uint32_t from, std::uint32_t to) { return start_of_walk(t, from, to, added); };
    if (!loops_.covers(t, start_at, owned, drafted_)) {
      if (!std::exchange(has_ring, true)) {
        enter_ring(added_count, owned);
        enter_covers();
      }
      if (!cover_by_candidates(t, limit, owned)) return lost_point_ = cover_.lost_point(), false;
    }
    set_cover(i, drafted_);
  }
  meets_seam_ = false;
  return true;
}

void ProofWorkers::Worker::assign_covers(CoverAssignment& cover) const {
  cover.assign(affected_, [&](std::size_t i) { return std::span(ids_).subspan(covers_[i].begin, covers_[i].count); });
}

bool ProofWorkers::Worker::cover_group(std::span<const std::uint32_t> changed, const Split& split,
                                       std::uint32_t region) {
  forget_faces();
  find_affected(changed);
  const auto owned = [&](std::uint32_t face) { return split.owns_face(region, face); };
  begin_covers();
  for (std::size_t i = 0; i < affected_.size(); ++i) {
    if (!is_covered_in(split, region, state_.cover, affected_[i])) return false;
    if (!cover_among(affected_[i], changed, owned)) return false;
    set_cover(i, drafted_);
  }
  return true;
}

void ProofWorkers::Worker::find_affected(std::span<const std::uint32_t> changed) {
  affected_clusters_.clear();
  for (const std::uint32_t face : changed) {
    if (state_.is_fixed[face] != 0) continue;
    for (const std::uint32_t t : state_.cover.originals_of(face)) {
      OriginalClusters::Members& members = affected_members_[OriginalClusters::cluster_of(t)];
      if (members == 0) affected_clusters_.push_back(OriginalClusters::cluster_of(t));
      members |= OriginalClusters::member(t);
    }
  }
  affected_.clear();
  for (const std::uint32_t c : affected_clusters_) {
    for (unsigned members = affected_members_[c]; members != 0; members &= members - 1)
      affected_.push_back(c * OriginalClusters::size + static_cast<std::uint32_t>(std::countr_zero(members)));
    affected_members_[c] = 0;
  }
}

std::uint32_t ProofWorkers::Worker::sample_face(std::uint32_t vertex) const {
  const std::uint32_t face = state_.samples.face_of(vertex);
  return face == no_index || state_.mesh.is_removed(face) ? no_index : face;
}

std::size_t ProofWorkers::Worker::end_of_cluster(std::size_t first) const {
  const std::uint32_t cluster = OriginalClusters::cluster_of(affected_[first]);
  std::size_t end = first + 1;
  while (end < affected_.size() && OriginalClusters::cluster_of(affected_[end]) == cluster) ++end;
  return end;
}

bool ProofWorkers::Worker::cover_cluster(std::size_t first, std::size_t end, FaceMask allowed) {
  const std::uint32_t cluster = OriginalClusters::cluster_of(affected_[first]);
  if (end - first < min_affected_of_cluster) return false;
  const FaceMask used = cover_.hold_all(state_.clustered.clusters.vertices(cluster), allowed);
  if (used == 0) return false;
  set_cover(first, used);
  const auto covers = std::span(covers_).subspan(first, end - first);
  std::fill(covers.begin(), covers.end(), covers.front());
  return true;
}

void ProofWorkers::Worker::cover_one_by_one(std::size_t first, std::size_t end, FaceMask allowed) {
  for (std::size_t i = first; i < end; ++i) {
    const FaceMask used = cover_.cover_whole(affected_[i], allowed);
    set_cover(i, used);
    if (used == 0) in_pieces_.push_back(i);
  }
}

void ProofWorkers::Worker::begin_covers() {
  ids_.clear();
  covers_.assign(affected_.size(), {});
}

void ProofWorkers::Worker::set_cover(std::size_t i, std::span<const std::uint32_t> faces) {
  covers_[i] = {ids_.size(), faces.size()};
  ids_.insert(ids_.end(), faces.begin(), faces.end());
}

void ProofWorkers::Worker::set_cover(std::size_t i, FaceMask used) {
  covers_[i] = {ids_.size(), static_cast<std::size_t>(std::popcount(used))};
  take(used, ids_);
}

template <class Usable>
bool ProofWorkers::Worker::cover_by_patches(const TriangleCorners& corners, double limit, const Usable& is_usable) {
  drafted_.clear();
  open_parts_.clear();
  patches_.cover(UsableFaces<Usable>{{state_.mesh}, is_usable}, {corners, 0}, limit, state_.magnitude, found_, drafted_,
                 open_parts_);
  for (const PatchCover::Part& part : open_parts_) {
    const std::optional<FaceMask> used = cover_.cover_sub_triangle(part.corners, part.cuts);
    if (!used || *used == 0) return drafted_.clear(), false;
    take(*used, drafted_);
  }
  sort_unique(drafted_);
  return true;
}

LoopCover::Start ProofWorkers::Worker::start_of_walk(std::uint32_t t, std::uint32_t from, std::uint32_t to,
                                                     FaceMask added) {
  if (const FaceMask of_start = cover_.holding(from, added); of_start != 0) {
    const FaceMask of_both = of_start & cover_.holding(to, added);
    return {cover_.face(std::countr_zero(of_both != 0 ? of_both : of_start)), of_both != 0};
  }
  for (const std::uint32_t f : state_.cover.faces_of(t))
    if (!state_.mesh.is_removed(f) && loops_.is_near(f, state_.vertices[from])) return {f, false};
  return {};
}

template <class Usable>
bool ProofWorkers::Worker::cover_by_candidates(std::uint32_t t, double limit, const Usable& is_usable) {
  const FaceMask all = ForwardCover::first(cover_.size());
  if (!cover_.are_corners_near(t, all)) return false;
  if (state_.cover.faces_of(t).size() >= many_faces && cover_by_patches(original_.corners(t), limit, is_usable))
    return true;
  drafted_.clear();
  take(cover_.cover(t, all), drafted_);
  return !drafted_.empty();
}

template <class Usable>
void ProofWorkers::Worker::cover_by_found(std::uint32_t t, const TriangleCorners& corners, double limit,
                                          const Usable& is_usable) {
  if (found_.size() <= CandidateFaces::capacity) {
    if (cover_by_few(t, limit)) return;
    if (!cover_.lost_point() && cover_by_patches(corners, limit, is_usable)) return;
  }
  (void)sub_triangles_.covers(corners, found_, limit, drafted_);
}

bool ProofWorkers::Worker::cover_by_few(std::uint32_t t, double limit) {
  cover_.begin(limit);
  for (const std::uint32_t f : found_) cover_.add(state_.mesh.triangle(f), f);
  take(cover_.cover_thoroughly(t, ForwardCover::first(cover_.size())), drafted_);
  return !drafted_.empty();
}

template <class Owned>
void ProofWorkers::Worker::enter_ring(std::size_t count, const Owned& owned) {
  vertex_marks_.clear();
  for (std::size_t k = 0; k < count; ++k) {
    for (Corner c = 3 * found_[k]; c < 3 * found_[k] + 3; ++c) {
      if (!vertex_marks_.insert(state_.mesh.vertex(c))) continue;
      state_.mesh.for_each_corner(state_.mesh.vertex(c), [&](Corner d) {
        if (!found_marks_.insert(d / 3)) return true;
        if (owned(d / 3))
          enter_face(d / 3);
        else
          meets_seam_ = true;
        return found_.size() < CandidateFaces::capacity;
      });
    }
  }
}

void ProofWorkers::Worker::enter_covers() {
  for (const std::size_t i : in_pieces_)
    for (const std::uint32_t f : state_.cover.faces_of(affected_[i]))
      if (!state_.mesh.is_removed(f) && found_marks_.insert(f)) enter_face(f);
}

void ProofWorkers::Worker::enter_face(std::uint32_t face) {
  found_.push_back(face);
  cover_.add(state_.mesh.triangle(face), face);
}

std::uint32_t ProofWorkers::Worker::face_under(Vec3 p, std::uint32_t face) const {
  for (int steps = 0; steps < max_steps; ++steps) {
    const TriangleCorners c = state_.mesh.triangle(face);
    const Vec3 normal = cross(c[1] - c[0], c[2] - c[0]);
    std::uint32_t next = no_index;
    double furthest = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Vec3 edge = c[(k + 1) % 3] - c[k];
      const double beyond = dot(cross(p - c[k], edge), normal);
      if (!(beyond > 0) || !(beyond * beyond > furthest * squared_length(edge))) continue;
      const Corner twin = state_.mesh.twin(3 * face + k);
      if (twin == no_index) continue;
      furthest = beyond * beyond / squared_length(edge);
      next = twin / 3;
    }
    if (next == no_index) break;
    face = next;
  }
  return face;
}

std::uint32_t ProofWorkers::Worker::across(const std::array<std::uint32_t, 3>& faces, const TriangleCorners& corners,
                                           double limit) {
  for (const std::uint32_t f : faces) {
    if (f == no_index) continue;
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
      const Corner twin = state_.mesh.twin(c);
      if (twin != no_index && holds(twin / 3, corners, limit)) return twin / 3;
    }
  }
  return no_index;
}

bool ProofWorkers::Worker::holds(std::uint32_t face, const TriangleCorners& points, double limit) {
  const PreparedTriangle& triangle = prepared_.triangle(face);
  return std::all_of(points.begin(), points.end(), [&](Vec3 p) { return triangle.is_within(p, limit * limit); });
}

template <class Owned>
bool ProofWorkers::Worker::cover_among(std::uint32_t t, std::span<const std::uint32_t> changed, const Owned& owned) {
  drafted_.clear();
  const TriangleCorners corners = state_.original(t);
  const double limit = state_.limit_around(corners);
  if (!(limit > 0)) return false;
  for (const std::uint32_t f : state_.cover.faces_of(t)) {
    if (state_.mesh.is_removed(f) || !holds(f, corners, limit)) continue;
    drafted_.push_back(f);
    return true;
  }
  const ReachOfTriangle reach(corners, state_.tolerance);
  found_.clear();
  found_marks_.clear();
  for (const std::uint32_t f : changed) {
    if (state_.mesh.is_removed(f) || !reach.meets(state_.mesh.triangle(f))) continue;
    found_marks_.insert(f);
    found_.push_back(f);
  }
  if (found_.size() <= CandidateFaces::capacity && cover_by_few(t, limit)) return true;
  spread(reach, owned);
  cover_by_found(t, corners, limit, owned);
  return !drafted_.empty();
}

bool ProofWorkers::Worker::find_around(const std::array<std::uint32_t, 3>& at, const ReachOfTriangle& reach) {
  found_.clear();
  found_marks_.clear();
  for (const std::uint32_t f : at)
    if (f != no_index && found_marks_.insert(f)) found_.push_back(f);
  return spread(reach, [](std::uint32_t) { return true; });
}

template <class Wanted>
bool ProofWorkers::Worker::spread(const ReachOfTriangle& reach, const Wanted& is_wanted) {
  vertex_marks_.clear();
  std::size_t looked_at = 0;
  const auto goes_on = [&] { return found_.size() < max_found && looked_at < max_looked_at; };
  for (std::size_t i = 0; i < found_.size() && goes_on(); ++i) {
    for (Corner c = 3 * found_[i]; c < 3 * found_[i] + 3; ++c) {
      if (!vertex_marks_.insert(state_.mesh.vertex(c))) continue;
      state_.mesh.for_each_corner(state_.mesh.vertex(c), [&](Corner d) {
        const std::uint32_t f = d / 3;
        ++looked_at;
        if (found_marks_.insert(f) && is_wanted(f) && reach.meets(state_.mesh.triangle(f))) found_.push_back(f);
        return goes_on();
      });
    }
  }
  return goes_on();
}

std::span<const std::uint32_t> ProofWorkers::Worker::draft(std::uint32_t face) {
  drafted_.assign(1, face);
  return drafted_;
}

void ProofWorkers::Worker::take(FaceMask used, std::vector<std::uint32_t>& faces) const {
  for (; used != 0; used &= used - 1) faces.push_back(cover_.face(std::countr_zero(used)));
}

bool ProofWorkers::Worker::has_room_for_clusters(const TriangleCorners& face, std::uint32_t near) const {
  const auto twice_area = [](const TriangleCorners& c) { return length(cross(c[1] - c[0], c[2] - c[0])); };
  const double perimeter = length(face[1] - face[0]) + length(face[2] - face[1]) + length(face[0] - face[2]);
  const double incircle = twice_area(face) / perimeter;
  return 2 * incircle * incircle >= min_incircle * min_incircle * twice_area(original_.corners(near));
}

}  // namespace meshbound
