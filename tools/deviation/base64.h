// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>

namespace meshbound::tools {

/// Bytes as base64 with padding (RFC 4648, section 4).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace meshbound::tools
