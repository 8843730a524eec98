// SPDX-License-Identifier: MIT
#include "simplify/cover/prepared_faces.h"

#include "simplify/cover/candidate_faces.h"

namespace meshbound {

FacePlanes FacePlanes::of(const TriangleCorners& corners, double tolerance, const PlaneKernel& kernel) {
  // The kernel makes those of four triangles.
  const std::array four{corners, corners, corners, corners};
  PlaneBlock block;
  const unsigned accurate = kernel.set(block, four.data(), tolerance, CandidateFaces::plane_slack * tolerance);
  FacePlanes planes;
  planes.are_accurate = (accurate & 1U) != 0;
  for (std::size_t k = 0; k < PlaneBlock::planes; ++k) {
    planes.x[k] = block.x[k][0], planes.y[k] = block.y[k][0], planes.z[k] = block.z[k][0];
    planes.offset[k] = block.offset[k][0];
  }
  return planes;
}

}  // namespace meshbound
