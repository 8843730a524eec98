// SPDX-License-Identifier: MIT
/// Closed, open, thin, flat and bumpy 2-manifolds, each with a tolerance and what it must shrink to.
#pragma once
#include <vector>

#include "datasets/analytic_meshes.h"
#include "reference/small_meshes.h"

namespace meshbound::test {

struct Shape {
  const char* name;
  TriangleMesh mesh;
  double tolerance;
  double max_left;  ///< share of the faces
};

inline std::vector<Shape> manifold_shapes() {
  return {{"sphere", datasets::icosphere(1, 4), 0.01, 0.1},
          {"torus", datasets::torus(1, 0.3, 60, 24), 0.01, 0.25},
          {"terrain", datasets::terrain(1, 40, 3), 0.01, 0.3},
          {"cube", datasets::cube(1, 12), 0.01, 0.03},
          {"thin sheet, tolerance below its thickness", datasets::thin_sheet(1, 0.02, 20), 0.01, 0.1},
          {"thin sheet, tolerance above its thickness", datasets::thin_sheet(1, 0.005, 20), 0.01, 0.1},
          {"plane with spikes", datasets::spiked_plane(1, 0.1, 24, 6), 0.01, 0.5},
          {"gear", datasets::gear(1, 0.4, 12, 12, 4), 0.01, 0.5},
          {"flat square", reference::unit_square(20), 0.01, 0.05}};
}

}  // namespace meshbound::test
