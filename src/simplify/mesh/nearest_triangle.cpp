// SPDX-License-Identifier: MIT
#include "simplify/mesh/nearest_triangle.h"

#include <algorithm>

#include "simplify/cover/face_box.h"

namespace meshbound {
namespace {

/// Share by which the squared distance of a box may come out larger than that of the triangle in it; far more than
/// roundings make.
constexpr double box_rounding = 1e-9;

double outside(double lo, double hi, double x) { return std::max(std::max(lo - x, x - hi), 0.0); }

}  // namespace

void NearestTriangle::add(const std::array<Vec3, 3>& t) {
  const auto [low_x, high_x] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [low_y, high_y] = std::minmax({t[0].y, t[1].y, t[2].y});
  const auto [low_z, high_z] = std::minmax({t[0].z, t[1].z, t[2].z});
  triangles_.push_back({t, {low_x, low_y, low_z}, {high_x, high_y, high_z}});
}

double NearestTriangle::squared_distance(std::size_t i, Vec3 p) const {
  return meshbound::squared_distance(triangles_[i].corners, p);
}

bool NearestTriangle::may_be_within(std::size_t i, Vec3 p, double squared) const {
  const auto& [corners, lo, hi] = triangles_[i];
  const Vec3 apart{outside(lo.x, hi.x, p.x), outside(lo.y, hi.y, p.y), outside(lo.z, hi.z, p.z)};
  return squared_length(apart) * (1 - box_rounding) <= squared;
}

std::size_t NearestTriangle::operator()(Vec3 p) {
  double least = squared_distance(nearest_, p);
  const std::size_t first = nearest_;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (i == first || !may_be_within(i, p, least)) continue;
    const double squared = squared_distance(i, p);
    if (squared < least || (squared == least && i < nearest_)) least = squared, nearest_ = i;
  }
  return nearest_;
}

}  // namespace meshbound
