// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "texture/charts.h"

namespace meshbound {

/// Searches for the proof that a triangle's texture moves at most a tolerance: a tree of cuts by lines of constant
/// weight, whose leaves name triangles of the other mesh. What these cover of a leaf is within the tolerance, and what
/// they do not cover of it no triangle of the other mesh covers (tools/schema/certificate-3.md).
class TextureSearch {
 public:
  /// `target` must outlive this. `tolerance` in model units.
  TextureSearch(const Charts& target, const ExactUnits& units, double tolerance)
      : target_(target), tolerance_(tolerance), overlay_(units) {}

  /// A node of a tree in preorder: an inner one, or a leaf with these triangles by their index in the target's mesh.
  struct Node {
    bool is_cut = false;
    std::vector<std::uint32_t> triangles;
  };

  /// Appends the tree of a triangle of the other mesh to `nodes`. False if there is none within the limits of the
  /// format; `nodes` are then incomplete.
  [[nodiscard]] bool prove(const ChartTriangle& source, std::vector<Node>& nodes);

 private:
  /// The weights of corner k that a piece has: from low[k] / 2^40 to (low[k] + size[k]) / 2^40.
  struct Range {
    std::array<std::int64_t, 3> low, size;
  };

  /// `near`: numbers of near candidates that may cover a part of the piece.
  [[nodiscard]] bool prove(const Overlay::Polygon& piece, const Range& range, int depth,
                           std::vector<std::uint32_t> near, std::vector<Node>& nodes);
  [[nodiscard]] bool prove_leaf(const Overlay::Polygon& piece, const std::vector<std::uint32_t>& near,
                                std::vector<std::uint32_t>& chosen);
  [[nodiscard]] bool take(const Overlay::Polygon& piece, const std::vector<std::uint32_t>& candidates,
                          std::vector<Overlay::Polygon>& rest, std::vector<std::uint32_t>& chosen);
  [[nodiscard]] bool is_covered_in_part(const Overlay::Polygon& polygon);
  [[nodiscard]] bool is_untouched(const Overlay::Polygon& piece);
  [[nodiscard]] bool is_near_at_corners(const Overlay::Polygon& piece);
  [[nodiscard]] bool is_near(const Overlay::Node& point, std::uint32_t candidate);
  void add(const std::vector<const ChartTriangle*>& triangles);
  void add_others();
  [[nodiscard]] double reach() const;
  [[nodiscard]] bool cell_is_near(const Overlay::Polygon& cell, std::uint32_t candidate);
  [[nodiscard]] bool clip(Overlay::Polygon& polygon, Overlay::Line line, bool flip);
  [[nodiscard]] bool clip(Overlay::Polygon& polygon, std::uint32_t candidate);
  [[nodiscard]] bool subtract(std::vector<Overlay::Polygon>& rest, std::uint32_t candidate);

  const Charts& target_;
  double tolerance_;
  Overlay overlay_;
  ChartCandidates found_;
  bool has_others_ = false;            ///< all of `found_` are candidates of the overlay, not only the near ones
  std::vector<std::uint32_t> others_;  ///< candidates that are not near ones
  std::vector<std::uint8_t> is_far_;   ///< by candidate: no point of it is within the tolerance of the source
  bool is_hopeless_ = false;           ///< a point of the source was found that no candidate is near
  std::size_t first_node_ = 0;         ///< of the tree at hand
  std::size_t max_chosen_ = 0;         ///< triangles that the leaf at hand may name
  Overlay::Polygon clipped_;
};

}  // namespace meshbound
