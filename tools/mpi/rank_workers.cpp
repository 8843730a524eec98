// SPDX-License-Identifier: MIT
#include "mpi/rank_workers.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <functional>
#include <utility>

#include "common/memory.h"
#include "common/sha256.h"
#include "common/standard_streams.h"
#include "common/tile_scratch.h"
#include "decimation/drivers.h"
#include "mesh/writers.h"
#include "meshbound/error.h"
#include "mpi/rank_runner.h"
#include "mpi/read_shares.h"
#include "mpi/write_shares.h"
#include "tiles/certificate_in_tiles.h"
#include "tiles/compact_bytes.h"
#include "tiles/measure_in_tiles.h"

namespace meshbound::tools {

/// What rank 0 tells the others to do: a message begins with one of these, and what belongs to it follows.
enum class RankWorkers::Command : std::uint8_t {
  End,
  LimitMemory,
  Read,
  Take,
  Write,
  Decimate,
  Measure,
  MeasureOneSide,
  Certify,
  Count
};

namespace {

using Command = RankWorkers::Command;

using mpi::Communicator;
using mpi::RankRunner;

bool lost_step = false;

/// Does what all ranks do at the same time. An exception that not all have is noted, unless it is one that all throw by
/// themselves: that something is asked for which cannot be.
template <class Work>
auto together(Communicator& ranks, const Work& work) {
  ranks.begin_together();
  try {
    return work();
  } catch (const InvalidInput&) {
    throw;
  } catch (...) {
    if (!ranks.has_thrown_together()) lost_step = true;
    throw;
  }
}

CompactWriter command(Command which) {
  CompactWriter bytes;
  bytes.raw(which);
  return bytes;
}

void tell(Communicator& ranks, CompactWriter& bytes) {
  std::string message = bytes.take();
  ranks.broadcast(message, 0);
}

void pack(CompactWriter& to, const SimplifyOptions& options) {
  pack_tile_options(to, options);
  to.raw(options.time_limit);
  to.raw(options.threads);
}

SimplifyOptions unpack_simplify(CompactReader& from) {
  SimplifyOptions options;
  from.raw(options.tolerance);
  from.raw(options.effort);
  from.raw(options.placements);
  from.raw(options.precision);
  from.raw(options.preserve_boundary);
  from.raw(options.time_limit);
  from.raw(options.threads);
  return options;
}

void pack(CompactWriter& to, const DistanceOptions& options) {
  constexpr double none = -1;
  to.raw(options.error_bound.value_or(none));
  to.raw(options.tolerance.value_or(none));
  to.raw(options.budget);
  to.raw(options.method);
  to.raw(options.threads);
}

DistanceOptions unpack_distance(CompactReader& from) {
  DistanceOptions options;
  double error_bound = 0, tolerance = 0;
  from.raw(error_bound);
  from.raw(tolerance);
  if (error_bound >= 0) options.error_bound = error_bound;
  if (tolerance >= 0) options.tolerance = tolerance;
  from.raw(options.budget);
  from.raw(options.method);
  from.raw(options.threads);
  return options;
}

void pack(CompactWriter& to, const TriangleMesh& mesh) {
  to.number(mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (int k = 0; k < 3; ++k) to.raw(p[k]);
  to.number(mesh.triangles.size());
  std::uint32_t before = 0;
  for (const Triangle& corners : mesh.triangles) {
    for (const std::uint32_t v : corners) {
      to.step(before, v);
      before = v;
    }
  }
}

std::string checksum_of(const TriangleMesh& mesh) {
  const auto bytes = [](const auto& items) {
    return std::string_view(reinterpret_cast<const char*>(items.data()), items.size() * sizeof items[0]);
  };
  Sha256 sum;
  sum.add(std::to_string(mesh.vertices.size()) + ",");
  sum.add(bytes(mesh.vertices));
  sum.add(bytes(mesh.triangles));
  return sum.digits();
}

TriangleMesh unpack_mesh(CompactReader& from) {
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(from.number()));
  for (Eigen::Vector3d& p : mesh.vertices)
    for (int k = 0; k < 3; ++k) from.raw(p[k]);
  mesh.triangles.resize(static_cast<std::size_t>(from.number()));
  std::uint32_t before = 0;
  for (Triangle& corners : mesh.triangles)
    for (std::uint32_t& v : corners) before = v = from.step(before);
  return mesh;
}

MeshFile read_together(Communicator& ranks, const std::string& path, const StopToken& stop, MeshInSpace& into,
                       const FileWindow::Reader& reader) {
  return together(ranks, [&] { return mpi::read_mesh_into(ranks, path, stop, into, reader); });
}

Decimated decimate_together(Communicator& ranks, const StoredMesh& original, const SimplifyOptions& options,
                            const TileOptions& tiles, std::optional<TileScratch>& scratch) {
  RankRunner runner(ranks, options.threads);
  Decimated decimated = decimate_in_tiles(original, options, tiles, runner, scratch);
  decimated.reused = ranks.sum(decimated.reused);
  return decimated;
}

/// What a rank other than 0 has been given, and does with it.
class Follower {
 public:
  explicit Follower(Communicator& ranks) : ranks_(ranks) {}

