// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <string>
#include <string_view>

namespace meshbound::tools {

/// SHA-256 (FIPS 180-4) in 64 hexadecimal digits, as `sha256sum` prints it. `look` is called every few milliseconds and
/// ends it by throwing; may be empty. O(n); safe to call from several threads.
[[nodiscard]] std::string sha256(std::string_view bytes, const std::function<void()>& look = {});

}  // namespace meshbound::tools
