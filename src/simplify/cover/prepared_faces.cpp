// SPDX-License-Identifier: MIT
#include "simplify/cover/prepared_faces.h"

#include <algorithm>

#include "geometry/position_table.h"
#include "simplify/cover/candidate_faces.h"

namespace meshbound {

/// What was made stays where the face is as it was.
void PreparedFaces::renew(Entry& entry, std::uint32_t face) const {
  const Corners corners = mesh_.triangle(face);
  if (entry.face != face || !std::equal(corners.begin(), corners.end(), entry.corners.begin(), same_position)) {
    entry.face = face, entry.corners = corners;
    entry.has_triangle = false;
    entry.tolerance_of_planes = -1;
  }
  entry.round = round_;
}

void PreparedFaces::set_triangle(Entry& entry) {
  const auto& [a, b, c] = entry.corners;
  entry.triangle = PreparedTriangle({a, b - a, c - a});
  entry.has_triangle = true;
}

void PreparedFaces::set_planes(Entry& entry, double tolerance) const {
  entry.tolerance_of_planes = tolerance;
  // The kernel makes those of four triangles.
  const std::array corners{entry.corners, entry.corners, entry.corners, entry.corners};
  PlaneBlock block;
  const unsigned accurate = kernel_.set(block, corners.data(), tolerance, CandidateFaces::plane_slack * tolerance);
  FacePlanes& planes = entry.planes;
  planes.are_accurate = (accurate & 1U) != 0;
  for (std::size_t k = 0; k < PlaneBlock::planes; ++k) {
    planes.x[k] = block.x[k][0], planes.y[k] = block.y[k][0], planes.z[k] = block.z[k][0];
    planes.offset[k] = block.offset[k][0];
  }
}

}  // namespace meshbound
