// SPDX-License-Identifier: MIT
#include "mpi/read_ranges.h"

#include "mesh/file_bytes.h"
#include "meshbound/error.h"
#include "tiles/compact_bytes.h"

namespace meshbound::mpi {
namespace {

/// Where the range of a rank begins; that of the rank behind the last one is where the file ends.
std::size_t begin_of_range(std::size_t size, int rank, int ranks) {
  const auto r = static_cast<std::size_t>(rank), n = static_cast<std::size_t>(ranks);
  return size / n * r + size % n * r / n;
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
    const std::size_t first = begin_of_range(size, ranks.rank(), ranks.size());
    const std::size_t count = begin_of_range(size, ranks.rank() + 1, ranks.size()) - first;
    const FileBytes range(path, stop, count, first);
    if (range.bytes().size() != count)
      throw IoError(path.string() + ": cannot read: rank " + std::to_string(ranks.rank()) +
                    " finds fewer bytes than rank 0; use a folder that all ranks see alike");
    range.bytes().copy(bytes.data() + first, count);
  });
  for (int rank = 0; rank < ranks.size(); ++rank) {
    const std::size_t first = begin_of_range(size, rank, ranks.size());
    ranks.broadcast(bytes.data() + first, begin_of_range(size, rank + 1, ranks.size()) - first, rank);
  }
  return bytes;
}

}  // namespace meshbound::mpi
