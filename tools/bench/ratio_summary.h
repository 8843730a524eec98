// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "table.h"

namespace meshbound::bench {

/// Our time over CGAL's for one mesh.
struct RatioOfMesh {
  std::string mesh;
  double percent = 0;                 ///< tolerance, of the diagonal
  std::size_t before = 0, after = 0;  ///< faces
  double ratio = 0;
};

/// For each tolerance: number of meshes, geometric mean, median and worst ratio of all of them, by size, by how far the
/// mesh shrinks, and of the six meshes that the README names.
[[nodiscard]] Table ratio_summary(const std::vector<RatioOfMesh>& ratios);

}  // namespace meshbound::bench
