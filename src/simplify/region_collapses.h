// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "simplify/change_prover.h"
#include "simplify/mesh/edge_queue.h"
#include "simplify/propose.h"
#include "simplify/prove.h"

namespace meshbound {

/// The collapses of one region of a mesh, which a driver asks for and commits. Each is near enough by the samples
/// around it, and proven before the next where there is a prover.
class RegionCollapses {
 public:
  struct Limits {
    double share = 1;                                    ///< share of the tolerance that samples may reach
    std::function<bool(std::size_t removed)> must_stop;  ///< asked with the number of faces gone from the region
    /// Asked when a collapse would break the bound, as far as samples or the proof tell; true ends the collapses.
    /// Empty: they continue.
    std::function<bool()> ends_at_refusal;
    /// `collapse_all` leaves edges that cost more as they are, and looks at the samples alone.
    float max_cost = HUGE_VALF;
    std::function<void(std::uint32_t kept)> made = {};  ///< told of each collapse: the vertex that it has kept
  };

  /// All must outlive this. `prover` may be null.
  RegionCollapses(DecimationState& state, const Split& split, Region& region, Proposer& proposer, ChangeProver* prover,
                  Limits limits);

  [[nodiscard]] const ArrayMesh& mesh() const { return state_.mesh; }
  [[nodiscard]] const DecimationState& state() const { return state_; }
  [[nodiscard]] bool owns_vertex(std::uint32_t vertex) const;
  /// Whether all corners of the face belong to the region.
  [[nodiscard]] bool owns_face(std::uint32_t face) const;
  /// Whether both ends of the edge belong to the region, and it was not refused as it is now.
  [[nodiscard]] bool is_open(Corner edge) const;
  /// Calls `visit(edge)` for each edge that begins in the region.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    if (split_.region_of.empty()) {
      for (Corner c = 0; c < 3 * mesh().face_count(); ++c)
        if (!mesh().is_removed(c / 3) && mesh().edge(c) == c) visit(c);
      return;
    }
    for (const std::uint32_t v : region_.vertices) {
      mesh().for_each_corner(v, [&](Corner c) {
        if (mesh().edge(c) == c) visit(c);
        return true;
      });
    }
  }
  /// The edges that begin in the region, and those of them that were open at the start.
  [[nodiscard]] std::size_t edge_count() const { return edge_count_; }
  [[nodiscard]] const std::vector<Corner>& open_edges() const { return open_edges_; }
  [[nodiscard]] bool must_stop() const { return ended_ || limits_.must_stop(region_.removed_faces); }

  /// Whether planes or lines refuse the edge whatever samples say; it is refused then. Never where a refusal ends the
  /// collapses.
  bool refuses_unseen(Corner edge);
  /// Collapses the edge, to `wanted` where there is one and that is near enough, else to where it costs least or the
  /// largest distance is least. False: it is refused, and the mesh is as it was.
  bool collapse(Corner edge, std::optional<Vec3> wanted = std::nullopt);
  /// The vertex that the last collapse left.
  [[nodiscard]] std::uint32_t kept() const { return proposer_.star().kept; }

  /// Collapses all open edges by cost, until nothing fits.
  void collapse_all();

 private:
  [[nodiscard]] bool is_owned(Corner edge) const;
  [[nodiscard]] bool shares_covers(Corner edge) const;
  [[nodiscard]] bool make(Vec3 point);
  void note_edges_that_go();
  bool refuses(Corner edge, const EdgeCost& cost);
  [[nodiscard]] bool is_refused_by(const EdgeCost& cost) const;
  void put(EdgeQueue& queue, Corner edge);

  DecimationState& state_;
  const Split& split_;
  Region& region_;
  Proposer& proposer_;
  ChangeProver* prover_;
  Limits limits_;
  bool ended_ = false;
  std::size_t edge_count_ = 0;
  std::vector<Corner> open_edges_;
  std::vector<Corner> edges_gone_;  ///< those of the faces that the last collapse removed
};

}  // namespace meshbound
