// SPDX-License-Identifier: MIT
/// Certified Hausdorff distances between triangle soups, after Tang, Lee, Kim, "Interactive Hausdorff Distance
/// Computation for General Polygonal Models", ACM Trans. Graph. 28(3), 2009 ("the paper" below).
///
///     one-sided   h(A,B) = max over a in A of min over b in B of |a - b|
///     symmetric   H(A,B) = max(h(A,B), h(B,A))
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "meshbound/bounds.h"
#include "meshbound/bvh.h"
#include "meshbound/error.h"

namespace meshbound {

/// Limits after which a computation ends with what it has proven so far.
struct Budget {
  /// From the call on; an infinite number is no limit. `InvalidInput` for a negative number and one that is none.
  double seconds = std::numeric_limits<double>::infinity();
  /// Cuts of pieces in one direction.
  std::uint64_t subdivisions = std::numeric_limits<std::uint64_t>::max();
};

/// How the triangles of A that are not culled are covered. Both prove the same interval.
enum class Method {
  CellWalking,  ///< pieces are cut by the cells of B's triangles and walk from cell to cell
  CrossCulling  ///< the paper's own: culling on A and on B, Voronoi subdivision (sections 4 and 5)
};

/// What is asked of a measurement, and what it may cost.
struct DistanceOptions {
  Method method = Method::CellWalking;  ///< how triangles are covered
  /// Wanted width of the interval, model units. Absent: `default_error_bound`.
  std::optional<double> error_bound;
  /// When given, the upper bound is also refined until it is at most this wherever the truth allows it.
  std::optional<double> tolerance;
  Budget budget;                              ///< of the whole call
  int threads = 0;                            ///< 0: as many as OpenMP has. Results are the same for every value.
  const std::atomic<bool>* cancel = nullptr;  ///< set to true from another thread or a signal handler to stop early
  /// Called from the calling thread with an estimate of the share done, which may fall from one direction to the other
  /// and need not reach 1; ten times a second at most, and once a tile where a function works in tiles. May call the
  /// library, for the same models too; what it throws ends this call and is passed on.
  std::function<void(double fraction)> progress;
};

/// The width of an interval that is asked for where no other is given, model units: 1e-6 of the bounding-box diagonal
/// of A, the original; of both models together where A is a single point. O(1), or O(n) where A is a point.
[[nodiscard]] double default_error_bound(const PlacedModel& a, const PlacedModel& b);
/// The default width for meshes without trees; `diagonal` is that of A (`bounding_box_diagonal`). Indices must be in
/// range, as `validate` checks.
[[nodiscard]] double default_error_bound(const MeshView& a, const MeshView& b, double diagonal);

/// How a computation ended.
enum class Outcome {
  /// upper - lower <= error bound (and the tolerance, if any, is decided); also of a direction that was not searched,
  /// whose bounds are 0 and infinity (`was_searched` in report.h).
  Converged,
  ExceedsTolerance,  ///< decision mode: a point further than the tolerance was found and the search ended there
  BudgetExhausted,   ///< a budget ran out or it was cancelled; the bounds hold but are wider than wanted
  PrecisionReached   ///< doubles cannot narrow the interval further; the bounds hold
};

/// Time of each phase, as in Fig. 9 of the paper.
struct PhaseSeconds {
  double matching = 0;      ///< finding triangles that both models have
  double culling_on_a = 0;  ///< nodes of A, and a first lower bound
  double culling_on_b = 0;  ///< closest triangles of B and the bounds they give
  double subdivision = 0;   ///< what is left, cut into pieces
};

/// What the search did. Percentages as in Table 2 of the paper.
struct DistanceStats {
  std::uint64_t triangles = 0;              ///< of the model that is searched ("A" of the one-sided distance)
  std::uint64_t matched = 0;                ///< dropped because the other model has the identical triangle
  std::uint64_t proven_before = 0;          ///< dropped by what `LevelChecker` or `MovingPair` had proven before
  std::uint64_t culled_by_node = 0;         ///< dropped with a whole tree node (paper, Alg. 1)
  std::uint64_t culled_by_vertices = 0;     ///< dropped by the closest triangles of their vertices (paper, Eq. 5)
  std::uint64_t walked = 0;                 ///< needed the walk over the cells of the other model
  std::uint64_t closest_point_queries = 0;  ///< traversals of the other model's tree
  std::uint64_t nodes_visited = 0;          ///< tree nodes opened by those queries
  std::uint64_t triangles_tested = 0;       ///< point-triangle distances evaluated by those queries
  std::uint64_t subdivisions = 0;           ///< cuts of a piece into two (cell walking) or four (cross-culling)
  std::uint32_t deepest_subdivision = 0;    ///< cuts behind any piece
  std::uint64_t pieces = 0;                 ///< bounded on the walk, whole triangles included
  std::uint64_t resolved = 0;               ///< pieces inside a cell but nearer to another triangle at a corner
  std::uint64_t enclosed = 0;               ///< pieces that a translation takes through a closed B (paper, Lemma 4)
  std::uint64_t given_up = 0;      ///< pieces left as they stood: beyond the precision of doubles, or of the budget
  double culled_on_a_percent = 0;  ///< triangles of A never subdivided
  double culled_on_b_percent = 0;  ///< mean share of B's triangles that a query did not touch
  double seconds = 0;              ///< from the call on
  PhaseSeconds phases;             ///< parts of `seconds`
};

/// h(A, B): how far A is from B.
struct OneSidedDistance {
  Bounds bounds;                         ///< model units, world coordinates
  Witness witness;                       ///< realises `bounds.lower` up to rounding
  Outcome outcome = Outcome::Converged;  ///< how the search ended
  DistanceStats stats;                   ///< what it did
};

/// H(A, B), and both directions. The direction searched second (from B, unless a few points show that B is clearly
/// further from A) is refined only as far as the lower bound of the first one leaves the maximum open (paper, section
/// 6): for it, `Converged` means that its upper bound is within the error bound of the larger of both lower bounds.
struct HausdorffDistance {
  Bounds bounds;            ///< the maximum of both directions, model units
  OneSidedDistance a_to_b;  ///< h(A, B)
  OneSidedDistance b_to_a;  ///< h(B, A)
};

/// Whether a distance is at most a tolerance.
struct ToleranceCheck {
  Verdict verdict = Verdict::Undecided;  ///< of `bounds`
  double tolerance = 0;                  ///< model units
  Bounds bounds;                         ///< as far as they had to be narrowed, model units
  OneSidedDistance a_to_b;               ///< searched first
  OneSidedDistance b_to_a;               ///< not searched (bounds [0, inf]) when a_to_b already exceeds
};

/// Measures h(A, B) to an interval of at most the error bound, where the budget and the precision of doubles allow it
/// (`Outcome`). Positions and lengths are in world coordinates, that is model units under the poses. Deterministic for
/// any number of threads, but for a budget of time and `cancel`. Throws `InvalidInput` for an error bound or tolerance
/// that is negative or not a number, and for a pose that is not a rigid motion. Any number of threads may call it, also
/// with the same trees. Time: about O((n_A + n_B) log n_B) where the surfaces are close or far apart for their size; it
/// grows with 1 / error bound where A runs along points that are equally far from several triangles of B. Source: the
/// paper, with the cell walk of src/distance/kernel/cell_walker.h instead of its subdivision.
[[nodiscard]] OneSidedDistance one_sided_hausdorff_distance(const PlacedModel& a, const PlacedModel& b,
                                                            const DistanceOptions& options = {});

/// Measures H(A, B): both directions, of which the second is narrowed only as far as it may be the larger one (paper,
/// section 6). Guarantees, errors, complexity and threads as above.
[[nodiscard]] HausdorffDistance hausdorff_distance(const PlacedModel& a, const PlacedModel& b,
                                                   const DistanceOptions& options = {});

/// H(A, B) where it needs no tree: for meshes of the same triangles (`same_surface`), at distance 0; and meshes whose
/// triangles correspond in order, with corners at most `limit` apart (a copy rounded to float, a mesh that has moved a
/// little), whatever the numbers of vertices and the turns of triangles. Absent where neither holds, which mostly takes
/// no longer than a look. The upper bound is at most `limit`, model units; statistics are of what was looked at. Throws
/// `InvalidInput` for a limit that is negative or not a number, and as `Bvh`, except that it does not look at meshes of
/// different numbers of triangles. O(n). Any number of threads may call it.
[[nodiscard]] std::optional<HausdorffDistance> distance_without_trees(const MeshView& a, const MeshView& b,
                                                                      double limit);

/// Measures H(A, B) for two meshes where they are: builds their trees only where `distance_without_trees` does not tell
/// the distance to the error bound (and the tolerance, if any). Throws as `Bvh` and as above. O(n log n) for the
/// trees. Any number of threads may call it.
[[nodiscard]] HausdorffDistance hausdorff_distance(const MeshView& a, const MeshView& b,
                                                   const DistanceOptions& options = {});

/// Measures h(A, B) for two meshes where they are, as the function above measures H(A, B).
[[nodiscard]] OneSidedDistance one_sided_hausdorff_distance(const MeshView& a, const MeshView& b,
                                                            const DistanceOptions& options = {});

/// Whether two meshes have the same triangles, bit for bit, however they number, order and turn them; -0 and 0 are one
/// coordinate. Not where they have different numbers of triangles, even if only by repetition. Throws as `Bvh`. O(n),
/// and hardly more than a look where the meshes differ in size.
[[nodiscard]] bool same_surface(const MeshView& a, const MeshView& b);

/// Decides H(A, B) <= tolerance (model units): stops at the first point known to be further, refines nothing below it.
/// `options.error_bound` and `options.tolerance` are not looked at. Errors and threads as `hausdorff_distance`; faster
/// than it wherever the distance is not next to the tolerance.
[[nodiscard]] ToleranceCheck check_tolerance(const PlacedModel& a, const PlacedModel& b, double tolerance,
                                             const DistanceOptions& options = {});

/// Decides H(A, B) <= tolerance for two meshes where they are; trees are built only where `distance_without_trees` does
/// not tell. Throws as `Bvh` too.
[[nodiscard]] ToleranceCheck check_tolerance(const MeshView& a, const MeshView& b, double tolerance,
                                             const DistanceOptions& options = {});

/// Decides h(A, B) <= tolerance as `check_tolerance` decides H; `b_to_a` of the result is empty.
[[nodiscard]] ToleranceCheck check_one_sided_tolerance(const PlacedModel& a, const PlacedModel& b, double tolerance,
                                                       const DistanceOptions& options = {});
[[nodiscard]] ToleranceCheck check_one_sided_tolerance(const MeshView& a, const MeshView& b, double tolerance,
                                                       const DistanceOptions& options = {});

}  // namespace meshbound
