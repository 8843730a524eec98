// SPDX-License-Identifier: MIT
/// The volumes of an intersection as a mesh for viewers.
#pragma once
#include <string>

#include "meshbound/penetration_depth.h"

namespace meshbound::tools {

/// Throws `InvalidInput` unless `path` ends in .obj or .ply.
void require_parts_format(const std::string& path);

/// The parts of each volume, which must have been kept, and a line between its deepest points. OBJ: the groups
/// volume_<i>_on_a, volume_<i>_on_b and volume_<i>_witness, the last with an element `l`. PLY, as text: faces on A
/// blue, on B red, and edges in green, as in Fig. 11 of the paper. Coordinates read back as the same doubles.
[[nodiscard]] std::string parts_as_obj(const PenetrationDepth& depth);
[[nodiscard]] std::string parts_as_ply(const PenetrationDepth& depth);

/// Writes one of them, by the extension of `path`. Throws as `write_text`.
void write_parts(const std::string& path, const PenetrationDepth& depth);

}  // namespace meshbound::tools
