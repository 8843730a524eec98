// SPDX-License-Identifier: MIT
#include "normals/stand_ins.h"

#include <algorithm>
#include <numbers>

#include "geometry/boxes.h"
#include "geometry/eigen_vec3.h"
#include "geometry/offset_from_triangle.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"

namespace meshbound {
namespace {

using Corners = StandIns::Corners;

/// The unit normal; absent for a triangle without area.
std::optional<Eigen::Vector3d> normal_of(const Corners& c) {
  const double longest = std::max({(c[1] - c[0]).stableNorm(), (c[2] - c[1]).stableNorm(), (c[0] - c[2]).stableNorm()});
  if (!(longest > 0)) return std::nullopt;
  const Eigen::Vector3d normal = ((c[1] - c[0]) / longest).cross((c[2] - c[0]) / longest);
  const double length = normal.norm();
  if (!(length > 0)) return std::nullopt;
  return normal / length;
}

double degrees_between(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return std::atan2(p.cross(q).norm(), p.dot(q)) * (180 / std::numbers::pi);
}

}  // namespace

SurfacePoint middle_of(const MeshView& mesh, std::size_t face) {
  const Corners corners = corners_of(mesh, face);
  return {(corners[0] + corners[1] + corners[2]) / 3, static_cast<std::uint32_t>(face)};
}

StandIns::StandIns(const MeshView& b, double tie, int threads) : tie_(tie) {
  mesh_.vertices.reserve(3 * b.triangle_count());
  mesh_.triangles.reserve(b.triangle_count());
  normals_.reserve(b.triangle_count());
  source_.reserve(b.triangle_count());
  for (std::size_t t = 0; t < b.triangle_count(); ++t) {
    const Corners corners = corners_of(b, t);
    const auto normal = normal_of(corners);
    if (!normal) continue;
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), corners.begin(), corners.end());
    mesh_.triangles.push_back({first, first + 1, first + 2});
    normals_.push_back(*normal);
    source_.push_back(static_cast<std::uint32_t>(t));
  }
  if (size() == 0) throw InvalidInput("no triangle has an area, so there are no normals to compare with");
  positions_ = positions_of(mesh_);
  vertex_at_.emplace(positions_);
  face_at_.emplace(mesh_.triangles, positions_, *vertex_at_);
  tree_.emplace(mesh_, BvhOptions{threads});
  std::vector<Eigen::AlignedBox3d> boxes(size());
  for (std::uint32_t f = 0; f < size(); ++f) boxes[f] = box(f);
  boxes_.emplace(boxes);
}

Eigen::AlignedBox3d StandIns::box(std::uint32_t face) const { return box_of(corners(face)); }

void StandIns::complete(const MeshView& a, std::size_t begin, std::span<NearStandIns> near) const {
  std::vector<std::size_t> unknown;
  std::vector<Eigen::Vector3d> middles, normals;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (near[i].is_known()) continue;
    const Corners corners = corners_of(a, begin + i);
    const auto normal = normal_of(corners);
    if (!normal) continue;
    if (has(corners, *normal)) {
      near[i] = {tie_, 0};  // the centroid is rounded off the face by less
      continue;
    }
    unknown.push_back(i);
    middles.push_back(middle_of(a, begin + i).position);
    normals.push_back(*normal);
  }
  const std::vector<ClosestPoint> closest = closest_points(*tree_, middles, {1});
  for (std::size_t k = 0; k < unknown.size(); ++k)
    near[unknown[k]] = {closest[k].distance.upper + tie_,
                        degrees_between(normals[k], normals_[closest[k].point.triangle])};
}

std::vector<FaceTurn> StandIns::turns(const MeshView& a, std::size_t begin, std::span<const NearStandIns> near,
                                      double tolerance) const {
  std::vector<FaceTurn> turns;
  double worst = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (!near[i].is_known() || (!turns.empty() && near[i].degrees <= std::min(worst, tolerance))) continue;
    turns.push_back(turn_of(middle_of(a, begin + i), *normal_of(corners_of(a, begin + i)), near[i].reach));
    worst = std::max(worst, turns.back().degrees);
  }
  return turns;
}

void StandIns::add_others(const StandIns& other, std::vector<Corners>& faces) const {
  for (std::uint32_t f = 0; f < size(); ++f)
    if (!other.has(corners(f), normals_[f])) faces.push_back(corners(f));
}

/// Whether a face has these corners and this normal, up to rounding.
bool StandIns::has(const Corners& corners, const Eigen::Vector3d& normal) const {
  const Triangle at = {vertex_at_->find(to_vec3(corners[0])), vertex_at_->find(to_vec3(corners[1])),
                       vertex_at_->find(to_vec3(corners[2]))};
  if (std::find(at.begin(), at.end(), no_index) != at.end()) return false;
  const std::uint32_t same = face_at_->find(at);
  return same != no_index && normal.dot(normals_[same]) > 0;
}

/// The turn from a face to that of the faces within `reach` of its middle which turns least.
FaceTurn StandIns::turn_of(const SurfacePoint& middle, const Eigen::Vector3d& normal, double reach) const {
  FaceTurn turn{middle, {}, HUGE_VAL};
  std::vector<std::uint32_t> near;
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(reach);
  boxes_->find({middle.position - around, middle.position + around}, near);
  for (const std::uint32_t f : near) {
    const Eigen::Vector3d offset = offset_from_triangle(corners(f), middle.position);
    const double degrees = degrees_between(normal, normals_[f]);
    if (offset.stableNorm() > reach || degrees >= turn.degrees) continue;
    turn.degrees = degrees;
    turn.nearest = {middle.position - offset, source_[f]};
  }
  return turn;
}

bool is_within(const StandIns::Corners& corners, const Eigen::Vector3d& p, double reach) {
  return offset_from_triangle(corners, p).stableNorm() <= reach;
}

}  // namespace meshbound
