// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>

#include "geometry/triangle_corners.h"
#include "numeric/no_index.h"
#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// Keeps a change from turning a face over or making a sliver out of a good one. The two-sided bound alone allows both:
/// a fold of less than the tolerance is as near as the flat surface.
class GuardedFace {
 public:
  /// The face before the change.
  explicit GuardedFace(const TriangleCorners& before) : normal_(normal(before)) {
    squared_area_ = squared_length(normal_);
    is_thin_ = is_thin(squared_area_, squared_longest_edge(before));
  }
  /// The face of a corner, whose vertex moves. A face that is too thin for a normal must not fold back onto the face
  /// across the edge that stays; it stays thin where `may_look_at` says that this one is not to be looked at. Else
  /// flaps are left on flat faces at an edge of their outline, where no collapse removes them.
  template <class MayLookAt>
  GuardedFace(const ArrayMesh& mesh, Corner moved, const MayLookAt& may_look_at)
      : GuardedFace(
            {mesh.position(mesh.start(moved)), mesh.position(mesh.end(moved)), mesh.position(mesh.apex(moved))}) {
    const Corner across = mesh.twin(next_corner(moved));
    if (!is_thin_ || across == no_index) return;
    if (!may_look_at(across / 3)) {
      stays_thin_ = true;
      return;
    }
    const TriangleCorners here = mesh.triangle(moved / 3), there = mesh.triangle(across / 3);
    beside_ = normal(there);
    const bool are_needles = is_needle(squared_area_, here) && is_needle(squared_length(beside_), there);
    const double cosine = dot(beside_, normal_) / (length(beside_) * length(normal_));
    if (are_needles && cosine > folded_cosine) allowed_cosine_ = std::min(allowed_cosine_, cosine);
  }

  [[nodiscard]] bool allows(const TriangleCorners& after) const {
    const Vec3 turned = normal(after);
    const double squared_area = squared_length(turned), longest = squared_longest_edge(after);
    if (!(squared_area > 0)) return false;
    if (squared_area < min_shape * min_shape * longest * longest && squared_area < min_squared_share * squared_area_)
      return false;
    if (is_thin_) return is_thin(squared_area, longest) || (!stays_thin_ && !folds_back(turned));
    const double cosine = dot(normal_, turned);
    return cosine > 0 && cosine * cosine > min_cosine * min_cosine * squared_area_ * squared_area;
  }

 private:
  static constexpr double min_cosine = 0.1;  ///< between the normals of a face before and after
  /// Between the normals of a face that was thin and of the one beside it: they may enclose 60 degrees, or less where
  /// two needles did before, as those of a curved surface do.
  static constexpr double min_cosine_beside = -0.5;
  /// Needles that enclose less than 18 degrees are flaps, which models of machines have, and stay as thin as they are.
  static constexpr double folded_cosine = -0.95;
  /// A face keeps its area where its corner moves parallel to the edge across, and rounding must not refuse that. This
  /// is the least share that is kept, of the squared area.
  static constexpr double min_squared_share = 1 - 1e-9;
  /// Twice the area over the squared longest edge; a face may be thinner if it was before. The normal of one with ten
  /// times as much says nothing.
  static constexpr double min_shape = 1e-4, min_shape_with_normal = 1e-3;

  [[nodiscard]] bool folds_back(Vec3 turned) const {
    return dot(beside_, turned) < allowed_cosine_ * length(beside_) * length(turned);
  }
  static Vec3 normal(const TriangleCorners& c) { return cross(c[1] - c[0], c[2] - c[0]); }
  static bool is_thin(double squared_area, double squared_longest) {
    return squared_area < min_shape_with_normal * min_shape_with_normal * squared_longest * squared_longest;
  }
  /// Whether a face is thin, but not too thin for its normal to say something beside another needle's.
  static bool is_needle(double squared_area, const TriangleCorners& corners) {
    const double longest = squared_longest_edge(corners);
    return squared_area > min_shape * min_shape * longest * longest && is_thin(squared_area, longest);
  }
  static double squared_longest_edge(const TriangleCorners& c) {
    return std::max({squared_length(c[1] - c[0]), squared_length(c[2] - c[1]), squared_length(c[0] - c[2])});
  }

  Vec3 normal_, beside_;     ///< of any length; `beside_` is 0 where no face is
  double squared_area_ = 0;  ///< of twice the area
  double allowed_cosine_ = min_cosine_beside;
  bool is_thin_ = false, stays_thin_ = false;
};

}  // namespace meshbound
