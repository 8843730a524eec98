// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>

#include "geometry/triangle_corners.h"
#include "proof/parity_view.h"
#include "simplify/cover/original_clusters.h"
#include "simplify/cover/original_soup.h"
#include "simplify/cover/slab_tree.h"
#include "simplify/kernel/kernels.h"

namespace meshbound {

/// Proves that a triangle T lies within a tolerance of an original, as a parity proof (proof/parity_patch.h) that takes
/// whole nodes of a tree where it can: its time grows with the length of the edges of T, while a patch that grows looks
/// at every original below T.
///
/// P are the originals that reach into the prism over T' (`ParityView`), but for those wholly above or below it. One
/// that the top or the bottom of the prism cuts refutes the proof. An edge between P and what is not in P is one of a
/// triangle that is beyond a side of T', and so is the edge; or of a triangle beyond the heights, where none of P
/// reaches over T'. So the boundary of P over T' are the edges without a neighbour, and a node that has none of these
/// and whose heights are allowed is in P as it is. It need not be looked at for the parity either, if it is away from
/// the middle of T': each of its triangles has an even number of crossings there.
///
/// The original, its clusters and the tree must outlive this. Immutable, safe to share.
class SlabProof {
 public:
  SlabProof(const OriginalSoup& soup, const OriginalClusters& clusters, const SlabTree& tree)
      : soup_(soup), clusters_(clusters), tree_(tree) {}

  /// True proves that `triangle` lies within `tolerance` of the original (but for CandidateFaces::rounding_slack of the
  /// largest coordinate), and sets `over_middle` to an original above or below the middle of T'. False says nothing:
  /// where two sheets lie in the prism, a patch that grows may find the one.
  [[nodiscard]] bool covers(const TriangleCorners& triangle, double tolerance, double magnitude,
                            std::uint32_t& over_middle) const;

 private:
  class Patch;

  OriginalSoup soup_;
  const OriginalClusters& clusters_;
  const SlabTree& tree_;
  SlabKernel kernel_ = simplify_kernels().slabs;
};

}  // namespace meshbound
