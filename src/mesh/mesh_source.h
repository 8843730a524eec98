// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "mesh/file_bytes.h"
#include "mesh/stored_mesh.h"
#include "meshbound/stop_token.h"

namespace meshbound {

/// The bytes of a mesh file and its name, for messages. Positions are byte offsets from the start of the file.
struct MeshSource {
  std::filesystem::path path;
  std::string_view bytes;
  std::size_t begin = 0;  ///< where the content starts: after a byte order mark
  StopToken stop;         ///< when the reading is to end
  bool with_attributes = false;
  FileWindow* window = nullptr;  ///< where the rest is read; null: `bytes` are the whole file, otherwise its start
  MeshInSpace* sink = nullptr;   ///< what takes the mesh; null: the `MeshFile` that is returned

  /// Bytes of the file.
  [[nodiscard]] std::size_t size() const { return window != nullptr ? window->size() : bytes.size(); }
  /// The bytes from `offset` on, at least `count` of them or all that are left; from a window as `FileWindow::at`.
  [[nodiscard]] std::string_view at(std::size_t offset, std::size_t count) const {
    return window != nullptr ? window->at(offset, count) : bytes.substr(offset);
  }

  /// Throws `Interrupted` or `Stopped` as `stop` says.
  void end_if_stopped() const;

  /// These throw `InvalidInput` with the file, the line or byte, and `defect`. Lines are counted only here, so that
  /// parsing need not count them.
  [[noreturn]] void fail_at_line(std::size_t offset, const std::string& defect) const;
  [[noreturn]] void fail_at_byte(std::size_t offset, const std::string& defect) const;
  [[noreturn]] void fail(const std::string& defect) const;
};

/// Whether text is encoded as UTF-16: it starts with a byte order mark, or one byte of its first character is zero.
[[nodiscard]] bool is_utf16(std::string_view bytes);

/// `text` in quotes, short enough for a message and with unprintable characters replaced.
[[nodiscard]] std::string quote(std::string_view text);

}  // namespace meshbound
