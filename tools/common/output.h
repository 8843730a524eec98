// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace meshbound::tools {

/// Throws `IoError` if `write_text` could not write to `path`, so that this is known before any work.
void check_writable(const std::string& path);

/// Writes `text` to stdout when `path` is "-", else as `AtomicFile` does: a failure leaves what was there before.
/// Throws `IoError`.
void write_text(const std::string& path, const std::string& text);

}  // namespace meshbound::tools
