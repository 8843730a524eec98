// SPDX-License-Identifier: MIT
#include "simplify/normals/refuted_turns.h"

#include <array>

#include "geometry/boxes.h"
#include "geometry/triangle_corners.h"
#include "simplify/mesh/faces_of_originals.h"

namespace meshbound {
namespace {

/// Whether the nearest of the faces turns little from the sample.
bool holds(const FaceTurns& turns, const ArrayMesh& mesh, const FaceTurns::Sample& sample,
           std::span<const std::uint32_t> faces) {
  double nearest = HUGE_VAL;
  bool is_allowed = true;
  for (const std::uint32_t face : faces) {
    if (face == no_index || mesh.is_removed(face)) continue;
    const TriangleCorners corners = mesh.triangle(face);
    const double squared = squared_distance(corners, sample.at);
    if (squared > nearest) continue;
    const bool is_as_near = squared == nearest;
    nearest = squared;
    is_allowed = turns.allows(sample.normal, turns.normal(face, corners)) || (is_as_near && is_allowed);
  }
  return is_allowed;
}

}  // namespace

std::vector<Refuted> refuted_by_turns(const FaceTurns& turns, const ArrayMesh& mesh,
                                      std::span<const std::uint32_t> source_triangle, std::size_t originals,
                                      std::span<const Refuted> refuted) {
  const std::vector<std::uint32_t> start_of = faces_of_originals(source_triangle, originals);
  std::vector<Refuted> left;
  for (const Refuted& r : refuted) {
    if (r.coordinate || r.original == no_index || start_of[r.original] == no_index) continue;
    const std::uint32_t sample = turns.sample_of_start(start_of[r.original]);
    if (sample != no_index && !holds(turns, mesh, turns.sample(sample), std::array{turns.face_of(sample), r.face}))
      left.push_back(r);
  }
  return left;
}

}  // namespace meshbound
