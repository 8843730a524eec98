// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/stop_token.h"
#include "simplify/decimation_threads.h"

namespace meshbound {

/// Those of some faces that are unproven and have an edge which is seen to be too far from the original, in their
/// order: a proof would fail. It looks at points only and proves nothing. The result is the same for any number of
/// threads. Throws `Stopped`.
[[nodiscard]] std::vector<std::uint32_t> stray_faces(const DecimationState& state, std::span<const std::uint32_t> faces,
                                                     DecimationThreads& threads, const StopToken& stop);

}  // namespace meshbound
