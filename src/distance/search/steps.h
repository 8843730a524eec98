// SPDX-License-Identifier: MIT
/// The steps of a one-sided search, in the order in which `search_one_sided` calls them. Each takes what is left and
/// returns what it leaves; once the search has `decided()` they return at once.
#pragma once
#include <memory>
#include <vector>

#include "distance/search/one_sided_search.h"
#include "distance/search/remaining.h"

namespace meshbound {

/// Asks for a few vertices and centroids, for a first lower bound. Whether one of them lies on B.
[[nodiscard]] bool probe(OneSidedSearch& search);

/// All triangles of A but those that B has too, if a probe lay on B: they are at distance 0 without arithmetic.
[[nodiscard]] Remaining drop_identical(OneSidedSearch& search, bool touches_b);

/// Drops triangles that an earlier search has proven to be near enough.
[[nodiscard]] Remaining drop_proven(OneSidedSearch& search, Remaining remaining);

/// Paper, Algorithm 1: drops whole nodes of A, best first.
[[nodiscard]] Remaining cull_nodes(OneSidedSearch& search, Remaining remaining);

/// Drops triangles that are bounded by what bounded their neighbour along the curve, without queries.
[[nodiscard]] Remaining sweep(OneSidedSearch& search, Remaining remaining);

/// The closest triangles of the vertices that a search still needed.
struct VertexDistances {
  /// Without initial values: a search that culls nearly everything does not touch what it does not need.
  struct Entry {
    double squared;
    std::uint32_t slot;
  };
  std::unique_ptr<Entry[]> nearest;  ///< by A's vertex, set for those that were asked for; null: none was
  bool asked_all = false;
  std::vector<std::uint32_t> asked;  ///< unless all were
};

/// Asks for the closest triangles of the corners of what is left, and bounds the triangles by them (paper, Lemma 2, Eq.
/// 5). Returns those that no closest triangle of a corner bounds.
[[nodiscard]] VertexDistances query_vertices(OneSidedSearch& search, const Remaining& remaining);
[[nodiscard]] std::vector<OpenTriangle> bound_triangles(OneSidedSearch& search, const Remaining& remaining,
                                                        const VertexDistances& vertices);

/// Paper, section 4: whole nodes of A, then its triangles against the nodes of B. Returns the triangles that are left.
[[nodiscard]] std::vector<OpenTriangle> cross_cull(OneSidedSearch& search);

/// Bounds what is left, worst first, by `DistanceOptions::method`.
void refine(OneSidedSearch& search, std::vector<OpenTriangle> open);

/// Leaves the closest triangles for the next search of this model.
void remember_hints(OneSidedSearch& search, const VertexDistances& vertices);

}  // namespace meshbound
