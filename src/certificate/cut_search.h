// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bvh/nearest.h"
#include "certificate/chord_cut.h"
#include "certificate/parity_search.h"
#include "certificate/proof_node.h"
#include "geometry/triangle_corners.h"
#include "proof/goal.h"
#include "proof/piece.h"

namespace meshbound {

/// Finds the cuts after which each piece of a triangle is near one triangle of B, and writes them down: the walk over
/// the cells of B (distance/kernel/cell_walker.h), with cuts that few bytes describe. Not thread-safe.
class CutSearch {
 public:
  /// `goal` gives the tolerance and the slacks, in B's working frame, `magnitude` bounds all coordinates there.
  /// `neighbours`: `edge_neighbours` of `target`. A parity patch has at most `max_patch` triangles. `target` and
  /// `neighbours` must outlive this.
  CutSearch(const Bvh::Data& target, const std::vector<std::array<std::uint32_t, 3>>& neighbours, const Goal& goal,
            double magnitude, std::size_t max_patch);

  enum class Outcome {
    Proven,
    TooFar,  ///< a point is further than the tolerance, but for the slack
    GaveUp   ///< not within the depth of the format or `max_steps`
  };

  /// Appends the tree for a triangle given in B's working frame; on failure leaves `nodes` as they were. Starts with
  /// the triangle of B at `hint`, and leaves there the one that served last. Throws `Stopped` soon after the token of
  /// the goal says so; `nodes` are of no use then.
  [[nodiscard]] Outcome prove(const TriangleCorners& triangle, std::uint32_t& hint, std::vector<ProofNode>& nodes,
                              std::uint64_t max_steps);

  /// `ParitySearch::work` of all triangles so far.
  [[nodiscard]] std::uint64_t parity_work() const { return parity_.work(); }

  /// The triangle of B nearest to the middle of the triangle that `prove` was called for last.
  [[nodiscard]] std::uint32_t nearest_to_middle() const { return nearest_to_middle_; }

 private:
  /// A strip cut off along a side of a piece.
  struct Trim {
    ChordCut cut;
    bool rest_is_first = false;
    [[nodiscard]] const Piece& rest() const { return rest_is_first ? cut.first : cut.second; }
    [[nodiscard]] const Piece& strip() const { return rest_is_first ? cut.second : cut.first; }
  };
  struct Walked {
    bool moved = false;  ///< the piece lies in the cell of a neighbour, which is its candidate now
    bool cut = false;
    bool covered = false;  ///< after a cut: both parts were covered
  };
  [[nodiscard]] CornerTriangle<double> triangle_at(std::uint32_t slot) const {
    return meshbound::triangle_at(b_, slot);
  }
  [[nodiscard]] bool try_near(const Piece& piece, std::uint32_t slot);
  [[nodiscard]] bool try_candidates(const Piece& piece);
  [[nodiscard]] bool try_parity(const Piece& piece);
  [[nodiscard]] bool cover_interior_by_parity(const Piece& piece);
  [[nodiscard]] bool try_trimmed(const Piece& piece, unsigned sides, double width);
  [[nodiscard]] bool emit_trimmed(const std::vector<Trim>& trims, std::size_t from, std::uint32_t seed);
  [[nodiscard]] bool halve_by_parity(const Piece& piece);
  [[nodiscard]] bool cover_part(Piece part);
  [[nodiscard]] bool cover(Piece piece);
  [[nodiscard]] bool cover_parts(const ChordCut& cut);
  [[nodiscard]] bool ask_near_worst(Piece& piece, std::uint32_t worst);
  [[nodiscard]] Walked walk(Piece& piece);
  [[nodiscard]] bool resolve(const Piece& piece, std::uint32_t worst);
  [[nodiscard]] bool halve(const Piece& piece);
  [[nodiscard]] std::optional<ChordCut> halves_of(const Piece& piece) const;
  [[nodiscard]] Nearest nearest(const Vec3& p, const Piece& piece, std::uint32_t hint);
  [[nodiscard]] double max_shift(const Piece& piece) const;
  void emit_cut(const Chord& chord);
  void emit(std::uint32_t slot, ProofNode::Kind kind = ProofNode::Kind::Near);

  const Bvh::Data& b_;
  StopToken stop_;
  double tolerance_ = 0;
  /// By the cuts behind a piece: squared distances that prove as computed; negative where none does.
  std::array<double, deepest_cut + 1> accepted_squared_{};
  ParitySearch parity_;
  QueryCounters counters_;
  std::vector<ProofNode>* nodes_ = nullptr;
  TriangleCorners triangle_;
  std::uint64_t steps_left_ = 0;
  std::uint32_t last_ = 0;
  std::uint32_t nearest_to_middle_ = 0;
  bool too_far_ = false;
};

}  // namespace meshbound