  /// Returns the exit code once rank 0 has said what it is.
  int run() {
    for (;;) {
      std::string bytes;
      ranks_.broadcast(bytes, 0);
      CompactReader from(bytes);
      Command which{};
      from.raw(which);
      if (which == Command::End) return static_cast<int>(from.number());
      try {
        together(ranks_, [&] { follow(which, from); });
      } catch (...) {
        if (lost_step) throw;  // otherwise rank 0 has the same exception and decides
      }
    }
  }

 private:
  void follow(Command which, CompactReader& from) {
    switch (which) {
      case Command::LimitMemory:
        return limit_memory(from.number());
      case Command::Read:
        return read(from);
      case Command::Take:
        return take(from);
      case Command::Write:
        return write(from);
      case Command::Decimate:
        return decimate(from);
      case Command::Measure:
      case Command::MeasureOneSide:
        return measure(which, from);
      case Command::Certify:
        return certify(from);
      case Command::Count:
        (void)ranks_.sum(ranks_.bytes_sent());
        return;
      case Command::End:
        return;
    }
  }

  /// A file that is no mesh leaves no mesh here and ends rank 0.
  void read(CompactReader& from) {
    const std::string path(from.text());
    auto mesh = std::make_unique<MeshInSpace>(space_in(from.text()));
    (void)read_together(ranks_, path, {}, *mesh, {});
    meshes_.push_back(std::move(mesh));
  }

  void take(CompactReader& from) {
    const StoreSpace space = space_in(from.text());
    meshes_.push_back(std::make_unique<MeshInSpace>(space, unpack_mesh(from)));
  }

  /// Puts what can be read back in the place of the mesh.
  void write(CompactReader& from) {
    const std::filesystem::path path(from.text());
    const StoreSpace space = space_in(from.text());
    WriteOptions options;
    from.raw(options.single_precision);
    std::unique_ptr<MeshInSpace>& mesh = meshes_.at(from.number());
    TriangleMesh rounded;
    ranks_.do_together([&] { rounded = rounded_for(path, loaded(*mesh), options); });
    mpi::write_mesh(ranks_, nullptr, path, rounded, options);
    ranks_.do_together([&] { mesh = std::make_unique<MeshInSpace>(space, rounded); });
  }

  /// Where this rank keeps meshes: in the folder of --scratch, or in one of its own.
  [[nodiscard]] static StoreSpace space_in(std::string_view scratch) {
    TileSetting setting;
    setting.scratch = scratch;
    return space_of(setting);
  }

  void decimate(CompactReader& from) {
    SimplifyOptions options = unpack_simplify(from);
    const std::string driver(from.text()), cost(from.text());
    options.driver = collapse_driver(driver, cost);
    const TileOptions tiles{static_cast<std::size_t>(from.number())};
    const StoredMesh& original = mesh(from);
    const std::string folder(from.text()), key(from.text());
    std::optional<TileScratch> scratch;
    if (!key.empty()) scratch.emplace(folder, key, true, ScratchOwner::AnotherRank);
    const Decimated decimated = decimate_together(ranks_, original, options, tiles, scratch);
    ranks_.do_together(
        [&] { meshes_.push_back(std::make_unique<MeshInSpace>(space_in(folder), decimated.result.last().mesh)); });
  }

  void measure(Command which, CompactReader& from) {
    const DistanceOptions options = unpack_distance(from);
    const TileOptions tiles{static_cast<std::size_t>(from.number())};
    const StoredMesh& a = mesh(from);
    const StoredMesh& b = mesh(from);
    RankRunner runner(ranks_, options.threads);
    if (which == Command::Measure)
      (void)measure_in_tiles(a, b, options, tiles, runner);
    else
      (void)measure_one_side_in_tiles(a, b, options, tiles, runner);
  }

  void certify(CompactReader& from) {
    CertificateOptions options;
    double tolerance = 0;
    from.raw(options.threads);
    from.raw(options.seconds);
    from.raw(tolerance);
    const TileOptions tiles{static_cast<std::size_t>(from.number())};
    const StoredMesh& original = mesh(from);
    const StoredMesh& simplified = mesh(from);
    RankRunner runner(ranks_, options.threads);
    (void)certify_in_tiles(original, simplified, tolerance, options, tiles, runner);
  }

  [[nodiscard]] const StoredMesh& mesh(CompactReader& from) const { return *meshes_.at(from.number()); }

