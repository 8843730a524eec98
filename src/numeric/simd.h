// SPDX-License-Identifier: MIT
/// Short vectors by the compiler's vector extension: one source for AVX2 and for any other machine.
#pragma once
#include <cstdint>

#include "numeric/isa.h"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace meshbound {
inline namespace MESHBOUND_ISA {

using Double4 = double __attribute__((vector_size(32)));
using Mask4 = decltype(Double4{} < Double4{});  // what a comparison gives: the type differs between compilers
using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Mask8 = decltype(Float8{} < Float8{});

inline Double4 broadcast4(double x) { return Double4{x, x, x, x}; }
inline Float8 broadcast8(float x) { return Float8{x, x, x, x, x, x, x, x}; }

inline double select(bool mask, double yes, double no) { return mask ? yes : no; }
inline Double4 select(Mask4 mask, Double4 yes, Double4 no) { return mask ? yes : no; }

inline Float8 maximum(Float8 a, Float8 b) {
#if defined(__AVX2__)
  return _mm256_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

inline Float8 minimum(Float8 a, Float8 b) {
#if defined(__AVX2__)
  return _mm256_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}

inline Double4 maximum(Double4 a, Double4 b) {
#if defined(__AVX2__)
  return _mm256_max_pd(a, b);
#else
  return a > b ? a : b;
#endif
}

inline Double4 minimum(Double4 a, Double4 b) {
#if defined(__AVX2__)
  return _mm256_min_pd(a, b);
#else
  return a < b ? a : b;
#endif
}

inline Double4 square_root(Double4 a) {
#if defined(__AVX2__)
  return _mm256_sqrt_pd(a);
#else
  return Double4{__builtin_sqrt(a[0]), __builtin_sqrt(a[1]), __builtin_sqrt(a[2]), __builtin_sqrt(a[3])};
#endif
}

inline Float8 square_root(Float8 a) {
#if defined(__AVX2__)
  return _mm256_sqrt_ps(a);
#else
  for (int i = 0; i < 8; ++i) a[i] = __builtin_sqrtf(a[i]);
  return a;
#endif
}

inline double horizontal_maximum(Double4 a) {
  const double low = a[0] > a[1] ? a[0] : a[1], high = a[2] > a[3] ? a[2] : a[3];
  return low > high ? low : high;
}

/// Bit i of the result is set where lane i of the mask is.
inline unsigned lane_bits(Mask8 mask) {
#if defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#else
  unsigned bits = 0;
  for (int i = 0; i < 8; ++i) bits |= (mask[i] != 0 ? 1U : 0U) << i;
  return bits;
#endif
}

inline unsigned lane_bits(Mask4 mask) {
#if defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#else
  unsigned bits = 0;
  for (int i = 0; i < 4; ++i) bits |= (mask[i] != 0 ? 1U : 0U) << i;
  return bits;
#endif
}

/// The mask whose lane i is set where bit i is.
inline Mask4 mask_of_lanes(unsigned bits) { return (Mask4{1, 2, 4, 8} & static_cast<std::int64_t>(bits)) != 0; }

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
