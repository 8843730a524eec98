// SPDX-License-Identifier: MIT
#include "common/pending_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include "common/output_target.h"
#include "meshbound/error.h"

namespace meshbound::tools {

PendingFile::PendingFile(std::filesystem::path path) : path_(std::move(path)), target_(output_target(path_)) {}

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
