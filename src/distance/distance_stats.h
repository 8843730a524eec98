// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/distance.h"

namespace meshbound {

/// Adds the counts and the times of the phases of another search, and takes the deeper subdivision. The percentages of
/// culling, which have no sum, and `seconds` stay as they are.
void add(DistanceStats& sum, const DistanceStats& stats);

}  // namespace meshbound
