// SPDX-License-Identifier: MIT
#pragma once
#include <meshbound.h>

#include "meshbound/distance.h"
#include "run_control.h"

namespace meshbound::c_interface {

/// The options of a measurement for the library. `control` must outlive them.
[[nodiscard]] DistanceOptions library_options(const mb_distance_options& options, RunControl& control);

}  // namespace meshbound::c_interface
