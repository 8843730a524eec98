// SPDX-License-Identifier: MIT
/// Simplification with a proven bound: as few triangles as possible, never further than a tolerance from the original.
#pragma once
#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meshbound/certificate.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/line_mesh.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

class RegionCollapses;

/// Chooses the order of the collapses that are proven one by one, and makes them.
class CollapseDriver {
 public:
  virtual ~CollapseDriver() = default;
  /// Collapses edges of one region of a mesh until nothing more fits. Called from several threads at once.
  virtual void collapse(RegionCollapses& collapses) const = 0;
};

/// What happens at a collapse that would exceed the tolerance.
enum class OnExceed {
  Skip,  ///< it is refused, and decimation goes on until no collapse fits: far fewer faces at the same bound
  /// Decimation ends there, once the global engine has confirmed that the distance would exceed wherever the vertex
  /// goes: to the best placement, to an end of the edge or to its middle. Edges that cannot be collapsed for another
  /// reason, as where a face would fold, are skipped.
  Stop
};

/// How much time to spend on a mesh with fewer faces. Both values keep the same bound.
enum class Effort {
  Normal,  ///< collapses until nothing fits
  /// Then vertices are moved and edges flipped to make room for further collapses, again and again. As `Normal` with
  /// `OnExceed::Stop`, texture coordinates or a normal tolerance.
  High
};

/// Where a collapse may put its vertex.
enum class CollapsePlacements {
  Optimal,  ///< where the cost or the largest distance is least
  Subset    ///< at one of the two ends: every vertex of every level is one of the original
};

