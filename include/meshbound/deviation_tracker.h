// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "meshbound/bvh.h"
#include "meshbound/mesh_view.h"
#include "meshbound/stop_token.h"

namespace meshbound {

/// A face of the mesh that is being simplified. Ids are dense: memory is proportional to the largest one.
struct TrackedFace {
  std::uint32_t id = 0;
  std::array<Eigen::Vector3d, 3> corners;
};

/// A local edit of the simplified mesh: an edge collapse, a moved vertex, a flip.
///
///         *-----*                 *-----*
///        / \   / \               / \   / \       removed: the faces around u and v
///       *---u-v---*    ---->    *---*w*---*      added:   those that are left, with w in place of u and v
///        \ /   \ /               \  |  /         ring:    the faces that touch these from outside
///         *-----*                 *-----*
struct SurfaceChange {
  std::span<const std::uint32_t> removed;
  std::span<const TrackedFace> added;           ///< may reuse ids of `removed`
  std::optional<Eigen::Vector3d> moved_vertex;  ///< w above, where there is one: checked before anything else
  std::uint32_t try_first = no_triangle;        ///< original triangle whose cover is most likely to fail
  /// Appends ids of current faces around the change, `removed` excluded. Called only when the added faces do not
  /// suffice, and once for changes of the same `removed` that follow each other.
  std::function<void(std::vector<std::uint32_t>&)> ring;

  static constexpr std::uint32_t no_triangle = 0xffffffff;
};

/// Why a change was refused.
enum class Refusal {
  None,
  MovedVertexTooFar,  ///< `moved_vertex` is further from the original than the tolerance, or cannot be proven not to be
  OriginalUncovered,  ///< a part of the original would have no face near enough around it
  NewFaceTooFar,      ///< a part of an added face would be too far from the original
  TooManyFaces,       ///< more added faces than `DeviationTracker::most_added_faces`
  ToleranceBelowRounding  ///< the tolerance is so small that doubles cannot prove anything but the unchanged mesh
};

/// What could not be proven of a mesh that is to stand for an original.
struct Unproven {
  std::vector<std::uint32_t> originals;  ///< triangles with a part that no face is near enough to, ascending
  std::vector<std::uint32_t> faces;      ///< ids of those that are too far from the original, in the order given
  [[nodiscard]] bool empty() const { return originals.empty() && faces.empty(); }
};

struct TrackerStats {
  std::uint64_t admitted = 0;                 ///< calls of `admits` that returned true
  std::array<std::uint64_t, 6> refused = {};  ///< by `Refusal`
  std::uint64_t originals_tested = 0;         ///< original triangles whose cover had to be found again
  std::uint64_t originals_split = 0;          ///< of these, held by no single face
  std::uint64_t cuts = 0;
  std::uint64_t ring_searches = 0;    ///< changes that needed faces beyond the added ones
  std::uint64_t faces_tested = 0;     ///< added faces compared with the original
  std::uint64_t faces_by_degree = 0;  ///< of these, proven by projecting the original onto them

  TrackerStats& operator+=(const TrackerStats& other);
};

/// The proofs of a tracker, by its own numbers of faces and original triangles.
struct TrackedProof {
  double tolerance = 0;                ///< for which they hold
  std::vector<std::uint32_t> nearest;  ///< by face id: an original triangle near the face
  std::vector<std::size_t> ends;       ///< by original triangle: where the faces of its cover end in `faces`
  std::vector<std::uint32_t> faces;    ///< ids, one cover after another
};

/// How far faces and the part of the original that they are to stand for are apart, as one number to choose by: the sum
/// of (distance / tolerance)^6 over sample points of both, which follows the worst of them and is smooth. No bound.
struct SampledDeviation {
  double sum = 0;
  double worst = 0;                                     ///< largest distance / tolerance
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();   ///< of `sum`, when the moved vertex goes
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();  ///< its second derivative, but for that of directions
};

/// Largest distance / tolerance of sample points around a vertex that is to be placed. No bound.
struct HeightStep {
  double here = 0;
  double there = 0;                                ///< expected after `move`, or a number that no move goes below
  Eigen::Vector3d move = Eigen::Vector3d::Zero();  ///< to where the largest is least
};

/// Keeps a proof that a mesh under local edits stays within a tolerance of a fixed original, both ways:
///
///     every point of the original lies within the tolerance of a face that its triangle is assigned to, and
///     every face of the current mesh lies within the tolerance of the original.
///
/// Forward, each original triangle t has a set of current faces S(t) such that t can be cut into convex pieces, each
/// with one face of S(t) that is within the tolerance of all its corners; the distance to a triangle is convex, so the
/// face is within the tolerance of the whole piece. An edit that removes a face of S(t) must find a new cover of t,
/// among the added faces, then the rest of S(t) and the faces around; every other triangle keeps its proof. Backward,
/// an added face is compared with the original itself, so errors never add up.
///
/// The proof uses a tolerance that is smaller by `tracking_share` and by the rounding errors of doubles at the size of
/// the coordinates. Coordinates should be of ordinary size (1e-70 to 1e70): their squares must neither overflow nor
/// vanish. Not thread-safe. Memory: O(original triangles + faces). Cost of a change: O(original triangles around it).
class DeviationTracker {
 public:
  /// The tracker proves this share of the tolerance it is given. What is left is room in which the measurement of the
  /// finished mesh can decide without refining to the last digit: it accepts an upper bound of the whole tolerance.
  static constexpr double tracking_share = 1 - 1e-4;
  /// More are refused: the candidate faces of a point are the bits of one 64-bit word, and some are kept for the ring.
  static constexpr std::size_t most_added_faces = 48;

