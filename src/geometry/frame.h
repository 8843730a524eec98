// SPDX-License-Identifier: MIT
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

#include "geometry/vec3.h"

namespace meshbound {

/// The coordinates a tree computes in: w = 2^-exponent (p - center), so that |w| < 1 in each coordinate whatever the
/// place and scale of the model. Scaling by a power of two is exact; `center` is 0 unless the model lies far from the
/// origin for its size, and then so coarse that the subtraction is exact for nearly all inputs.
struct Frame {
  Vec3 center;       ///< model units
  int exponent = 0;  ///< working unit = 2^exponent model units
  double error = 0;  ///< largest |w - exact| over the vertices of the model, working units (0 when all were exact)

  [[nodiscard]] Vec3 to_working(const Vec3& p) const;
  [[nodiscard]] Vec3 to_model(const Vec3& w) const;  ///< rounded to nearest

  /// The error made by `to_working(p)`, as a length in working units.
  [[nodiscard]] double rounding_of(const Vec3& p) const;

  /// Working to model units, rounded towards +infinity and 0 respectively. Arguments are >= 0.
  [[nodiscard]] double length_up(double working) const;
  [[nodiscard]] double length_down(double working) const;
  /// Model to working units: rounded down (safe as a tolerance).
  [[nodiscard]] double working_length_down(double model) const;
};

/// `Frame::to_working` for many points: a product with a power of two that is a normal number gives what `ldexp` gives.
class FrameMap {
 public:
  explicit FrameMap(const Frame& frame)
      : frame_(frame),
        scale_(frame.exponent > -1023 && frame.exponent < 1023
                   ? std::bit_cast<double>(static_cast<std::uint64_t>(1023 - frame.exponent) << 52)
                   : 0) {}
  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    return scale_ != 0 ? scale_ * (p - frame_.center) : frame_.to_working(p);
  }

 private:
  Frame frame_;
  double scale_;  ///< 2^-exponent, or 0 where that is not a normal number
};

/// The frame for a model within the box [lo, hi] (model units, finite).
Frame frame_for_box(const Vec3& lo, const Vec3& hi);

}  // namespace meshbound
