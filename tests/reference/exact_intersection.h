// SPDX-License-Identifier: MIT
/// Intersections of solids in rational arithmetic, by clipping convex polygons: the oracle for penetration depths, with
/// which it shares no code.
#pragma once
#include <gmpxx.h>

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "meshbound/triangle_mesh.h"

namespace meshbound::reference {

/// A solid and convex solids without common content that make it up. Each is a closed surface with normals outwards.
struct CellSolid {
  TriangleMesh surface;
  std::vector<TriangleMesh> cells;
};

using ExactVector = std::array<mpq_class, 3>;
using ExactPolygon = std::vector<ExactVector>;

/// Image of a point under a map of doubles, without rounding.
[[nodiscard]] ExactVector exact_image(const Eigen::Isometry3d& pose, const Eigen::Vector3d& p);

/// Content that two placed solids have in common.
[[nodiscard]] mpq_class exact_common_content(const CellSolid& a, const Eigen::Isometry3d& pose_a, const CellSolid& b,
                                             const Eigen::Isometry3d& pose_b);

/// The part of the surface of a that lies in b, as convex polygons with area, by triangle of a.
struct ExactPart {
  std::vector<ExactPolygon> inside;   ///< in the interior of b, or on its surface with the normals on the same side
  std::vector<ExactPolygon> contact;  ///< on the surface of b with the normals on opposite sides
};
[[nodiscard]] ExactPart exact_part(const CellSolid& a, const Eigen::Isometry3d& pose_a, const CellSolid& b,
                                   const Eigen::Isometry3d& pose_b);

/// Their area, rounded; and the polygons as triangles with rounded corners.
[[nodiscard]] double area_of(const std::vector<ExactPolygon>& polygons);
[[nodiscard]] TriangleMesh rounded_mesh(const std::vector<ExactPolygon>& polygons);

}  // namespace meshbound::reference
