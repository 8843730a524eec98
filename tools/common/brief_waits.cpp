// SPDX-License-Identifier: MIT
#include "common/brief_waits.h"

#include <cstdlib>

#if defined(__linux__)
#include <unistd.h>
#endif

namespace meshbound::tools {

void wait_briefly([[maybe_unused]] const char* const* argv) {
#if defined(__linux__)
  constexpr const char* spins = "3000";  // of a pause instruction each
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  if (::setenv("GOMP_SPINCOUNT", spins, 1) == 0) ::execv("/proc/self/exe", const_cast<char* const*>(argv));
#endif
}

}  // namespace meshbound::tools
