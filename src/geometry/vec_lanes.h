// SPDX-License-Identifier: MIT
/// Points in the lanes of vectors. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <array>

#include "geometry/vec3.h"
#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

inline Vec<Double4> broadcast4(const Vec3& v) { return {broadcast4(v.x), broadcast4(v.y), broadcast4(v.z)}; }

/// x, y, z, 0.
inline Double4 coordinates(const Vec3& v) {
#if defined(__AVX2__)
  return _mm256_maskload_pd(&v.x, _mm256_set_epi64x(0, -1, -1, -1));
#else
  return Double4{v.x, v.y, v.z, 0};
#endif
}

/// Four points, each given by its `coordinates`, lane by lane.
inline Vec<Double4> lanes(const std::array<Double4, 4>& p) {
#if defined(__AVX2__)
  const __m256d xz_low = _mm256_unpacklo_pd(p[0], p[1]), y_low = _mm256_unpackhi_pd(p[0], p[1]),
                xz_high = _mm256_unpacklo_pd(p[2], p[3]), y_high = _mm256_unpackhi_pd(p[2], p[3]);
  return {_mm256_permute2f128_pd(xz_low, xz_high, 0x20), _mm256_permute2f128_pd(y_low, y_high, 0x20),
          _mm256_permute2f128_pd(xz_low, xz_high, 0x31)};
#else
  return {Double4{p[0][0], p[1][0], p[2][0], p[3][0]}, Double4{p[0][1], p[1][1], p[2][1], p[3][1]},
          Double4{p[0][2], p[1][2], p[2][2], p[3][2]}};
#endif
}

/// Four points, lane by lane.
inline Vec<Double4> gather4(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  return lanes({coordinates(p), coordinates(q), coordinates(r), coordinates(s)});
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
