// SPDX-License-Identifier: MIT
#include "texture/exact_length.h"

#include <algorithm>
#include <cmath>

#include "numeric/rounding.h"

namespace meshbound {
namespace {

constexpr std::size_t mantissa_bits = 53;

long bits(const mpz_class& x) { return static_cast<long>(mpz_sizeinbase(x.get_mpz_t(), 2)); }

mpz_class shifted(const mpz_class& x, long by) {
  return by >= 0 ? mpz_class(x << static_cast<mp_bitcnt_t>(by)) : mpz_class(x >> static_cast<mp_bitcnt_t>(-by));
}

/// Whether x is a double without rounding, in units of 2^`unit`.
bool is_double(const mpz_class& x, long unit) {
  const auto zeros = static_cast<long>(mpz_scan1(x.get_mpz_t(), 0));
  const long highest = bits(x) + unit;
  return bits(x) - zeros <= static_cast<long>(mantissa_bits) && highest > -1000 && highest < 1000;
}

}  // namespace

bool operator<(const SquaredLength& a, const SquaredLength& b) {
  return a.numerator * b.denominator < b.numerator * a.denominator;
}

SquaredLength squared_distance_to_segment(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r) {
  const ExactPoint along = r - q, way = p - q;
  const mpz_class length = dot(along, along), foot = dot(along, way);
  if (sgn(foot) <= 0) return {dot(way, way), 1};
  if (foot >= length) {
    const ExactPoint rest = p - r;
    return {dot(rest, rest), 1};
  }
  return {dot(way, way) * length - foot * foot, length};
}

SquaredLength squared_distance_to_triangle(const ExactPoint& p, const std::array<ExactPoint, 3>& corners) {
  const ExactPoint normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const mpz_class squared_normal = dot(normal, normal);
  bool is_above = sgn(squared_normal) > 0;
  for (std::size_t k = 0; k < 3 && is_above; ++k)
    is_above = sgn(dot(cross(corners[(k + 1) % 3] - corners[k], p - corners[k]), normal)) >= 0;
  if (is_above) {
    const mpz_class height = dot(normal, p - corners[0]);
    return {height * height, squared_normal};
  }
  SquaredLength least = squared_distance_to_segment(p, corners[0], corners[1]);
  for (std::size_t k = 1; k < 3; ++k) {
    const SquaredLength other = squared_distance_to_segment(p, corners[k], corners[(k + 1) % 3]);
    if (other < least) least = other;
  }
  return least;
}

Bounds root_bounds(const SquaredLength& squared, int unit) {
  if (sgn(squared.numerator) == 0) return {0, 0};
  constexpr long wanted_bits = 140;  // of the quotient, so that the root has more bits than a double
  const long shift = std::max(0L, (wanted_bits - bits(squared.numerator) + bits(squared.denominator) + 1) / 2);
  const mpz_class numerator = shifted(squared.numerator, 2 * shift);
  const mpz_class quotient = numerator / squared.denominator, root = sqrt(quotient);
  const long root_unit = unit - shift;
  const bool is_exact = quotient * squared.denominator == numerator && root * root == quotient;
  long exponent = 0;
  const double leading = mpz_get_d_2exp(&exponent, root.get_mpz_t());  // rounded towards 0
  const double near = std::ldexp(leading, static_cast<int>(exponent + root_unit));
  if (is_exact && is_double(root, root_unit)) return {near, near};
  return {std::max(0.0, next_down(near)), next_up(next_up(near))};
}

}  // namespace meshbound
