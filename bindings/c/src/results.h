// SPDX-License-Identifier: MIT
/// Conversion of the library's results to the structures of C callers.
#pragma once
#include <meshbound.h>

#include "meshbound/distance.h"
#include "meshbound/simplify.h"

namespace meshbound::c_interface {

[[nodiscard]] mb_bounds to_c(const Bounds& bounds);
[[nodiscard]] mb_verdict to_c(Verdict verdict);
[[nodiscard]] mb_distance to_c(const HausdorffDistance& distance);
[[nodiscard]] mb_distance to_c(const ToleranceCheck& check);
[[nodiscard]] mb_ended_by to_c(EndedBy reason);  ///< a cancelled run has no result, so no reason

}  // namespace meshbound::c_interface
