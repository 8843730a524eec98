// SPDX-License-Identifier: MIT
/// Checks that a mesh bounds a solid. Each check throws `InvalidInput` with a message that names triangles of the mesh
/// as given, and a place.
#pragma once
#include "meshbound/stop_token.h"
#include "penetration/closed_model_data.h"

namespace meshbound {

/// Fills `edges` and `edges_of`: each edge has two triangles, which run along it in opposite directions.
void require_closed(ClosedModel::Data& model);

/// No triangle is without area, and no two meet but in common vertices and edges. Throws `Stopped` as the token says.
void require_no_crossing(const ClosedModel::Data& model, const StopToken& stop);

/// Each component encloses a volume of the right sign: positive if an even number of other components is around it.
/// Throws `Stopped` as the token says.
void require_outward(const ClosedModel::Data& model, const StopToken& stop);

}  // namespace meshbound
