// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound::internal {

/// For tests of what stands behind the tracker, and nothing else: trackers made or grown while this is not 1 prove this
/// multiple of the tolerance they were given, and so admit what they must refuse.
extern double tracker_fault;

}  // namespace meshbound::internal
