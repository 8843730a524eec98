// SPDX-License-Identifier: MIT
#include "levels/measured_level.h"

#include <cmath>
#include <numbers>

#include "meshbound/error.h"
#include "meshbound/face_tolerances.h"
#include "meshbound/mesh_view.h"

namespace meshbound {
void check_options(const SimplifyOptions& options) {
  const auto is_length = [](double x) { return std::isfinite(x) && x >= 0; };
  if (!is_length(options.tolerance))
    throw InvalidInput("the tolerance must be given: a length in model units, 0 or more");
  for (const double level : options.levels) {
    if (!is_length(level)) throw InvalidInput("a level must be a length in model units, 0 or more");
    if (level > options.tolerance)
      throw InvalidInput("a level is larger than the tolerance; the tolerance is the last level");
  }
  if (options.target_ratio && !(*options.target_ratio >= 0 && *options.target_ratio <= 1))
    throw InvalidInput("the target ratio must lie between 0 and 1");
  if (options.feature_angle && !(*options.feature_angle >= 0 && *options.feature_angle <= std::numbers::pi))
    throw InvalidInput("the feature angle must lie between 0 and 180 degrees");
  if (!(options.time_limit >= 0)) throw InvalidInput("the time limit must be 0 seconds or more");
}

void measure_level(const TriangleMesh& original, const Bvh& tree, SimplifiedLevel& level,
                   const SimplifyOptions& options) {
  DistanceOptions distance;
  distance.tolerance = level.tolerance;
  distance.threads = options.threads;
  distance.cancel = options.cancel;
  const Bvh mesh(level.mesh, BvhOptions{options.threads});
  const bool is_stopped = options.cancel != nullptr && options.cancel->load();
  for (const Method method : {Method::CellWalking, Method::CrossCulling}) {
    if (level.distance && (level.verdict != Verdict::Undecided || is_stopped)) break;
    distance.method = method;
    level.distance = hausdorff_distance(tree, mesh, distance);
    level.verdict = verdict_of(level.distance->bounds, level.tolerance);
  }
  if (!options.face_tolerances.empty() && level.verdict == Verdict::Within)
    level.verdict = check_face_tolerances(original, options.face_tolerances, level.tolerance, level.mesh).verdict;
  if (!options.certificate || level.verdict != Verdict::Within) return;
  CertificateOptions certificate;
  certificate.threads = options.threads;
  certificate.cancel = options.cancel;
  level.certificate = build_certificate(original, level.mesh, level.tolerance, certificate);
}

}  // namespace meshbound
