// SPDX-License-Identifier: MIT
#include "simplify/exceed_check.h"

#include <algorithm>
#include <array>

#include "numeric/no_index.h"
#include "numeric/sort_unique.h"
#include "simplify/mesh/face_box.h"
#include "simplify/repair.h"

namespace meshbound {
namespace {

/// A collapse of the edge that was proposed last, taken back at the end of its life.
class Trial {
 public:
  Trial(DecimationState& state, Region& region, Proposer& proposer, Vec3 placement) : state_(state), region_(region) {
    proposer.collapse(region, placement);
  }
  ~Trial() { undo_last(state_, region_); }
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

 private:
  DecimationState& state_;
  Region& region_;
};

using Corners = std::array<Vec3, 3>;

Corners original_triangle(const DecimationState& state, std::uint32_t t) {
  const auto& v = state.triangles[t];
  return {state.vertices[v[0]], state.vertices[v[1]], state.vertices[v[2]]};
}

/// All triangles of a soup have vertices of their own.
void add(TriangleMesh& soup, const Corners& corners) {
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  for (const Vec3 p : corners) soup.vertices.emplace_back(p.x, p.y, p.z);
  soup.triangles.push_back({first, first + 1, first + 2});
}

void add_faces(const DecimationState& state, std::span<const std::uint32_t> faces, TriangleMesh& soup) {
  for (const std::uint32_t f : faces) add(soup, state.mesh.triangle(f));
}
void add_originals(const DecimationState& state, std::span<const std::uint32_t> originals, TriangleMesh& soup) {
  for (const std::uint32_t t : originals) add(soup, original_triangle(state, t));
}

/// A corner with more faces near it is a hub, or at one.
constexpr std::size_t max_faces_near_corner = 64;

/// h(from, to) <= tolerance; nothing is within the tolerance of an empty mesh.
bool is_within(const TriangleMesh& from, const Bvh& to, double tolerance, const DistanceOptions& options) {
  return from.triangles.empty() ||
         check_one_sided_tolerance(Bvh(from), to, tolerance, options).verdict == Verdict::Within;
}
bool is_within(const TriangleMesh& from, const TriangleMesh& to, double tolerance, const DistanceOptions& options) {
  return from.triangles.empty() || (!to.triangles.empty() && is_within(from, Bvh(to), tolerance, options));
}

}  // namespace

void ExceedCheck::note_change(std::uint32_t kept) {
  if (!boxes_) return;
  state_.mesh.for_each_corner(kept, [&](Corner c) {
    if (is_changed_.insert(c / 3)) changed_.push_back(c / 3);
    return true;
  });
}

/// Where there are none, or too many faces have changed since.
void ExceedCheck::make_boxes() {
  if (boxes_ && !boxes_->are_outdated(changed_.size())) return;
  boxes_.emplace(state_.mesh);
  is_changed_.clear();
  changed_.clear();
}

std::vector<std::uint32_t> ExceedCheck::faces_near(const Eigen::AlignedBox3d& box, double tolerance) {
  const Eigen::AlignedBox3d reach = grown(box, tolerance);
  found_.clear();
  boxes_->find(reach, found_);
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t f : found_)
    if (!state_.mesh.is_removed(f) && !is_changed_.contains(f)) faces.push_back(f);
  for (const std::uint32_t f : changed_)
    if (!state_.mesh.is_removed(f) && box_meets(state_.mesh.triangle(f), reach)) faces.push_back(f);
  return faces;
}

/// Adds the faces near each corner of these originals, unless that is a hub.
void ExceedCheck::add_faces_near_corners(std::span<const std::uint32_t> originals, double tolerance,
                                         std::vector<std::uint32_t>& faces) {
  std::vector<std::uint32_t> corners;
  for (const std::uint32_t t : originals)
    corners.insert(corners.end(), state_.triangles[t].begin(), state_.triangles[t].end());
  sort_unique(corners);
  for (const std::uint32_t v : corners) {
    const std::vector<std::uint32_t> near = faces_near(Eigen::AlignedBox3d(to_eigen(state_.vertices[v])), tolerance);
    if (near.size() <= max_faces_near_corner) faces.insert(faces.end(), near.begin(), near.end());
  }
}

bool ExceedCheck::exceeds(Region& region, Proposer& proposer, double tolerance, const DistanceOptions& options) {
  make_boxes();
  const Corner edge = proposer.star().edge;
  const Vec3 start = state_.mesh.position(state_.mesh.start(edge)), end = state_.mesh.position(state_.mesh.end(edge));
  const std::array placements = {proposer.refused_placement(), start, end, 0.5 * (start + end)};
  return std::all_of(placements.begin(), placements.end(),
                     [&](Vec3 placement) { return exceeds_at(placement, region, proposer, tolerance, options); });
}

bool ExceedCheck::exceeds_at(Vec3 placement, Region& region, Proposer& proposer, double tolerance,
                             const DistanceOptions& options) {
  const Trial trial(state_, region, proposer, placement);
  const Affected affected = affected_by(proposer.star());
  TriangleMesh new_faces, originals, likely, all;
  add_faces(state_, affected.faces, new_faces);
  if (!is_within(new_faces, state_.tree, tolerance, options)) return true;
  add_originals(state_, affected.originals, originals);
  if (originals.triangles.empty()) return false;
  add_faces(state_, likely_faces(affected, tolerance), likely);
  if (is_within(originals, likely, tolerance, options)) return false;
  // Rounding of the box is far below the tolerance that it grows by, of which the engine decides the rest.
  add_faces(state_, faces_near(affected.box, 2 * tolerance), all);
  add_originals(state_, state_.kept, all);
  return !is_within(originals, all, tolerance, options);
}

ExceedCheck::Affected ExceedCheck::affected_by(const EdgeStar& collapsed) {
  Affected affected;
  std::vector<std::uint32_t> star = collapsed.removed;
  for (const Corner c : collapsed.moved) star.push_back(c / 3);
  for (const std::uint32_t face : star) {
    if (is_changed_.insert(face)) changed_.push_back(face);
    if (!state_.mesh.is_removed(face)) affected.faces.push_back(face);
    const auto of_face = state_.cover.originals_of(face);
    affected.originals.insert(affected.originals.end(), of_face.begin(), of_face.end());
  }
  sort_unique(affected.originals);
  for (const std::uint32_t t : affected.originals) affected.box.extend(box_of(original_triangle(state_, t)));
  return affected;
}

std::vector<std::uint32_t> ExceedCheck::likely_faces(const Affected& affected, double tolerance) {
  std::vector<std::uint32_t> faces = affected.faces;
  for (const std::uint32_t face : affected.faces)
    for (Corner c = 3 * face; c < 3 * face + 3; ++c)
      if (const Corner twin = state_.mesh.twin(c); twin != no_index) faces.push_back(twin / 3);
  for (const std::uint32_t t : affected.originals)
    for (const std::uint32_t f : state_.cover.faces_of(t))
      if (!state_.mesh.is_removed(f)) faces.push_back(f);
  add_faces_near_corners(affected.originals, tolerance, faces);
  sort_unique(faces);
  return faces;
}

}  // namespace meshbound
