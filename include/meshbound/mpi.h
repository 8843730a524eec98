// SPDX-License-Identifier: MIT
/// One mesh over the ranks of an MPI run: the component `meshbound::mpi`, which is there where the library was built
/// with MPI. No other header of meshbound needs MPI.
///
/// All functions are collective: every rank of the communicator calls them with the same arguments, from the thread
/// that initialised MPI (`MPI_THREAD_FUNNELED` is enough), and leaves with the same result, to the bit that of the
/// functions of "meshbound/tiles.h", whatever the number of ranks and threads. Every rank holds the whole original in
/// memory (the tools keep it on disk); tiles are worked on by one rank each. What one of the functions throws, it
/// throws on all ranks; an exception from anywhere else on a single rank leaves the others waiting, so end such a run
/// with `MPI_Abort`.
#pragma once
#include <mpi.h>

#include <cstdint>
#include <filesystem>

#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/simplify.h"
#include "meshbound/tiles.h"

namespace meshbound::mpi {

/// As `meshbound::read_mesh`: each rank reads an equal range of the bytes of the file, which all must see under the
/// same path, and all ranks exchange these ranges. (r - 1) times the size of the file is sent for r ranks.
[[nodiscard]] MeshFile read_mesh(const std::filesystem::path& path, MPI_Comm ranks, const ReadOptions& options = {});

/// As `meshbound::write_mesh` of a mesh that all ranks have, with the same bytes: the ranks of rank 0's machine each
/// write a range of a binary PLY or STL, rank 0 any other file. It appears under its name when all have written theirs.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, MPI_Comm ranks,
                const WriteOptions& options = {});

/// As `meshbound::simplify_in_tiles`. Ranks may have different numbers of threads, limits of time and flags to cancel:
/// the first limit that comes ends the tiles of its rank, and the run once all ranks have finished the pass.
[[nodiscard]] SimplifyResult simplify_in_tiles(const TriangleMesh& original, const SimplifyOptions& options,
                                               MPI_Comm ranks, const TileOptions& tiles = {});

/// As `meshbound::hausdorff_distance_in_tiles`.
[[nodiscard]] HausdorffDistance hausdorff_distance_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                            MPI_Comm ranks, const DistanceOptions& options = {},
                                                            const TileOptions& tiles = {});

/// As `meshbound::one_sided_hausdorff_distance_in_tiles`.
[[nodiscard]] OneSidedDistance one_sided_hausdorff_distance_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                                     MPI_Comm ranks,
                                                                     const DistanceOptions& options = {},
                                                                     const TileOptions& tiles = {});

}  // namespace meshbound::mpi
