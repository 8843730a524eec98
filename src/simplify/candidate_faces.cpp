// SPDX-License-Identifier: MIT
#include "simplify/candidate_faces.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "numeric/rounding.h"

namespace meshbound {

void CandidateFaces::Plane::set(int k, Vec3 normal, Vec3 through) {
  x[k] = normal.x;
  y[k] = normal.y;
  z[k] = normal.z;
  offset[k] = -dot(normal, through);
}

void CandidateFaces::clear(double tolerance) {
  tolerance_ = tolerance;
  squared_tolerance_ = tolerance * tolerance;
  size_ = 0;
  flat_ = 0;
}

void CandidateFaces::add(const std::array<Vec3, 3>& corners) {
  const int k = size_++;
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
  if (!flat) {
    for (Plane* plane : {&face_, &side_[0], &side_[1], &side_[2]}) plane->set(k, {}, {});
    return;
  }
  flat_ |= FaceMask{1} << k;
  const Vec3 unit = (1 / area) * normal;
  face_.set(k, unit, corners[0]);
  const std::array<Vec3, 3> edges = {ab, bc, Vec3{-ac.x, -ac.y, -ac.z}};
  for (int i = 0; i < 3; ++i) side_[i].set(k, (1 / length(edges[i])) * cross(edges[i], unit), corners[i]);
}

bool CandidateFaces::holds(int k, Vec3 p) const {
  return closest_on_triangle(triangles_[k], p).squared_distance <= squared_tolerance_;
}

FaceMask CandidateFaces::holding(Vec3 p, int first, int last) const {
  // Two passes: the first is straight-line arithmetic that compilers vectorise, the second looks at the few in doubt.
  double height[capacity], outside[capacity];
  for (int k = first; k < last; ++k) {
    height[k] = std::abs(face_.at(k, p));
    const double a = side_[0].at(k, p), b = side_[1].at(k, p), c = side_[2].at(k, p);
    const double ab = a > b ? a : b;
    outside[k] = ab > c ? ab : c;
  }
  FaceMask mask = 0;
  const double reach = squared_tolerance_ * (1 + 2 * plane_slack);
  for (int k = first; k < last; ++k) {
    if (height[k] > tolerance_) continue;
    const FaceMask bit = FaceMask{1} << k;
    if (outside[k] <= 0 && (flat_ & bit)) {
      mask |= bit;
    } else if (outside[k] * outside[k] + height[k] * height[k] <= reach && holds(k, p)) {
      mask |= bit;
    }
  }
  return mask;
}

FaceMask CandidateFaces::holding(Vec3 p, FaceMask among) const {
  FaceMask mask = 0;
  for (; among != 0; among &= among - 1) {
    const int k = std::countr_zero(among);
    mask |= holding(p, k, k + 1);
  }
  return mask;
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
    double share = 1;
    for (const Plane& side : side_) {
      const double from = side.at(k, p), to = side.at(k, q);
      if (to > rim) share = std::min(share, from >= rim ? 0 : (rim - from) / (to - from));
    }
    const double from = face_.at(k, p), to = face_.at(k, q);
    if (std::abs(to) > tolerance_) share = std::min(share, ((to > 0 ? tolerance_ : -tolerance_) - from) / (to - from));
    farthest = std::max(farthest, share);
  }
  return farthest;
}

}  // namespace meshbound
