// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshbound/cgal/edge_collapse_driver.h"
#include "meshbound/cgal/lod_chain.h"

namespace meshbound::cgal {

SimplifyOptions with_edge_collapse(SimplifyOptions options) {
  if (!options.driver) options.driver = edge_collapse_driver();
  return options;
}

SimplifyResult simplify_with_bound(const TriangleMesh& original, const SimplifyOptions& options) {
  return meshbound::simplify_with_bound(original, with_edge_collapse(options));
}

std::size_t build_lod_chain(const MeshView& original, std::span<const double> tolerances, const LodOptions& options,
                            const LodSink& sink) {
  return meshbound::build_lod_chain(original, tolerances, with_edge_collapse(options), sink);
}

}  // namespace meshbound::cgal
