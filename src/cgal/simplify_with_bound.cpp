// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshbound/cgal/simplify_with_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cgal/level_run.h"
#include "cgal/measured_level.h"
#include "meshbound/error.h"
#include "meshbound/face_tolerances.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/mesh_view.h"

namespace meshbound::cgal {
namespace {

/// Ascending, each once, ending with the tolerance.
std::vector<double> tolerances(const SimplifyOptions& options) {
  std::vector<double> all = options.levels;
  all.push_back(options.tolerance);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Faces to end at in the last level; 0 when no target is given.
std::size_t target(const TriangleMesh& original, const SimplifyOptions& options) {
  std::size_t faces = options.target_faces.value_or(0);
  if (options.target_ratio) {
    const double share = *options.target_ratio * static_cast<double>(original.triangles.size());
    faces = std::max(faces, static_cast<std::size_t>(std::floor(share)));
  }
  return faces;
}

Verdict verdict_of(const Bounds& bounds, double tolerance) {
  if (bounds.upper <= tolerance) return Verdict::Within;
  return bounds.lower > tolerance ? Verdict::Exceeds : Verdict::Undecided;
}

}  // namespace

std::string to_string(EndedBy reason) {
  switch (reason) {
    case EndedBy::NothingFits:
    case EndedBy::Tolerance:
      return "tolerance";
    case EndedBy::Target:
      return "target";
    case EndedBy::Rounding:
      return "rounding";
    case EndedBy::TimeLimit:
      return "time_limit";
    case EndedBy::Cancelled:
      break;
  }
  return "cancelled";
}

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
  if (!is_length(options.output_rounding)) throw InvalidInput("the output rounding must be a length, 0 or more");
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
    level.distance = symmetric_distance(tree, mesh, distance);
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

SimplifyResult simplify_with_bound(const TriangleMesh& original, const SimplifyOptions& options) {
  check_options(options);
  validate(original);
  SimplifyResult result;
  LevelRun run(original, options);
  const std::vector<double> levels = tolerances(options);
  for (const double tolerance : levels) {
    const bool is_last = tolerance == levels.back();
    result.levels.push_back(run.next(tolerance, is_last ? target(original, options) : 0));
    if (options.progress)
      options.progress(static_cast<double>(result.levels.size()) / static_cast<double>(levels.size()));
  }
  run.describe(result);
  if (!options.measure) return result;
  const auto measuring = LevelRun::Clock::now();
  const Bvh tree(original, BvhOptions{options.threads});
  for (SimplifiedLevel& level : result.levels) measure_level(original, tree, level, options);
  result.seconds.measure = seconds_since(measuring);
  return result;
}

}  // namespace meshbound::cgal
