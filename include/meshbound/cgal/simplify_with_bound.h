// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "meshbound/certificate.h"
#include "meshbound/cgal/surface_mesh.h"
#include "meshbound/deviation_tracker.h"
#include "meshbound/distance.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::cgal {

enum class CollapseCost { GarlandHeckbert, LindstromTurk };

/// What happens at a collapse that would exceed the tolerance.
enum class OnExceed {
  Skip,  ///< it is refused, and decimation goes on until no collapse fits: far fewer faces at the same bound
  Stop   ///< decimation ends there, once the global engine has confirmed that the distance would exceed
};

/// How long to look for a mesh with fewer faces. All hold the same bound.
enum class Effort {
  Fast,    ///< one pass over the edges, each with the placement of its cost only
  Normal,  ///< passes until nothing fits, several placements for each edge
  High     ///< then vertices are moved and edges flipped to make room for further collapses, again and again
};

/// Why decimation ended.
enum class EndedBy {
  NothingFits,  ///< no further collapse keeps the bound
  Target,
  Tolerance,  ///< OnExceed::Stop: the next collapse would exceed
  TimeLimit,
  Cancelled,
  Rounding  ///< the tolerance is too small for doubles at these coordinates: nothing was collapsed
};

/// Which bound came first, for reports: "tolerance" (also where nothing fits), "target", "rounding", "time_limit" or
/// "cancelled".
[[nodiscard]] std::string to_string(EndedBy reason);

struct SimplifyOptions {
  /// Bound of the symmetric Hausdorff distance to the original, model units. Must be given.
  double tolerance = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::size_t> target_faces;  ///< decimation ends at this many faces if the tolerance allows it
  std::optional<double> target_ratio;       ///< the same as a share of the original's faces, 0 to 1
  OnExceed on_exceed = OnExceed::Skip;
  /// Smaller tolerances at which the mesh is handed out as well, in any order. One run with growing tolerance makes
  /// all, each bounded against the original itself. Targets apply to `tolerance` only.
  std::vector<double> levels;
  Effort effort = Effort::Normal;
  CollapseCost cost = CollapseCost::GarlandHeckbert;
  /// Whole components whose every point lies within the tolerance of what remains are dropped, the smallest first. Not
  /// those with locked vertices or, with `preserve_boundary`, with a border.
  bool prune = false;
  bool preserve_boundary = false;  ///< edges with one face stay as they are
  /// By vertex of the original, empty for none: true keeps a vertex that a triangle uses where it is, to the bit.
  std::vector<bool> locked_vertices;
  /// Edges whose faces' normals are further apart than this stay as they are, both ends locked. Radians, 0 to pi.
  std::optional<double> feature_angle;
  /// By triangle of the original, model units, empty for none: beside `tolerance`, every point of triangle k stays
  /// within face_tolerances[k] of the result, and every point of the result within face_tolerances[g] of the original
  /// triangle g nearest to it. The verdict of a level includes them (`check_face_tolerances`).
  std::vector<double> face_tolerances;
  /// The caller will move vertices by at most this afterwards (a file format of single precision), model units: room
  /// for it is kept within the tolerance.
  double output_rounding = 0;
  /// Measure what comes out, against the original, and say so in `distance`. Without, the caller must do that.
  bool measure = true;
  /// Make the certificate of each level that was measured to be within its tolerance.
  bool certificate = false;
  double time_limit = std::numeric_limits<double>::infinity();  ///< seconds after which decimation ends
  /// Originals of 10,000 triangles or more are cut into parts, which are decimated side by side by all threads, joined
  /// again, and decimated at the seams. Not with `OnExceed::Stop`, a target, `prune` or `face_tolerances`, which go by
  /// the whole mesh.
  bool parts = true;
  int threads = 0;                                ///< 0: as many as OpenMP has. The result is the same for every value.
  const std::atomic<bool>* cancel = nullptr;      ///< set to true from another thread or a signal handler to stop early
  std::function<void(double fraction)> progress;  ///< called from the calling thread; a guess
};

struct SimplifiedLevel {
  double tolerance = 0;
  TriangleMesh mesh;
  EndedBy ended_by = EndedBy::NothingFits;
  /// Of the original (a) and `mesh` (b), with the verdict on `tolerance`, when it was measured.
  std::optional<SymmetricDistance> distance;
  Verdict verdict = Verdict::Undecided;
  std::optional<Certificate> certificate;  ///< of the original and `mesh`, when it was asked for
  std::uint64_t collapses_performed = 0;   ///< since the beginning of the run
  std::uint64_t collapses_refused = 0;

  [[nodiscard]] std::size_t faces() const { return mesh.triangles.size(); }
};

/// Collapses far from the tolerance are made by an estimate first, then the mesh is proven as a whole, and every
/// collapse from there.
struct EstimatedCollapses {
  std::uint64_t performed = 0;  ///< of those in the result; 0 where the options or the input leave no room for it
  /// Times that the proof failed and all began again, first without what could not be proven, then with proofs for
  /// every collapse.
  std::uint64_t restarts = 0;
};

struct SimplifyResult {
  std::vector<SimplifiedLevel> levels;    ///< ascending; the last is the one of `SimplifyOptions::tolerance`
  std::size_t dropped_triangles = 0;      ///< duplicates and degenerate ones that lie on others
  std::size_t kept_triangles = 0;         ///< degenerate ones that lie on no other: part of every level as they are
  std::size_t pruned_components = 0;      ///< dropped as wholes, `SimplifyOptions::prune`
  std::size_t pruned_faces = 0;           ///< that these had when they were dropped
  bool split = false;                     ///< the input was not an oriented 2-manifold and was cut into one
  bool tolerance_below_rounding = false;  ///< too small for doubles at these coordinates: nothing was collapsed
  TrackerStats stats;
  EstimatedCollapses estimated;
  struct Seconds {
    double prepare = 0, simplify = 0, measure = 0;
  } seconds;

  [[nodiscard]] const SimplifiedLevel& last() const { return levels.back(); }
};

/// Simplifies a triangle soup by edge collapses while its symmetric Hausdorff distance to the original stays within the
/// tolerance. A `DeviationMonitor` proves both ways the mesh that the first collapses, far from the tolerance, leave,
/// and each collapse from there; that proof steers, and the verdict of each level is a fresh measurement of its mesh
/// (`options.measure`). Decimation needs a 2-manifold, so it works on a `manifold_copy`; the bound is always against
/// the soup as it came in. Deterministic for any number of threads, but for `time_limit` and `cancel`.
///
/// Throws `InvalidInput` for options out of range, for input that `validate` refuses, and when no manifold copy exists.
[[nodiscard]] SimplifyResult simplify_with_bound(const TriangleMesh& original, const SimplifyOptions& options);

/// A vertex property map of a face graph as `SimplifyOptions::locked_vertices` for that graph. O(n).
template <class FaceGraph, class LockMap>
[[nodiscard]] std::vector<bool> locked_vertices(const FaceGraph& graph, const LockMap& is_locked) {
  std::vector<bool> locked;
  for (const auto v : vertices(graph)) locked.push_back(bool(get(is_locked, v)));
  return locked;
}

/// The same for any triangulated face graph of CGAL.
template <class FaceGraph>
requires(!std::is_same_v<FaceGraph, TriangleMesh>) [[nodiscard]] SimplifyResult
    simplify_with_bound(const FaceGraph& original, const SimplifyOptions& options) {
  return simplify_with_bound(to_triangle_mesh(original), options);
}

}  // namespace meshbound::cgal
