// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "texture/overlay.h"

namespace meshbound {

/// What candidates of an overlay leave uncovered of its triangle A in the texture, by the edges where one follows
/// another.
///
/// Each candidate covers what lies to the left of its edges, once its corners go round counter-clockwise. How many
/// candidates cover a point changes only across their edges, and not across a segment that as many edges run along one
/// way as the other. A piece of A that none of the other segments, the *open* edges, runs through the inside of is
/// therefore covered by one number of candidates all over, but on edges; so where one point of it is inside a
/// candidate, every point is in at least one of them, as they are closed, and where one point is outside all of them,
/// no candidate covers any area of it. Edges count as the same where the doubles of their ends are, and sides are
/// exact. The triangle and all candidates must have an area in the texture. Not thread-safe: each thread has its own.
class Covering {
 public:
  using Candidates = std::span<const std::uint32_t>;

  /// Convex pieces of A, without common area: all that the candidates leave uncovered but lines and points. Absent
  /// where that cannot be decided. Expected O(candidates (open edges + log candidates)).
  [[nodiscard]] std::optional<std::vector<Overlay::Polygon>> uncovered(Overlay& overlay, Candidates candidates);

 private:
  struct Edge {
    const Eigen::Vector2d *from, *to;  ///< `from` comes first by its coordinates
    int direction;                     ///< 1: it is run from `from` to `to`; -1: back
    std::uint32_t candidate, number;   ///< its candidate, and its number there
  };
  void find_open_edges(Overlay& overlay, Candidates candidates);
  [[nodiscard]] bool cancels(const Overlay& overlay, const ChartTriangle* across) const;
  void add_edges(Overlay& overlay, std::uint32_t candidate);
  void drop_edges_that_cancel();
  void cut(Overlay& overlay, const Edge& edge);

  std::vector<std::uint8_t> is_counted_;  ///< by candidate of the overlay
  std::vector<Edge> edges_;
  std::vector<Overlay::Polygon> pieces_, halves_;
};

}  // namespace meshbound
