// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/stop_token.h"
#include "penetration/closed_model_data.h"

namespace meshbound {

/// Fills `plane_of`: triangles that are connected across edges between triangles of one plane share a number. Decided
/// exactly; needs `edges_of` and triangles that all have an area. Throws `Stopped` as the token says. O(n).
void find_planes(ClosedModel::Data& model, const StopToken& stop);

}  // namespace meshbound
