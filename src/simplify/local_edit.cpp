// SPDX-License-Identifier: MIT
#include "simplify/local_edit.h"

#include <algorithm>
#include <cmath>

#include "geometry/point_triangle.h"
#include "geometry/unit.h"
#include "numeric/no_index.h"
#include "simplify/repair.h"

namespace meshbound {
namespace {

/// Points of edges that are looked at where no walk leads: seven tell which way to go, 15 whether a proof is worth its
/// time, as an edge may leave the original anywhere.
constexpr int points_to_guide = 7, points_to_test = 15;

/// Originals that a walk below an edge passes. With 16 `high` takes 1.15 of the time for 0.6% more faces (three meshes
/// at 0.1%).
constexpr int max_walk_passes = 64;

/// Originals below the edges around a vertex and its neighbours, which are walked along again and again: with 128
/// `high` takes 9% longer (four meshes at 0.1%).
constexpr std::size_t originals_of_ring = 1024;

constexpr std::size_t min_degree = 3;

/// Where the sum is smaller, the worst sample at a tenth of the tolerance, there is nothing to gain by a flip, and one
/// that lowers it by a smaller share is not worth a proof.
constexpr double min_deviation_sum = 1e-6, min_flip_gain = 0.05;

}  // namespace

LocalEdit::LocalEdit(DecimationState& state)
    : state_(state), samples_(state, originals_of_ring), proximity_(state.tree) {}

void LocalEdit::enter(const Split& split, Region& region) {
  split_ = &split;
  region_ = &region;
}

bool LocalEdit::owns_around(std::uint32_t vertex) const {
  return owns(vertex) && state_.mesh.for_each_corner(
                             vertex, [&](Corner c) { return owns(state_.mesh.end(c)) && owns(state_.mesh.apex(c)); });
}

bool LocalEdit::has_edge(std::uint32_t a, std::uint32_t b) const {
  return !state_.mesh.for_each_corner(a, [&](Corner c) { return state_.mesh.end(c) != b && state_.mesh.apex(c) != b; });
}

void LocalEdit::begin() {
  taken_.clear(), numbers_.clear(), beside_.clear(), before_.clear(), corners_.clear(), below_edges_.clear();
  near_ = state_.nearest[edge_ / 3];
  samples_.begin(origin_);
}

void LocalEdit::take_face(std::uint32_t face) {
  taken_.push_back(face);
  samples_.add_face(face);
}

/// The face across an edge of the rim, where it belongs to the region.
void LocalEdit::take_beside(Corner rim) {
  const Corner across = state_.mesh.twin(rim);
  if (across != no_index && owns(state_.mesh.apex(across))) beside_.push_back(across / 3);
}

bool LocalEdit::may_move(std::uint32_t vertex) const {
  return !state_.keeps_positions && state_.locked[vertex] == 0 && !state_.lines.is_on_line(vertex) &&
         !state_.mesh.is_border(vertex) && owns_around(vertex);
}

bool LocalEdit::gather_move(std::uint32_t vertex) {
  const ArrayMesh& mesh = state_.mesh;
  if (!mesh.is_vertex(vertex) || !may_move(vertex)) return false;
  kind_ = Edit::Kind::Move;
  edge_ = mesh.corner_of(vertex);
  origin_ = mesh.position(vertex);
  begin();
  return mesh.for_each_corner(vertex, [&](Corner c) {
    take_face(c / 3);
    numbers_.push_back(c / 3);
    corners_.push_back({origin_, mesh.position(mesh.end(c)), mesh.position(mesh.apex(c))});
    before_.push_back(guarded_face(c));
    take_beside(next_corner(c));
    return numbers_.size() < max_faces_of_star;
  });
}

bool LocalEdit::gather_flip(Corner edge) {
  const ArrayMesh& mesh = state_.mesh;
  const Corner other = mesh.twin(edge);
  if (other == no_index) return false;
  const std::uint32_t a = mesh.start(edge), b = mesh.end(edge), c = mesh.apex(edge), d = mesh.apex(other);
  if (c == d || state_.locked[a] != 0 || state_.locked[b] != 0) return false;
  for (const Corner e : {edge, other})  // corners of a flipped edge's faces stand for other edges afterwards
    for (const Corner side : {e, next_corner(e), previous_corner(e)})
      if (state_.lines.is_line(mesh, side)) return false;
  for (const std::uint32_t v : {a, b, c, d})
    if (!owns(v)) return false;
  for (const std::uint32_t v : {a, b}) {
    std::size_t degree = 0;
    if (mesh.for_each_corner(v, [&](Corner) { return ++degree <= min_degree; })) return false;
  }
  if (has_edge(c, d)) return false;
  kind_ = Edit::Kind::Flip;
  edge_ = edge;
  origin_ = mesh.position(a);
  begin();
  for (const Corner e : {edge, other}) {
    take_face(e / 3);
    numbers_.push_back(e / 3);
    corners_.push_back({mesh.position(mesh.start(e)), mesh.position(mesh.end(e)), mesh.position(mesh.apex(e))});
    before_.emplace_back(corners_.back());
    take_beside(next_corner(e));
    take_beside(previous_corner(e));
  }
  set_faces();
  return true;
}

bool LocalEdit::gather_collapse(Corner edge) {
  const ArrayMesh& mesh = state_.mesh;
  if (!star_.gather(mesh, edge)) return false;
  if (!may_move(star_.kept) || !may_move(star_.gone)) return false;
  kind_ = Edit::Kind::Collapse;
  edge_ = edge;
  origin_ = mesh.position(star_.kept);
  begin();
  for (const std::uint32_t face : star_.removed) take_face(face);
  for (const Corner c : star_.moved) {
    take_face(c / 3);
    numbers_.push_back(c / 3);
    corners_.push_back({mesh.position(mesh.start(c)), mesh.position(mesh.end(c)), mesh.position(mesh.apex(c))});
    before_.push_back(guarded_face(c));
    take_beside(next_corner(c));
  }
  return true;
}

void LocalEdit::set_faces() {
  faces_.clear();
  for (const TriangleCorners& c : corners_) faces_.emplace_back(c[0] - origin_, c[1] - origin_, c[2] - origin_);
  note_shared_sides(faces_);
}

bool LocalEdit::place(Vec3 point) {
  bool allowed = true;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    corners_[i][0] = point;
    allowed = allowed && before_[i].allows(corners_[i]);
  }
  set_faces();
  return allowed;
}

