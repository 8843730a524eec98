// SPDX-License-Identifier: MIT
#include "geometry/hilbert.h"

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

/// Two levels of the curve in one step, by state and two bits of each coordinate (column: bits 0-1 are x, 2-3 y, 4-5
/// z).
constexpr std::array<std::array<Step, 64>, 24> make_double_table() {
  std::array<std::array<Step, 64>, 24> result{};
  for (unsigned state = 0; state < 24; ++state) {
    for (unsigned cell = 0; cell < 64; ++cell) {
      const Step upper = table[state][(cell >> 1 & 1U) | (cell >> 3 & 1U) << 1 | (cell >> 5 & 1U) << 2];
      const Step lower = table[upper.state][(cell & 1U) | (cell >> 2 & 1U) << 1 | (cell >> 4 & 1U) << 2];
      result[state][cell] = {static_cast<std::uint8_t>(upper.digit << 3 | lower.digit), lower.state};
    }
  }
  return result;
}

constexpr auto double_table = make_double_table();

}  // namespace

std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z, int bits) {
  std::uint64_t index = 0;
  unsigned state = 0;
  int bit = bits;
  if (bit % 2 != 0) {
    --bit;
    const Step step = table[state][(x >> bit & 1U) | (y >> bit & 1U) << 1 | (z >> bit & 1U) << 2];
    index = step.digit;
    state = step.state;
  }
  while (bit > 0) {
    bit -= 2;
    const Step step = double_table[state][(x >> bit & 3U) | (y >> bit & 3U) << 2 | (z >> bit & 3U) << 4];
    index = index << 6 | step.digit;
    state = step.state;
  }
  return index;
}

}  // namespace meshbound
