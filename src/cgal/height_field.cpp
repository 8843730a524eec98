// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/height_field.h"

#include <cmath>

namespace meshbound::cgal {
namespace {

/// A point whose offset leans further from the normal than by this cosine, 45 degrees, lies beside the face: the
/// offsets of points off a border or a needle say nothing about the side, and must not cancel.
constexpr float least_cosine = 0.7F;

Heights::Offset height_of(const Vec<float>& offset, float squared, const SampleFace& face) {
  const Vec<float> normal = cross(face.ab, face.ac);
  const float along = dot(normal, offset), area = std::sqrt(dot(normal, normal));
  const double distance = std::sqrt(squared);
  if (!(std::abs(along) > least_cosine * area * std::sqrt(squared))) return {-distance, distance};
  return {std::copysign(distance, along), std::copysign(distance, along)};
}

}  // namespace

void HeightField::clear(Vec3 origin) {
  origin_ = origin;
  faces_.clear();
  points_.clear();
}

void HeightField::add(const std::array<Vec3, 3>& c) {
  faces_.emplace_back(c[0] - origin_, c[1] - origin_, c[2] - origin_);
}

std::span<const Heights::Offset> HeightField::heights() {
  kernel_.offsets(points_, faces_, offsets_);
  heights_.clear();
  for (const SampleOffsets& at : offsets_) {
    for (std::size_t k = 0; k < 8; ++k)
      heights_.push_back(
          height_of({at.x[k], at.y[k], at.z[k]}, at.squared[k], faces_[static_cast<std::size_t>(at.face[k])]));
  }
  return std::span(heights_).first(points_.size());
}

}  // namespace meshbound::cgal
