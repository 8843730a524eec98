// SPDX-License-Identifier: MIT
/// Proposals: collapses, moves and flips that samples of the original find near enough. They prove nothing.
#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "simplify/decimation_state.h"
#include "simplify/kernel/kernels.h"
#include "simplify/mesh/normal_guard.h"
#include "simplify/normals/turn_guard.h"
#include "simplify/regions.h"
#include "simplify/star_samples.h"
#include "simplify/texture/texture_guard.h"

namespace meshbound {

/// The faces around an edge, or around a vertex.
struct EdgeStar {
  std::uint32_t kept = 0, gone = 0;
  Corner edge = 0;
  std::vector<Corner> moved;           ///< of faces that stay: the corner that moves
  std::vector<std::uint32_t> removed;  ///< faces that go

  /// False if the collapse would not leave a manifold, or if there are too many faces around it.
  [[nodiscard]] bool gather(const ArrayMesh& mesh, Corner edge);

 private:
  std::vector<std::uint32_t> around_kept_, around_gone_;  ///< vertices
};

/// Points on an edge that are compared with the original.
struct PointsOnEdge {
  double spacing;  ///< smallest distance between them, in tolerances
  double max;      ///< most points between the ends
};

/// Makes a collapse that has been noted.
void apply_collapse(DecimationState& state, Region& region, const EdgeStar& star, Vec3 point);

/// What the quadrics of its ends say of a collapse.
struct EdgeCost {
  float cost = 0;
  /// Where they, or lines, refuse it without a look at samples: the deviation to be noted, see `Proposer::deviation`.
  std::optional<float> refused_with;
};
/// `share` as for `Proposer::placement`.
[[nodiscard]] EdgeCost edge_cost(const DecimationState& state, Corner edge, double share);

/// Whether the planes in the quadrics of an edge refuse it without a look at samples.
[[nodiscard]] bool is_refused_by_planes(const DecimationState& state, Corner edge);

/// Tries changes against the samples around them, and makes them. One for each thread.
class Proposer {
 public:
  explicit Proposer(DecimationState& state);

  /// Where the collapse of an edge puts its vertex so that all samples around are within `share` of the tolerance: at
  /// `wanted`, or where its cost is least, or where the largest distance is smallest. Absent if no such point is found.
  [[nodiscard]] std::optional<Vec3> placement(Corner edge, double share, std::optional<Vec3> wanted);
  /// What a placement is compared with the original by.
  enum class Looks {
    AtSamples,  ///< alone, but for borders: enough for cheap collapses, which are proven together
    Around      ///< and at the vertex and its edges
  };
  /// Selects the region in which changes are made. Both must outlive them.
  void enter(const Split& split, const Region& region, Looks looks = Looks::Around);
  /// Whether all vertices around an edge belong to the region. An edge with too many faces around it may count as
  /// outside: it can not be collapsed either.
  [[nodiscard]] bool is_inside(Corner edge) const;
  /// Whether the last edge was refused for a distance from the original, not because it would fold a face where its
  /// vertex was to go.
  [[nodiscard]] bool refused_for_distance() { return refused_for_distance_ && set_faces(tried_); }
  [[nodiscard]] Vec3 refused_placement() const { return tried_; }
  /// How far samples, in space or of the texture, were from the best placement of the edge refused last, or how much
  /// they turned there, in tolerances; 0 where that is not known. An edge that was not refused for a distance waits for
  /// a change around it.
  [[nodiscard]] float deviation() const;
  /// Another placement for the edge asked for last, as the proof of the collapse to `refuted` has found that it leaves
  /// this point of the original too far from the faces. Absent where there is no such point or no such placement, or
  /// where enough have been refuted.
  [[nodiscard]] std::optional<Vec3> next_placement(const std::optional<Vec3>& lost_point, Vec3 refuted);
  /// Makes the collapse found last.
  void collapse(Region& region, Vec3 point);
  /// Once this collapse is final: gives the samples to the faces that it leaves, and opens the edges around it again.
  void make_final(Region& region);
  [[nodiscard]] const EdgeStar& star() const { return star_; }
  /// The faces that the last collapse has altered or removed.
  [[nodiscard]] std::span<const std::uint32_t> changed_faces() const { return taken_; }
  /// Whether a long edge of a face of the mesh is seen to be too far from the original: where collapses are proven
  /// together, only its middle was looked at. To be asked where no thread changes the mesh.
  [[nodiscard]] bool has_stray_edge(std::uint32_t face);

