// SPDX-License-Identifier: MIT
// Linked with the source of simplify_with_bound: the tool as it is, but the first measurements of results, as many as
// the environment says, count as undecided.
#include <cstdlib>

#include "decimation/measurement_fault.h"

namespace {

struct InjectFault {
  InjectFault() {
    const char* const count = std::getenv("UNDECIDED_MEASUREMENTS");
    if (count != nullptr) meshbound::tools::internal::undecided_measurements = std::atoi(count);
  }
};
const InjectFault inject_fault;

}  // namespace
