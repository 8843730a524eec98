// SPDX-License-Identifier: MIT
/// Short vectors by the compiler's vector extension: one source for AVX2, AVX-512 and any other machine.
#pragma once
#include <cstddef>
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

inline double square_root(double a) { return __builtin_sqrt(a); }
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

/// The lanes of both, in a vector that is twice as wide.
template <class Wide>
Wide join(Float8 low, Float8 high);

#if defined(__AVX512F__)
using Double8 = double __attribute__((vector_size(64)));
using Float16 = float __attribute__((vector_size(64)));

inline Double8 select(decltype(Double8{} < Double8{}) mask, Double8 yes, Double8 no) { return mask ? yes : no; }
inline Double8 maximum(Double8 a, Double8 b) { return _mm512_max_pd(a, b); }
inline Double8 minimum(Double8 a, Double8 b) { return _mm512_min_pd(a, b); }
inline Float16 maximum(Float16 a, Float16 b) { return _mm512_max_ps(a, b); }
inline Float16 minimum(Float16 a, Float16 b) { return _mm512_min_ps(a, b); }
inline Float16 square_root(Float16 a) { return _mm512_sqrt_ps(a); }
template <>
inline Float16 join(Float8 low, Float8 high) {
  return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
}
inline Float8 low_half(Float16 a) { return _mm512_castps512_ps256(a); }
inline Float8 high_half(Float16 a) { return _mm512_extractf32x8_ps(a, 1); }

using Doubles = Double8;
using Floats = Float16;
#else
using Doubles = Double4;
using Floats = Float8;
#endif

/// a b + c, rounded once where the machine can do that: for numbers whose last bits no result depends on.
inline Float8 multiply_add(Float8 a, Float8 b, Float8 c) {
#if defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}
#if defined(__AVX512F__)
inline Float16 multiply_add(Float16 a, Float16 b, Float16 c) { return _mm512_fmadd_ps(a, b, c); }
#endif

/// `Doubles`, `Floats` and `Words`: as wide as the machine's vectors.
using Words = std::uint32_t __attribute__((vector_size(sizeof(Floats))));
inline constexpr std::size_t doubles_width = sizeof(Doubles) / sizeof(double),
                             floats_width = sizeof(Floats) / sizeof(float);
using DoublesMask = decltype(Doubles{} < Doubles{});
using FloatsMask = decltype(Floats{} < Floats{});

inline Doubles broadcast_doubles(double x) { return x - Doubles{}; }  // not +, for -0
inline Floats broadcast_floats(float x) { return x - Floats{}; }

/// By lane: all bits are the highest one.
inline Words signs(Words a) {
  using Signed = std::int32_t __attribute__((vector_size(sizeof(Words))));
  return reinterpret_cast<Words>(reinterpret_cast<Signed>(a) >> 31);
}

/// `yes` in the lanes where all bits of the mask are set, `no` in those where none is.
inline Words select_by_sign(Words mask, Words yes, Words no) {
#if defined(__AVX2__) && !defined(__AVX512F__)
  return reinterpret_cast<Words>(
      _mm256_blendv_ps(reinterpret_cast<__m256>(no), reinterpret_cast<__m256>(yes), reinterpret_cast<__m256>(mask)));
#else
  return (mask & yes) | (~mask & no);
#endif
}

/// The largest and the smallest lane.
inline float largest_lane(Floats a) {
#if defined(__AVX512F__)
  return _mm512_reduce_max_ps(a);
#else
  float most = a[0];
  for (std::size_t i = 1; i < floats_width; ++i) most = most < a[i] ? a[i] : most;
  return most;
#endif
}

inline double smallest_lane(Doubles a) {
#if defined(__AVX512F__)
  return _mm512_reduce_min_pd(a);
#else
  const double low = a[0] < a[1] ? a[0] : a[1], high = a[2] < a[3] ? a[2] : a[3];
  return low < high ? low : high;
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

#if defined(__AVX512F__)
inline unsigned lane_bits(decltype(Float16{} < Float16{}) mask) {
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
}

inline unsigned lane_bits(decltype(Double8{} < Double8{}) mask) {
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
}
#endif

/// Bit i of the result is set where a < b in lane i. With AVX-512, `lane_bits` would spread them over whole lanes
/// first.
inline unsigned less_bits(Floats a, Floats b) {
#if defined(__AVX512F__)
  return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
#else
  return lane_bits(a < b);
#endif
}

/// The mask whose lane i is set where bit i is.
inline Mask4 mask_of_lanes(unsigned bits) { return (Mask4{1, 2, 4, 8} & static_cast<std::int64_t>(bits)) != 0; }

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
