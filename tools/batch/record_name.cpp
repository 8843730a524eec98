// SPDX-License-Identifier: MIT
#include "batch/record_name.h"

#include <cstddef>

#include "common/utf8.h"

namespace meshbound::tools {
namespace {

std::string escaped_byte(char byte) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  const auto value = static_cast<unsigned char>(byte);
  return {'\\', 'x', digits[value / 16], digits[value % 16]};
}

}  // namespace

std::string utf8_text(std::string_view bytes) {
  std::string text;
  while (!bytes.empty()) {
    const std::size_t size = first_character(bytes).size;
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
