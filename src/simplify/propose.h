// SPDX-License-Identifier: MIT
/// Proposals: collapses, moves and flips that samples of the original find near enough. They prove nothing.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "simplify/decimation_state.h"
#include "simplify/edge_queue.h"
#include "simplify/linear_heights.h"
#include "simplify/normal_guard.h"
#include "simplify/prove.h"
#include "simplify/star_samples.h"

namespace meshbound {

/// The faces around an edge, or around a vertex.
struct EdgeStar {
  static constexpr std::size_t max_faces = 48;

  std::uint32_t kept = 0, gone = 0;
  Corner edge = 0;
  std::vector<Corner> moved;           ///< of faces that stay: the corner that moves
  std::vector<std::uint32_t> removed;  ///< faces that go

  /// False where the collapse would not leave a manifold, or where there are too many faces.
  [[nodiscard]] bool gather(const ArrayMesh& mesh, Corner edge);

 private:
  std::vector<std::uint32_t> around_kept_, around_gone_;  ///< vertices
};

/// Makes a collapse that has been noted.
void apply_collapse(DecimationState& state, Region& region, const EdgeStar& star, Vec3 point);

/// What a collapse costs by the quadrics of its ends.
[[nodiscard]] float edge_cost(const DecimationState& state, Corner edge);

/// Tries changes against the samples around them, and makes them. One for each thread.
class Proposer {
 public:
  explicit Proposer(DecimationState& state);

  /// Where the collapse of an edge puts its vertex so that all samples around are within `share` of the tolerance:
  /// where its cost is least, or where the largest distance is. None where no such place is found.
  [[nodiscard]] std::optional<Vec3> placement(const Split& split, const Region& region, Corner edge, double share);
  /// Whether all vertices around an edge belong to the region.
  [[nodiscard]] bool is_inside(const Split& split, const Region& region, Corner edge) const;
  /// Another place for the edge that was asked for last, where the largest distance is smaller: for one that could not
  /// be proven.
  [[nodiscard]] std::optional<Vec3> lower_placement(Vec3 than);
  /// Makes the collapse that was found last, and then, where it is to stay, gives the samples to the faces that are
  /// left.
  void collapse(Region& region, Vec3 point);
  void settle(Region& region);
  [[nodiscard]] const EdgeStar& star() const { return star_; }

  struct Counts {
    std::uint64_t tried = 0, by_topology = 0, by_cost = 0, by_minimax = 0, hopeless = 0, near_misses = 0, folded = 0,
                  stray = 0;
  } counts;

 private:
  void gather_samples();
  [[nodiscard]] bool is_locked(std::uint32_t v) const { return state_.locked[v] != 0; }
  [[nodiscard]] bool owns(std::uint32_t face) const;
  [[nodiscard]] bool set_faces(Vec3 point);
  [[nodiscard]] bool fits(Vec3 point, double limit);
  [[nodiscard]] std::optional<Vec3> minimax(Vec3 point, double limit);

  DecimationState& state_;
  const Split* split_ = nullptr;  ///< of the last edge
  std::uint32_t region_ = 0;
  StarSamples samples_;
  HeightKernel height_kernel_ = fastest_height_kernel();
  EdgeStar star_;
  std::vector<GuardedFace> before_;  ///< the faces that move
  double limit_ = 0;
  bool lowered_ = false;   ///< the last place is one where the largest distance is least
  bool gathered_ = false;  ///< the samples
  bool hopeless_ = false;  ///< no place comes near
  Vec3 origin_;
  SamplePoints few_;
  std::vector<SampleFace> faces_;       ///< that stay, as they would be
  std::vector<std::uint32_t> taken_;    ///< all faces of the star
  std::vector<std::uint32_t> numbers_;  ///< of these in the mesh
  std::vector<std::uint32_t> beside_;   ///< faces around the star, of the same region
  LinearHeights heights_;
};

/// Collapses edges of a region by cost until `stop`, told how many faces have gone, says so, or nothing fits `share` of
/// the tolerance. Each is proven at once where there is a prover.
void propose(DecimationState& state, const Split& split, Region& region, Proposer& proposer, double share,
             ChangeProver* prover, const std::function<bool(std::size_t removed)>& stop);

}  // namespace meshbound
