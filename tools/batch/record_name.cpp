// SPDX-License-Identifier: MIT
#include "batch/record_name.h"

#include <cstddef>

namespace meshbound::tools {
namespace {

/// Number of bytes of the character at the beginning of a text; 0 where these bytes are no UTF-8 (RFC 3629, section 4).
std::size_t character_size(std::string_view text) {
  const auto is_within = [text](std::size_t i, unsigned lowest, unsigned highest) {
    const unsigned byte = i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
    return byte >= lowest && byte <= highest;
  };
  const auto continues = [&](std::size_t i) { return is_within(i, 0x80, 0xBF); };
  if (is_within(0, 0x00, 0x7F)) return 1;
  if (is_within(0, 0xC2, 0xDF)) return continues(1) ? 2 : 0;
  if (is_within(0, 0xE0, 0xEF)) {
    // No longer form of a shorter character, and no half of a surrogate pair.
    const bool is_second = is_within(1, is_within(0, 0xE0, 0xE0) ? 0xA0 : 0x80, is_within(0, 0xED, 0xED) ? 0x9F : 0xBF);
    return is_second && continues(2) ? 3 : 0;
  }
  if (is_within(0, 0xF0, 0xF4)) {
    // No longer form of a shorter character, and none beyond U+10FFFF.
    const bool is_second = is_within(1, is_within(0, 0xF0, 0xF0) ? 0x90 : 0x80, is_within(0, 0xF4, 0xF4) ? 0x8F : 0xBF);
    return is_second && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

std::string escaped_byte(char byte) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  const auto value = static_cast<unsigned char>(byte);
  return {'\\', 'x', digits[value / 16], digits[value % 16]};
}

}  // namespace

std::string utf8_text(std::string_view bytes) {
  std::string text;
  while (!bytes.empty()) {
    const std::size_t size = character_size(bytes);
    if (size == 0)
      text += escaped_byte(bytes.front());
    else
      text += bytes.substr(0, size);
    bytes.remove_prefix(size == 0 ? 1 : size);
  }
  return text;
}

std::string record_name(std::string_view file_name) {
  std::string name;
  for (const char c : file_name) name += c == '\\' ? std::string("\\\\") : std::string(1, c);
  return utf8_text(name);
}

}  // namespace meshbound::tools
