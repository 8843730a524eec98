// SPDX-License-Identifier: MIT
#include "mpi/read_shares.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>

#include "mesh/weld.h"
#include "meshbound/error.h"
#include "tiles/compact_bytes.h"

namespace meshbound::mpi {
namespace {

struct SharedWeld {
  SharedMesh mesh;
  SharedBytes numbers;
};

/// The vertices of several meshes in one that has no triangles yet, each position once, in the order in which they come
/// first; and by vertex of these meshes, one after the other, its number there.
class Weld {
 public:
  Weld(const StoreSpace& space, const std::vector<SharedMesh>& parts) : mesh_(space), numbers_(space) {
    Welder welder;
    for (const SharedMesh& shared : parts) {
      MeshInSpace part(space);
      part.use(shared);
      part.for_each_vertex([&](std::uint32_t, const Eigen::Vector3d& p) {
        const std::uint32_t number = welder.index_of(p);
        if (number == mesh_.vertex_count()) mesh_.append({&p, 1});
        numbers_.append(number);
      });
    }
  }
  [[nodiscard]] SharedWeld share() { return {mesh_.share(), numbers_.share()}; }

 private:
  MeshInSpace mesh_;
  ItemStore<std::uint32_t> numbers_;
};

/// One rank of those that read a file together.
class ShareReader {
 public:
  ShareReader(Communicator& ranks, const std::filesystem::path& path, const StopToken& stop, MeshInSpace& into)
      : ranks_(ranks),
        here_(ranks.on_this_machine()),
        share_{static_cast<std::size_t>(here_.rank()), static_cast<std::size_t>(here_.size())},
        path_(path),
        stop_(stop),
        into_(into) {}

  /// Nothing where the file must be read as a whole.
  std::optional<MeshFile> read_shares() {
    ranks_.do_together([&] { counts_ = counts_for_shares(path_, stop_); });
    if (ranks_.any(!counts_)) return std::nullopt;
    ranks_.do_together([&] { part_.emplace(into_.space()); });
    return counts_->vertices ? read_numbered() : read_welded();
  }

  /// The first rank reads, and the others use its copy.
  MeshFile read_whole(const FileWindow::Reader& reader) {
    MeshFile file;
    SharedMesh copy;
    ranks_.do_together([&] {
      if (here_.rank() != 0) return;
      file = meshbound::read_mesh_into(path_, stop_, into_, reader);
      copy = into_.share();
    });
    give_from_first(copy);
    ranks_.do_together([&] {
      if (here_.rank() != 0) into_.use(copy);
    });
    return file;
  }

 private:
  /// Vertices have their numbers in the file: each rank writes to its place in the files of the first one.
  std::optional<MeshFile> read_numbered() {
    std::optional<MeshFile> file;
    SharedMesh whole;
    ranks_.do_together([&] { whole = part_->share(); });
    give_from_first(whole);
    ranks_.do_together([&] {
      if (here_.rank() != 0)
        part_->use(whole.with_counts(share_.begin(*counts_->vertices), share_.begin(counts_->triangles)));
      file = read_share(path_, share_, stop_, *part_);
      whole = part_->share();
    });
    if (ranks_.any(!file)) return std::nullopt;
    ranks_.do_together([&] { into_.use(whole.with_counts(*counts_->vertices, counts_->triangles)); });
    return file;
  }

  /// Vertices of each share are welded by its rank, then those of all shares by the first rank, which tells the others
  /// the numbers of theirs.
  std::optional<MeshFile> read_welded() {
    std::optional<MeshFile> file;
    SharedMesh part;
    ranks_.do_together([&] {
      file = read_share(path_, share_, stop_, *part_);
      part = part_->share();
    });
    if (ranks_.any(!file)) return std::nullopt;
    const std::vector<SharedMesh> parts = of_all(part);
    const auto vertices = [](std::size_t sum, const SharedMesh& one) { return sum + one.vertex_count(); };
    const std::size_t all = std::accumulate(parts.begin(), parts.end(), std::size_t{0}, vertices);
    if (ranks_.any(all > std::numeric_limits<std::uint32_t>::max())) return std::nullopt;

    std::optional<Weld> weld;  // of the first rank
    SharedWeld welded;
    ranks_.do_together([&] {
      if (here_.rank() == 0) welded = weld.emplace(into_.space(), parts).share();
    });
    give_from_first(welded);
    ranks_.do_together([&] {
      renumber(std::accumulate(parts.begin(), parts.begin() + here_.rank(), std::size_t{0}, vertices), welded);
    });
    file->dropped.facet_attributes = here_.sum(file->dropped.facet_attributes);
    return file;
  }

  /// Adds the triangles of this rank, whose first vertex is the `first` of all parts.
  void renumber(std::size_t first, const SharedWeld& welded) {
    std::vector<std::uint32_t> numbers(part_->vertex_count());
    ItemStore<std::uint32_t>(into_.space(), welded.numbers).read(first, numbers);
    const std::size_t vertices = welded.mesh.vertex_count();
    into_.use(welded.mesh.with_counts(vertices, share_.begin(counts_->triangles)));
    part_->for_each_triangle([&](std::uint32_t, Triangle corners) {
      for (std::uint32_t& v : corners) v = numbers[v];
      into_.append({&corners, 1});
    });
    into_.use(into_.share().with_counts(vertices, counts_->triangles));
  }

  template <class T>
  void give_from_first(T& value) {
    here_.broadcast(reinterpret_cast<char*>(&value), sizeof value, 0);
  }

  /// By rank of this machine.
  std::vector<SharedMesh> of_all(const SharedMesh& own) {
    std::vector<SharedMesh> all;
    for (const std::string& bytes : here_.all_gather({reinterpret_cast<const char*>(&own), sizeof own}))
      std::memcpy(&all.emplace_back(), bytes.data(), sizeof own);
    return all;
  }

  Communicator& ranks_;
  Communicator here_;
  FileShare share_;
  const std::filesystem::path& path_;
  const StopToken& stop_;
  MeshInSpace& into_;
  std::optional<MeshCounts> counts_;
  std::optional<MeshInSpace> part_;  ///< what this rank reads
};

void refuse_different_meshes(Communicator& ranks, const std::filesystem::path& path, const StoredMesh& mesh) {
  CompactWriter found;
  found.number(mesh.vertex_count());
  found.number(mesh.triangle_count());
  const std::vector<std::string> all = ranks.all_gather(found.take());
  if (std::adjacent_find(all.begin(), all.end(), std::not_equal_to<>()) != all.end())
    throw InvalidInput(path.string() + ": the ranks do not find the same mesh; use a folder that all ranks see alike");
}

}  // namespace

MeshFile read_mesh_into(Communicator& ranks, const std::filesystem::path& path, const StopToken& stop,
                        MeshInSpace& into, const FileWindow::Reader& reader) {
  ShareReader share(ranks, path, stop, into);
  std::optional<MeshFile> file = share.read_shares();
  if (!file) {
    file = share.read_whole(reader);
  } else {
    ranks.do_together([&] {
      if (!reader) return;
      FileWindow window(path, stop, reader);
      (void)window.at(window.size(), 0);
    });
  }
  refuse_different_meshes(ranks, path, into);
  return *std::move(file);
}

}  // namespace meshbound::mpi
