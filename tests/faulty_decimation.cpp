// SPDX-License-Identifier: MIT
// Linked with the source of simplify_with_bound: the tool as it is, with samples that admit too much, or with proofs
// that prove too little, as the environment says.
#include <cstdlib>

#include "simplify/faults.h"

namespace {

struct InjectFaults {
  InjectFaults() {
    if (const char* const factor = std::getenv("SAMPLE_FAULT")) meshbound::internal::sample_fault = std::atof(factor);
    if (const char* const factor = std::getenv("PROOF_FAULT")) meshbound::internal::proof_fault = std::atof(factor);
  }
};
const InjectFaults inject_faults;

}  // namespace
