// SPDX-License-Identifier: MIT
#include "mesh/readers.h"
#include "meshbound/mpi.h"
#include "mpi/rank_runner.h"
#include "mpi/read_ranges.h"
#include "mpi/write_shares.h"
#include "tiles/decimate_in_tiles.h"
#include "tiles/measure_in_tiles.h"

namespace meshbound::mpi {

MeshFile read_mesh(const std::filesystem::path& path, MPI_Comm ranks, const ReadOptions& options) {
  (void)format_of(path);
  Communicator communicator(ranks);
  return parse_mesh(path, read_ranges(communicator, path, {options.deadline, options.cancel}), options);
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, MPI_Comm ranks,
                const WriteOptions& options) {
  Communicator communicator(ranks);
  std::optional<AtomicFile> file;
  communicator.do_together([&] {
    (void)format_of(path);  // an unknown extension is the better message where both are wrong
    const StopToken stop{options.deadline, options.cancel};
    if (communicator.rank() == 0) file.emplace(path, AtomicFile::Stream::Staged, stop);
  });
  write_mesh(communicator, file ? &*file : nullptr, path, mesh, options);
  communicator.do_together([&] {
    if (file) file->commit();
  });
}

SimplifyResult simplify_in_tiles(const TriangleMesh& original, const SimplifyOptions& options, MPI_Comm ranks,
                                 const TileOptions& tiles) {
  Communicator communicator(ranks);
  RankRunner runner(communicator, options.threads);
  return meshbound::simplify_in_tiles(original, options, tiles, runner);
}

HausdorffDistance hausdorff_distance_in_tiles(const TriangleMesh& a, const TriangleMesh& b, MPI_Comm ranks,
                                              const DistanceOptions& options, const TileOptions& tiles) {
  Communicator communicator(ranks);
  RankRunner runner(communicator, options.threads);
  return measure_in_tiles(a, b, options, tiles, runner);
}

OneSidedDistance one_sided_hausdorff_distance_in_tiles(const TriangleMesh& a, const TriangleMesh& b, MPI_Comm ranks,
                                                       const DistanceOptions& options, const TileOptions& tiles) {
  Communicator communicator(ranks);
  RankRunner runner(communicator, options.threads);
  return measure_one_side_in_tiles(a, b, options, tiles, runner);
}

}  // namespace meshbound::mpi
