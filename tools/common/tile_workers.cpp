// SPDX-License-Identifier: MIT
#include "common/tile_workers.h"

#include "tiles/decimate_in_tiles.h"

namespace meshbound::tools {

SimplifyResult LocalTileWorkers::decimate(const TriangleMesh& original, const SimplifyOptions& options) {
  ThreadRunner threads(options.threads);
  return decimate_in_tiles(original, options, tiles_, threads);
}

HausdorffDistance LocalTileWorkers::measure(const TriangleMesh& a, const TriangleMesh& b,
                                            const DistanceOptions& options) {
  return hausdorff_distance_in_tiles(a, b, options, tiles_);
}

OneSidedDistance LocalTileWorkers::measure_one_side(const TriangleMesh& a, const TriangleMesh& b,
                                                    const DistanceOptions& options) {
  return one_sided_hausdorff_distance_in_tiles(a, b, options, tiles_);
}

}  // namespace meshbound::tools
