// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "geometry/mapping.h"

namespace meshbound {

class OneSidedSearch;

/// The nodes of A that a search ended with, which together hold all triangles of A, each with a proven bound of its
/// distance to B. Under a rigid motion of the models a distance changes by no more than points of A move as seen from
/// B, so the bounds hold at a later pose too, each raised by that length.
struct NodeFront {
  struct Node {
    double upper;  ///< of the distance of all its triangles, B's working units, rounding included; infinite: none
    std::uint32_t level;
    std::uint32_t index;
    std::uint32_t slot;  ///< the triangle of B that gives the bound: a hint
  };
  std::vector<Node> nodes;  ///< empty: nothing is known
  Mapping map;              ///< from A to B where the bounds hold
  double slack = 0;         ///< rounding there: `Goal::slack`
  bool is_new = false;      ///< made by the search that is going on
};

/// How far a point of A has moved at most, as seen from B, since the front was made: B's working units, never below the
/// true length. O(1).
[[nodiscard]] double drift_since(const NodeFront& front, const OneSidedSearch& search);

/// Whether all of A is within a length of B, in B's working units, by the front alone. O(nodes).
[[nodiscard]] bool is_within(const NodeFront& front, const OneSidedSearch& search, double length);

/// Whether a search is to begin at the front: the models have moved by little in proportion to the bound that is
/// wanted, so most of its nodes are still near enough. Else all of it would have to be looked at again, and a search
/// from the root, in larger nodes, costs less.
[[nodiscard]] bool is_coherent(const NodeFront& front, const OneSidedSearch& search);

}  // namespace meshbound
