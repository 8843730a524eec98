// SPDX-License-Identifier: GPL-3.0-or-later
/// The ways to simplify that the `simplify` benchmark compares, each as a user would write it.
#pragma once
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::bench {

struct Simplified {
  TriangleMesh mesh;
  double cpu = 0, wall = 0;  ///< seconds, the measurement that certifies included where there is one
  double certify_cpu = 0;    ///< seconds of that measurement
};

/// `simplify_with_bound`, the final measurement included.
[[nodiscard]] Simplified bounded(const TriangleMesh& mesh, double tolerance, cgal::Effort effort, int threads);

/// CGAL's Garland-Heckbert run without any bound, from the soup to `faces`: what the bound's time is compared with.
[[nodiscard]] Simplified unbounded(const TriangleMesh& mesh, std::size_t faces);

/// CGAL's `Polyhedral_envelope_filter` over the same decimation: bounds the new faces only, not the original.
[[nodiscard]] Simplified in_envelope(const TriangleMesh& mesh, double tolerance);

/// The valid recipe without our monitor: decimate to a number of faces, measure both ways, bisect the number (to 2%).
[[nodiscard]] Simplified by_bisection(const TriangleMesh& mesh, double tolerance);

/// The upper bound of the symmetric distance over the tolerance, measured afresh: at most 1 where the result holds.
[[nodiscard]] double share_of_tolerance(const TriangleMesh& mesh, const TriangleMesh& simplified, double tolerance);

}  // namespace meshbound::bench
