// SPDX-License-Identifier: MIT
#include "common/pending_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include "meshbound/error.h"

namespace meshbound::tools {

PendingFile::PendingFile(std::filesystem::path path) : path_(std::move(path)), target_(path_) {
  std::error_code none;
  if (std::filesystem::is_symlink(path_, none)) target_ = std::filesystem::weakly_canonical(path_);
  if (std::filesystem::is_directory(target_, none)) throw IoError(path_.string() + " is a folder; name a file in it");
  const std::filesystem::path folder = target_.parent_path().empty() ? "." : target_.parent_path();
  if (!std::filesystem::is_directory(folder, none))
    throw IoError("cannot write " + path_.string() + ": no such folder");
  if (access(folder.c_str(), W_OK) != 0)
    throw IoError("cannot write " + path_.string() + ": the folder is not writable");
}

bool PendingFile::is_at(const std::filesystem::path& other) const {
  return std::filesystem::weakly_canonical(target_) == std::filesystem::weakly_canonical(other);
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})) {}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void PendingFile::write(std::span<const std::uint8_t> bytes) {
  temporary_ = target_.parent_path() / ("." + target_.filename().string() + ".unproven" + std::to_string(getpid()));
  std::FILE* const file = std::fopen(temporary_.c_str(), "wb");
  if (file == nullptr) throw IoError("cannot write " + path_.string() + ": " + std::strerror(errno));
  bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
  const int error = errno;
  written = std::fclose(file) == 0 && written;
  if (!written) throw IoError("cannot write " + path_.string() + ": " + std::strerror(error));
}

void PendingFile::publish() {
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) throw IoError("cannot write " + path_.string() + ": " + error.message());
  temporary_.clear();
}

}  // namespace meshbound::tools
