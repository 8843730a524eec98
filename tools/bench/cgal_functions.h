// SPDX-License-Identifier: GPL-3.0-or-later
/// What we measure ourselves against, and the decimation that makes the pairs. `Simple_cartesian<double>`, CGAL's
/// fastest kernel here, and the sequential versions: Debian's CGAL is used without TBB.
#pragma once
#include <memory>
#include <optional>

#include "meshbound/triangle_mesh.h"

namespace meshbound::bench {

/// A pair of Surface_mesh. Conversion is not part of what is timed.
class CgalPair {
 public:
  /// Absent when one of the meshes is not a 2-manifold: CGAL's functions do not take it.
  static std::optional<CgalPair> make(const TriangleMesh& a, const TriangleMesh& b);

  /// `bounded_error_symmetric_Hausdorff_distance`.
  [[nodiscard]] double bounded_error(double error_bound) const;
  /// `bounded_error_Hausdorff_distance` from the first to the second.
  [[nodiscard]] double one_sided_bounded_error(double error_bound) const;
  /// `approximate_symmetric_Hausdorff_distance` with a fixed seed; `points_per_area` of 0 leaves the number of samples
  /// at its default.
  [[nodiscard]] double approximate(double points_per_area = 0) const;
  /// `is_Hausdorff_distance_larger`, both ways.
  [[nodiscard]] bool is_larger(double distance, double error_bound) const;

 private:
  struct Meshes;
  std::shared_ptr<const Meshes> meshes_;
};

/// The surface that Garland-Heckbert `edge_collapse` with `Bounded_normal_change_filter` leaves at `ratio` of the
/// edges. Soups are made manifold first, by duplicating vertices.
[[nodiscard]] TriangleMesh decimated(const TriangleMesh& mesh, double ratio);

}  // namespace meshbound::bench
