// SPDX-License-Identifier: MIT
/// `hilbert_index` of many cells, one in each lane. Compiled once per instruction set (numeric/isa.h).
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "numeric/simd.h"

namespace meshbound {
inline namespace MESHBOUND_ISA {

/// Cells turned and mirrored so that the curve passes their eight largest octants in one fixed order, that of the Gray
/// code. The coordinates are shifted to the left: the signs of `r` tell the octant.
struct TurnedCells {
  Words r[3];

  /// Hamilton's state 0, which begins at the corner 0 and ends along x, has z before y before x.
  TurnedCells(Words x, Words y, Words z, int bits) : r{y << (32 - bits), z << (32 - bits), x << (32 - bits)} {}

  /// The position of the octant along the curve, 0 to 7: its Gray code's inverse. Then goes on to the octants in it,
  /// which the curve passes in an order that is turned and mirrored again: mirrored by Hamilton's entry point of the
  /// octant (the coordinates complemented), turned by his direction (the coordinates renamed).
  Words next_digit() {
    const Words s0 = signs(r[0]), s1 = signs(r[1]), s2 = signs(r[2]);
    const Words digit = (s2 & 4U) | ((s2 ^ s1) & 2U) | ((s2 ^ s1 ^ s0) & 1U);
    const Words mirror0 = ~s0 & (s1 | s2), mirror2 = s2 & (s0 | ~s1);
    const Words a = (r[0] ^ mirror0) << 1, b = (r[1] ^ mirror0 ^ mirror2) << 1, c = (r[2] ^ mirror2) << 1;
    r[0] = select_by_sign(s0, c, select_by_sign(s1, a, b));
    r[1] = select_by_sign(s0, a, select_by_sign(s1, b, c));
    r[2] = select_by_sign(s0, b, select_by_sign(s1, c, a));
    return digit;
  }
};

/// `count`: cells; a multiple of twice `floats_width`. As each digit depends on the one before, two vectors are worked
/// on in turn.
inline void hilbert_indices_in_lanes(const std::uint32_t* x, const std::uint32_t* y, const std::uint32_t* z,
                                     std::size_t count, int bits, std::uint64_t* indices) {
  constexpr int digits_in_word = 10;
  const auto load = [](const std::uint32_t* from) {
    Words words;
    std::memcpy(&words, from, sizeof words);
    return words;
  };
  constexpr std::size_t width = floats_width;
  for (std::size_t i = 0; i < count; i += 2 * width) {
    TurnedCells cells[2] = {{load(x + i), load(y + i), load(z + i), bits},
                            {load(x + i + width), load(y + i + width), load(z + i + width), bits}};
    std::array<std::uint64_t, 2 * width> index{};
    for (int left = bits, taken = 0; left > 0; left -= taken) {
      taken = std::min(left, digits_in_word);
      Words word[2] = {};
      for (int digit = 0; digit < taken; ++digit) {
        word[0] = word[0] << 3 | cells[0].next_digit();
        word[1] = word[1] << 3 | cells[1].next_digit();
      }
      for (std::size_t k = 0; k < index.size(); ++k) index[k] = index[k] << 3 * taken | word[k / width][k % width];
    }
    std::copy(index.begin(), index.end(), indices + i);
  }
}

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
