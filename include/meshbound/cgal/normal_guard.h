// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace meshbound::cgal {

/// Keeps a collapse from turning faces over or making slivers out of good ones. The two-sided bound alone allows both:
/// a fold of less than the tolerance is as near as the flat surface.
struct NormalGuard {
  double least_cosine = 0.1;  ///< between the normals of a face before and after
  double least_shape = 1e-4;  ///< twice the area over the squared longest edge; a face may be thinner if it was before

  [[nodiscard]] bool allows(const std::array<Eigen::Vector3d, 3>& before,
                            const std::array<Eigen::Vector3d, 3>& after) const {
    const Eigen::Vector3d old_normal = normal(before), new_normal = normal(after);
    const double old_area = old_normal.norm(), new_area = new_normal.norm();
    if (new_area < least_shape * squared_longest_edge(after) && new_area <= old_area) return false;
    // The normal of a face this thin says nothing.
    if (old_area < 10 * least_shape * squared_longest_edge(before)) return true;
    return old_normal.dot(new_normal) > least_cosine * old_area * new_area;
  }

 private:
  using Corners = std::array<Eigen::Vector3d, 3>;
  static Eigen::Vector3d normal(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }
  static double squared_longest_edge(const Corners& c) {
    return std::max({(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()});
  }
};

}  // namespace meshbound::cgal
