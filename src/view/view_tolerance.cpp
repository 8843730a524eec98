// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/affine.h"
#include "geometry/safe_length.h"
#include "meshbound/error.h"
#include "meshbound/view_levels.h"

namespace meshbound {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Relative margin for the rounding of depths, angles and tolerances, each computed in a few operations of doubles.
constexpr double rounding = 0x1p-40;

/// Cosine of the angle from the view axis to the corners of the screen. At depth z and angle a, a displacement d covers
/// up to f d / (z cos a) pixels; f d / z is what it covers on the axis, parallel to the screen.
double cosine_to_corner(const ViewCamera& camera) {
  const double up = std::tan(camera.screen.vertical_field_of_view / 2), right = up * camera.aspect_ratio;
  return 1 / safe_length({1, up, right});
}

}  // namespace

double view_tolerance(const ViewCamera& camera, double pixels, const Eigen::AlignedBox3d& box, const AffineMap& pose) {
  const double largest = camera.direction.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !camera.direction.allFinite())
    throw InvalidInput("the direction of a camera must have a length");
  const Eigen::Vector3d direction = (camera.direction / largest).normalized();  // whose square is a number
  if (!(camera.aspect_ratio > 0) || !std::isfinite(camera.aspect_ratio))
    throw InvalidInput("the aspect ratio of a camera must be positive");
  if (!camera.position.allFinite()) throw InvalidInput("the position of a camera has a coordinate that is not finite");
  require_affine(pose.matrix(), "a pose");
  const double at_one = screen_space_tolerance(camera.screen, pixels, 1) * cosine_to_corner(camera);
  double nearest = infinity, furthest = -nearest, size = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p = pose * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)) - camera.position;
    const double extent = p.cwiseAbs().sum() + pose.translation().cwiseAbs().sum() + camera.position.cwiseAbs().sum();
    if (!(extent < infinity)) return 0;  // beyond the numbers there are
    const double depth = p.dot(direction);
    nearest = std::min(nearest, depth);
    furthest = std::max(furthest, depth);
    size = std::max(size, extent);
  }
  if (furthest < -rounding * size) return infinity;
  // A deviation t may bring a point nearer, to a depth of at least nearest - t, so that t <= (nearest - t) at_one.
  return std::max(0.0, (nearest - rounding * size) * (at_one / (1 + at_one)) * (1 - rounding));
}

}  // namespace meshbound
