// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/height_field.h"

#include <algorithm>
#include <cmath>

namespace meshbound::cgal {
namespace {

/// A point whose offset leans further from the normal than by this cosine, 45 degrees, lies beside the face: the
/// offsets of points off a border or a needle say nothing about the side, and must not cancel.
constexpr double least_cosine = 0.7;

}  // namespace

void HeightField::add(const std::array<Vec3, 3>& c) {
  Face& face = faces_.emplace_back();
  const CornerTriangle<double> triangle{c[0], c[1] - c[0], c[2] - c[0]};
  face.triangle = PreparedTriangle(triangle);
  const Vec3 normal = cross(triangle.ab, triangle.ac);
  const double area = length(normal);
  if (area > 0) face.normal = (1 / area) * normal;
  face.middle = (1.0 / 3) * (c[0] + c[1] + c[2]);
  face.radius = std::sqrt(std::max(
      {squared_length(c[0] - face.middle), squared_length(c[1] - face.middle), squared_length(c[2] - face.middle)}));
}

Heights::Offset HeightField::height_of(Vec3 p) {
  if (last_ >= faces_.size()) last_ = 0;
  std::size_t best = last_;
  TriangleOffset<double> nearest = faces_[best].triangle.closest(p);
  double least = std::sqrt(nearest.squared_distance);
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const Face& face = faces_[i];
    if (i == last_ || std::abs(dot(face.normal, p - face.triangle.triangle().a)) >= least) continue;
    if (squared_length(p - face.middle) >= (face.radius + least) * (face.radius + least)) continue;
    const TriangleOffset<double> other = face.triangle.closest(p);
    if (!(other.squared_distance < nearest.squared_distance)) continue;
    nearest = other;
    least = std::sqrt(nearest.squared_distance);
    best = i;
  }
  last_ = best;
  const double height = dot(faces_[best].normal, nearest.offset);
  if (std::abs(height) < least_cosine * least) return {-least, least};
  return {std::copysign(least, height), std::copysign(least, height)};
}

}  // namespace meshbound::cgal
