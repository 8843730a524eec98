// SPDX-License-Identifier: MIT
#include "fuzz/claims.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  meshbound::fuzz::check_penetration({data, size});
  return 0;
}