  struct Counts {
    std::uint64_t tried = 0, refused = 0;
  } counts;

 private:
  void gather_samples();
  /// A point of an edge of the new vertex, (1 - share) vertex + share end: the vertex itself where the share is 0.
  struct Stray {
    Vec3 end;
    double share;
  };
  /// Where the vertex of a collapse may stand.
  struct AllowedEnds {
    bool start = false, end = false, elsewhere = false;
  };
  [[nodiscard]] AllowedEnds allowed_ends(Corner edge) const;
  [[nodiscard]] std::optional<Vec3> placement_at_end(const AllowedEnds& ends);
  [[nodiscard]] double limit_around() const;
  [[nodiscard]] bool owns(std::uint32_t face) const;
  [[nodiscard]] bool set_faces(Vec3 point);
  void begin_star(double share);
  void take_few();
  void add_stray(const Stray& stray, Vec3 point);
  [[nodiscard]] bool fits(Vec3 point);
  [[nodiscard]] bool keeps_normals(Vec3 point);
  [[nodiscard]] bool keeps_normals_around();
  [[nodiscard]] bool keeps_texture(Vec3 point);
  bool refuse(std::optional<float>& least, float deviation);
  bool is_too_far();
  /// Whether the texture has moved so far at a placement that no other one of the edge is worth a look: two in a
  /// thousand of those looked at would hold.
  [[nodiscard]] bool is_texture_far() const { return texture_deviation_ && is_far_beyond(*texture_deviation_); }
  void find_borders();
  [[nodiscard]] bool looks_around() const { return looks_ == Looks::Around || !borders_.empty(); }
  [[nodiscard]] bool is_vertex_near(Vec3 point);
  void look_along(Vec3 point, Vec3 end, const PointsOnEdge& points);
  [[nodiscard]] bool are_edges_near(Vec3 point);
  [[nodiscard]] std::optional<Vec3> minimax(Vec3 point);

  DecimationState& state_;
  const Split* split_ = nullptr;  ///< of the last edge
  std::uint32_t region_ = 0;
  Looks looks_ = Looks::Around;
  StarSamples samples_;
  std::optional<TextureGuard> texture_;
  std::optional<TurnGuard> turns_;
  SampleKernel sample_kernel_ = simplify_kernels().samples;
  DeviationKernel deviation_kernel_ = simplify_kernels().deviations;
  EdgeStar star_;
  std::vector<GuardedFace> before_;    ///< the faces that move
  double limit_ = 0, full_limit_ = 0;  ///< what samples may reach, and all of the tolerance
  bool is_together_ = false;           ///< proofs are still to come
  bool moves_ = false;                 ///< the vertex may stand anywhere
  int proofs_failed_ = 0;              ///< of collapses of this edge
  bool gathered_ = false;              ///< samples of the star are in `samples_`
  bool texture_gathered_ = false;      ///< those of the texture are in `texture_`
  bool turns_gathered_ = false;        ///< those of normals are in `turns_`
  std::optional<Vec3> placed_;         ///< where the vertex is in `faces_`
  std::vector<Stray> found_;           ///< points too far from the original that `fits` found last
  std::vector<Stray> strays_;          ///< those that the placement must bring near it
  float deviation_ = 0;
  /// The least of refused placements of the edge, in tolerances of texture and normals.
  std::optional<float> texture_deviation_, turn_deviation_;
  bool refused_for_distance_ = false;  ///< some placement, or the edge, was: more of the tolerance may help
  Vec3 tried_;                         ///< the first placement
  Vec3 origin_;
  std::vector<Vec3> borders_;  ///< other ends of border edges
  SamplePoints few_;
  std::vector<SampleOffsets> few_offsets_;
  std::vector<SampleFace> faces_;       ///< that stay, as they would be
  std::vector<std::uint32_t> numbers_;  ///< numbers of `faces_` in the mesh
  std::vector<std::uint32_t> taken_;    ///< all faces of the star
  std::vector<std::uint32_t> beside_;   ///< faces around the star, of the same region
  LinearDeviations deviations_;
};

}  // namespace meshbound
