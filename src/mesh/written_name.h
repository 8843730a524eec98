// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <string>

namespace meshbound {

/// What STL calls a solid that has no name of its own.
inline constexpr const char* name_of_unnamed_solid = "meshbound";

/// A name as one line of a text file: a line break, or a backslash at its end or in front of one, which would join the
/// line with the next, is a blank.
[[nodiscard]] inline std::string name_on_a_line(std::string name) {
  for (std::size_t i = name.size(); i-- > 0;) {
    const bool ends = i + 1 == name.size() || name[i + 1] == '\n' || name[i + 1] == '\r';
    if (name[i] == '\\' && ends) name[i] = ' ';
  }
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return name;
}

/// A name as one word of a text file: a blank or a control character is '_'.
[[nodiscard]] inline std::string name_as_a_word(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c <= ' ' || c == 0x7f; }, '_');
  return name;
}

}  // namespace meshbound
