// SPDX-License-Identifier: MIT
#include "common/output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "mesh/atomic_file.h"
#include "mesh/output_target.h"
#include "meshbound/error.h"

namespace meshbound::tools {

void check_writable(const std::string& path) {
  if (path != "-") (void)output_target(path);
}

void write_text(const std::string& path, const std::string& text) {
  if (path == "-") {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (std::fflush(stdout) != 0 || !written)
      throw IoError(std::string("cannot write to standard output: ") + std::strerror(errno));
    return;
  }
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace meshbound::tools
