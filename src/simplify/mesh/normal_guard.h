// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>

#include "geometry/vec3.h"

namespace meshbound {

/// Keeps a change from turning a face over or making a sliver out of a good one. The two-sided bound alone allows both:
/// a fold of less than the tolerance is as near as the flat surface.
class GuardedFace {
 public:
  using Corners = std::array<Vec3, 3>;

  /// The face before the change.
  explicit GuardedFace(const Corners& before) : normal_(normal(before)) {
    squared_area_ = squared_length(normal_);
    const double longest = squared_longest_edge(before);
    is_thin_ = squared_area_ < 100 * min_shape * min_shape * longest * longest;
  }

  [[nodiscard]] bool allows(const Corners& after) const {
    const Vec3 turned = normal(after);
    const double squared_area = squared_length(turned), longest = squared_longest_edge(after);
    if (!(squared_area > 0)) return false;
    if (squared_area < min_shape * min_shape * longest * longest && squared_area <= squared_area_) return false;
    if (is_thin_) return true;  // the normal of a face this thin says nothing
    const double cosine = dot(normal_, turned);
    return cosine > 0 && cosine * cosine > min_cosine * min_cosine * squared_area_ * squared_area;
  }

 private:
  static constexpr double min_cosine = 0.1;  ///< between the normals of a face before and after
  /// Twice the area over the squared longest edge; a face may be thinner if it was before.
  static constexpr double min_shape = 1e-4;

  static Vec3 normal(const Corners& c) { return cross(c[1] - c[0], c[2] - c[0]); }
  static double squared_longest_edge(const Corners& c) {
    return std::max({squared_length(c[1] - c[0]), squared_length(c[2] - c[1]), squared_length(c[0] - c[2])});
  }

  Vec3 normal_;
  double squared_area_ = 0;  ///< of twice the area
  bool is_thin_ = false;
};

}  // namespace meshbound
