// SPDX-License-Identifier: MIT
/// Links the half-edges of each edge that stand in one bucket. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "bvh/build_kernels.h"
#include "numeric/isa.h"

#if defined(__AVX512F__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// Bit i: whether far[i] is equal to `wanted`, of `compared_at_once`.
inline std::uint64_t equal_bits(const std::uint32_t* far, std::uint32_t wanted) {
#if defined(__AVX512F__)
  return _mm512_cmpeq_epi32_mask(_mm512_loadu_si512(far), _mm512_set1_epi32(static_cast<int>(wanted)));
#elif defined(__SSE2__)
  const __m128i all = _mm_set1_epi32(static_cast<int>(wanted));
  const auto equal = [&](int i) {
    return _mm_cmpeq_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(far) + i), all);
  };
  const __m128i low = _mm_packs_epi32(equal(0), equal(1)), high = _mm_packs_epi32(equal(2), equal(3));
  return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(low, high)));
#else
  std::uint64_t bits = 0;
  for (std::uint32_t i = 0; i < compared_at_once; ++i) bits |= std::uint64_t{far[i] == wanted} << i;
  return bits;
#endif
}

inline void link_half_edges(const HalfEdges& edges, int from, int to, EdgeNeighbours* neighbours) {
  neighbours[edges.id[from] / 4][edges.id[from] % 4] = {edges.id[to] / 4 & no_slot,
                                                        edges.upward[from] == edges.upward[to] ? 1U : 0U};
}

/// Links the half-edges of an edge: `first` and the later ones whose bits are set.
inline void link_ring(const HalfEdges& edges, int first, std::uint64_t others, EdgeNeighbours* neighbours) {
  if (others == 0) {
    neighbours[edges.id[first] / 4][edges.id[first] % 4] = {};
    return;
  }
  int last = first;
  for (; others != 0; others &= others - 1) {
    const int next = std::countr_zero(others);
    link_half_edges(edges, last, next, neighbours);
    last = next;
  }
  link_half_edges(edges, last, first, neighbours);
}

/// Compares the first half-edge of each edge with all others: a word of bits holds those that are left.
inline void match_by_comparing(const HalfEdges& edges, std::uint32_t count, EdgeNeighbours* neighbours) {
  std::uint64_t left = count == 0 ? 0 : ~std::uint64_t{0} >> (max_compared - count);
  while (left != 0) {
    const int first = std::countr_zero(left);
    std::uint64_t equal = 0;
    for (std::uint32_t begin = 0; begin < count; begin += compared_at_once)
      equal |= equal_bits(edges.far + begin, edges.far[first]) << begin;
    const std::uint64_t others = equal & left & (left - 1);
    left &= ~equal;
    link_ring(edges, first, others, neighbours);
  }
}

#if defined(__AVX512F__)
/// Links a bucket of at most 16 half-edges where at most two of them belong to each edge. Returns false, and does
/// nothing, elsewhere.
inline bool match_pairs(const HalfEdges& edges, std::uint32_t count, EdgeNeighbours* neighbours) {
  const auto all = static_cast<__mmask16>((1U << count) - 1);
  const __m512i one = _mm512_set1_epi32(1), far = _mm512_loadu_si512(edges.far),
                earlier = _mm512_maskz_conflict_epi32(all, far);  // by lane: a bit for each equal one before it
  if (_mm512_test_epi32_mask(earlier, _mm512_sub_epi32(earlier, one)) != 0) return false;
  const __mmask16 second = _mm512_test_epi32_mask(earlier, earlier);
  const unsigned pairs = static_cast<unsigned>(std::popcount(second));
  if (2 * pairs != count) {
    const unsigned alone = all & ~(second | static_cast<unsigned>(_mm512_reduce_or_epi32(earlier)));
    for (unsigned left = alone; left != 0; left &= left - 1) link_ring(edges, std::countr_zero(left), 0, neighbours);
  }
  const __m512i ids = _mm512_loadu_si512(edges.id),
                upward = _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(edges.upward))),
                partner = _mm512_sub_epi32(_mm512_set1_epi32(31), _mm512_lzcnt_epi32(earlier)),
                partner_ids = _mm512_permutexvar_epi32(partner, ids),
                partner_upward = _mm512_permutexvar_epi32(partner, upward),
                flipped = _mm512_xor_si512(_mm512_xor_si512(upward, partner_upward), one);
  alignas(64) std::array<std::uint32_t, 16> id, partner_id, flip;
  _mm512_store_si512(id.data(), _mm512_maskz_compress_epi32(second, ids));
  _mm512_store_si512(partner_id.data(), _mm512_maskz_compress_epi32(second, partner_ids));
  _mm512_store_si512(flip.data(), _mm512_maskz_compress_epi32(second, flipped));
  for (unsigned i = 0; i < pairs; ++i) {
    neighbours[id[i] / 4][id[i] % 4] = {partner_id[i] / 4 & no_slot, flip[i] & 1U};
    neighbours[partner_id[i] / 4][partner_id[i] % 4] = {id[i] / 4 & no_slot, flip[i] & 1U};
  }
  return true;
}
#endif

/// Links the half-edges of a bucket with at most `max_compared` of them.
inline void match_bucket(const HalfEdges& edges, std::uint32_t count, EdgeNeighbours* neighbours) {
#if defined(__AVX512F__)
  if (count <= compared_at_once && match_pairs(edges, count, neighbours)) return;
#endif
  match_by_comparing(edges, count, neighbours);
}

inline void match_half_edges(const HalfEdges& edges, const std::uint32_t* bucket_end, std::size_t begin,
                             std::size_t end, EdgeNeighbours* neighbours) {
  for (std::size_t bucket = begin; bucket < end; ++bucket) {
    const std::uint32_t from = bucket == 0 ? 0 : bucket_end[bucket - 1], count = bucket_end[bucket] - from;
    if (count <= max_compared)
      match_bucket({edges.far + from, edges.id + from, edges.upward + from}, count, neighbours);
  }
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