  /// `bvh` must be built from `original` and outlive this. The view is copied. Throws `InvalidInput` when the two
  /// differ in size or the tolerance is negative or not finite.
  DeviationTracker(const MeshView& original, const Bvh& bvh, double tolerance);
  DeviationTracker(DeviationTracker&&) noexcept;
  DeviationTracker& operator=(DeviationTracker&&) noexcept;
  ~DeviationTracker();

  /// Says that face `id` of the current mesh is original triangle `triangle`. Before the first change only.
  void start(std::uint32_t id, std::uint32_t triangle);
  /// Finds covers for the original triangles that no face was started from (duplicates, degenerate ones), among the
  /// faces that share vertices with them. Returns those that it found none for: start them too, or give up.
  [[nodiscard]] std::vector<std::uint32_t> cover_the_rest();

  /// Makes `faces` the current mesh, in place of whatever it was: one that approximates the original, made by anything,
  /// whose bound is proven here from nothing. Original triangles that the mesh leaves out can be given as faces too.
  /// Returns what could not be proven; unless that is empty, the tracker stays as it was. The same for any number of
  /// threads; 0: as many as OpenMP has. Throws `InvalidInput` when an id comes twice, and `Stopped` when `stop` ended
  /// the proof: the tracker is as it was then. Expected O(n log n).
  [[nodiscard]] Unproven start_from(std::span<const TrackedFace> faces, int threads = 0, const StopToken& stop = {});
  /// The proofs as they stand, to be taken over by another tracker. O(original triangles + faces).
  [[nodiscard]] TrackedProof proof() const;
  /// Takes over the proofs of a tracker of a part of this original, in place of `start`: triangle k there is
  /// `triangle_of[k]` here and face f there is `faces[f]` here, with `SurfaceChange::no_triangle` as id when it is not
  /// a current face any more. Before the first change only. Throws `InvalidInput` when the proofs are for a larger
  /// tolerance, or use a face that is not current. O(original triangles + faces of the part).
  void take_over(const TrackedProof& part, std::span<const std::uint32_t> triangle_of,
                 std::span<const TrackedFace> faces);

  /// Tolerances of single original triangles beside the one for all, infinity where there is none. From now on
  ///
  ///     every point of triangle k lies within tolerances[k] of the current mesh, and
  ///     every point of the current mesh lies within tolerances[g] of the original triangle g nearest to it.
  ///
  /// A change is tested with the smallest tolerance of the triangles around it, so a coarse region begins about a face
  /// away from a fine one. Call it before the first change. Throws `InvalidInput` for another number of triangles, a
  /// tolerance below 0 or not a number, and after `cover_the_rest` has used a larger tolerance. O(n log n).
  void limit_triangles(std::span<const double> tolerances);

  /// True when the bound is proven to survive the change. Nothing changes until `commit`.
  [[nodiscard]] bool admits(const SurfaceChange& change);
  /// True when the bound is proven to survive the removal of current faces without a substitute: what they stand for is
  /// within the tolerance of other faces. Those that held a part of the original at `begin_removals`, O(n log n), and
  /// still do are tried.
  void begin_removals();
  [[nodiscard]] bool admits_removal(std::span<const std::uint32_t> removed);
  /// Makes the change that the last call of `admits` admitted. Throws `Error` when there is none.
  void commit();

  /// For choosing among changes of the same faces, `removed`: `sample` takes points of the part of the original that
  /// they stand for, and what was admitted may no longer be committed. `moved_corner` has the place, 0 to 2, of the
  /// corner that is to be moved in each of `added`.
  void sample(std::span<const std::uint32_t> removed);
  [[nodiscard]] SampledDeviation sampled_deviation(std::span<const TrackedFace> added,
                                                   std::span<const std::size_t> moved_corner);

  /// For placing the moved vertex of such changes: `sample_heights` takes points as `sample` does, and `height_step`
  /// says where the vertex should go, as far as distances are linear. O(samples x faces) each.
  void sample_heights(std::span<const std::uint32_t> removed);
  [[nodiscard]] HeightStep height_step(std::span<const TrackedFace> added, std::span<const std::size_t> moved_corner);

  /// A larger tolerance keeps every proof made so far. Throws `InvalidInput` for a smaller one.
  void grow_tolerance(double tolerance);
  [[nodiscard]] double tolerance() const;

  [[nodiscard]] Refusal last_refusal() const;
  /// The original triangle that the last refusal could not cover, else `SurfaceChange::no_triangle`.
  [[nodiscard]] std::uint32_t last_uncovered() const;
  [[nodiscard]] const TrackerStats& stats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshbound
