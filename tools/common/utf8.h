// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace meshbound::tools {

/// A character of a text in UTF-8.
struct Utf8Character {
  char32_t value = U'\uFFFD';
  std::size_t size = 0;  ///< bytes
};

/// The character at the beginning of a text; of size 0 where these bytes are no UTF-8 (RFC 3629, section 4).
[[nodiscard]] Utf8Character first_character(std::string_view text);

/// The characters of a text. A byte that is no part of UTF-8 becomes U+FFFD, so that a text in another encoding keeps
/// its length.
[[nodiscard]] std::u32string code_points(std::string_view text);

}  // namespace meshbound::tools
