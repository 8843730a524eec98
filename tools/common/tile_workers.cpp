// SPDX-License-Identifier: MIT
#include "common/tile_workers.h"

#include <cstdlib>

#include "mesh/writers.h"
#include "meshbound/error.h"
#include "tiles/certificate_in_tiles.h"
#include "tiles/measure_in_tiles.h"

namespace meshbound::tools {

StoreSpace space_of(const TileSetting& setting) {
  if (!setting.scratch.empty()) {
    std::error_code error;
    std::filesystem::create_directories(setting.scratch, error);
    if (error) throw IoError("--scratch: cannot make " + setting.scratch + ": " + error.message());
    return {setting.scratch};
  }
  const char* const folder = std::getenv("TMPDIR");
  return {folder != nullptr && *folder != '\0' ? folder : "/var/tmp"};
}

TileWorkers::TileWorkers(const TileSetting& setting) : setting_(setting) {
  if (!setting.scratch.empty()) scratch_folder_.emplace(setting.scratch);
  space_ = space_of(setting);
}

void TileWorkers::write(AtomicFile& file, const std::filesystem::path& path, const TriangleMesh& mesh,
                        const WriteOptions& options) {
  write_mesh(file, path, mesh, options);
}

std::string TileWorkers::open_tile_scratch(const StoredMesh& original, const SimplifyOptions& options,
                                           ScratchOwner owner) {
  if (setting_.scratch.empty()) return "";
  const std::string key = decimation_key(original, options, setting_.driver + " " + setting_.cost, setting_.tiles);
  tile_scratch_.emplace(setting_.scratch, key, setting_.resumes, owner);
  return key;
}

MeshFile LocalTileWorkers::read(const std::string& path, const StopToken& stop, MeshInSpace& into,
                                const FileWindow::Reader& reader) {
  return read_mesh_into(path, stop, into, reader);
}

SimplifyResult LocalTileWorkers::decimate(const StoredMesh& original, const SimplifyOptions& options) {
  ThreadRunner threads(options.threads);
  open_tile_scratch(original, options, ScratchOwner::ThisProcess);
  auto [result, reused] = decimate_in_tiles(original, options, setting_.tiles, threads, tile_scratch_);
  reused_tiles_ += reused;
  return std::move(result);
}

HausdorffDistance LocalTileWorkers::measure(const StoredMesh& a, const StoredMesh& b, const DistanceOptions& options) {
  ThreadRunner threads(options.threads);
  return measure_in_tiles(a, b, options, setting_.tiles, threads);
}

OneSidedDistance LocalTileWorkers::measure_one_side(const StoredMesh& a, const StoredMesh& b,
                                                    const DistanceOptions& options) {
  ThreadRunner threads(options.threads);
  return measure_one_side_in_tiles(a, b, options, setting_.tiles, threads);
}

std::optional<Certificate> LocalTileWorkers::certify(const StoredMesh& original, const StoredMesh& simplified,
                                                     double tolerance, const CertificateOptions& options) {
  ThreadRunner threads(options.threads);
  return certify_in_tiles(original, simplified, tolerance, options, setting_.tiles, threads);
}

}  // namespace meshbound::tools