/// The corners of (a, b, c) and (b, a, d) become those of (c, d, b) and (d, c, a), as `ArrayMesh::flip` makes them.
bool LocalEdit::place_flipped() {
  const Vec3 a = corners_[0][0], b = corners_[0][1], c = corners_[0][2], d = corners_[1][2];
  corners_ = {{c, d, b}, {d, c, a}};
  below_edges_.clear();
  set_faces();
  return std::all_of(before_.begin(), before_.end(),
                     [&](const GuardedFace& face) { return face.allows(corners_[0]) && face.allows(corners_[1]); });
}

bool LocalEdit::flip_lowers_deviation(Corner edge) {
  if (!gather_flip(edge)) return false;
  const double now = deviation().sum;
  const double enough = (1 - min_flip_gain) * now;
  return now >= min_deviation_sum && place_flipped() && deviation(enough).sum < enough;
}

/// A point of an edge, which moves by `share` of what the vertex does, and an original triangle near it.
void LocalEdit::add_point(Vec3 p, std::uint32_t near, double share, DeviationSums& sums) const {
  const auto& t = state_.triangles[near];
  const Vec3 corner = state_.vertices[t[0]];
  const CornerTriangle<double> nearest{corner, state_.vertices[t[1]] - corner, state_.vertices[t[2]] - corner};
  // It is the point of the edge that moves here, not the closest one.
  sums.add((1 / state_.tolerance) * closest_on_triangle(nearest, p).offset, -share);
}

/// An original triangle near a point, and near a triangle near that. Where a walk leads to one beyond the tolerance
/// there may be a nearer one that no walk leads to. Looking from 0.5 or 1.25 tolerances on takes 1.03 or 0.98 of the
/// time, for 0.4% or 0.2% more faces (seven meshes at 0.1%).
std::uint32_t LocalEdit::original_near(Vec3 p, std::uint32_t hint) {
  return proximity_.nearby_triangle({p.x, p.y, p.z}, hint, state_.tolerance);
}

/// Where the edge from the vertex is farthest from the originals that a walk passes below it. `near` is an original
/// near the vertex.
LocalEdit::BelowEdge LocalEdit::below_edge(Vec3 vertex, Vec3 end, std::uint32_t near) {
  const StarSamples::Walked walked = samples_.walk_below(vertex, end, near, max_walk_passes);
  if (walked.share < 1) return {};
  if (!walked.farthest) return {true, 0, {}, {}};
  const auto& [a, b, c] = state_.triangles[walked.farthest->near];
  const Vec3 corner = state_.vertices[a];
  const Vec3 normal = unit(cross(state_.vertices[b] - corner, state_.vertices[c] - corner));
  if (squared_length(normal) == 0) return {};
  return {true, 1 - length(walked.farthest->point - vertex) / length(end - vertex), corner, normal};
}

/// Adds the edge from the vertex, at the point where it was farthest from the original; where no walk led to its end,
/// points all along stand for it.
void LocalEdit::add_edge(Vec3 vertex, Vec3 end, const BelowEdge& below, DeviationSums& sums) {
  const auto at = [&](double share) { return share * vertex + (1 - share) * end; };
  if (below.is_known) {
    const double height = dot(below.normal, at(below.share) - below.corner);
    return sums.add((height / state_.tolerance) * below.normal, -below.share);
  }
  std::uint32_t near = near_;
  for (int k = 1; k <= points_to_guide; ++k) {
    const double share = 1 - static_cast<double>(k) / (points_to_guide + 1);
    near = original_near(at(share), near);
    add_point(at(share), near, share, sums);
  }
}

