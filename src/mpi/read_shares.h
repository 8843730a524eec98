// SPDX-License-Identifier: MIT
#pragma once
#include "mesh/readers.h"
#include "mpi/communicator.h"

namespace meshbound::mpi {

/// As `read_mesh_into`, for all ranks: those of a machine keep one copy of the mesh in the space of `into`. Each of
/// them reads a share of a binary PLY or STL; where that is impossible, and for any other file, the first one reads all
/// of it. The mesh is the same to the bit for any number of ranks. `reader` gets the bytes of the rank that has one.
/// All ranks throw what one of them throws, and `InvalidInput` where they do not find the same mesh.
[[nodiscard]] MeshFile read_mesh_into(Communicator& ranks, const std::filesystem::path& path, const StopToken& stop,
                                      MeshInSpace& into, const FileWindow::Reader& reader = {});

}  // namespace meshbound::mpi
