// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound::tools::internal {

/// So many measurements of results, from now on, count as undecided. 0 but in tests of what happens then.
extern int undecided_measurements;

}  // namespace meshbound::tools::internal