DeviationSums LocalEdit::sampled_deviation() const {
  DeviationSums sums;
  kernel_.add_deviations(samples_.points(), faces_, static_cast<float>(1 / state_.tolerance), sums);
  return sums;
}

DeviationSums LocalEdit::deviation(double enough) {
  DeviationSums sums = sampled_deviation();
  const Vec3 vertex = corners_[0][0];
  near_ = original_near(vertex, near_);
  add_point(vertex, near_, 1, sums);
  const std::span<const TriangleCorners> edges = changing_edges();
  for (std::size_t i = 0; i < edges.size() && sums.sum < enough; ++i) {
    if (i == below_edges_.size()) below_edges_.push_back(below_edge(edges[i][0], edges[i][1], near_));
    add_edge(edges[i][0], edges[i][1], below_edges_[i], sums);
  }
  return sums;
}

/// The faces whose first edges change.
std::span<const TriangleCorners> LocalEdit::changing_edges() const {
  return std::span(corners_).first(kind_ == Edit::Kind::Flip ? 1 : corners_.size());
}

bool LocalEdit::fits(double share) {
  const double limit = share * state_.limit;
  samples_.compare(faces_);
  if (!samples_.hold(beside_, limit)) return false;
  const auto edges = changing_edges();
  return std::all_of(edges.begin(), edges.end(), [&](const TriangleCorners& c) {
    return samples_.is_edge_near(c[0], c[1], near_, points_to_test, limit);
  });
}

void LocalEdit::make() {
  if (grouped_) join_group();
  note_edit(state_, *region_, kind_, edge_, taken_);
  switch (kind_) {
    case Edit::Kind::Move:
      state_.mesh.move(state_.mesh.start(edge_), corners_[0][0]);
      break;
    case Edit::Kind::Flip:
      state_.mesh.flip(edge_);
      break;
    case Edit::Kind::Collapse:
      quadric_before_ = state_.quadrics[star_.kept];
      apply_collapse(state_, *region_, star_, corners_[0][0]);
      break;
  }
}

void LocalEdit::assign_samples() {
  for (const std::uint32_t face : taken_) state_.samples.clear(face);
  if (grouped_) {  // its faces share no samples with others, so that these can be given back
    samples_.compare(faces_);
    samples_.give_to_nearest(numbers_);
  } else {
    samples_.give(numbers_);
    touch(numbers_);
  }
}

void LocalEdit::touch(std::span<const std::uint32_t> faces) {
  for (const std::uint32_t face : faces) {
    if (state_.mesh.is_removed(face)) continue;
    for (Corner c = 3 * face; c < 3 * face + 3; ++c) state_.notes.open(state_.mesh.edge(c));
    for (const std::uint32_t v : state_.mesh.corners(face)) reopen_around(state_, *split_, *region_, v);
  }
}

void LocalEdit::begin_group() {
  grouped_ = true;
  is_of_group_.clear();
  group_.clear();
  owned_before_.clear();
}

void LocalEdit::join_group() {
  for (const std::uint32_t face : taken_) {
    if (!is_of_group_.insert(face)) continue;
    group_.push_back(face);
    for (std::uint32_t s = state_.samples.first(face); s != no_index; s = state_.samples.following(s))
      owned_before_.emplace_back(s, face);
  }
}

bool LocalEdit::group_fits(double share) {
  const ArrayMesh& mesh = state_.mesh;
  const double limit = share * state_.limit;
  for (const std::uint32_t face : group_) {
    if (mesh.is_removed(face)) continue;
    const auto [a, b, c] = mesh.triangle(face);
    samples_.begin(a);
    samples_.add_face(face);
    const SampleFace alone({0, 0, 0}, b - a, c - a);
    samples_.compare({&alone, 1});
    if (!samples_.hold({}, limit)) return false;
  }
  for (const std::uint32_t face : group_) {
    if (mesh.is_removed(face)) continue;
    const TriangleCorners corners = mesh.triangle(face);
    std::uint32_t near = state_.nearest[face];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Corner edge = 3 * face + k;
      const bool is_seen_twice = mesh.twin(edge) != no_index && is_of_group_.contains(mesh.twin(edge) / 3);
      if (is_seen_twice && mesh.edge(edge) != edge) continue;
      if (!samples_.is_edge_near(corners[k], corners[(k + 1) % 3], near, points_to_test, limit)) return false;
    }
  }
  return true;
}

void LocalEdit::keep_group() {
  grouped_ = false;
  touch(group_);
}

void LocalEdit::undo_group() {
  grouped_ = false;
  while (!region_->log.edits.empty()) undo_last(state_, *region_);
  state_.quadrics[star_.kept] = quadric_before_;  // without the rounding of what was added and subtracted
  for (const std::uint32_t face : group_) state_.samples.clear(face);
  for (const auto& [sample, face] : owned_before_) state_.samples.give_to(sample, face);
}

}  // namespace meshbound
