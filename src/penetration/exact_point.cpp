// SPDX-License-Identifier: MIT
#include "penetration/exact_point.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace meshbound {
namespace {

constexpr int mantissa_bits = 53;

int lowest_bit_of(const Eigen::Matrix3d& m) {
  int bit = no_bit;
  for (int i = 0; i < 9; ++i) bit = std::min(bit, lowest_bit(m.data()[i]));
  return bit;
}

int lowest_bit_of(const Eigen::Vector3d& v) { return std::min({lowest_bit(v[0]), lowest_bit(v[1]), lowest_bit(v[2])}); }

}  // namespace

ExactPoint operator-(const ExactPoint& p, const ExactPoint& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }

ExactPoint cross(const ExactPoint& p, const ExactPoint& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

mpz_class dot(const ExactPoint& p, const ExactPoint& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

mpz_class volume_of(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r, const ExactPoint& s) {
  return dot(q - p, cross(r - p, s - p));
}

int lowest_bit(double x) {
  if (x == 0) return no_bit;
  constexpr std::uint64_t one = 1, fraction_bits = mantissa_bits - 1, lowest_exponent = 1074;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t exponent = bits >> fraction_bits & 0x7ff, fraction = bits & ((one << fraction_bits) - 1);
  if (exponent == 0) return std::countr_zero(fraction) - static_cast<int>(lowest_exponent);
  return std::countr_zero(fraction | one << fraction_bits) + static_cast<int>(exponent - 1 - lowest_exponent);
}

mpz_class in_units(double x, int unit) {
  if (x == 0) return 0;
  int exponent = 0;
  mpz_class value(std::ldexp(std::frexp(x, &exponent), mantissa_bits));
  const int shift = exponent - mantissa_bits - unit;
  if (shift >= 0)
    value <<= static_cast<mp_bitcnt_t>(shift);
  else
    value >>= static_cast<mp_bitcnt_t>(-shift);
  return value;
}

int ExactMap::image_bit(const Pose& pose, int input_bit) {
  const Eigen::Matrix3d linear = pose.linear();
  const Eigen::Vector3d translation = pose.translation();
  return std::min(lowest_bit_of(linear) + input_bit, lowest_bit_of(translation));
}

ExactMap::ExactMap(const Pose& pose, int input_bit, int output_unit)
    : input_bit_(input_bit), is_translation_(pose.linear() == Eigen::Matrix3d::Identity()) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      linear_[static_cast<std::size_t>(3 * row + column)] =
          in_units(pose.linear()(row, column), output_unit - input_bit);
    translation_[static_cast<std::size_t>(row)] = in_units(pose.translation()[row], output_unit);
  }
}

ExactPoint ExactMap::operator()(const Vec3& p) const {
  const mpz_class x = in_units(p.x, input_bit_), y = in_units(p.y, input_bit_), z = in_units(p.z, input_bit_);
  if (is_translation_)
    return {linear_[0] * x + translation_[0], linear_[4] * y + translation_[1], linear_[8] * z + translation_[2]};
  return {linear_[0] * x + linear_[1] * y + linear_[2] * z + translation_[0],
          linear_[3] * x + linear_[4] * y + linear_[5] * z + translation_[1],
          linear_[6] * x + linear_[7] * y + linear_[8] * z + translation_[2]};
}

}  // namespace meshbound
