// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>

namespace meshbound::tools {

/// SHA-256 (FIPS 180-4) in 64 hexadecimal digits, as `sha256sum` prints it. O(n); safe to call from several threads.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace meshbound::tools
