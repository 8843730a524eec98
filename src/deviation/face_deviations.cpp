// SPDX-License-Identifier: MIT
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "deviation/measure_points.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/deviation_map.h"
#include "meshbound/error.h"
#include "meshbound/proximity.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"

namespace meshbound {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// The search for the bound of one triangle as a multiple of the error bound: `failed` times it could not be proven,
/// `proven` times it is proven.
struct FaceSearch {
  double lower = 0;  ///< some point of the triangle is at least this far from the other mesh, model units
  double upper = 0;  ///< no point of the triangle is further from it, model units
  double failed = 0;
  double proven = 0;
  double step = 1;         ///< to the next multiple tried; doubles with each failure
  std::uint32_t hint = 0;  ///< a triangle of the other mesh near the centroid

  [[nodiscard]] double next() const { return std::min(failed + step, std::floor((failed + proven) / 2)); }
  /// Beyond 2^53 multiples the numbers between two neighbours are no doubles.
  [[nodiscard]] bool is_open() const { return next() > failed && next() < proven; }
};

/// An upper bound by the corners: no point of a triangle is further from a corner than the longest edge is long, and
/// the distance to a mesh is 1-Lipschitz.
double lipschitz_upper(const Corners& p, double upper_of_corners) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (p[(k + 1) % 3] - p[k]).stableNorm());
  constexpr double roundings = 16 * unit_roundoff;  // of the differences, the norm and the sum
  return next_up((upper_of_corners + longest) * (1 + roundings));
}

/// The centroid as computed misses the exact one by less than this: three quotients and two sums, 4u a coordinate.
double centroid_rounding(const Corners& p) {
  double largest = 0;
  for (const Eigen::Vector3d& corner : p) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  return next_up(16 * unit_roundoff * largest);
}

/// Bounds of each triangle by its corners and its centroid.
std::vector<FaceSearch> first_bounds(const MeshView& mesh, const Bvh& other, const std::vector<Bounds>& vertices,
                                     double error_bound, const DeviationOptions& options) {
  std::vector<FaceSearch> faces(mesh.triangle_count());
  std::vector<Eigen::Vector3d> centroids(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Corners p = corners_of(mesh, f);
    centroids[f] = p[0] / 3 + p[1] / 3 + p[2] / 3;
    for (const std::uint32_t v : mesh.triangle(f)) {
      faces[f].lower = std::max(faces[f].lower, vertices[v].lower);
      faces[f].upper = std::max(faces[f].upper, vertices[v].upper);
    }
    faces[f].upper = lipschitz_upper(p, faces[f].upper);
  }
  measure_points(centroids, other, options, [&](std::size_t f, const ClosestPoint& found) {
    FaceSearch& face = faces[f];
    face.hint = found.point.triangle;
    face.lower = std::max(face.lower, next_down(found.distance.lower - centroid_rounding(corners_of(mesh, f))));
    face.failed = std::floor(face.lower / error_bound);
    face.proven = std::ceil(face.upper / error_bound);
  });
  return faces;
}

/// Tries the next multiple for every open triangle, grouped by multiple, since a `Proximity` is for one tolerance.
/// False if no triangle is open.
bool advance(std::vector<FaceSearch>& faces, const MeshView& mesh, std::vector<Proximity>& proximity,
             double error_bound, const StopToken& stop) {
  std::vector<std::size_t> open;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f].is_open()) open.push_back(f);
  std::stable_sort(open.begin(), open.end(),
                   [&](std::size_t a, std::size_t b) { return faces[a].next() < faces[b].next(); });
  constexpr std::size_t faces_per_task = 256;
  for_each_range(open.size(), faces_per_task, [&](std::size_t begin, std::size_t end) {
    Proximity& near = proximity[static_cast<std::size_t>(omp_get_thread_num())];
    for (std::size_t i = begin; i < end; ++i) {
      stop.check();  // a look costs less than 1% of the cheapest test, and some tests take milliseconds
      FaceSearch& face = faces[open[i]];
      const double multiple = face.next(), tolerance = multiple * error_bound;
      std::uint32_t hint = face.hint;  // a copy: the next test must not depend on what this one met
      const Verdict verdict = near.triangle_within(corners_of(mesh, open[i]), tolerance, hint);
      if (verdict == Verdict::Within) {
        face.proven = multiple;
        face.upper = std::min(face.upper, tolerance);
      } else {
        face.failed = multiple;
        face.step *= 2;
        if (verdict == Verdict::Exceeds) face.lower = std::max(face.lower, tolerance);
      }
    }
  });
  return !open.empty();
}

}  // namespace

std::vector<Bounds> face_deviations(const MeshView& mesh, const Bvh& other, const std::vector<Bounds>& vertices,
                                    double error_bound, const DeviationOptions& options) {
  validate(mesh);
  if (!(error_bound > 0) || !std::isfinite(error_bound))
    throw InvalidInput("the error bound of face deviations must be a length of more than 0");
  if (vertices.size() != mesh.vertex_count())
    throw InvalidInput("face deviations need the deviation of every vertex: " + std::to_string(vertices.size()) +
                       " for " + std::to_string(mesh.vertex_count()) + " vertices");
  std::vector<FaceSearch> faces = first_bounds(mesh, other, vertices, error_bound, options);
  const int threads = thread_count(options.threads);
  std::vector<Proximity> proximity;
  for (int i = 0; i < threads; ++i) proximity.emplace_back(other);
  with_team(threads, [&] {
    while (advance(faces, mesh, proximity, error_bound, options.stop)) continue;
  });
  std::vector<Bounds> deviations(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) deviations[f] = {faces[f].lower, faces[f].upper};
  return deviations;
}

}  // namespace meshbound
