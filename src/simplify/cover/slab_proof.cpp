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
  Patch(const SlabProof& proof, const ParityView& view, const SlabView& slabs)
      : clusters_(proof.clusters_), kernel_(proof.kernel_), slabs_(slabs), sight_{view, proof.soup_} {}

  /// Adds the originals of a cluster that belong to P. False where one refutes the proof. In a cluster that is closed,
  /// all edges have a neighbour. A triangle beside the middle has an even number of crossings with the ray from there.
  [[nodiscard]] bool add_cluster(std::uint32_t cluster, bool is_closed) {
    using Seen = VertexSeen;
    kernel_.look_at_vertices(sight_.soup.vertices.data(), clusters_.vertices(cluster), slabs_, seen_.data());
    std::uint32_t t = cluster * OriginalClusters::size;
    for (const auto& [a, b, c] : clusters_.triangles(cluster)) {
      const std::uint64_t all = seen_[a] & seen_[b] & seen_[c], any = seen_[a] | seen_[b] | seen_[c];
      const bool is_outside = (all & (Seen::beyond_side | Seen::above | Seen::below)) != 0;
      const bool is_plain = is_closed && (any & Seen::too_high) == 0 && (all & Seen::beside_middle) != 0;
      if (!is_outside && !is_plain && !add(t)) return false;
      ++t;
    }
    return true;
  }
  /// The original above or below the middle of T', if the parity is odd; `no_index` if it is even.
  [[nodiscard]] std::uint32_t over_middle() const { return is_odd_ ? over_middle_ : no_index; }

 private:
  /// Adds an original that meets the prism. False where that refutes the proof.
  [[nodiscard]] bool add(std::uint32_t t) {
    if (!sight_.look_at(t)) return sight_.is_beyond_heights();
    if (sight_.has_middle()) is_odd_ = !is_odd_, over_middle_ = t;
    for (std::size_t k = 0; k < 3; ++k)
      if (sight_.soup.neighbour(t, k) == no_index && sight_.passage(k) != Passage::Clear) return false;
    return true;
  }

  const OriginalClusters& clusters_;
  const SlabKernel& kernel_;
  const SlabView& slabs_;
  Sight<OriginalSoup> sight_;
  alignas(32) std::array<std::uint64_t, OriginalClusters::max_vertices> seen_;  ///< by vertex of a cluster
  bool is_odd_ = false;
  std::uint32_t over_middle_ = no_index;
};

bool SlabProof::covers(const TriangleCorners& triangle, double tolerance, double magnitude,
                       std::uint32_t& over_middle) const {
  const std::optional<ParityView> view = ParityView::of(triangle, tolerance, magnitude);
  if (!view) return false;
  const SlabView slabs = slabs_seen_from(*view);
  Patch patch(*this, *view, slabs);
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
