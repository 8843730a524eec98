// SPDX-License-Identifier: MIT
#pragma once
#include "common/distance_text.h"
#include "meshbound/report.h"

namespace meshbound::tools {

/// The lines on stdout by which a tool says how far the texture moves: the interval in model units, in percent of the
/// diagonal and in texels, then each direction with its witness and the share of the area that is not covered.
void print_texture(const TextureReport& texture, const DirectionNames& names, double diagonal);

/// The line that says how far faces turn, and where.
void print_normals(const NormalReport& normals);

}  // namespace meshbound::tools
