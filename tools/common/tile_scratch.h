// SPDX-License-Identifier: MIT
#pragma once
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "common/file_lock.h"
#include "mesh/stored_mesh.h"
#include "mesh/temporary_files.h"
#include "meshbound/simplify.h"
#include "meshbound/tiles.h"
#include "tiles/compact_bytes.h"
#include "tiles/tile_jobs.h"

namespace meshbound::tools {

/// Appends those options of a simplification that the results of tiles follow from.
void pack_tile_options(CompactWriter& to, const SimplifyOptions& options);

/// What the results of all tiles of a decimation follow from, as a word: a hash of the original, the options, and the
/// version of the program and of the files.
[[nodiscard]] std::string decimation_key(const StoredMesh& original, const SimplifyOptions& options,
                                         const std::string& driver, const TileOptions& tiles);

/// Which process removes a scratch folder at the end of a run.
enum class ScratchOwner {
  ThisProcess,  ///< the only one that works there: also where a signal ends it
  FirstRank,    ///< this one, the first of several: a signal leaves the folder, as mpirun sends one when a rank dies
  AnotherRank
};

/// Results of finished tiles in a folder, from which a run that was killed is resumed. Each file stands for one tile,
/// is there whole or not at all, and says with a checksum whose result it is: any other file counts as none.
class TileScratch {
 public:
  /// Uses the folder `key` in `folder`, which is made if needed. Unless `resumes`, what an earlier run left there is
  /// removed first. The destructor of its owner removes it, unless `keep` was called, and no other process may own it
  /// meanwhile. Throws `IoError`, also where another one owns it.
  TileScratch(const std::filesystem::path& folder, std::string key, bool resumes, ScratchOwner owner);
  ~TileScratch();
  TileScratch(const TileScratch&) = delete;
  TileScratch& operator=(const TileScratch&) = delete;

  /// Safe to call from several threads, as `store` is.
  [[nodiscard]] std::optional<std::string> load(std::size_t stage, std::size_t job) const;
  /// Throws `IoError`.
  void store(std::size_t stage, std::size_t job, std::string_view bytes);
  /// For a run that ends as there was no room for a result: it can be resumed.
  void keep() { is_kept_ = true; }

 private:
  [[nodiscard]] std::filesystem::path file_of(std::size_t stage, std::size_t job) const;
  [[nodiscard]] std::string checksum_of(std::size_t stage, std::size_t job, std::string_view bytes) const;

  std::filesystem::path folder_;
  std::string key_;
  ScratchOwner owner_;
  bool is_kept_ = false;
  std::optional<FileLock> lock_;  ///< of the owner, beside the folder
  std::mutex mutex_;
  std::deque<TemporaryName> listed_;  ///< what a signal removes: the folder, then the files
};

struct Decimated {
  SimplifyResult result;
  std::size_t reused = 0;  ///< tiles whose results this process took from the scratch folder
};

/// As `decimate_in_tiles`, but takes results of tiles that the scratch folder has, if there is one, and stores those
/// that it has not.
[[nodiscard]] Decimated decimate_in_tiles(const StoredMesh& original, const SimplifyOptions& options,
                                          const TileOptions& tiles, JobRunner& runner,
                                          std::optional<TileScratch>& scratch);

}  // namespace meshbound::tools
