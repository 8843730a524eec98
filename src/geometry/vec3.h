// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

#include "numeric/isa.h"

namespace meshbound {

/// A point or vector in a working frame; `Real` is double, `DoubleDouble` or four lanes of double.
template <class Real>
struct Vec {
  Real x{}, y{}, z{};
};

using Vec3 = Vec<double>;

inline namespace MESHBOUND_ISA {

template <class Real>
Vec<Real> operator+(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
Vec<Real> operator-(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
Vec<Real> operator*(const Real& s, const Vec<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
Real dot(const Vec<Real>& a, const Vec<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
Real squared_length(const Vec<Real>& a) {
  return dot(a, a);
}
template <class Real>
Vec<Real> cross(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
