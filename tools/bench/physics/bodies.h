// SPDX-License-Identifier: GPL-3.0-or-later
/// The models of the scenes of the paper's section 7.3.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "meshbound/penetration_depth.h"

namespace meshbound::bench {

/// Twelve letters, extruded from squares of a grid of 5 x 7, upright in the yz plane and centred at the origin: closed,
/// about 150 triangles each. `height` in model units.
[[nodiscard]] std::vector<TriangleMesh> letters(double height);

/// A closed bunny of about so many triangles, its longest side 1, centred; a gear where there is none in the data sets
/// or its decimation meets itself.
[[nodiscard]] TriangleMesh small_bunny(std::size_t triangles);

}  // namespace meshbound::bench
