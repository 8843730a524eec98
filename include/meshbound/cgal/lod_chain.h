// SPDX-License-Identifier: GPL-3.0-or-later
/// Levels of detail as in `meshbound/lod_chain.h`, with CGAL's `edge_collapse` in charge of the collapses that are
/// proven one by one, for triangle soups and for CGAL's face graphs.
#pragma once
#include <span>
#include <type_traits>
#include <utility>

#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/lod_chain.h"

namespace meshbound::cgal {

using meshbound::LodLevel;
using meshbound::LodOptions;
using meshbound::LodSink;

/// `meshbound::LodChain`, driven by `edge_collapse_driver()` unless `options.driver` is another.
class LodChain : public meshbound::LodChain {
 public:
  /// As the constructor of `meshbound::LodChain`.
  explicit LodChain(TriangleMesh original, const LodOptions& options = {})
      : meshbound::LodChain(std::move(original), with_edge_collapse(options)) {}
  /// As the constructor of `meshbound::LodChain` for a view.
  explicit LodChain(const MeshView& original, const LodOptions& options = {})
      : meshbound::LodChain(original, with_edge_collapse(options)) {}
};

/// `meshbound::build_lod_chain` with that driver.
std::size_t build_lod_chain(const MeshView& original, std::span<const double> tolerances, const LodOptions& options,
                            const LodSink& sink);

/// `build_lod_chain` for any triangulated face graph of CGAL, whose faces count in the order of the graph.
template <class FaceGraph>
requires(!std::is_convertible_v<const FaceGraph&, MeshView>) std::size_t
    build_lod_chain(const FaceGraph& original, std::span<const double> tolerances, const LodOptions& options,
                    const LodSink& sink) {
  return cgal::build_lod_chain(MeshView(to_triangle_mesh(original)), tolerances, options, sink);
}

}  // namespace meshbound::cgal
