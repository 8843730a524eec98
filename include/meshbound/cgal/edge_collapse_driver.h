// SPDX-License-Identifier: GPL-3.0-or-later
/// CGAL's `edge_collapse` as a `CollapseDriver`, and `meshbound::simplify_with_bound` with it, for triangle soups.
/// Includes nothing of CGAL, whose headers take seconds to compile; face graphs are the affair of
/// cgal/simplify_with_bound.h.
#pragma once
#include <memory>

#include "meshbound/simplify.h"

namespace meshbound::cgal {

/// What decides the order in which edges are collapsed, and where the vertex goes if the bound allows.
enum class CollapseCost {
  GarlandHeckbert,  ///< the quadrics of the core: both drivers ask for the same collapses in nearly the same order
  LindstromTurk     ///< volume, area and shape as in CGAL. Proposals, which samples admit, still go by quadrics
};

/// CGAL's `edge_collapse` on a `Surface_mesh` of each region asks for every collapse that is proven on its own, and
/// makes it. For `SimplifyOptions::driver`; may be shared among runs and threads.
[[nodiscard]] std::shared_ptr<const CollapseDriver> edge_collapse_driver(
    CollapseCost cost = CollapseCost::GarlandHeckbert);

/// The options with this driver where they name none.
[[nodiscard]] SimplifyOptions with_edge_collapse(SimplifyOptions options);

/// `meshbound::simplify_with_bound`, driven by `edge_collapse_driver()` unless `options.driver` is another.
[[nodiscard]] SimplifyResult simplify_with_bound(const TriangleMesh& original, const SimplifyOptions& options);

}  // namespace meshbound::cgal
