// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>

namespace meshbound::tools {

/// A file that stands under a temporary name in its folder until `publish` renames it; the destructor removes what was
/// not published. A symbolic link is followed. Every member throws `IoError`.
class PendingFile {
 public:
  /// Throws when the folder does not exist or is not writable: known now, not after an hour of work.
  explicit PendingFile(std::filesystem::path path);

  /// Whether publishing would replace this file.
  [[nodiscard]] bool is_at(const std::filesystem::path& other) const;
  PendingFile(PendingFile&& other) noexcept;
  PendingFile& operator=(PendingFile&&) = delete;
  ~PendingFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void write(std::span<const std::uint8_t> bytes);
  void publish();

 private:
  std::filesystem::path path_;       ///< as named by the user
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< empty when there is none
};

}  // namespace meshbound::tools
