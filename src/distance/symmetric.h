// SPDX-License-Identifier: MIT
#pragma once
#include "distance/search/search_memory.h"
#include "meshbound/distance.h"

namespace meshbound {

/// The memories of earlier searches of both directions; null: none.
struct HausdorffMemory {
  SearchMemory* a_to_b = nullptr;
  SearchMemory* b_to_a = nullptr;
};

/// As the functions of the same name in meshbound/distance.h, with memories that are used and updated.
[[nodiscard]] HausdorffDistance hausdorff_distance(const PlacedModel& a, const PlacedModel& b,
                                                   const DistanceOptions& options, const HausdorffMemory& memory);
[[nodiscard]] ToleranceCheck check_tolerance(const PlacedModel& a, const PlacedModel& b, double tolerance,
                                             const DistanceOptions& options, const HausdorffMemory& memory);

}  // namespace meshbound
