// SPDX-License-Identifier: GPL-3.0-or-later
/// `meshbound::simplify_with_bound` with CGAL's `edge_collapse` in charge of the collapses that are proven one by one,
/// for triangle soups and for CGAL's face graphs.
#pragma once
#include <type_traits>
#include <vector>

#include "meshbound/cgal/edge_collapse_driver.h"
#include "meshbound/cgal/surface_mesh.h"
#include "meshbound/simplify.h"

namespace meshbound::cgal {

using meshbound::CollapseCounts;
using meshbound::CollapseDriver;
using meshbound::Effort;
using meshbound::EndedBy;
using meshbound::OnExceed;
using meshbound::Precision;
using meshbound::SimplifiedLevel;
using meshbound::SimplifyOptions;
using meshbound::SimplifyResult;
using meshbound::to_string;

/// A vertex property map of a face graph as `SimplifyOptions::locked_vertices` for that graph. O(n).
template <class FaceGraph, class LockMap>
[[nodiscard]] std::vector<bool> locked_vertices(const FaceGraph& graph, const LockMap& is_locked) {
  std::vector<bool> locked;
  for (const auto v : vertices(graph)) locked.push_back(bool(get(is_locked, v)));
  return locked;
}

/// `simplify_with_bound` for any triangulated face graph of CGAL; vertices and faces count in the order of the graph.
template <class FaceGraph>
requires(!std::is_same_v<FaceGraph, TriangleMesh>) [[nodiscard]] SimplifyResult
    simplify_with_bound(const FaceGraph& original, const SimplifyOptions& options) {
  return cgal::simplify_with_bound(to_triangle_mesh(original), options);
}

}  // namespace meshbound::cgal
