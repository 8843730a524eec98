// SPDX-License-Identifier: MIT
/// The JSON documents of the tools, one function per schema. The schemas are published in tools/schema/; keys are
/// added, never renamed. Lengths are in model units. Doubles are written so that reading them back gives the same
/// double; a value that is not finite is written as null (an upper bound nobody has proven yet, a percentage of a
/// diagonal that is 0). Functions are pure and safe to call from any thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "meshbound/bounds.h"
#include "meshbound/deviation_map.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/normal_deviation.h"
#include "meshbound/screen_space.h"
#include "meshbound/texture_deviation.h"

namespace meshbound {

/// The program, date and command line that made a document.
struct Provenance {
  std::string tool;                  ///< such as "lod_chain"
  std::string version;               ///< as `--version` says it
  std::string date;                  ///< UTC, such as "2026-11-22T08:40:00Z"
  std::vector<std::string> command;  ///< the words of the command line, the program's own name first
};

/// A mesh file named in a report.
struct MeshReport {
  std::string path;                               ///< as it was given
  MeshSummary summary;                            ///< facts about its triangles
  std::size_t triangulated_polygons = 0;          ///< see `MeshFile`
  std::size_t decoded_strips = 0;                 ///< see `MeshFile`
  std::size_t ignored_elements = 0;               ///< see `MeshFile`
  std::optional<DroppedAttributes> dropped = {};  ///< of a mesh that is written again
  std::string sha256 = {};                        ///< of the file, hexadecimal; empty: not computed
  std::size_t rest_pose_parts = 0;                ///< see `MeshFile`
};

/// False for a direction that was never searched, such as the second one of a decision that the first one ended: its
/// bounds say nothing, and it has no witness.
[[nodiscard]] bool was_searched(const OneSidedDistance& distance);

/// The point that is furthest from the other mesh among those that a search has met.
struct WorstSpot {
  bool on_a = true;      ///< the point is on A (the original), else on B (the simplified mesh)
  SurfacePoint point;    ///< the one that is furthest
  SurfacePoint nearest;  ///< on the other mesh
  /// `lower`: this point is at least so far from the other mesh. `upper`: no point of either mesh is further, in the
  /// directions that were asked for.
  Bounds distance;
};

/// The witness of the direction with the larger lower bound. Absent when nothing was searched. `b_to_a` may be null.
[[nodiscard]] std::optional<WorstSpot> worst_spot(const Bounds& bounds, const OneSidedDistance& a_to_b,
                                                  const OneSidedDistance* b_to_a);

/// How far a texture moves on the surface from one mesh to the other.
struct TextureReport {
  TextureDeviation deviation;          ///< a: the original, b: the mesh that is compared with it
  std::optional<double> tolerance;     ///< of it, model units, where one was asked for
  std::optional<double> texture_size;  ///< texels of a side, where one was given
  double texel_length = 0;             ///< see `texel_length`, model units; where there is a texture size
  bool compares_floats = false;  ///< one file holds texture coordinates as floats: those of the other were rounded so
};

/// How far two meshes are from each other over their area.
struct DeviationReport {
  double scale = 1;            ///< where the histograms and the scale of colours end, model units
  std::string scale_meaning;   ///< "tolerance", "proven maximum" or "1e-9 of the diagonal"
  std::string unit;            ///< of lengths, as the user named it; may be empty
  DeviationStatistics a_to_b;  ///< of points of A (the original), distances to B
  DeviationStatistics b_to_a;  ///< of points of B (the simplified mesh), distances to A
};

/// How far the faces of an original turn in a result.
struct NormalReport {
  NormalDeviation deviation;  ///< from the original to the simplified mesh
  double tolerance = 0;       ///< degrees
};

/// What the ranks of a parallel run have told one another.
struct CommunicationReport {
  int ranks = 1;                  ///< processes
  std::uint64_t input_bytes = 0;  ///< sent by all ranks together so that each has the files that were read
  std::uint64_t bytes = 0;        ///< everything else that they sent
};

/// What `hausdorff_distance` says: schema "meshbound/distance/1".
struct DistanceReport {
  std::optional<Provenance> provenance;  ///< absent: the document does not say who made it
  std::string verdict;  ///< "done" (the interval is as narrow as wanted), "within", "exceeds" or "undecided"
  Outcome outcome = Outcome::Converged;    ///< of the whole question
  std::string reason;                      ///< why the outcome is "budget" or "precision"; else empty
  std::optional<double> error_bound;       ///< wanted width of the interval; absent when only a decision was asked for
  std::optional<double> tolerance;         ///< of the decision, if one was asked for
  MeshReport a;                            ///< the original
  MeshReport b;                            ///< the mesh that is compared with it
  Bounds bounds;                           ///< of the distance that was asked for, model units
  OneSidedDistance a_to_b;                 ///< h(A, B)
  std::optional<OneSidedDistance> b_to_a;  ///< absent when only one side was asked for
  std::optional<WorstSpot> worst;          ///< see `worst_spot`
  bool worst_was_wanted = false;           ///< by `--worst`: the text names it whatever the verdict
  std::optional<DeviationReport> deviation;      ///< where an output that shows it was asked for
  std::optional<double> transform_displacement;  ///< rounding of the transformed vertices of B, within the bounds
  std::optional<TextureReport> texture;          ///< where it was asked for and measured in time
  bool texture_was_wanted = false;               ///< by `--texture`
  /// Wall-clock time of the phases.
  struct Seconds {
    double read = 0;                                      ///< both files
    double build = 0;                                     ///< both trees
    double query = 0;                                     ///< the search
    double total = 0;                                     ///< from the start of the tool
  } seconds;                                              ///< of the run
  int threads = 1;                                        ///< that were used
  std::optional<CommunicationReport> communication = {};  ///< of a run over several processes
};

/// How the distance of a result was decided.
enum class DecidedBy {
  Measurement,       ///< by the first measurement
  SecondMethod,      ///< by another method of measuring the same mesh
  SmallerTolerance,  ///< by measuring a mesh that was made for a slightly smaller tolerance
  SmallerLevel,      ///< by the next finer level, which is written in its place: no other result could be decided
  Original           ///< by the original, which is written in its place: no other result could be decided
};

/// The feature lines of an original and of a result, see `SimplifyOptions::line_tolerance`.
struct LineReport {
  double tolerance = 0;            ///< model units
  std::size_t original_edges = 0;  ///< of the original's lines
  std::size_t edges = 0;           ///< of the result's lines
  HausdorffDistance distance;      ///< a: the original's lines, b: the result's as written
};

/// One level of detail that was written.
struct LevelReport {
  double tolerance = 0;                           ///< model units
  DecidedBy decided_by = DecidedBy::Measurement;  ///< of `distance`
  std::string path;                               ///< of its file
  std::size_t faces = 0;                          ///< triangles
  HausdorffDistance distance;                     ///< a: the original, b: the level as written
  std::optional<LineReport> lines = {};           ///< where there are feature lines
  std::optional<TextureReport> texture = {};      ///< where it was asked for
  std::optional<NormalReport> normals = {};       ///< where it was asked for
  std::string sha256 = {};                        ///< of the file, hexadecimal; empty: not computed
  std::size_t turned_faces = 0;                   ///< see `SimplifiedLevel`
};

/// A proof that was written for `verify_certificate`.
struct CertificateReport {
  std::string path;       ///< of its file
  std::size_t bytes = 0;  ///< its size
};

/// How much memory a run in tiles took.
struct MemoryReport {
  std::uint64_t peak_bytes = 0;   ///< the largest number that the process has held at once
  std::uint64_t limit_bytes = 0;  ///< of `--memory`
};

/// What `simplify_with_bound` says: schema "meshbound/simplify/1".
struct SimplifyReport {
  std::optional<Provenance> provenance;           ///< of the document
  Verdict verdict = Verdict::Undecided;           ///< of `distance`
  DecidedBy decided_by = DecidedBy::Measurement;  ///< how `distance` was found
  double tolerance = 0;                           ///< model units
  MeshReport original;                            ///< as read
  MeshReport simplified;                          ///< as written
  HausdorffDistance distance;                     ///< a: the original, b: the simplified mesh as written
  std::optional<LineReport> lines;                ///< where there are feature lines
  std::optional<TextureReport> texture;           ///< where it was asked for
  std::optional<DeviationReport> deviation;       ///< where an output that shows it was asked for
  std::optional<NormalReport> normals;            ///< where it was asked for
  std::string stopped_by;  ///< which bound came first: "tolerance", "target", "rounding", "time_limit", "cancelled"
  /// What `SimplifyOptions::prune` dropped.
  struct Pruned {
    std::size_t components = 0;  ///< whole ones
    std::size_t faces = 0;       ///< faces of these components when they were dropped
  } pruned;                      ///< by this run
  /// What became of an input that is not an oriented 2-manifold, see `SimplifyResult`.
  struct Repair {
    bool split = false;                         ///< it was cut into one
    std::size_t dropped_triangles = 0;          ///< duplicate or degenerate ones
    std::size_t kept_triangles = 0;             ///< degenerate ones that stay as they are
  } input;                                      ///< of the original
  std::string effort;                           ///< that had an effect: "normal" or "high"
  std::string driver;                           ///< "cgal" or "core"
  std::vector<LevelReport> levels;              ///< of smaller tolerances, ascending
  std::vector<CertificateReport> certificates;  ///< when they were asked for: of the levels, then of the result
  /// Collapses by their outcome; with `effort` "high" vertices that were moved and edges that were flipped count as
  /// well.
  struct Collapses {
    std::uint64_t performed = 0;        ///< proven, and not undone for the texture or the normals
    std::uint64_t refused = 0;          ///< edges tried that samples refused
    std::uint64_t proven_together = 0;  ///< also those that were undone afterwards; the key is "estimated"
    std::uint64_t taken_back = 0;       ///< of those that samples admitted, since the proof of all failed there
    std::uint64_t proven_alone = 0;     ///< also those that were undone afterwards
  } collapses;                          ///< of the whole run
  /// Wall-clock time of the phases.
  struct Seconds {
    double read = 0;                                      ///< the original
    double simplify = 0;                                  ///< collapses and their proofs
    double certify = 0;                                   ///< measuring what was written
    double certificate = 0;                               ///< making certificates
    double write = 0;                                     ///< meshes and certificates
    double total = 0;                                     ///< from the start of the tool
  } seconds;                                              ///< of the run
  std::size_t locked_vertices = 0;                        ///< that options kept from moving
  std::size_t turned_faces = 0;                           ///< see `SimplifiedLevel`
  std::optional<std::size_t> resumed_tiles = {};          ///< that an earlier run had finished, where it was resumed
  std::optional<MemoryReport> memory = {};                ///< where there was a limit
  int threads = 1;                                        ///< that were used
  std::optional<CommunicationReport> communication = {};  ///< of a run over several processes
};

/// What `lod_chain` says: schema "meshbound/lod/1".
struct LodReport {
  /// The view from which tolerances were computed, if they were not given.
  struct View {
    double pixels = 1;  ///< that a deviation may cover, for the finest level
    Screen screen;      ///< that it is seen on
  };
  /// A level of the chain.
  struct Level : LevelReport {
    std::string file;                     ///< the file name of `path`, enough where the report lies beside the levels
    std::size_t vertices = 0;             ///< of the level as written
    std::optional<double> pixels;         ///< that the tolerance covers at `view_distance`
    std::optional<double> view_distance;  ///< the one that the tolerance was made for
    std::string stopped_by;               ///< as in `SimplifyReport`
  };
  std::optional<Provenance> provenance;      ///< of the document
  Verdict verdict = Verdict::Undecided;      ///< of all levels together
  std::string driver;                        ///< "cgal" or "core"
  MeshReport original;                       ///< as read
  std::optional<View> view;                  ///< absent where tolerances were given
  std::vector<Level> levels;                 ///< those that were proven, ascending by tolerance
  std::optional<DeviationReport> deviation;  ///< of the coarsest level, where a report was asked for
  SimplifyReport::Seconds seconds;           ///< of the run
  std::size_t locked_vertices = 0;           ///< that options kept from moving
  int threads = 1;                           ///< that were used
};

/// "within", "exceeds" or "undecided".
[[nodiscard]] std::string to_string(Verdict verdict);

/// "measurement", "second_method", "smaller_tolerance", "smaller_level" or "original".
[[nodiscard]] std::string to_string(DecidedBy how);

/// "converged", "exceeds", "budget" or "precision".
[[nodiscard]] std::string to_string(Outcome outcome);

/// One JSON document, indented, with a newline at its end. Bytes of a path that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string to_json(const DistanceReport& report);
/// @overload
[[nodiscard]] std::string to_json(const SimplifyReport& report);
/// @overload
[[nodiscard]] std::string to_json(const LodReport& report);

}  // namespace meshbound
