// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "common/output_folder.h"
#include "common/tile_scratch.h"
#include "mesh/atomic_file.h"
#include "mesh/readers.h"
#include "mesh/stored_mesh.h"
#include "meshbound/certificate.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/report.h"
#include "meshbound/simplify.h"
#include "meshbound/stop_token.h"
#include "meshbound/tiles.h"

namespace meshbound::tools {

/// What tiles are cut and simplified by, beside the options of the library.
struct TileSetting {
  TileOptions tiles;
  std::string driver = "core", cost = "garland-heckbert";  ///< as typed
  std::string scratch = {};  ///< folder for results of finished tiles; empty: they are kept in memory alone
  bool resumes = false;      ///< goes on from what an earlier run left there
};

/// Where meshes are kept beside the tiles in work: the folder of `scratch`, or the one for temporary files ($TMPDIR,
/// else /var/tmp). Throws `IoError` where there is no such folder and none can be made.
[[nodiscard]] StoreSpace space_of(const TileSetting& setting);

/// Who works on the tiles of meshes: this process alone, or all ranks of a parallel run. Called from one thread.
class TileWorkers {
 public:
  /// Makes the folder of `scratch`, which is removed at the end if it is empty then. Throws as `space_of`.
  explicit TileWorkers(const TileSetting& setting);
  TileWorkers(const TileWorkers&) = delete;
  TileWorkers& operator=(const TileWorkers&) = delete;
  virtual ~TileWorkers() = default;

  /// As `read_mesh_into`; `into` must outlive this.
  [[nodiscard]] virtual MeshFile read(const std::string& path, const StopToken& stop, MeshInSpace& into,
                                      const FileWindow::Reader& reader) = 0;
  /// Writes the mesh into a file that the caller commits.
  virtual void write(AtomicFile& file, const std::filesystem::path& path, const TriangleMesh& mesh,
                     const WriteOptions& options);
  /// Where meshes are to be kept for these workers.
  [[nodiscard]] const StoreSpace& space() const { return space_; }

  /// As `decimate_in_tiles`.
  [[nodiscard]] virtual SimplifyResult decimate(const StoredMesh& original, const SimplifyOptions& options) = 0;
  /// As `hausdorff_distance_in_tiles`.
  [[nodiscard]] virtual HausdorffDistance measure(const StoredMesh& a, const StoredMesh& b,
                                                  const DistanceOptions& options) = 0;
  /// As `one_sided_hausdorff_distance_in_tiles`.
  [[nodiscard]] virtual OneSidedDistance measure_one_side(const StoredMesh& a, const StoredMesh& b,
                                                          const DistanceOptions& options) = 0;

  /// As `certify_in_tiles`.
  [[nodiscard]] virtual std::optional<Certificate> certify(const StoredMesh& original, const StoredMesh& simplified,
                                                           double tolerance, const CertificateOptions& options) = 0;

  /// For a run that ends as there is no room for what it writes: the results of tiles stay in the scratch folder, and a
  /// later run goes on from them.
  void keep_tiles() {
    if (tile_scratch_) tile_scratch_->keep();
  }
  /// Removes the results of tiles from the scratch folder. Else the destructor does: they are of use as long as the
  /// result does not stand.
  void drop_tiles() { tile_scratch_.reset(); }

  /// Tiles whose results the decimations so far took from the scratch folder.
  [[nodiscard]] std::size_t reused_tiles() const { return reused_tiles_; }

  /// What they have told one another so far; absent for one process.
  [[nodiscard]] virtual std::optional<CommunicationReport> communication() = 0;

 private:
  std::optional<OutputFolder> scratch_folder_;
  StoreSpace space_;

 protected:
  /// Opens the scratch folder of the tiles of a decimation, if the setting names one, and returns its key; else empty.
  std::string open_tile_scratch(const StoredMesh& original, const SimplifyOptions& options, ScratchOwner owner);

  TileSetting setting_;
  std::optional<TileScratch> tile_scratch_;  ///< of the last decimation; in the folder above, so it goes before that
  std::size_t reused_tiles_ = 0;
};

/// The threads of this process.
class LocalTileWorkers : public TileWorkers {
 public:
  using TileWorkers::TileWorkers;
  [[nodiscard]] MeshFile read(const std::string& path, const StopToken& stop, MeshInSpace& into,
                              const FileWindow::Reader& reader) override;
  [[nodiscard]] SimplifyResult decimate(const StoredMesh& original, const SimplifyOptions& options) override;
  [[nodiscard]] HausdorffDistance measure(const StoredMesh& a, const StoredMesh& b,
                                          const DistanceOptions& options) override;
  [[nodiscard]] OneSidedDistance measure_one_side(const StoredMesh& a, const StoredMesh& b,
                                                  const DistanceOptions& options) override;
  [[nodiscard]] std::optional<Certificate> certify(const StoredMesh& original, const StoredMesh& simplified,
                                                   double tolerance, const CertificateOptions& options) override;
  [[nodiscard]] std::optional<CommunicationReport> communication() override { return std::nullopt; }
};

}  // namespace meshbound::tools
