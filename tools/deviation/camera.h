// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>

namespace meshbound::tools {

/// The axis of a model that points up.
enum class UpAxis { X, Y, Z };

/// A parallel projection that shows the whole of a box, from the front right and above.
class Camera {
 public:
  /// Makes the box fill a picture of `width` x `height` pixels but for a margin. For a box that is a point or empty, a
  /// box of size 1 around it is shown.
  Camera(const Eigen::AlignedBox3d& box, UpAxis up, int width, int height);

  /// Height over width of what a picture of this box shows.
  [[nodiscard]] static double aspect(const Eigen::AlignedBox3d& box, UpAxis up);

  /// Pixels right and down from the corner of the picture, and the depth in pixels.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = to_view_ * ((p - centre_) * scale_);
    return {q.x() + shift_.x(), shift_.y() - q.y(), -q.z()};
  }
  /// How bright a face with this normal (any length, either side) is lit, 0 to 1.
  [[nodiscard]] double light(const Eigen::Vector3d& normal) const;

 private:
  Eigen::Matrix3d to_view_;  ///< rows: right, up, towards the eye
  Eigen::Vector3d centre_;
  Eigen::Vector2d shift_;
  double scale_ = 1;  ///< pixels for a model unit
};

}  // namespace meshbound::tools
