// SPDX-License-Identifier: MIT
/// The arithmetic of overlays, for doubles with an error bound and for integers alike.
#pragma once
#include <gmpxx.h>

#include <array>
#include <cstddef>

#include "texture/approximate.h"
#include "texture/overlay.h"

namespace meshbound {

/// A number type in which a line is evaluated: doubles with an error bound, or integers.
template <class Number>
struct TexturePoint {
  Number x, y;
};

/// A coordinate as a number.
template <class Number>
[[nodiscard]] Number number_of(double x, const ExactUnits& units);
template <>
[[nodiscard]] inline Approximate number_of<Approximate>(double x, const ExactUnits& /*units*/) {
  return {x, 0};
}
template <>
[[nodiscard]] inline mpz_class number_of<mpz_class>(double x, const ExactUnits& units) {
  return in_units(x, units.texture);
}

template <class Number>
std::array<TexturePoint<Number>, 3> texture_points(const ChartTriangle& t, const ExactUnits& units) {
  std::array<TexturePoint<Number>, 3> points;
  for (std::size_t k = 0; k < 3; ++k) {
    points[k].x = number_of<Number>(t.source->coordinates[k].x(), units);
    points[k].y = number_of<Number>(t.source->coordinates[k].y(), units);
  }
  return points;
}

template <class Number>
TexturePoint<Number> operator-(const TexturePoint<Number>& p, const TexturePoint<Number>& q) {
  return {Number(p.x - q.x), Number(p.y - q.y)};
}
template <class Number>
Number cross(const TexturePoint<Number>& p, const TexturePoint<Number>& q) {
  return Number(p.x * q.y) - Number(p.y * q.x);
}
/// Twice the area of the triangle that a point makes with an edge, positive to the left of it. Differences, products
/// and their difference round by at most 4 u of the products together; 8 u leave room for their sizes as computed.
[[nodiscard]] inline Approximate doubled_area(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                              const Eigen::Vector2d& p) {
  const Eigen::Vector2d way = to - from, there = p - from;
  const double left = way.x() * there.y(), right = way.y() * there.x();
  const auto is_zero = [&] {  // not by underflow
    return (way.x() == 0 || there.y() == 0) && (way.y() == 0 || there.x() == 0);
  };
  if (left == 0 && right == 0 && is_zero()) return {};
  return {left - right, (std::fabs(left) + std::fabs(right)) * (8 * unit_roundoff) + Approximate::tiny};
}

template <class Number>
Number dot(const TexturePoint<Number>& p, const TexturePoint<Number>& q) {
  return Number(p.x * q.x) + Number(p.y * q.y);
}

template <class Number>
Number weighted(const std::array<Number, 3>& line, const std::array<Number, 3>& weights) {
  return Number(line[0] * weights[0]) + Number(line[1] * weights[1]) + Number(line[2] * weights[2]);
}

template <>
[[nodiscard]] inline Approximate weighted(const std::array<Approximate, 3>& line,
                                          const std::array<Approximate, 3>& weights) {
  return sum_of_products(line, weights);
}

template <class Number>
Number sum(const std::array<Number, 3>& x) {
  return Number(x[0] + x[1]) + x[2];
}

}  // namespace meshbound
