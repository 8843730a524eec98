// SPDX-License-Identifier: MIT
#include "simplify/cover/prepared_faces.h"

#include <algorithm>

#include "geometry/position_table.h"
#include "simplify/cover/candidate_faces.h"

namespace meshbound {

PreparedFaces::Entry& PreparedFaces::entry(std::uint32_t face) {
  Entry& entry = entries_[face % entry_count];
  const Corners corners = mesh_.triangle(face);
  if (entry.face != face || !std::equal(corners.begin(), corners.end(), entry.corners.begin(), same_position)) {
    entry.face = face, entry.corners = corners;
    entry.has_triangle = false;
    entry.tolerance_of_planes = -1;
  }
  return entry;
}

const PreparedTriangle& PreparedFaces::triangle(std::uint32_t face) {
  Entry& at = entry(face);
  if (!at.has_triangle) {
    const auto& [a, b, c] = at.corners;
    at.triangle = PreparedTriangle({a, b - a, c - a});
    at.has_triangle = true;
  }
  return at.triangle;
}

const FacePlanes& PreparedFaces::planes(std::uint32_t face, double tolerance) {
  Entry& at = entry(face);
  if (at.tolerance_of_planes == tolerance) return at.planes;
  at.tolerance_of_planes = tolerance;
  // The kernel makes those of four triangles.
  const std::array corners{at.corners, at.corners, at.corners, at.corners};
  PlaneBlock block;
  const unsigned accurate = kernel_.set(block, corners.data(), tolerance, CandidateFaces::plane_slack * tolerance);
  at.planes.are_accurate = (accurate & 1U) != 0;
  for (std::size_t k = 0; k < PlaneBlock::planes; ++k) {
    at.planes.x[k] = block.x[k][0], at.planes.y[k] = block.y[k][0], at.planes.z[k] = block.z[k][0];
    at.planes.offset[k] = block.offset[k][0];
  }
  return at.planes;
}

}  // namespace meshbound
