// SPDX-License-Identifier: MIT
#include "common/output.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

bool write_and_flush(std::FILE* file, const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  return std::fflush(file) == 0 && written;
}

[[noreturn]] void fail(const std::string& path, int error) {
  throw IoError("cannot write " + path + ": " + std::strerror(error));
}

}  // namespace

void write_text(const std::string& path, const std::string& text) {
  if (path == "-") {
    if (!write_and_flush(stdout, text)) fail("to standard output", errno);
    return;
  }
  const std::string temporary = path + ".partial" + std::to_string(getpid());
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) fail(path, errno);
  const bool written = write_and_flush(file, text);
  const int error = errno;
  const bool closed = std::fclose(file) == 0;
  std::error_code rename_error;
  if (written && closed) std::filesystem::rename(temporary, path, rename_error);
  if (written && closed && !rename_error) return;
  std::remove(temporary.c_str());
  fail(path, rename_error ? rename_error.value() : error);
}

}  // namespace meshbound::tools
