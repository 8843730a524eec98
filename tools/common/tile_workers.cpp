// SPDX-License-Identifier: MIT
#include "common/tile_workers.h"

#include "common/tile_scratch.h"
#include "tiles/decimate_in_tiles.h"

namespace meshbound::tools {

SimplifyResult LocalTileWorkers::decimate(const TriangleMesh& original, const SimplifyOptions& options) {
  ThreadRunner threads(options.threads);
  if (setting_.scratch.empty()) return decimate_in_tiles(original, options, setting_.tiles, threads);
  TileScratch scratch(setting_.scratch,
                      decimation_key(original, options, setting_.driver + " " + setting_.cost, setting_.tiles),
                      setting_.resumes, true);
  ScratchRunner runner(threads, scratch);
  SimplifyResult result = decimate_in_tiles(original, options, setting_.tiles, runner);
  reused_tiles_ += runner.reused();
  return result;
}

HausdorffDistance LocalTileWorkers::measure(const TriangleMesh& a, const TriangleMesh& b,
                                            const DistanceOptions& options) {
  return hausdorff_distance_in_tiles(a, b, options, setting_.tiles);
}

OneSidedDistance LocalTileWorkers::measure_one_side(const TriangleMesh& a, const TriangleMesh& b,
                                                    const DistanceOptions& options) {
  return one_sided_hausdorff_distance_in_tiles(a, b, options, setting_.tiles);
}

}  // namespace meshbound::tools
