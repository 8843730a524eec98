// SPDX-License-Identifier: MIT
#pragma once
#include <map>
#include <optional>
#include <string>

#include "common/tile_workers.h"
#include "mpi/communicator.h"

namespace meshbound::tools {

/// Rank 0 of a parallel run: tells the others, which are in `serve`, what all do together.
class RankWorkers : public TileWorkers {
 public:
  /// `ranks` must outlive this.
  RankWorkers(mpi::Communicator& ranks, const TileSetting& setting);

  /// Limits the memory of the others as `tools::limit_memory` does.
  void limit_memory(std::uint64_t bytes);

  [[nodiscard]] MeshFile read(const std::string& path, const StopToken& stop, MeshInSpace& into,
                              const FileWindow::Reader& reader) override;
  /// The other ranks of this machine write with this one what is the last result, in formats that allow it.
  void write(AtomicFile& file, const std::filesystem::path& path, const TriangleMesh& mesh,
             const WriteOptions& options) override;
  [[nodiscard]] SimplifyResult decimate(const StoredMesh& original, const SimplifyOptions& options) override;
  [[nodiscard]] HausdorffDistance measure(const StoredMesh& a, const StoredMesh& b,
                                          const DistanceOptions& options) override;
  [[nodiscard]] OneSidedDistance measure_one_side(const StoredMesh& a, const StoredMesh& b,
                                                  const DistanceOptions& options) override;
  [[nodiscard]] std::optional<Certificate> certify(const StoredMesh& original, const StoredMesh& simplified,
                                                   double tolerance, const CertificateOptions& options) override;
  [[nodiscard]] std::optional<CommunicationReport> communication() override;

  enum class Command : std::uint8_t;

 private:
  [[nodiscard]] std::uint64_t share(const StoredMesh& stored);
  [[nodiscard]] std::uint64_t number_of(const StoredMesh& mesh);
  void tell_measurement(Command which, const StoredMesh& a, const StoredMesh& b, const DistanceOptions& options);

  mpi::Communicator& ranks_;
  std::map<const StoredMesh*, std::uint64_t> kept_;  ///< number that the others know the mesh by
  std::uint64_t shared_ = 0;                         ///< meshes that the others have
  std::string checksum_of_result_;                   ///< of the last decimation, which the others have too
  std::uint64_t number_of_result_ = 0;               ///< that they know it by
};

/// The other ranks: do what rank 0 says until it calls `dismiss`, and return the exit code that it gives.
[[nodiscard]] int serve(mpi::Communicator& ranks);

/// Ends `serve` on the other ranks. To be called by rank 0 unless `has_lost_step`.
void dismiss(mpi::Communicator& ranks, int exit_code);

/// Whether this rank has left something that the others are still at, by an exception that they do not know of: they
/// can only be ended from outside.
[[nodiscard]] bool has_lost_step();

}  // namespace meshbound::tools
