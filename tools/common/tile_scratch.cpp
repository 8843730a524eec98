// SPDX-License-Identifier: MIT
#include "common/tile_scratch.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>
#include <vector>

#include "common/sha256.h"
#include "common/signals.h"
#include "mesh/atomic_file.h"
#include "mesh/file_bytes.h"
#include "meshbound/error.h"
#include "tiles/decimate_in_tiles.h"

namespace meshbound::tools {
namespace {

/// Version of the files in the folder; it must change whenever their bytes, or the results of tiles, change.
constexpr std::string_view format = "meshbound tiles 33 " MESHBOUND_VERSION;

/// Appends the checksums of blocks of `size` items, which read(first, items) reads.
template <class T, class Read>
void add_checksums(CompactWriter& to, std::size_t size, const Read& read) {
  constexpr std::size_t block_size = std::size_t{1} << 18;
  std::vector<T> block;
  for (std::size_t first = 0; first < size; first += block.size()) {
    block.resize(std::min(block_size, size - first));
    read(first, std::span<T>(block));
    to.text(sha256({reinterpret_cast<const char*>(block.data()), block.size() * sizeof(T)}));
  }
}

/// Jobs of which some may be in the folder.
class ScratchJobs : public TileJobs {
 public:
  ScratchJobs(TileJobs& jobs, TileScratch& scratch, std::size_t stage)
      : jobs_(jobs), scratch_(scratch), stage_(stage) {}

  [[nodiscard]] std::size_t size() const override { return jobs_.size(); }
  [[nodiscard]] std::uint64_t weight(std::size_t job) const override { return jobs_.weight(job); }
  void run(std::size_t job) override { (void)run_packed(job); }
  [[nodiscard]] std::string run_packed(std::size_t job) override {
    if (std::optional<std::string> bytes = taken_over(job)) {
      ++reused_;
      return *std::move(bytes);
    }
    std::string bytes = jobs_.run_packed(job);
    if (jobs_.is_complete(job)) scratch_.store(stage_, job, bytes);
    return bytes;
  }
  void unpack(std::size_t job, std::string_view bytes) override { jobs_.unpack(job, bytes); }
  [[nodiscard]] bool is_complete(std::size_t job) const override { return jobs_.is_complete(job); }
  void progress(double share) override { jobs_.progress(share); }
  [[nodiscard]] std::size_t reused() const { return reused_; }

 private:
  /// The result of the folder, unpacked, if there is one.
  std::optional<std::string> taken_over(std::size_t job) {
    std::optional<std::string> bytes = scratch_.load(stage_, job);
    if (!bytes) return std::nullopt;
    try {
      jobs_.unpack(job, *bytes);
    } catch (const InvalidInput&) {
      return std::nullopt;
    }
    return bytes;
  }

  TileJobs& jobs_;
  TileScratch& scratch_;
  std::size_t stage_;
  std::atomic<std::size_t> reused_ = 0;
};

/// Runs jobs by another runner and by way of the folder.
class ScratchRunner : public JobRunner {
 public:
  /// Both must outlive this.
  ScratchRunner(JobRunner& runner, TileScratch& scratch) : runner_(runner), scratch_(scratch) {}
  void run(TileJobs& jobs) override {
    ScratchJobs with_scratch(jobs, scratch_, stage_++);
    runner_.run(with_scratch);
    reused_ += with_scratch.reused();
  }
  [[nodiscard]] bool is_first() const override { return runner_.is_first(); }
  [[nodiscard]] bool any(bool here) override { return runner_.any(here); }
  void do_together(const std::function<void()>& step) override { runner_.do_together(step); }
  [[nodiscard]] std::size_t reused() const { return reused_; }

