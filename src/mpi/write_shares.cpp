// SPDX-License-Identifier: MIT
#include "mpi/write_shares.h"

#include "mesh/writers.h"

namespace meshbound::mpi {

void write_mesh(Communicator& ranks, AtomicFile* file, const std::filesystem::path& path, const TriangleMesh& mesh,
                const WriteOptions& options) {
  if (!is_written_in_shares(path, options))
    return ranks.do_together([&] {
      if (file != nullptr) meshbound::write_mesh(*file, path, mesh, options);
    });
  Communicator here = ranks.on_this_machine();
  SharedFile shared{.descriptor = -1};
  ranks.do_together([&] {
    if (file != nullptr) shared = file->share();
  });
  here.broadcast(reinterpret_cast<char*>(&shared), sizeof shared, 0);
  ranks.do_together([&] {
    if (shared.descriptor < 0) return;  // rank 0 is on another machine
    const FileShare share{static_cast<std::size_t>(here.rank()), static_cast<std::size_t>(here.size())};
    if (file != nullptr) return write_share(*file, path, mesh, options, share);
    AtomicFile part(path, shared);
    write_share(part, path, mesh, options, share);
    part.complete();
  });
}

}  // namespace meshbound::mpi