/// Precision of the coordinates of a result.
enum class Precision {
  Double,
  Single  ///< every coordinate of a result is a float, and the bound is that of the rounded mesh
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

/// What is asked of a simplification, and what it may cost.
struct SimplifyOptions {
  /// Bound of the symmetric Hausdorff distance to the original, model units. Must be given.
  double tolerance = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::size_t> target_faces;  ///< decimation ends at this many faces if the tolerance allows it
  std::optional<double> target_ratio;       ///< the same as a share of the original's faces, 0 to 1
  OnExceed on_exceed = OnExceed::Skip;      ///< at a collapse that would exceed the tolerance
  /// Smaller tolerances at which the mesh is handed out as well, in any order. One run with growing tolerance makes
  /// all, each bounded against the original itself. Targets apply to `tolerance` only.
  std::vector<double> levels;
  Effort effort = Effort::Normal;  ///< time for fewer faces
  /// Whole components whose every point lies within the tolerance of what remains are dropped, the smallest first. Not
  /// those with locked vertices or, with `preserve_boundary`, with a border, and none where a texture or normals count.
  bool prune = false;
  bool preserve_boundary = false;  ///< edges with one face stay as they are
  /// By vertex of the original, empty for none: true keeps a vertex that a triangle uses where it is, to the bit; with
  /// `Precision::Single` at the floats nearest to its coordinates.
  std::vector<bool> locked_vertices;
  /// Edges whose faces' normals are further apart than this are creases. Without `line_tolerance` they stay as they
  /// are, both ends locked. Radians, 0 to pi.
  std::optional<double> feature_angle;
  /// Where this is set, or `feature_edges` are given, the mesh has feature lines: borders, creases and those edges.
  /// Line vertices move only along their line, ends and crossings of lines stay, and the symmetric Hausdorff distance
  /// between the lines of original and result is at most this or `tolerance`, whichever is smaller; the verdict of a
  /// level includes it. Model units.
  std::optional<double> line_tolerance;
  /// Further edges that are lines, by the vertices of the original; pairs that no triangle has as an edge say nothing.
  std::vector<Edge> feature_edges;
  /// Texture coordinates at the corners of each triangle of the original, not numbers where there are none; empty: the
  /// texture does not count. Borders, and edges where those of the two triangles differ, are feature lines then, and
  /// `Effort::High` is `Effort::Normal`.
  std::vector<std::array<Eigen::Vector2d, 3>> texture_coordinates;
  /// By triangle of the original: coordinates of different materials are different. Empty: all have the same one.
  std::vector<std::uint32_t> materials;
  /// By triangle of the original: triangles with the same corners but different numbers are layers that are simplified
  /// each, as a decal and what it lies on, or both sides of a sheet; of those with equal numbers that show the same
  /// side one stays. Empty: one stays of all, unless texture coordinates or normals tell them apart.
  std::vector<std::uint32_t> looks;
  /// Every triangle of a result shows the side that its original shows. Where two neighbours are wound in opposite
  /// directions, their edge is a feature line, and so are borders then. Texture coordinates and a normal tolerance keep
  /// sides as well. False: neighbours are turned over until they agree (`SimplifiedLevel::turned_faces`), so that scans
  /// of random winding become one surface.
  bool keep_sides = false;
  /// How far the texture may move on the surface (`texture_deviation`), model units: collapses that move samples of the
  /// original further are refused. This is no proof, and the verdict of a level does not include it. Needs
  /// `texture_coordinates` where it is finite.
  double texture_tolerance = std::numeric_limits<double>::infinity();
  /// How far faces may turn (`normal_deviation`), degrees: collapses after which samples of the original turn further
  /// are refused. This is no proof, and the verdict of a level does not include it. `Effort::High` is `Effort::Normal`
  /// then.
  std::optional<double> normal_tolerance;
  CollapsePlacements placements = CollapsePlacements::Optimal;  ///< with `Subset`, `Effort::High` only flips edges
  /// By triangle of the original, model units, empty for none: beside `tolerance`, every point of triangle k stays
  /// within face_tolerances[k] of the result, and every point of the result within face_tolerances[g] of the original
  /// triangle g nearest to it. The verdict of a level includes them (`check_face_tolerances`).
  std::vector<double> face_tolerances;
  Precision precision = Precision::Double;  ///< of the result's coordinates
  /// Make the certificate of each level that was measured to be within its tolerance.
  bool certificate = false;
  /// Seconds after which decimation ends; `InvalidInput` for a negative number and one that is none.
  double time_limit = std::numeric_limits<double>::infinity();
  int threads = 0;                            ///< 0: as many as OpenMP has. The result is the same for every value.
  const std::atomic<bool>* cancel = nullptr;  ///< set to true from another thread or a signal handler to stop early
  /// Called from the calling thread with an estimate of the share done, some thousands of times a second. May call the
  /// library, for the same models too; what it throws ends this call and is passed on.
  std::function<void(double fraction)> progress;
  std::shared_ptr<const CollapseDriver> driver;  ///< null: the queue of the core
};

/// A simplified mesh and its distance from the original.
struct SimplifiedLevel {
  double tolerance = 0;  ///< for which it was made, model units
  TriangleMesh mesh;     ///< model units
  /// By vertex of `mesh`: the vertex of the original that it comes from, for data that the caller wants to carry along.
  /// It may have moved from there; with `CollapsePlacements::Subset` it stands exactly there, or with
  /// `Precision::Single` at the floats nearest to it.
  std::vector<std::uint32_t> source_vertex;
  /// By triangle of `mesh`: one of the triangles of the original that it stands for.
  std::vector<std::uint32_t> source_triangle;
  /// By triangle of `mesh`, where `SimplifyOptions::texture_coordinates` are given: those of its corners.
  std::vector<std::array<Eigen::Vector2d, 3>> texture_coordinates;
  std::size_t turned_faces = 0;             ///< triangles that face the other way than their `source_triangle`
  std::vector<Edge> lines;                  ///< edges of `mesh` that are lines, if the mesh has feature lines
  EndedBy ended_by = EndedBy::NothingFits;  ///< why decimation did not go further
  /// Distance between the original (a) and `mesh` (b), with the verdict on `tolerance`.
  std::optional<HausdorffDistance> distance;
  std::optional<HausdorffDistance> line_distance;  ///< between the lines of the original (a) and `lines` (b)
  Verdict verdict = Verdict::Undecided;            ///< on `distance` and, if there are lines, `line_distance`
  std::optional<Certificate> certificate;          ///< of the original and `mesh`, when it was asked for
  std::uint64_t collapses_performed = 0;           ///< and other changes, since the beginning of the run
  std::uint64_t collapses_refused = 0;             ///< since the beginning of the run

