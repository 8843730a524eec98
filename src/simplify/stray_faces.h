// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/decimation_threads.h"

namespace meshbound {

/// Those of some faces that are unproven and have an edge which is seen to be too far from the original, in their
/// order: a proof would fail. It takes a tenth of the time of a proof of all, and proves nothing. The result is the
/// same for any number of threads.
[[nodiscard]] std::vector<std::uint32_t> stray_faces(const DecimationState& state, std::span<const std::uint32_t> faces,
                                                     DecimationThreads& threads);

}  // namespace meshbound