  Communicator& ranks_;
  std::vector<std::unique_ptr<MeshInSpace>> meshes_;
};

}  // namespace

RankWorkers::RankWorkers(Communicator& ranks, const TileSetting& setting) : TileWorkers(setting), ranks_(ranks) {}

void RankWorkers::limit_memory(std::uint64_t bytes) {
  CompactWriter message = command(Command::LimitMemory);
  message.number(bytes);
  tell(ranks_, message);
}

MeshFile RankWorkers::read(const std::string& path, const StopToken& stop, MeshInSpace& into,
                           const FileWindow::Reader& reader) {
  CompactWriter message = command(Command::Read);
  message.text(path);
  message.text(setting_.scratch);
  tell(ranks_, message);
  MeshFile file = read_together(ranks_, path, stop, into, reader);
  kept_[&into] = shared_++;
  return file;
}

/// Sends a mesh that the others neither have read nor have as a result. They keep it until the end.
std::uint64_t RankWorkers::share(const StoredMesh& stored) {
  const TriangleMesh mesh = loaded(stored);
  if (checksum_of(mesh) == checksum_of_result_) return number_of_result_;
  CompactWriter message = command(Command::Take);
  message.text(setting_.scratch);
  pack(message, mesh);
  tell(ranks_, message);
  return shared_++;
}

std::uint64_t RankWorkers::number_of(const StoredMesh& mesh) {
  const auto kept = kept_.find(&mesh);
  return kept != kept_.end() ? kept->second : share(mesh);
}

SimplifyResult RankWorkers::decimate(const StoredMesh& original, const SimplifyOptions& options) {
  CompactWriter message = command(Command::Decimate);
  pack(message, options);
  message.text(setting_.driver);
  message.text(setting_.cost);
  message.number(setting_.tiles.max_triangles);
  message.number(number_of(original));
  message.text(setting_.scratch);
  message.text(
      open_tile_scratch(original, options, ranks_.size() > 1 ? ScratchOwner::FirstRank : ScratchOwner::ThisProcess));
  tell(ranks_, message);
  return together(ranks_, [&] {
    auto [result, reused] = decimate_together(ranks_, original, options, setting_.tiles, tile_scratch_);
    ranks_.do_together([&] { checksum_of_result_ = checksum_of(result.last().mesh); });
    number_of_result_ = shared_++;
    reused_tiles_ += reused;
    return std::move(result);
  });
}

void RankWorkers::write(AtomicFile& file, const std::filesystem::path& path, const TriangleMesh& mesh,
                        const WriteOptions& options) {
  if (!is_written_in_shares(path, options) || checksum_of(mesh) != checksum_of_result_)
    return TileWorkers::write(file, path, mesh, options);
  CompactWriter message = command(Command::Write);
  message.text(path.string());
  message.text(setting_.scratch);
  message.raw(options.single_precision);
  message.number(number_of_result_);
  tell(ranks_, message);
  together(ranks_, [&] {
    TriangleMesh rounded;
    ranks_.do_together([&] { rounded = rounded_for(path, mesh, options); });
    mpi::write_mesh(ranks_, &file, path, rounded, options);
    ranks_.do_together([&] { checksum_of_result_ = checksum_of(rounded); });
  });
}

HausdorffDistance RankWorkers::measure(const StoredMesh& a, const StoredMesh& b, const DistanceOptions& options) {
  tell_measurement(Command::Measure, a, b, options);
  RankRunner runner(ranks_, options.threads);
  return together(ranks_, [&] { return measure_in_tiles(a, b, options, setting_.tiles, runner); });
}

OneSidedDistance RankWorkers::measure_one_side(const StoredMesh& a, const StoredMesh& b,
                                               const DistanceOptions& options) {
  tell_measurement(Command::MeasureOneSide, a, b, options);
  RankRunner runner(ranks_, options.threads);
  return together(ranks_, [&] { return measure_one_side_in_tiles(a, b, options, setting_.tiles, runner); });
}

void RankWorkers::tell_measurement(Command which, const StoredMesh& a, const StoredMesh& b,
                                   const DistanceOptions& options) {
  const std::uint64_t number_of_a = number_of(a), number_of_b = number_of(b);
  CompactWriter message = command(which);
  pack(message, options);
  message.number(setting_.tiles.max_triangles);
  message.number(number_of_a);
  message.number(number_of_b);
  tell(ranks_, message);
}

std::optional<Certificate> RankWorkers::certify(const StoredMesh& original, const StoredMesh& simplified,
                                                double tolerance, const CertificateOptions& options) {
  const std::uint64_t number_of_original = number_of(original), number_of_simplified = number_of(simplified);
  CompactWriter message = command(Command::Certify);
  message.raw(options.threads);
  message.raw(options.seconds);
  message.raw(tolerance);
  message.number(setting_.tiles.max_triangles);
  message.number(number_of_original);
  message.number(number_of_simplified);
  tell(ranks_, message);
  RankRunner runner(ranks_, options.threads);
  return together(ranks_,
                  [&] { return certify_in_tiles(original, simplified, tolerance, options, setting_.tiles, runner); });
}

std::optional<CommunicationReport> RankWorkers::communication() {
  CompactWriter message = command(Command::Count);
  tell(ranks_, message);
  return together(ranks_, [&] { return CommunicationReport{ranks_.size(), 0, ranks_.sum(ranks_.bytes_sent())}; });
}

int serve(Communicator& ranks) { return Follower(ranks).run(); }

void dismiss(Communicator& ranks, int exit_code) {
  CompactWriter message = command(Command::End);
  message.number(static_cast<std::uint64_t>(exit_code));
  tell(ranks, message);
}

bool has_lost_step() { return lost_step; }

}  // namespace meshbound::tools
