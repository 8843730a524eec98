// SPDX-License-Identifier: MIT
#include "simplify/mesh/nearest_triangle.h"

#include <algorithm>

#include "geometry/boxes.h"

namespace meshbound {
namespace {

/// Share by which the squared distance of a box may come out larger than that of the triangle in it; far more than
/// roundings make.
constexpr double box_rounding = 1e-9;

double outside(double lo, double hi, double x) { return std::max(std::max(lo - x, x - hi), 0.0); }

}  // namespace

void NearestTriangle::Extent::extend(Vec3 p) {
  lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
  hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
}

bool NearestTriangle::Extent::may_be_within(Vec3 p, double squared) const {
  const Vec3 apart{outside(lo.x, hi.x, p.x), outside(lo.y, hi.y, p.y), outside(lo.z, hi.z, p.z)};
  return squared_length(apart) * (1 - box_rounding) <= squared;
}

void NearestTriangle::add(const TriangleCorners& corners) {
  Boxed& triangle = triangles_.emplace_back(Boxed{corners, {}});
  for (const Vec3 p : corners) triangle.box.extend(p);
}

std::size_t NearestTriangle::operator()(Vec3 p) {
  double least = squared_distance(triangles_[nearest_].corners, p);
  const std::size_t first = nearest_;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (i == first || !triangles_[i].box.may_be_within(p, least)) continue;
    const double squared = squared_distance(triangles_[i].corners, p);
    if (squared < least || (squared == least && i < nearest_)) least = squared, nearest_ = i;
  }
  return nearest_;
}

}  // namespace meshbound
