// SPDX-License-Identifier: GPL-3.0-or-later
/// The ways to simplify that the benchmarks `simplify` and `simplify_all` compare, each as a user would write it.
#pragma once
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::bench {

struct Simplified {
  TriangleMesh mesh;
  double cpu = 0, wall = 0;  ///< seconds
};

/// `simplify_with_bound` with its proof, without the fresh measurement of what comes out (`seconds_of_measuring`).
/// `mesh` in the result is that of the level of `tolerance`, or of `options.levels[level]` where these ascend.
[[nodiscard]] Simplified bounded(const TriangleMesh& mesh, const SimplifyOptions& options,
                                 std::optional<std::size_t> level = std::nullopt);

/// Options for one tolerance, with the driver that was chosen last.
[[nodiscard]] SimplifyOptions within(double tolerance, Effort effort = Effort::Normal, int threads = 1);

/// "cgal", which it is at first, or "core". Before any thread is started.
void choose_driver(const std::string& name);

/// Processor seconds of the fresh measurement that decides whether `simplified` is within the tolerance of `mesh`,
/// trees included.
[[nodiscard]] double seconds_of_measuring(const TriangleMesh& mesh, const TriangleMesh& simplified, double tolerance,
                                          int threads = 1);

/// CGAL's Garland-Heckbert `edge_collapse` without any bound, until at most `faces` are left. Only its policies and the
/// decimation are timed: neither the copy of `mesh` that it works on, nor the conversion of the result.
[[nodiscard]] Simplified unbounded(const cgal::SurfaceMesh& mesh, std::size_t faces);

/// CGAL's `Polyhedral_envelope_filter` over the same decimation: bounds the new faces only, not the original.
[[nodiscard]] Simplified in_envelope(const TriangleMesh& mesh, double tolerance);

/// The valid recipe without our monitor: decimate to a number of faces, measure both ways, bisect the number (to 2%).
[[nodiscard]] Simplified by_bisection(const TriangleMesh& mesh, double tolerance);

/// The upper bound of the symmetric distance over the tolerance, measured afresh: at most 1 where the result holds.
[[nodiscard]] double share_of_tolerance(const TriangleMesh& mesh, const TriangleMesh& simplified, double tolerance);

}  // namespace meshbound::bench
