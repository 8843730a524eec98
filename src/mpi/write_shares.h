// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "mesh/atomic_file.h"
#include "meshbound/io.h"
#include "mpi/communicator.h"

namespace meshbound::mpi {

/// As `meshbound::write_mesh` into `file`, which only rank 0 has (null on the others): the ranks of its machine each
/// write a share of a binary PLY or STL, and rank 0 any other file. Every rank has the whole mesh. `file` has the same
/// bytes for any number of ranks. All ranks throw what one of them throws.
void write_mesh(Communicator& ranks, AtomicFile* file, const std::filesystem::path& path, const TriangleMesh& mesh,
                const WriteOptions& options);

}  // namespace meshbound::mpi
