// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/bvh.h"
#include "meshbound/mesh_view.h"

namespace meshbound {

/// A face of one mesh and the face of another that stands for it.
struct FaceTurn {
  SurfacePoint from;     ///< the centroid of the face, model units, rounded
  SurfacePoint nearest;  ///< the nearest point of the other mesh, on the face that stands for it
  double degrees = 0;    ///< between their normals, 0 to 180
};

/// What is asked of a measurement of normals.
struct NormalDeviationOptions {
  std::optional<double> tolerance;  ///< degrees; faces that turn by more are listed
  int threads = 0;                  ///< 0: as many as OpenMP has. Results are the same for every value.
};

/// How far faces turn.
struct NormalDeviation {
  double degrees = 0;               ///< the largest angle; 0 where no face of A has an area
  std::optional<FaceTurn> worst;    ///< where it is; the first of several in the order of A
  std::vector<FaceTurn> exceeding;  ///< those above the tolerance, in the order of A
};

/// The largest angle between a face of A and the face of B that stands for it: the one nearest to its centroid. Where
/// several are that near, up to 1e-9 of the diagonal of A's bounding box or 2^-40 of its largest coordinate, as around
/// an edge that the nearest point lies on, the one that turns least counts. Faces without area are left out on both
/// sides.
///
/// A statement about the centroids of A's faces, not about all points between: where a crease has moved by less than a
/// face, points beside it may be nearest to the other side of the crease. Angles are computed in doubles; they are off
/// by less than 1e-6 degrees for faces whose height is above 1e-7 of their longest edge.
///
/// Throws `InvalidInput` as `validate`, for a tolerance that is negative or not a number, and where no face of B has an
/// area. O((n_A + n_B) log n_B). Safe to call from several threads.
[[nodiscard]] NormalDeviation normal_deviation(const MeshView& a, const MeshView& b,
                                               const NormalDeviationOptions& options = {});

}  // namespace meshbound
