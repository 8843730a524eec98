// SPDX-License-Identifier: MIT
#include "common/utf8.h"

#include <algorithm>
#include <cstdint>

namespace meshbound::tools {
namespace {

/// Number of bytes of the sequence that a byte begins; 0 where it begins none.
std::size_t sequence_length(std::uint8_t first) {
  if (first < 0x80) return 1;
  if (first < 0xC2) return 0;  // continues a sequence, or would be longer than needed
  if (first < 0xE0) return 2;
  if (first < 0xF0) return 3;
  return first < 0xF5 ? 4 : 0;
}

}  // namespace

Utf8Character first_character(std::string_view text) {
  if (text.empty()) return {};
  const std::size_t length = sequence_length(static_cast<std::uint8_t>(text[0]));
  if (length == 0 || text.size() < length) return {};
  constexpr char32_t payload[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
  char32_t value = static_cast<std::uint8_t>(text[0]) & payload[length];
  for (std::size_t k = 1; k < length; ++k) {
    const auto byte = static_cast<std::uint8_t>(text[k]);
    if ((byte & 0xC0) != 0x80) return {};
    value = value << 6 | (byte & 0x3F);
  }
  const bool is_surrogate = value >= 0xD800 && value < 0xE000;
  const bool is_too_long = (length == 3 && value < 0x800) || (length == 4 && value < 0x10000);
  return is_surrogate || is_too_long || value > 0x10FFFF ? Utf8Character{} : Utf8Character{value, length};
}

std::u32string code_points(std::string_view text) {
  std::u32string points;
  while (!text.empty()) {
    const Utf8Character character = first_character(text);
    points += character.value;
    text.remove_prefix(std::max<std::size_t>(character.size, 1));
  }
  return points;
}

}  // namespace meshbound::tools
