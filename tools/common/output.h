// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "mesh/atomic_file.h"
#include "meshbound/stop_token.h"

namespace meshbound::tools {

/// Throws `IoError` if `write_text` could not write to `path`, so that this is known before any work. Empty: no file.
void check_writable(const std::string& path);

/// Writes `text` to stdout when `path` is "-", else as `AtomicFile` does: a failure leaves what was there before.
/// Throws `IoError`, and `Interrupted` as the flag of `stop` says.
void write_text(const std::string& path, const std::string& text, const StopToken& stop = {});

/// A text that appears together with other files: all that a full disk can prevent is done before any of them appears.
class StagedText {
 public:
  /// Writes the text under no name; arguments as for `write_text`. Throws as that.
  StagedText(std::string path, std::string text, const StopToken& stop);
  /// Makes it visible, or sends it to stdout, a device or a FIFO. Call once. Throws as `write_text`.
  void publish();

 private:
  std::string path_, text_;
  StopToken stop_;
  std::optional<AtomicFile> file_;  ///< absent where nothing can be written yet
};

}  // namespace meshbound::tools
