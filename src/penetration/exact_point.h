// SPDX-License-Identifier: MIT
/// Points with integer coordinates, in a unit that is a power of two: doubles, and their images under maps of doubles,
/// without rounding.
#pragma once
#include <gmpxx.h>

#include <Eigen/Geometry>
#include <array>

#include "geometry/vec3.h"
#include "meshbound/pose.h"

namespace meshbound {

struct ExactPoint {
  mpz_class x, y, z;
};

/// Coordinate 0, 1 or 2 of a point.
[[nodiscard]] inline double coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : (axis == 1 ? p.y : p.z); }
[[nodiscard]] inline const mpz_class& coordinate(const ExactPoint& p, int axis) {
  return axis == 0 ? p.x : (axis == 1 ? p.y : p.z);
}

[[nodiscard]] ExactPoint operator-(const ExactPoint& p, const ExactPoint& q);
[[nodiscard]] ExactPoint cross(const ExactPoint& p, const ExactPoint& q);
[[nodiscard]] mpz_class dot(const ExactPoint& p, const ExactPoint& q);
/// dot(q - p, cross(r - p, s - p)).
[[nodiscard]] mpz_class volume_of(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r, const ExactPoint& s);

/// The exponent of the lowest bit that is set in x; `no_bit` for 0.
[[nodiscard]] int lowest_bit(double x);
inline constexpr int no_bit = 2000;

/// x in units of 2^unit, of which it must be a multiple.
[[nodiscard]] mpz_class in_units(double x, int unit);

/// The map x -> R x + t in integers.
class ExactMap {
 public:
  /// The largest power of two, as an exponent, of which all images of points are multiples, provided that the points'
  /// coordinates are multiples of 2^`input_bit`.
  [[nodiscard]] static int image_bit(const Pose& pose, int input_bit);
  /// `output_unit` must be at most `image_bit`.
  ExactMap(const Pose& pose, int input_bit, int output_unit);
  [[nodiscard]] ExactPoint operator()(const Vec3& p) const;

 private:
  int input_bit_;
  bool is_translation_;
  std::array<mpz_class, 9> linear_;
  std::array<mpz_class, 3> translation_;
};

}  // namespace meshbound
