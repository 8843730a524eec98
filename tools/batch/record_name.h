// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>

namespace meshbound::tools {

/// A text for records and tables, which are UTF-8: each byte that is no part of UTF-8 becomes a backslash, an x and two
/// digits ("\xE9").
[[nodiscard]] std::string utf8_text(std::string_view bytes);

/// The name of a file in records and tables. Each backslash becomes two, so that different files have different names.
[[nodiscard]] std::string record_name(std::string_view file_name);

}  // namespace meshbound::tools
