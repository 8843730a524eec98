// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>

#include "meshbound/bounds.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"
#include "meshbound/pose.h"

namespace meshbound {

/// A mesh whose vertices went through an affine map, and what rounding did to them.
struct TransformedMesh {
  TriangleMesh mesh;  ///< the images, each coordinate rounded once
  /// No used vertex is further than this from its image in real arithmetic, model units. A triangle is the convex hull
  /// of its vertices, so no point of the surface is either, and no Hausdorff distance to another mesh changes by more:
  /// see `widened`. Exactly 0 where every result is a double, as under the identity, permutations and sign changes.
  double displacement_bound = 0;
};

/// Maps every vertex by `map`: any finite affine map, rigid or not, singular ones included. Coordinates are evaluated
/// in twice the working precision and rounded once. Throws `InvalidInput` as `validate` does, when the last row of the
/// matrix is not 0 0 0 1, an entry is not finite, or an image leaves `largest_coordinate`. O(n); safe from any thread.
[[nodiscard]] TransformedMesh transformed(const MeshView& mesh, const AffineMap& map);

/// The interval for a quantity that differs by at most `displacement` from one that lies in `bounds`: rounded outward,
/// cut off at 0. Throws `InvalidInput` for a displacement that is negative or not a number.
[[nodiscard]] Bounds widened(const Bounds& bounds, double displacement);

}  // namespace meshbound