  /// Number of triangles.
  [[nodiscard]] std::size_t faces() const { return mesh.triangles.size(); }
};

/// How the collapses of a run came about, for those who tune it.
struct CollapseCounts {
  std::uint64_t tried = 0;            ///< edges compared with samples of the original
  std::uint64_t refused = 0;          ///< edges tried that samples refused
  std::uint64_t proven_together = 0;  ///< collapses that samples admitted and one common proof confirmed
  std::uint64_t taken_back = 0;       ///< collapses that samples admitted, undone where that proof failed or would have
  std::uint64_t proven_alone = 0;     ///< collapses, and other changes, that were proven one by one
  std::uint64_t restored = 0;         ///< proven collapses that were undone for the texture or the normals
  std::uint64_t unproven = 0;         ///< changes tried one by one and undone, as their proof failed
  std::uint64_t originals_tested = 0;  ///< triangles of the original that proofs tested
  std::uint64_t faces_tested = 0;      ///< faces of the result that proofs tested

  /// Adds what another run counted.
  CollapseCounts& operator+=(const CollapseCounts& other);
};

/// All levels of a run, and facts about it.
struct SimplifyResult {
  std::vector<SimplifiedLevel> levels;  ///< ascending; the last is the one of `SimplifyOptions::tolerance`
  std::vector<Edge> lines;              ///< edges of the original that are lines, if it has feature lines
  std::size_t dropped_triangles = 0;    ///< duplicates and degenerate ones that lie on others
  /// Degenerate ones that lie on no other, or with a part of the texture that no face near has: they stay as they are.
  std::size_t kept_triangles = 0;
  std::size_t pruned_components = 0;      ///< whole components dropped, `SimplifyOptions::prune`
  std::size_t pruned_faces = 0;           ///< faces of these components when they were dropped
  std::size_t locked_vertices = 0;        ///< that no collapse may move: by the options that lock some
  bool split = false;                     ///< the input was not an oriented 2-manifold and was cut into one
  bool tolerance_below_rounding = false;  ///< too small for the numbers of the result at these coordinates
  CollapseCounts counts;                  ///< of all levels together
  /// Wall-clock time of the phases.
  struct Seconds {
    double prepare = 0;   ///< the manifold, the original's tree and samples
    double simplify = 0;  ///< collapses and their proofs
    double measure = 0;   ///< the distance of each level, and certificates
  } seconds;              ///< of the run

  /// The level of `SimplifyOptions::tolerance`.
  [[nodiscard]] const SimplifiedLevel& last() const { return levels.back(); }
};

/// Simplifies a triangle soup by edge collapses while its symmetric Hausdorff distance to the original stays within the
/// tolerance. Samples of the original propose collapses, proofs confirm them, and the verdict of each level is a fresh
/// measurement of its mesh. Decimation works on a manifold that is cut from the soup; the bound is always against the
/// soup as it came in. Deterministic for any number of threads, but for `time_limit` and `cancel`.
///
/// Triangles with two equal corners stay as they are where no other face is near enough, also where there are no
/// others. Expected O(n log n) time, O(n) memory. Safe to call from several threads. Throws `InvalidInput` for options
/// out of range, and for input that `validate` refuses.
[[nodiscard]] SimplifyResult simplify_with_bound(const TriangleMesh& original, const SimplifyOptions& options);

}  // namespace meshbound
