// SPDX-License-Identifier: MIT
#include "levels/measured_level.h"

#include <cmath>
#include <numbers>

#include "distance/unfinished.h"
#include "meshbound/error.h"
#include "meshbound/face_tolerances.h"
#include "meshbound/mesh_view.h"
#include "numeric/checked_seconds.h"

namespace meshbound {
void check_options(const SimplifyOptions& options) {
  const auto is_length = [](double x) { return std::isfinite(x) && x >= 0; };
  if (!is_length(options.tolerance)) throw InvalidInput("the tolerance must be a length in model units, 0 or more");
  for (const double level : options.levels) {
    if (!is_length(level)) throw InvalidInput("a level must be a length in model units, 0 or more");
    if (level > options.tolerance)
      throw InvalidInput("a level is larger than the tolerance; the tolerance is the last level");
  }
  if (options.line_tolerance && !is_length(*options.line_tolerance))
    throw InvalidInput("the line tolerance must be a length in model units, 0 or more");
  if (!(options.texture_tolerance >= 0))
    throw InvalidInput("the texture tolerance must be a length in model units, 0 or more");
  if (std::isfinite(options.texture_tolerance) && options.texture_coordinates.empty())
    throw InvalidInput("a texture tolerance needs texture coordinates of the triangles");
  if (options.normal_tolerance && !(*options.normal_tolerance >= 0 && *options.normal_tolerance <= 180))
    throw InvalidInput("the normal tolerance must lie between 0 and 180 degrees");
  if (options.target_ratio && !(*options.target_ratio >= 0 && *options.target_ratio <= 1))
    throw InvalidInput("the target ratio must lie between 0 and 1");
  if (options.feature_angle && !(*options.feature_angle >= 0 && *options.feature_angle <= std::numbers::pi))
    throw InvalidInput("the feature angle must lie between 0 and pi radians, which are 180 degrees");
  (void)checked_seconds(options.time_limit);
}

namespace {

/// The distance between the lines of original and level, with the verdict on their tolerance.
Verdict measure_lines(const TriangleMesh& original, std::span<const Edge> lines, SimplifiedLevel& level,
                      const SimplifyOptions& options) {
  DistanceOptions distance;
  distance.tolerance = std::min(level.tolerance, options.line_tolerance.value_or(level.tolerance));
  distance.threads = options.threads;
  distance.cancel = options.cancel;
  const auto [a, b] = build_trees(line_mesh(original, lines), line_mesh(level.mesh, level.lines), {options.threads});
  level.line_distance = hausdorff_distance(a, b, distance);
  return verdict_of(level.line_distance->bounds, *distance.tolerance);
}

}  // namespace

void measure_level(const TriangleMesh& original, const Bvh& tree, std::span<const Edge> lines, SimplifiedLevel& level,
                   const SimplifyOptions& options) {
  DistanceOptions distance;
  distance.tolerance = level.tolerance;
  distance.threads = options.threads;
  distance.cancel = options.cancel;
  const bool is_stopped = options.cancel != nullptr && options.cancel->load();
  if (is_stopped) {
    level.distance = unfinished_distance();
    return;
  }
  const Bvh mesh(level.mesh, BvhOptions{options.threads});
  for (const Method method : {Method::CellWalking, Method::CrossCulling}) {
    if (level.distance && level.verdict != Verdict::Undecided) break;
    distance.method = method;
    level.distance = hausdorff_distance(tree, mesh, distance);
    level.verdict = verdict_of(level.distance->bounds, level.tolerance);
  }
  if (!options.face_tolerances.empty() && level.verdict == Verdict::Within)
    level.verdict = check_face_tolerances(original, options.face_tolerances, level.tolerance, level.mesh).verdict;
  if (!lines.empty() && level.verdict == Verdict::Within)
    level.verdict = measure_lines(original, lines, level, options);
  if (!options.certificate || level.verdict != Verdict::Within) return;
  CertificateOptions certificate;
  certificate.threads = options.threads;
  certificate.cancel = options.cancel;
  level.certificate = build_certificate(original, level.mesh, level.tolerance, certificate);
}

}  // namespace meshbound
