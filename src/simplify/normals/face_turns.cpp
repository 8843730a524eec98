// SPDX-License-Identifier: MIT
#include "simplify/normals/face_turns.h"

#include <numbers>

#include "simplify/mesh/nearest_triangle.h"

namespace meshbound {

FaceTurns::FaceTurns(const ArrayMesh& start, std::vector<std::uint8_t> is_turned_over, const Limits& limits)
    : is_turned_over_(std::move(is_turned_over)),
      max_angle_(limits.degrees / 180 * std::numbers::pi),
      min_cosine_(std::cos(max_angle_)),
      lists_(start.face_count()) {
  std::vector<FacedTriangle> triangles;
  for (std::uint32_t f = 0; f < start.face_count(); ++f) {
    const TriangleCorners corners = start.triangle(f);
    const FacedTriangle triangle{corners, normal(f, corners)};
    if (squared_length(triangle.normal) == 0) continue;
    triangles.push_back(triangle);
    samples_.push_back({triangle.middle(), triangle.normal});
    lists_.add(f);
    face_of_.push_back(f);
  }
  start_of_ = face_of_;
  rivals_.emplace(triangles, Rivals::Limits{limits.reach, min_cosine_, limits.threads});
}

Vec3 FaceTurns::normal(std::uint32_t face, const TriangleCorners& corners) const {
  const Vec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double size = length(across);
  if (!(size > 0)) return {};
  return (is_turned_over_[face] != 0 ? -1 / size : 1 / size) * across;
}

void FaceTurns::give_back(const ArrayMesh& mesh, std::span<const std::uint32_t> faces) {
  std::vector<std::uint32_t> samples;
  for (const std::uint32_t f : faces) {
    for_each_sample(f, [&](std::uint32_t s) { samples.push_back(s); });
    clear(f);
  }
  NearestTriangle nearest;
  std::vector<std::uint32_t> present;
  for (const std::uint32_t f : faces) {
    if (mesh.is_removed(f)) continue;
    nearest.add(mesh.triangle(f));
    present.push_back(f);
  }
  for (const std::uint32_t s : samples) give_to(s, present[nearest(samples_[s].at)]);
}

}  // namespace meshbound
