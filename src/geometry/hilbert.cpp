// SPDX-License-Identifier: MIT
#include "geometry/hilbert.h"

#include <cstddef>

namespace meshbound {
namespace {

struct Step {
  std::uint8_t digit;  ///< position of the octant along the curve inside its parent
  std::uint8_t state;  ///< state (orientation) of the curve inside that octant
};

constexpr unsigned rotate_left(unsigned b, unsigned n) { return ((b << (n % 3)) | (b >> (3 - n % 3))) & 7U; }
constexpr unsigned rotate_right(unsigned b, unsigned n) { return rotate_left(b, 3 - n % 3); }
constexpr unsigned gray(unsigned i) { return i ^ (i >> 1); }
constexpr unsigned gray_inverse(unsigned g) { return (g ^ (g >> 1) ^ (g >> 2)) & 7U; }
constexpr unsigned trailing_ones(unsigned i) { return (i & 1U) != 0 ? 1 + trailing_ones(i >> 1) : 0; }
constexpr unsigned entry(unsigned w) { return w == 0 ? 0 : gray(2 * ((w - 1) / 2)); }
constexpr unsigned direction(unsigned w) {
  if (w == 0) return 0;
  return (w % 2 == 0 ? trailing_ones(w - 1) : trailing_ones(w)) % 3;
}

/// The curve by state (row: 3 * entry + direction) and octant (column: bit 0 is x, 1 y, 2 z).
constexpr std::array<std::array<Step, 8>, 24> make_table() {
  std::array<std::array<Step, 8>, 24> table{};
  for (unsigned e = 0; e < 8; ++e) {
    for (unsigned d = 0; d < 3; ++d) {
      for (unsigned octant = 0; octant < 8; ++octant) {
        const unsigned w = gray_inverse(rotate_right(octant ^ e, d + 1));
        const unsigned next_entry = e ^ rotate_left(entry(w), d + 1);
        const unsigned next_direction = (d + direction(w) + 1) % 3;
        table[3 * e + d][octant] = {static_cast<std::uint8_t>(w),
                                    static_cast<std::uint8_t>(3 * next_entry + next_direction)};
      }
    }
  }
  return table;
}

constexpr auto table = make_table();

/// Two levels of the curve in one step. Index: 64 times the state, and two bits of each coordinate, interleaved. Entry:
/// 64 times the next state, and the position along the curve inside the cell of two levels before.
constexpr auto double_table = [] {
  std::array<std::uint16_t, std::size_t{24} * 64> result{};
  for (std::size_t state = 0; state < 24; ++state) {
    for (std::size_t cell = 0; cell < 64; ++cell) {
      const Step upper = table[state][cell >> 3], lower = table[upper.state][cell & 7U];
      result[64 * state + cell] = static_cast<std::uint16_t>(64 * lower.state + 8 * upper.digit + lower.digit);
    }
  }
  return result;
}();

/// A grid of an odd number of levels is the first octant of one with a level more: from this state, the curve begins
/// there in state 0.
constexpr unsigned before_first = 2;
static_assert(table[before_first][0].digit == 0 && table[before_first][0].state == 0);

/// By a byte: bit i of it as bit 3 i.
constexpr auto spread_bytes = [] {
  std::array<std::uint32_t, 256> result{};
  for (std::uint32_t byte = 0; byte < 256; ++byte)
    for (std::uint32_t i = 0; i < 8; ++i) result[byte] |= (byte >> i & 1U) << 3 * i;
  return result;
}();

/// Bit i of `x`, which is below 2^21, as bit 3 i.
std::uint64_t spread(std::uint32_t x) {
  return spread_bytes[x & 255U] | std::uint64_t{spread_bytes[x >> 8 & 255U]} << 24 |
         std::uint64_t{spread_bytes[x >> 16]} << 48;
}

}  // namespace

std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bits) {
  const std::uint64_t cells = spread(x) | spread(y) << 1 | spread(z) << 2;
  std::uint64_t index = 0;
  std::size_t entry = bits % 2 != 0 ? std::size_t{64} * before_first : 0;
  for (int bit = 3 * (bits + bits % 2) - 6; bit >= 0; bit -= 6) {
    entry = double_table[(entry & ~std::size_t{63}) | (cells >> bit & 63U)];
    index = index << 6 | (entry & 63U);
  }
  return index;
}

}  // namespace meshbound
