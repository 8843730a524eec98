// SPDX-License-Identifier: MIT
#include "common/omp_spin.h"

#include <cstdlib>

namespace meshbound::tools {
namespace {

/// The first priority that is not the compiler's own; that of libgomp's constructor is the last.
[[gnu::constructor(101)]] void set_spin_count() {
  constexpr const char* spins = "3000";  // of a pause instruction each
  if (std::getenv("OMP_WAIT_POLICY") == nullptr) ::setenv("GOMP_SPINCOUNT", spins, 0);
}

}  // namespace

void limit_omp_spin() {}

}  // namespace meshbound::tools
