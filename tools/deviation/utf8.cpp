// SPDX-License-Identifier: MIT
#include "deviation/utf8.h"

#include <cstdint>

namespace meshbound::tools {
namespace {

constexpr char32_t replacement = U'\uFFFD';

/// Number of bytes of the sequence that a byte begins; 0 where it begins none.
std::size_t sequence_length(std::uint8_t first) {
  if (first < 0x80) return 1;
  if (first < 0xC2) return 0;  // continues a sequence, or would be longer than needed
  if (first < 0xE0) return 2;
  if (first < 0xF0) return 3;
  return first < 0xF5 ? 4 : 0;
}

/// The value of a sequence, or `replacement` where it is none: cut off, a surrogate or longer than needed.
char32_t decoded(std::string_view sequence, std::size_t length) {
  if (length == 0 || sequence.size() < length) return replacement;
  constexpr char32_t payload[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t value = static_cast<std::uint8_t>(sequence[0]) & payload[length];
  for (std::size_t k = 1; k < length; ++k) {
    const auto byte = static_cast<std::uint8_t>(sequence[k]);
    if ((byte & 0xC0) != 0x80) return replacement;
    value = value << 6 | (byte & 0x3F);
  }
  const bool is_surrogate = value >= 0xD800 && value < 0xE000;
  const bool is_too_long = (length == 3 && value < 0x800) || (length == 4 && value < 0x10000);
  return is_surrogate || is_too_long || value > 0x10FFFF ? replacement : value;
}

}  // namespace

std::u32string code_points(std::string_view text) {
  std::u32string points;
  while (!text.empty()) {
    const std::size_t length = sequence_length(static_cast<std::uint8_t>(text[0]));
    points += decoded(text, length);
    text.remove_prefix(points.back() == replacement ? 1 : length);
  }
  return points;
}

}  // namespace meshbound::tools
