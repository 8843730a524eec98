// SPDX-License-Identifier: MIT
#include "simplify/mesh/face_turns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numeric/no_index.h"
#include "simplify/mesh/face_box.h"

namespace meshbound {
namespace {

/// Squared distances that differ by less than this share count as equal: the nearest point lies on a common edge.
constexpr double tie = 1e-9;

/// Faces around a vertex that are looked at: a hub has thousands, around which each collapse would look.
constexpr std::size_t max_around = 24;

}  // namespace

FaceTurns::FaceTurns(const ArrayMesh& start, std::vector<std::uint8_t> is_turned_over, double max_degrees)
    : lists(start.face_count()),
      is_turned_over_(std::move(is_turned_over)),
      min_cosine_(std::cos(max_degrees / 180 * std::numbers::pi)) {
  for (std::uint32_t f = 0; f < start.face_count(); ++f) {
    const std::array<Vec3, 3> corners = start.triangle(f);
    const Vec3 unit = normal(f, corners);
    if (squared_length(unit) == 0) continue;
    samples_.push_back({(1.0 / 3) * (corners[0] + corners[1] + corners[2]), unit});
    lists.add(f);
  }
}

Vec3 FaceTurns::normal(std::uint32_t face, const std::array<Vec3, 3>& corners) const {
  const Vec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double size = length(across);
  if (!(size > 0)) return {};
  return (is_turned_over_[face] != 0 ? -1 / size : 1 / size) * across;
}

void FaceTurns::give_back(const ArrayMesh& mesh, std::span<const std::uint32_t> faces) {
  std::vector<std::uint32_t> samples;
  for (const std::uint32_t f : faces) {
    lists.for_each(f, [&](std::uint32_t s) { samples.push_back(s); });
    lists.clear(f);
  }
  NearestTriangle nearest;
  std::vector<std::uint32_t> present;
  for (const std::uint32_t f : faces) {
    if (mesh.is_removed(f)) continue;
    nearest.add(mesh.triangle(f));
    present.push_back(f);
  }
  for (const std::uint32_t s : samples) lists.give_to(s, present[nearest(samples_[s].at)]);
}

void TurnGuard::begin(std::span<const Corner> moved, std::span<const std::uint32_t> removed, double reach) {
  moved_.assign(moved.begin(), moved.end());
  squared_reach_ = reach * reach;
  neighbours_.reset();
  faces_.clear();
  samples_.clear();
  removed_.assign(removed.begin(), removed.end());
  const auto add_samples = [&](std::uint32_t face) {
    turns_.lists.for_each(face, [&](std::uint32_t s) { samples_.push_back(s); });
  };
  for (const Corner c : moved) {
    faces_.push_back({{Vec3{}, mesh_.position(mesh_.end(c)), mesh_.position(mesh_.apex(c))}, {}, c / 3});
    add_samples(c / 3);
  }
  for (const std::uint32_t f : removed) add_samples(f);
}

/// Finds the samples of faces that share a vertex with a face of the star but are not in it. The vertices of a star all
/// belong to the region of its collapse, so no other thread changes these faces or their samples.
void TurnGuard::find_neighbours() {
  around_.clear();
  for (const Corner c : moved_) {
    for (const std::uint32_t v : {mesh_.end(c), mesh_.apex(c)}) {
      std::size_t seen = 0;
      mesh_.for_each_corner(v, [&](Corner d) {
        around_.push_back(d / 3);
        return ++seen < max_around;
      });
    }
  }
  std::sort(around_.begin(), around_.end());
  around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
  neighbours_.emplace();
  for (const std::uint32_t f : around_) {
    const auto is_f = [f](const Face& face) { return face.number == f; };
    if (std::any_of(faces_.begin(), faces_.end(), is_f) ||
        std::find(removed_.begin(), removed_.end(), f) != removed_.end())
      continue;
    turns_.lists.for_each(f, [&](std::uint32_t s) { neighbours_->push_back({s, f, -1}); });
  }
}

bool TurnGuard::is_allowed_by_all(const FaceTurns::Sample& sample) const {
  return std::all_of(faces_.begin(), faces_.end(),
                     [&](const Face& face) { return turns_.allows(sample.normal, face.normal); });
}

bool TurnGuard::turns_little(const FaceTurns::Sample& sample) {
  if (is_allowed_by_all(sample)) return true;  // whichever is nearest
  const auto is_allowed = [&](std::size_t f) { return turns_.allows(sample.normal, faces_[f].normal); };
  const std::size_t nearest = nearest_(sample.at);
  if (is_allowed(nearest)) return true;
  const double limit = (1 + tie) * nearest_.squared_distance(nearest, sample.at);
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (is_allowed(f) && nearest_.may_be_within(f, sample.at, limit) &&
        nearest_.squared_distance(f, sample.at) <= limit)
      return true;
  return false;
}

bool TurnGuard::stays_or_turns_little(Neighbour& neighbour) {
  const FaceTurns::Sample& sample = turns_.sample(neighbour.sample);
  if (!nearest_.may_any_be_within(sample.at, squared_reach_) || is_allowed_by_all(sample)) return true;
  if (neighbour.squared < 0) neighbour.squared = squared_distance(mesh_.triangle(neighbour.face), sample.at);
  const double nearer = (1 - tie) * neighbour.squared;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    if (nearest_.may_be_within(f, sample.at, nearer) && nearest_.squared_distance(f, sample.at) < nearer)
      return turns_little(sample);
  return true;
}

bool TurnGuard::holds(Vec3 point) {
  nearest_.clear();
  for (Face& face : faces_) {
    face.corners[0] = point;
    nearest_.add(face.corners);
    face.normal = turns_.normal(face.number, face.corners);
  }
  if (!std::all_of(samples_.begin(), samples_.end(), [&](std::uint32_t s) { return turns_little(turns_.sample(s)); }))
    return false;
  if (!neighbours_) find_neighbours();
  return std::all_of(neighbours_->begin(), neighbours_->end(),
                     [&](Neighbour& neighbour) { return stays_or_turns_little(neighbour); });
}

void TurnGuard::give_samples(FaceTurns& turns) {
  for (const Face& face : faces_) turns.lists.clear(face.number);
  for (const std::uint32_t f : removed_) turns.lists.clear(f);
  for (const std::uint32_t s : samples_) turns.lists.give_to(s, faces_[nearest_(turns.sample(s).at)].number);
}

}  // namespace meshbound
