// SPDX-License-Identifier: MIT
#include "simplify/cover/slab_proof.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "numeric/no_index.h"

namespace meshbound {
namespace {

SlabView slabs_seen_from(const ParityView& from) {
  const FaceView& view = from.view;
  SlabView slabs;
  slabs.middle = view.origin + from.centre_x * view.x_axis + from.centre_y * view.y_axis;
  slabs.up = view.z_axis;
  const Projected middle{from.centre_x, from.centre_y, 0};
  for (std::size_t side = 0; side < 3; ++side) {
    slabs.side[side] = from.window.side_x[side] * view.x_axis + from.window.side_y[side] * view.y_axis;
    slabs.side_offset[side] = -from.window.outside(side, middle);
  }
  slabs.height_limit = from.height_limit;
  slabs.rim = from.rim;
  return slabs;
}

}  // namespace

/// P, as far as it has to be looked at.
class SlabProof::Patch {
 public:
  Patch(const ParityView& view, const OriginalSoup& soup, const OriginalClusters& clusters)
      : view_(view), clusters_(clusters), sight_{view, soup} {}

  /// Adds the originals of a cluster that belong to P. False where one refutes the proof. In a cluster that is closed,
  /// all edges have a neighbour.
  [[nodiscard]] bool add_cluster(std::uint32_t cluster, bool is_closed) {
    look_at_vertices(clusters_.vertices(cluster));
    std::uint32_t t = cluster * OriginalClusters::size;
    for (const auto& [a, b, c] : clusters_.triangles(cluster)) {
      const unsigned all = seen_[a] & seen_[b] & seen_[c], any = seen_[a] | seen_[b] | seen_[c];
      const bool is_outside = (all & (beyond_side | above | below)) != 0;
      const bool is_plain = is_closed && (any & too_high) == 0 && (all & beside_middle) != 0;
      if (!is_outside && !is_plain && !add(t)) return false;
      ++t;
    }
    return true;
  }
  /// The original above or below the middle of T', if the parity is odd; `no_index` if it is even.
  [[nodiscard]] std::uint32_t over_middle() const { return is_odd_ ? over_middle_ : no_index; }

 private:
  /// What is seen of a vertex, by more than the rim but for `too_high`. A triangle on one side of the middle along an
  /// axis has an even number of crossings with the ray from there.
  enum Seen : unsigned { beyond_side = 7, too_high = 8, above = 16, below = 32, beside_middle = 0x3c0 };

  void look_at_vertices(std::span<const std::uint32_t> vertices) {
    const auto bit = [](bool is_set, unsigned place) { return (is_set ? 1U : 0U) << place; };
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Projected p = view_.view.project(sight_.soup.vertices[vertices[i]]);
      const double rim = view_.rim, limit = view_.height_limit, x = p.x - view_.centre_x, y = p.y - view_.centre_y;
      const auto is_beyond = [&](std::size_t side) { return view_.window.outside(side, p) > rim; };
      seen_[i] = bit(is_beyond(0), 0) | bit(is_beyond(1), 1) | bit(is_beyond(2), 2) |
                 bit(!(std::abs(p.h) <= limit), 3) | bit(p.h > limit + rim, 4) | bit(p.h < -limit - rim, 5) |
                 bit(x < -rim, 6) | bit(x > rim, 7) | bit(y < -rim, 8) | bit(y > rim, 9);
    }
  }
  /// Adds an original that meets the prism. False where that refutes the proof.
  [[nodiscard]] bool add(std::uint32_t t) {
    if (!sight_.look_at(t)) return sight_.is_beyond_heights();
    if (sight_.has_middle()) is_odd_ = !is_odd_, over_middle_ = t;
    for (std::size_t k = 0; k < 3; ++k)
      if (sight_.soup.neighbour(t, k) == no_index && sight_.passage(k) != Passage::Clear) return false;
    return true;
  }

  const ParityView& view_;
  const OriginalClusters& clusters_;
  Sight<OriginalSoup> sight_;
  std::array<unsigned, OriginalClusters::max_vertices> seen_;  ///< by vertex of a cluster
  bool is_odd_ = false;
  std::uint32_t over_middle_ = no_index;
};

bool SlabProof::covers(const std::array<Vec3, 3>& triangle, double tolerance, double magnitude,
                       std::uint32_t& over_middle) const {
  const std::optional<ParityView> view = ParityView::of(triangle, tolerance, magnitude);
  if (!view) return false;
  const SlabView slabs = slabs_seen_from(*view);
  Patch patch(*view, soup_, clusters_);
  struct BlockAt {
    std::uint32_t level, index;
  };
  // Seven siblings of each level and a block of leaves: up to 16 * 8^10 triangles.
  std::array<BlockAt, 7 * 10 + 8> open;
  std::size_t count = 0;
  open[count++] = {tree_.levels() - 1, 0};
  while (count > 0) {
    const auto [level, index] = open[--count];
    const SlabTree::Block& block = tree_.block(level, index);
    const SlabsSeen seen = kernel_.look(block.slabs, slabs);
    for (unsigned left = seen.meets & ~(seen.within & block.is_closed); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      const std::uint32_t child = index * SlabBlock::lanes + lane;
      if (level > 0)
        open[count++] = {level - 1, child};
      else if (!patch.add_cluster(tree_.cluster(child), (block.is_closed >> lane & 1) != 0))
        return false;
    }
  }
  if (patch.over_middle() == no_index) return false;
  over_middle = patch.over_middle();
  return true;
}

}  // namespace meshbound
