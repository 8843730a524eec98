// SPDX-License-Identifier: MIT
#pragma once
#include "distance/search_memory.h"
#include "meshbound/distance.h"

namespace meshbound {

/// What both directions take over from earlier searches; null: nothing.
struct SymmetricMemory {
  SearchMemory* a_to_b = nullptr;
  SearchMemory* b_to_a = nullptr;
};

/// As the functions of the same name in meshbound/distance.h, with memories that are used and updated.
[[nodiscard]] SymmetricDistance symmetric_distance(const PlacedModel& a, const PlacedModel& b,
                                                   const DistanceOptions& options, const SymmetricMemory& memory);
[[nodiscard]] ToleranceCheck check_symmetric(const PlacedModel& a, const PlacedModel& b, double tolerance,
                                             const DistanceOptions& options, const SymmetricMemory& memory);

}  // namespace meshbound
