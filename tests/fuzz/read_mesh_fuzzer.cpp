// SPDX-License-Identifier: MIT
// One libFuzzer target for each format: MESHBOUND_FUZZ_EXTENSION chooses it.
#include "fuzz/claims.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  meshbound::fuzz::check_reader(MESHBOUND_FUZZ_EXTENSION, {data, size});
  return 0;
}
