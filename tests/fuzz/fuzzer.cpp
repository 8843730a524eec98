// SPDX-License-Identifier: MIT
// One libFuzzer target for each claim of claims.h: MESHBOUND_FUZZ_CHECK, a call with `bytes`, chooses it.
#include "fuzz/claims.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const meshbound::fuzz::Bytes bytes(data, size);
  meshbound::fuzz::MESHBOUND_FUZZ_CHECK;
  return 0;
}
