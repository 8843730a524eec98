// SPDX-License-Identifier: MIT
#include "common/brief_waits.h"

#include <cstdlib>

#if defined(__linux__)
#include <unistd.h>

#include <filesystem>
#include <system_error>
#endif

namespace meshbound::tools {

void wait_briefly([[maybe_unused]] const char* const* argv) {
#if defined(__linux__)
  constexpr const char* spins = "3000";  // of a pause instruction each
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error || ::setenv("GOMP_SPINCOUNT", spins, 1) != 0) return;
  ::execv(program.c_str(), const_cast<char* const*>(argv));  // under its own path: it keeps its name in lists
#endif
}

}  // namespace meshbound::tools
