// SPDX-License-Identifier: MIT
/// How far a mesh is from another one, place by place: at its vertices, over each of its faces, and as statistics over
/// its area. The distance of a point is that to the nearest point of the other mesh; all lengths are in model units.
/// The functions are pure; any number of threads may call them, also with the same tree. Results are the same to the
/// last bit for any number of threads.
#pragma once
#include <cstddef>
#include <limits>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/bvh.h"
#include "meshbound/mesh_view.h"
#include "meshbound/stop_token.h"

namespace meshbound {

/// How deviations are computed.
struct DeviationOptions {
  int threads = 0;      ///< 0: as many as OpenMP has
  StopToken stop = {};  ///< the computation ends with `Stopped` soon after this says so
};

/// The distance of every vertex of `mesh` to `other`, as a proven interval; one entry for each vertex. Nothing is known
/// of a vertex that no triangle uses and that is not finite or beyond `largest_coordinate`: its interval is
/// [0, infinity]. Throws `InvalidInput` as `validate` does, `Stopped` as the options say. Expected O(n log m) for n
/// vertices and m triangles of the other mesh.
[[nodiscard]] std::vector<Bounds> vertex_deviations(const MeshView& mesh, const Bvh& other,
                                                    const DeviationOptions& options = {});

/// The largest distance of a point of each triangle of `mesh` to `other`, as a proven interval; one entry for each
/// triangle. An interval is at most `error_bound` (model units, more than 0) and a rounding wide, unless `Proximity`
/// cannot decide; it then still holds, and is at most an edge of the triangle wider. `vertices` are the deviations of
/// the vertices, as `vertex_deviations` returns them. Throws `InvalidInput` for an error bound that is not positive and
/// finite, for another number of `vertices` than the mesh has, and as `validate` does; `Stopped` as the options say.
/// Expected O(k (log m + log(d / error_bound))) for k triangles and the largest distance d within one of them.
[[nodiscard]] std::vector<Bounds> face_deviations(const MeshView& mesh, const Bvh& other,
                                                  const std::vector<Bounds>& vertices, double error_bound,
                                                  const DeviationOptions& options = {});

/// Which statistics are wanted.
struct DeviationSampling {
  std::size_t samples = std::size_t{1} << 17;  ///< points on the mesh, each representing an equal share of the area
  std::size_t bins = 100;                      ///< of the histogram, of equal width, from 0 to `scale`
  double scale = 1;                            ///< model units, more than 0 and finite
  /// An upper bound of the distance of every point of the mesh, where it is known: no sample counts as further away.
  /// Model units, at least 0.
  double max_distance = std::numeric_limits<double>::infinity();
};

/// Distances of points that are spread evenly over the area of a mesh, each rounded up by what rounding the point to
/// doubles may have changed. Estimates, not bounds: a narrow peak may stand between the points.
struct DeviationStatistics {
  std::size_t samples = 0;             ///< 0 where the mesh has no area; the lengths below are then not numbers
  double mean = 0;                     ///< of the distances, model units
  double root_mean_square = 0;         ///< of the distances, model units
  double percentile_95 = 0;            ///< 95% of the area are at most so far away, model units
  double largest_sample = 0;           ///< the largest of the distances, model units
  double scale = 0;                    ///< where the last bin ends, model units
  std::vector<std::size_t> histogram;  ///< samples in each bin; a bin holds its upper end
  std::size_t beyond_scale = 0;        ///< samples that are proven to be further than the last bin
};

/// Statistics of the distances from `mesh` to `other`. The points stand at equal steps of area along the triangles in
/// the order they have (systematic sampling), and inside the triangles where the R2 sequence says (M. Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018). Throws `InvalidInput` for a sampling that is not as
/// described, and as `validate` does; `Stopped` as the options say. O(k + s log m) for k triangles and s samples.
[[nodiscard]] DeviationStatistics deviation_statistics(const MeshView& mesh, const Bvh& other,
                                                       const DeviationSampling& sampling,
                                                       const DeviationOptions& options = {});

}  // namespace meshbound
