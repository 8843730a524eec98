// SPDX-License-Identifier: MIT
#include "deviation/camera.h"

#include <algorithm>
#include <cmath>

namespace meshbound::tools {
namespace {

/// Unit vectors to the right, to the front and up, for a model with this axis up.
Eigen::Matrix3d axes_of(UpAxis up) {
  Eigen::Matrix3d axes;  // columns
  switch (up) {
    case UpAxis::X:
      axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
      break;
    case UpAxis::Y:
      axes << 1, 0, 0, 0, 0, 1, 0, 1, 0;
      break;
    case UpAxis::Z:
      axes << 1, 0, 0, 0, -1, 0, 0, 0, 1;
      break;
  }
  return axes;
}

/// Rows: right, up, towards the eye.
Eigen::Matrix3d view_of(UpAxis up) {
  const Eigen::Matrix3d axes = axes_of(up);
  const Eigen::Vector3d to_eye = axes * Eigen::Vector3d(0.5, 1, 0.55).normalized();
  const Eigen::Vector3d right = axes.col(2).cross(to_eye).normalized();
  Eigen::Matrix3d view;
  view.row(0) = right;
  view.row(1) = to_eye.cross(right);
  view.row(2) = to_eye;
  return view;
}

/// Half of the width, height and depth of the box in the view, model units.
Eigen::Vector3d half_extents(const Eigen::AlignedBox3d& box, const Eigen::Matrix3d& view) {
  return box.isEmpty() ? Eigen::Vector3d::Zero().eval() : (view.cwiseAbs() * (box.max() / 2 - box.min() / 2)).eval();
}

}  // namespace

Camera::Camera(const Eigen::AlignedBox3d& box, UpAxis up, int width, int height)
    : to_view_(view_of(up)),
      centre_(box.isEmpty() ? Eigen::Vector3d::Zero().eval() : (box.min() / 2 + box.max() / 2).eval()),
      shift_(width / 2.0, height / 2.0) {
  const Eigen::Vector3d half = half_extents(box, to_view_);
  constexpr double filled = 0.92;  // of the picture
  const double fit = filled / 2 * std::min(width / half.x(), height / half.y());
  scale_ = std::isfinite(fit) && fit > 0 ? fit : 1;
}

double Camera::aspect(const Eigen::AlignedBox3d& box, UpAxis up) {
  const Eigen::Vector3d half = half_extents(box, view_of(up));
  return half.x() > 0 ? half.y() / half.x() : 1;
}

double Camera::light(const Eigen::Vector3d& normal) const {
  const double length = normal.stableNorm();
  if (!(length > 0)) return 1;
  const Eigen::Vector3d n = to_view_ * (normal / length);
  const Eigen::Vector3d lamp = Eigen::Vector3d(-0.4, 0.6, 0.7).normalized();
  const double facing = n.z() < 0 ? -lamp.dot(n) : lamp.dot(n);
  return 0.3 + 0.7 * std::max(0.0, facing);
}

}  // namespace meshbound::tools
