// SPDX-License-Identifier: MIT
#include "simplify/exceed_check.h"

#include <algorithm>
#include <array>

#include "geometry/boxes.h"
#include "geometry/triangle_corners.h"
#include "numeric/no_index.h"
#include "numeric/sort_unique.h"
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

/// All triangles of a soup have vertices of their own.
void add(TriangleMesh& soup, const TriangleCorners& corners) {
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  for (const Vec3 p : corners) soup.vertices.emplace_back(p.x, p.y, p.z);
  soup.triangles.push_back({first, first + 1, first + 2});
}

void add_faces(const DecimationState& state, std::span<const std::uint32_t> faces, TriangleMesh& soup) {
  for (const std::uint32_t f : faces) add(soup, state.mesh.triangle(f));
}
void add_originals(const DecimationState& state, std::span<const std::uint32_t> originals, TriangleMesh& soup) {
  for (const std::uint32_t t : originals) add(soup, state.original(t));
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

/// Adds all that is within `tolerance` of a point, as computed. Returns whether that is more than there was.
bool ExceedCheck::add_what_is_near(Vec3 point, double tolerance, Holders& holders) {
  const Eigen::AlignedBox3d reach = grown(Eigen::AlignedBox3d(to_eigen(point)), tolerance);
  const auto is_near = [&](const TriangleCorners& corners) {
    return box_meets(corners, reach) && squared_distance(corners, point) <= tolerance * tolerance;
  };
  const auto is_face_near = [&](std::uint32_t f) {
    return !state_.mesh.is_removed(f) && is_near(state_.mesh.triangle(f));
  };
  const std::size_t before = holders.faces.size() + holders.kept.size();
  found_.clear();
  boxes_->find(reach, found_);
  for (const std::uint32_t f : found_)
    if (!is_changed_.contains(f) && is_face_near(f)) holders.faces.push_back(f);
  for (const std::uint32_t f : changed_)
    if (is_face_near(f)) holders.faces.push_back(f);
  for (const std::uint32_t t : state_.kept)
    if (is_near(state_.original(t))) holders.kept.push_back(t);
  sort_unique(holders.faces);
  sort_unique(holders.kept);
  return holders.faces.size() + holders.kept.size() > before;
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
  TriangleMesh new_faces;
  add_faces(state_, affected.faces, new_faces);
  if (!new_faces.triangles.empty() &&
      check_one_sided_tolerance(Bvh(new_faces), state_.tree, tolerance, options).verdict != Verdict::Within)
    return true;
  if (affected.originals.empty()) return false;
  TriangleMesh originals;
  add_originals(state_, affected.originals, originals);
  const Bvh tree(originals);
  Holders holders{likely_faces(affected), {}};
  const Vec3 first = state_.original(affected.originals.front())[0];
  if (holders.faces.empty() && !add_what_is_near(first, tolerance, holders)) return true;
  while (const std::optional<Vec3> lost = lost_point(tree, holders, tolerance, options))
    if (!add_what_is_near(*lost, tolerance, holders)) return true;
  return false;
}

std::optional<Vec3> ExceedCheck::lost_point(const Bvh& originals, const Holders& holders, double tolerance,
                                            const DistanceOptions& options) const {
  TriangleMesh soup;
  add_faces(state_, holders.faces, soup);
  add_originals(state_, holders.kept, soup);
  const ToleranceCheck check = check_one_sided_tolerance(originals, Bvh(soup), tolerance, options);
  return check.verdict == Verdict::Within ? std::nullopt : std::optional(to_vec3(check.a_to_b.witness.from.position));
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
  return affected;
}

std::vector<std::uint32_t> ExceedCheck::likely_faces(const Affected& affected) {
  std::vector<std::uint32_t> faces = affected.faces;
  for (const std::uint32_t face : affected.faces)
    for (Corner c = 3 * face; c < 3 * face + 3; ++c)
      if (const Corner twin = state_.mesh.twin(c); twin != no_index) faces.push_back(twin / 3);
  for (const std::uint32_t t : affected.originals)
    for (const std::uint32_t f : state_.cover.faces_of(t))
      if (!state_.mesh.is_removed(f)) faces.push_back(f);
  sort_unique(faces);
  return faces;
}

}  // namespace meshbound
