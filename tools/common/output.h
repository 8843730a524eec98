// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace meshbound::tools {

/// Writes `text` to stdout when `path` is "-", else to a temporary name beside `path` that is renamed at the end: a
/// failure leaves what was there before. Throws `IoError`.
void write_text(const std::string& path, const std::string& text);

}  // namespace meshbound::tools
