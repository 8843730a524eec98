// SPDX-License-Identifier: MIT
#include "simplify/candidate_faces.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "numeric/rounding.h"

namespace meshbound {

void CandidateFaces::clear(double tolerance) {
  tolerance_ = tolerance;
  squared_tolerance_ = tolerance * tolerance;
  size_ = 0;
  flat_ = 0;
}

void CandidateFaces::put(int k, const std::array<Vec3, 3>& corners) {
  const Vec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], bc = corners[2] - corners[1];
  triangles_[k] = {corners[0], ab, ac};
  const Vec3 normal = cross(ab, ac);
  const double area = length(normal);
  const double longest = std::sqrt(std::max({squared_length(ab), squared_length(ac), squared_length(bc)}));
  // A cross product of computed edges is off by at most 8u |ab| |ac| in length, so the unit normal turns by at most
  // 8u longest^2 / area and a side plane by twice that; at the distance of a point of the slab that is a displacement
  // of 24u (longest + tolerance) longest^2 / area in all. Beyond the slack, or at zero area, the planes are not used.
  const double displacement = 24 * unit_roundoff * (longest + tolerance_) * longest * longest;
  const bool flat = displacement < plane_slack * tolerance_ * area;
  PlaneBlock& block = blocks_[static_cast<std::size_t>(k / PlaneBlock::lanes)];
  const int lane = k % PlaneBlock::lanes;
  flat_ &= ~(FaceMask{1} << k);
  if (!flat) {
    for (int plane = 0; plane < PlaneBlock::planes; ++plane) block.set(lane, plane, {}, {});
    return;
  }
  flat_ |= FaceMask{1} << k;
  const Vec3 unit = (1 / area) * normal;
  block.set(lane, face_plane, unit, corners[0]);
  const std::array<Vec3, sides> edges = {ab, bc, Vec3{-ac.x, -ac.y, -ac.z}};
  for (int i = 0; i < sides; ++i) block.set(lane, 1 + i, (1 / length(edges[i])) * cross(edges[i], unit), corners[i]);
}

bool CandidateFaces::holds(int k, Vec3 p) const {
  return closest_on_triangle(triangles_[k], p).squared_distance <= squared_tolerance_;
}

FaceMask CandidateFaces::holding(Vec3 p, FaceMask among) const {
  const double squared_reach = squared_tolerance_ * (1 + 2 * plane_slack);
  FaceMask mask = 0;
  for (int first = 0; (among >> first) != 0; first += PlaneBlock::lanes) {
    const unsigned wanted = static_cast<unsigned>(among >> first) & 15U;
    if (wanted == 0) continue;
    const SlabBits bits = test_(block_of(first), p, tolerance_, squared_reach);
    const unsigned inside = bits.inside & wanted & static_cast<unsigned>(flat_ >> first);
    mask |= FaceMask{inside} << first;
    for (unsigned doubtful = (bits.inside | bits.outside) & wanted & ~inside; doubtful != 0; doubtful &= doubtful - 1) {
      const int k = first + std::countr_zero(doubtful);
      if (holds(k, p)) mask |= FaceMask{1} << k;
    }
    if (first + PlaneBlock::lanes == capacity) break;
  }
  return mask;
}

FaceMask CandidateFaces::nearest(Vec3 p, FaceMask among) const {
  FaceMask best = 0;
  double least = HUGE_VAL;
  for (FaceMask rest = among; rest != 0; rest &= rest - 1) {
    const double squared = closest_on_triangle(triangles_[std::countr_zero(rest)], p).squared_distance;
    if (best != 0 && !(squared < least)) continue;
    least = squared;
    best = rest & (~rest + 1);
  }
  return best;
}

double CandidateFaces::reach(Vec3 p, Vec3 q, FaceMask mask) const {
  // Past the side planes by this share of the tolerance a point is still well within it unless it is also high above.
  const double rim = 0.3 * tolerance_;
  double farthest = 0;
  for (FaceMask rest = mask; rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    if (!((flat_ >> k) & 1)) {
      farthest = std::max(farthest, 0.5);
      continue;
    }
    const PlaneBlock& block = block_of(k);
    const int lane = k % PlaneBlock::lanes;
    double share = 1;
    for (int side = 1; side <= sides; ++side) {
      const double from = block.at(lane, side, p), to = block.at(lane, side, q);
      if (to > rim) share = std::min(share, from >= rim ? 0 : (rim - from) / (to - from));
    }
    const double from = block.at(lane, face_plane, p), to = block.at(lane, face_plane, q);
    if (std::abs(to) > tolerance_) share = std::min(share, ((to > 0 ? tolerance_ : -tolerance_) - from) / (to - from));
    farthest = std::max(farthest, share);
  }
  return farthest;
}

}  // namespace meshbound
