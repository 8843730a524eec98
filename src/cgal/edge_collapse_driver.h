// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "meshbound/cgal/edge_collapse_driver.h"

namespace meshbound::cgal {

/// CGAL's `edge_collapse` on a `Surface_mesh` of each region: its queue, its checks, its Euler operations. Each
/// collapse that it is about to make is asked for at the core, which makes it in its own mesh and proves it, or refuses
/// it; CGAL then does the same.
///
/// After each collapse CGAL asks for the cost of every edge of every vertex around: quadratic time at a vertex with
/// many edges, as on every cylinder cap. A region that has one is left to the queue of the core, and so is one with an
/// edge of no length, which CGAL collapses without asking.
class EdgeCollapseDriver : public CollapseDriver {
 public:
  /// A region with a vertex of more edges than this is left to the core's own queue.
  static constexpr std::size_t max_edges_of_vertex = 96;

  explicit EdgeCollapseDriver(CollapseCost cost) : cost_(cost) {}
  void collapse(RegionCollapses& collapses) const override;

 private:
  CollapseCost cost_;
};

}  // namespace meshbound::cgal
