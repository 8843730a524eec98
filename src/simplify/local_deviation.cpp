// SPDX-License-Identifier: MIT
#include "simplify/local_deviation.h"

#include <algorithm>
#include <cmath>

#include "geometry/point_triangle.h"

namespace meshbound {
namespace {

/// Enough to see the shape of a neighbourhood; more only cost time.
constexpr std::size_t most_samples = 192;

}  // namespace

void LocalDeviation::set_faces(std::span<const Corners> faces) {
  faces_.clear();
  for (const Corners& c : faces) faces_.emplace_back(c[0] - origin_, c[1] - origin_, c[2] - origin_);
}

void LocalDeviation::begin(double tolerance, std::span<const std::uint32_t> originals, std::span<const Corners> faces,
                           std::uint32_t hint) {
  by_tolerance_ = 1 / tolerance;
  samples_.clear();
  hints_.clear();
  hint_ = hint;
  if (faces.empty()) return;
  origin_ = faces.front()[0];
  set_faces(faces);
  const std::span<const std::uint32_t> corners = corners_.of(originals);
  const std::size_t stride = (corners.size() + most_samples - 1) / most_samples;
  for (std::size_t i = 0; i < corners.size(); i += stride) samples_.add(vertices_[corners[i]] - origin_);
  // Triangles that reach over the rim of the change have corners that other faces answer for.
  kernel_.drop_far(samples_, faces_, static_cast<float>(tolerance));
}

void LocalDeviation::add_to_original(Vec3 p, double share, std::size_t which, Proximity& original, SlopeSums& sums) {
  if (which >= hints_.size()) hints_.resize(which + 1, hint_);
  (void)original.upper_distance({p.x, p.y, p.z}, hints_[which]);
  const auto& t = triangles_[hints_[which]];
  const CornerTriangle<double> nearest{vertices_[t[0]], vertices_[t[1]] - vertices_[t[0]],
                                       vertices_[t[2]] - vertices_[t[0]]};
  const Vec3 offset = closest_on_triangle(nearest, p).offset;
  // It is the point of the face that moves here, not the closest one.
  sums.add(by_tolerance_ * offset, -share);
}

SlopeSums LocalDeviation::of(std::span<const Corners> faces, Proximity& original) {
  SlopeSums sums;
  if (faces.empty()) return sums;
  set_faces(faces);
  kernel_.add_slope(samples_, faces_, static_cast<float>(by_tolerance_), sums);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Corners& c = faces[i];
    add_to_original((1.0 / 3) * (c[0] + c[1] + c[2]), 1.0 / 3, 2 * i, original, sums);
    add_to_original(0.5 * (c[0] + c[1]), 0.5, 2 * i + 1, original, sums);
  }
  return sums;
}

}  // namespace meshbound
