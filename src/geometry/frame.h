// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "geometry/vec3.h"

namespace meshbound {

/// The coordinates a tree computes in: w = 2^-exponent (p - center), so that |w| < 1 in each coordinate wherever the
/// model lies and whatever its scale. Scaling by a power of two is exact; `center` is 0 unless the model lies far from
/// the origin for its size, and then so coarse that the subtraction is exact for nearly all inputs.
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
  /// Model to working units, rounded towards 0: safe as a tolerance.
  [[nodiscard]] double working_length_down(double model) const;
};

/// The maps of a frame, fast for many points: multiplying by a power of two that is a normal number gives the same bits
/// as `ldexp`.
class FrameMap {
 public:
  explicit FrameMap(const Frame& frame)
      : frame_(frame),
        scale_(frame.exponent > -1023 && frame.exponent < 1023 ? power_of_two(-frame.exponent) : 0),
        unit_(scale_ != 0 ? power_of_two(frame.exponent) : 0),
        is_exact_from_(frame.center.x == 0 && frame.center.y == 0 && frame.center.z == 0 && scale_ != 0
                           ? power_of_two(std::max(frame.exponent, 0) - 1021)
                           : std::numeric_limits<double>::infinity()) {}
  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    return scale_ != 0 ? scale_ * (p - frame_.center) : frame_.to_working(p);
  }
  [[nodiscard]] Vec3 to_model(const Vec3& w) const {
    return scale_ != 0 ? unit_ * w + frame_.center : frame_.to_model(w);
  }
  /// The error made by mapping p, as a length in working units.
  [[nodiscard]] double rounding_of(const Vec3& p) const {
    return is_exact(p.x) && is_exact(p.y) && is_exact(p.z) ? 0 : frame_.rounding_of(p);
  }
  [[nodiscard]] double length_up(double working) const {
    const double model = unit_ * working;
    return scale_ != 0 && scale_ * model == working ? model : frame_.length_up(working);
  }
  [[nodiscard]] double length_down(double working) const {
    const double model = unit_ * working;
    return scale_ != 0 && scale_ * model == working ? model : frame_.length_down(working);
  }
  [[nodiscard]] double working_length_down(double model) const {
    const double working = scale_ * model;
    return scale_ != 0 && unit_ * working == model ? working : frame_.working_length_down(model);
  }

 private:
  [[nodiscard]] bool is_exact(double x) const { return x == 0 || std::fabs(x) >= is_exact_from_; }

  static double power_of_two(int exponent) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
  }

  Frame frame_;
  double scale_;          ///< 2^-exponent, or 0 where that or its inverse is not a normal number
  double unit_;           ///< 2^exponent, or 0 where that or its inverse is not a normal number
  double is_exact_from_;  ///< coordinates of this magnitude or more lose nothing; infinite where that is not known
};

/// The frame for a model within the box [lo, hi] (model units, finite).
Frame frame_for_box(const Vec3& lo, const Vec3& hi);

}  // namespace meshbound
