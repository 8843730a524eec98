// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meshbound {

/// Coordinates of size 1 around the origin for the decimation, whatever the model's: quadrics and cross products of
/// coordinates of 1e-160 or 1e155, or of a small model far from the origin, would underflow, overflow or cancel.
/// Scaling is by a power of two, so only the subtraction of the centre rounds.
class WorkingFrame {
 public:
  explicit WorkingFrame(const Eigen::AlignedBox3d& box) {
    // Halves first: the sum of two coordinates of 2^1000 is fine, their difference as well.
    centre_ = 0.5 * box.min() + 0.5 * box.max();
    const double half_extent = (0.5 * box.max() - 0.5 * box.min()).maxCoeff();
    if (half_extent > 0) std::frexp(half_extent, &exponent_);
    largest_ = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  }
  [[nodiscard]] double length_to_frame(double length) const { return std::ldexp(length, -exponent_); }
  [[nodiscard]] Eigen::Vector3d to_frame(const Eigen::Vector3d& p) const { return scaled(p - centre_, -exponent_); }
  [[nodiscard]] Eigen::Vector3d to_model(const Eigen::Vector3d& p) const { return scaled(p, exponent_) + centre_; }

  /// How far a point can move, in units of the frame, on the way in or out: half an ulp of each coordinate of the
  /// difference (at most 2, by the extent) and of the model coordinate, doubled for the vector length sqrt(3).
  [[nodiscard]] double rounding() const { return 0x1p-51 + length_to_frame(largest_ * 0x1p-52); }

 private:
  static Eigen::Vector3d scaled(const Eigen::Vector3d& p, int exponent) {
    return {std::ldexp(p.x(), exponent), std::ldexp(p.y(), exponent), std::ldexp(p.z(), exponent)};
  }
  Eigen::Vector3d centre_;
  int exponent_ = 0;
  double largest_ = 0;
};

}  // namespace meshbound