 private:
  JobRunner& runner_;
  TileScratch& scratch_;
  std::size_t stage_ = 0;  ///< calls of `run`
  std::size_t reused_ = 0;
};

}  // namespace

void pack_tile_options(CompactWriter& to, const SimplifyOptions& options) {
  to.raw(options.tolerance);
  to.raw(options.effort);
  to.raw(options.placements);
  to.raw(options.precision);
  to.raw(options.preserve_boundary);
}

std::string decimation_key(const StoredMesh& original, const SimplifyOptions& options, const std::string& driver,
                           const TileOptions& tiles) {
  CompactWriter bytes;
  bytes.text(format);
  bytes.text(driver);
  bytes.number(tiles.max_triangles);
  pack_tile_options(bytes, options);
  add_checksums<Vec3>(bytes, original.vertex_count(),
                      [&](std::size_t first, std::span<Vec3> to) { original.read_vertices(first, to); });
  add_checksums<Triangle>(bytes, original.triangle_count(),
                          [&](std::size_t first, std::span<Triangle> to) { original.read_triangles(first, to); });
  return sha256(bytes.take());
}

TileScratch::TileScratch(const std::filesystem::path& folder, std::string key, bool resumes, ScratchOwner owner)
    : folder_(folder / ("meshbound-" + key.substr(0, 16))), key_(std::move(key)), owner_(owner) {
  std::error_code error;
  const auto make = [&error](const std::filesystem::path& path) {
    std::filesystem::create_directories(path, error);
    if (error) throw IoError("--scratch: cannot make " + path.string() + ": " + error.message());
  };
  if (owner_ != ScratchOwner::AnotherRank) {
    make(folder);
    lock_.emplace(folder_.string() + ".lock");
    if (!lock_->is_held())
      throw IoError("--scratch: another run of the same mesh and options works in " + folder_.string() +
                    "; wait for it, or name another folder");
  }
  if (!resumes) std::filesystem::remove_all(folder_, error);
  make(folder_);
  if (owner_ == ScratchOwner::ThisProcess) listed_.emplace_back(folder_);
}

TileScratch::~TileScratch() {
  const bool is_left = is_kept_ || (owner_ == ScratchOwner::FirstRank && interrupted());
  if (is_left || owner_ == ScratchOwner::AnotherRank) return;
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path TileScratch::file_of(std::size_t stage, std::size_t job) const {
  return folder_ / (std::to_string(stage) + "-" + std::to_string(job));
}

std::string TileScratch::checksum_of(std::size_t stage, std::size_t job, std::string_view bytes) const {
  return sha256(key_ + " " + std::to_string(stage) + " " + std::to_string(job) + " " + std::string(bytes));
}

std::optional<std::string> TileScratch::load(std::size_t stage, std::size_t job) const {
  try {
    const FileBytes file(file_of(stage, job));
    constexpr std::size_t checksum_size = 64;
    if (file.bytes().size() < checksum_size) return std::nullopt;
    const std::string_view bytes = file.bytes().substr(checksum_size);
    if (file.bytes().substr(0, checksum_size) != checksum_of(stage, job, bytes)) return std::nullopt;
    return std::string(bytes);
  } catch (const IoError&) {
    return std::nullopt;  // it was not finished
  }
}

void TileScratch::store(std::size_t stage, std::size_t job, std::string_view bytes) {
  AtomicFile file(file_of(stage, job));
  file.write(checksum_of(stage, job, bytes));
  file.write(bytes);
  file.commit();
  if (owner_ != ScratchOwner::ThisProcess) return;
  const std::lock_guard lock(mutex_);
  listed_.emplace_front(file_of(stage, job));
}

Decimated decimate_in_tiles(const StoredMesh& original, const SimplifyOptions& options, const TileOptions& tiles,
                            JobRunner& runner, std::optional<TileScratch>& scratch) {
  if (!scratch) return {meshbound::decimate_in_tiles(original, options, tiles, runner), 0};
  ScratchRunner with_scratch(runner, *scratch);
  SimplifyResult result = meshbound::decimate_in_tiles(original, options, tiles, with_scratch);
  return {std::move(result), with_scratch.reused()};
}

}  // namespace meshbound::tools
