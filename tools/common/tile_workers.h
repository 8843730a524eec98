// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "meshbound/distance.h"
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

/// Who works on the tiles of meshes: this process alone, or all ranks of a parallel run. Called from one thread.
class TileWorkers {
 public:
  TileWorkers() = default;
  TileWorkers(const TileWorkers&) = delete;
  TileWorkers& operator=(const TileWorkers&) = delete;
  virtual ~TileWorkers() = default;

  /// The bytes of a mesh file where it is these workers who read it; absent: read it here. Throws as `FileBytes`.
  [[nodiscard]] virtual std::optional<std::string> read(const std::string& path, const StopToken& stop) = 0;
  /// The mesh of the file that was read last stands here from now on, as it was read.
  virtual void keep(const TriangleMesh& mesh) = 0;

  /// As `decimate_in_tiles`; `original` has been given to `keep`.
  [[nodiscard]] virtual SimplifyResult decimate(const TriangleMesh& original, const SimplifyOptions& options) = 0;
  /// As `hausdorff_distance_in_tiles`.
  [[nodiscard]] virtual HausdorffDistance measure(const TriangleMesh& a, const TriangleMesh& b,
                                                  const DistanceOptions& options) = 0;
  /// As `one_sided_hausdorff_distance_in_tiles`.
  [[nodiscard]] virtual OneSidedDistance measure_one_side(const TriangleMesh& a, const TriangleMesh& b,
                                                          const DistanceOptions& options) = 0;

  /// Tiles whose results the decimations so far took from the scratch folder.
  [[nodiscard]] std::size_t reused_tiles() const { return reused_tiles_; }

  /// What they have told one another so far; absent for one process.
  [[nodiscard]] virtual std::optional<CommunicationReport> communication() = 0;

 protected:
  std::size_t reused_tiles_ = 0;
};

/// The threads of this process.
class LocalTileWorkers : public TileWorkers {
 public:
  explicit LocalTileWorkers(const TileSetting& setting) : setting_(setting) {}
  [[nodiscard]] std::optional<std::string> read(const std::string&, const StopToken&) override { return std::nullopt; }
  void keep(const TriangleMesh&) override {}
  [[nodiscard]] SimplifyResult decimate(const TriangleMesh& original, const SimplifyOptions& options) override;
  [[nodiscard]] HausdorffDistance measure(const TriangleMesh& a, const TriangleMesh& b,
                                          const DistanceOptions& options) override;
  [[nodiscard]] OneSidedDistance measure_one_side(const TriangleMesh& a, const TriangleMesh& b,
                                                  const DistanceOptions& options) override;
  [[nodiscard]] std::optional<CommunicationReport> communication() override { return std::nullopt; }

 private:
  TileSetting setting_;
};

}  // namespace meshbound::tools
