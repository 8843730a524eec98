// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "texture/overlay.h"

namespace meshbound {

/// Whether candidates of an overlay together cover all of its triangle A in the texture, by the edges where one follows
/// another.
///
/// Each candidate covers what lies to the left of its edges, once its corners go round counter-clockwise. How many
/// candidates cover a point changes only across their edges. If inside A, for each segment that edges run along, as
/// many run one way as the other, the number is the same all over A but on the edges; so where one point of A is inside
/// a candidate, every point is in at least one of them, as they are closed. Edges count as the same where the doubles
/// of their ends are, so nothing is rounded. Not thread-safe: each thread has its own.
class Covering {
 public:
  /// True only if the candidates cover all of A; false also where that cannot be decided. The triangle and all
  /// candidates must have an area in the texture. Expected O(candidates log candidates).
  [[nodiscard]] bool is_complete(Overlay& overlay, std::span<const std::uint32_t> candidates);

 private:
  struct Edge {
    const Eigen::Vector2d *from, *to;  ///< `from` comes first by its coordinates
    int direction;                     ///< 1: it is run from `from` to `to`; -1: back
  };
  void add_edges(Overlay& overlay, std::uint32_t candidate);
  [[nodiscard]] bool do_edges_cancel();

  std::vector<Edge> edges_;
};

}  // namespace meshbound
