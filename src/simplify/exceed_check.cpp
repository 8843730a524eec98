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

using Corners = std::array<Vec3, 3>;

void add(TriangleMesh& soup, const Corners& corners) {
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  for (const Vec3 p : corners) soup.vertices.emplace_back(p.x, p.y, p.z);
  soup.triangles.push_back({first, first + 1, first + 2});
}

Corners original_triangle(const DecimationState& state, std::uint32_t t) {
  const auto& v = state.triangles[t];
  return {state.vertices[v[0]], state.vertices[v[1]], state.vertices[v[2]]};
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
  const Compared likely = compared_at(placement, region, proposer, tolerance, Faces::Likely);
  if (!is_within(likely.new_faces, state_.tree, tolerance, options)) return true;
  if (is_within(likely.originals, likely.faces, tolerance, options)) return false;
  const Compared all = compared_at(placement, region, proposer, tolerance, Faces::All);
  return !is_within(all.originals, all.faces, tolerance, options);
}

ExceedCheck::Compared ExceedCheck::compared_at(Vec3 placement, Region& region, Proposer& proposer, double tolerance,
                                               Faces wanted) {
  proposer.collapse(region, placement);
  Compared compared;
  Eigen::AlignedBox3d box;
  std::vector<std::uint32_t> affected, faces;
  std::vector<std::uint32_t> star = proposer.star().removed;
  for (const Corner c : proposer.star().moved) star.push_back(c / 3);
  for (const std::uint32_t face : star) {
    if (is_changed_.insert(face)) changed_.push_back(face);
    const auto of_face = state_.cover.originals_of(face);
    affected.insert(affected.end(), of_face.begin(), of_face.end());
    if (state_.mesh.is_removed(face)) continue;
    add(compared.new_faces, state_.mesh.triangle(face));
    faces.push_back(face);
    for (Corner c = 3 * face; c < 3 * face + 3; ++c)
      if (const Corner twin = state_.mesh.twin(c); twin != no_index) faces.push_back(twin / 3);
  }
  sort_unique(affected);
  for (const std::uint32_t t : affected) {
    add(compared.originals, original_triangle(state_, t));
    box.extend(box_of(original_triangle(state_, t)));
    for (const std::uint32_t f : state_.cover.faces_of(t))
      if (!state_.mesh.is_removed(f)) faces.push_back(f);
  }
  if (wanted == Faces::Likely) add_faces_near_corners(affected, tolerance, faces);
  // Rounding of the box is far below the tolerance that it grows by, of which the engine decides the rest.
  if (wanted == Faces::All && !affected.empty()) faces = faces_near(box, 2 * tolerance);
  sort_unique(faces);
  for (const std::uint32_t f : faces) add(compared.faces, state_.mesh.triangle(f));
  if (wanted == Faces::All)
    for (const std::uint32_t t : state_.kept) add(compared.faces, original_triangle(state_, t));
  undo_last(state_, region);
  return compared;
}

}  // namespace meshbound
