// SPDX-License-Identifier: MIT
#include "mpi/read_ranges.h"

#include "mesh/file_bytes.h"
#include "mesh/file_share.h"
#include "meshbound/error.h"
#include "tiles/compact_bytes.h"

namespace meshbound::mpi {
namespace {

FileShare share_of(int rank, const Communicator& ranks) {
  return {static_cast<std::size_t>(rank), static_cast<std::size_t>(ranks.size())};
}

std::uint64_t size_of_file(const std::filesystem::path& path) {
  (void)FileBytes(path, {}, 0);  // throws for what is no file
  return std::filesystem::file_size(path);
}

}  // namespace

std::string read_ranges(Communicator& ranks, const std::filesystem::path& path, const StopToken& stop) {
  std::uint64_t size = 0;
  ranks.do_together([&] {
    if (ranks.rank() == 0) size = size_of_file(path);
  });
  ranks.broadcast(reinterpret_cast<char*>(&size), sizeof size, 0);
  std::string bytes;
  ranks.do_together([&] {
    bytes.resize(size);
    const FileShare share = share_of(ranks.rank(), ranks);
    const std::size_t first = share.begin(size), count = share.size(size);
    const FileBytes range(path, stop, count, first);
    if (range.bytes().size() != count)
      throw IoError(path.string() + ": cannot read: rank " + std::to_string(ranks.rank()) +
                    " finds fewer bytes than rank 0; use a folder that all ranks see alike");
    range.bytes().copy(bytes.data() + first, count);
  });
  for (int rank = 0; rank < ranks.size(); ++rank) {
    const FileShare share = share_of(rank, ranks);
    ranks.broadcast(bytes.data() + share.begin(size), share.size(size), rank);
  }
  return bytes;
}

}  // namespace meshbound::mpi
