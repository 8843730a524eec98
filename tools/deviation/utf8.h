// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>

namespace meshbound::tools {

/// The code points of a text in UTF-8. A byte that begins no valid sequence becomes U+FFFD, so that a text in another
/// encoding keeps its length.
[[nodiscard]] std::u32string code_points(std::string_view text);

}  // namespace meshbound::tools
