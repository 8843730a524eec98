// SPDX-License-Identifier: MIT
#include "reference/exact_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace meshbound::reference {
namespace {

/// value = integer * 2^exponent exactly; zero gets the largest exponent so that it never limits a common one.
struct Binary {
  mpz_class integer;
  long exponent = std::numeric_limits<long>::max();
};

Binary binary(double value) {
  if (value == 0) return {};
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return {mpz_class(std::ldexp(mantissa, 53)), static_cast<long>(exponent) - 53};
}

mpz_class shifted_left(const mpz_class& value, long bits) {
  mpz_class result;
  mpz_mul_2exp(result.get_mpz_t(), value.get_mpz_t(), static_cast<mp_bitcnt_t>(bits));
  return result;
}

/// Sign of (a * 2^a_exponent - b * 2^b_exponent).
int compare_scaled(const mpz_class& a, long a_exponent, const mpz_class& b, long b_exponent) {
  if (a_exponent >= b_exponent) return cmp(shifted_left(a, a_exponent - b_exponent), b);
  return cmp(a, shifted_left(b, b_exponent - a_exponent));
}

using Vector = std::array<mpz_class, 3>;

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
mpz_class dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Fraction {
  mpz_class numerator;
  mpz_class denominator;
};

bool operator<(const Fraction& a, const Fraction& b) {
  return a.numerator * b.denominator < b.numerator * a.denominator;
}

Fraction squared_distance_to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector ab = b - a;
  const Vector ap = p - a;
  const mpz_class along = dot(ap, ab);
  const mpz_class squared_length = dot(ab, ab);
  if (along <= 0) return {dot(ap, ap), 1};
  if (along >= squared_length) return {dot(p - b, p - b), 1};
  return {dot(ap, ap) * squared_length - along * along, squared_length};
}

bool projects_inside(const Vector& p, const std::array<Vector, 3>& v, const Vector& normal) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (dot(normal, cross(v[(i + 1) % 3] - v[i], p - v[i])) < 0) return false;
  }
  return true;
}

Fraction squared_distance_to_triangle(const Vector& p, const std::array<Vector, 3>& v) {
  const Vector normal = cross(v[1] - v[0], v[2] - v[0]);
  const mpz_class squared_normal = dot(normal, normal);
  if (squared_normal != 0 && projects_inside(p, v, normal)) {
    const mpz_class height = dot(normal, p - v[0]);
    return {height * height, squared_normal};
  }
  // The nearest point lies on the boundary; a degenerate triangle is the union of its edges.
  return std::min({squared_distance_to_segment(p, v[0], v[1]), squared_distance_to_segment(p, v[1], v[2]),
                   squared_distance_to_segment(p, v[2], v[0])});
}

}  // namespace

ExactLength::ExactLength(mpz_class squared_numerator, mpz_class squared_denominator, long exponent)
    : numerator_(std::move(squared_numerator)), denominator_(std::move(squared_denominator)), exponent_(exponent) {}

int ExactLength::compare(double length) const {
  const Binary other = binary(length);
  if (other.integer == 0) return sgn(numerator_);
  return compare_scaled(numerator_, 2 * exponent_, other.integer * other.integer * denominator_, 2 * other.exponent);
}

bool ExactLength::operator<(const ExactLength& other) const {
  return compare_scaled(numerator_ * other.denominator_, 2 * exponent_, other.numerator_ * denominator_,
                        2 * other.exponent_) < 0;
}

double ExactLength::approximate() const {
  if (numerator_ == 0) return 0;
  long numerator_exponent = 0;
  long denominator_exponent = 0;
  double quotient = mpz_get_d_2exp(&numerator_exponent, numerator_.get_mpz_t()) /
                    mpz_get_d_2exp(&denominator_exponent, denominator_.get_mpz_t());
  long exponent = numerator_exponent - denominator_exponent;
  if (exponent % 2 != 0) {
    quotient *= 2;
    exponent -= 1;
  }
  return std::ldexp(std::sqrt(quotient), static_cast<int>(exponent / 2 + exponent_));
}

Corners corners(const MeshView& mesh, std::size_t triangle) {
  const Triangle t = mesh.triangle(triangle);
  return {mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2])};
}

ExactLength exact_distance(const Eigen::Vector3d& point, const Corners& triangle) {
  const std::array<Eigen::Vector3d, 4> points = {triangle[0], triangle[1], triangle[2], point};
  std::array<std::array<Binary, 3>, 4> parts;
  long exponent = std::numeric_limits<long>::max();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      parts[i][k] = binary(points[i][static_cast<Eigen::Index>(k)]);
      exponent = std::min(exponent, parts[i][k].exponent);
    }
  }
  if (exponent == std::numeric_limits<long>::max()) return {0, 1, 0};
  std::array<Vector, 4> integers;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (parts[i][k].integer != 0) integers[i][k] = shifted_left(parts[i][k].integer, parts[i][k].exponent - exponent);
    }
  }
  const Fraction squared = squared_distance_to_triangle(integers[3], {integers[0], integers[1], integers[2]});
  return {squared.numerator, squared.denominator, exponent};
}

ExactLength exact_distance(const Eigen::Vector3d& point, const MeshView& mesh) {
  ExactLength nearest = exact_distance(point, corners(mesh, 0));
  for (std::size_t i = 1; i < mesh.triangle_count(); ++i)
    nearest = std::min(nearest, exact_distance(point, corners(mesh, i)));
  return nearest;
}

}  // namespace meshbound::reference
