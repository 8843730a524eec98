// SPDX-License-Identifier: MIT
#include "batch/batch_run.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <thread>
#include <utility>
#include <vector>

#include "batch/assets.h"
#include "batch/child.h"
#include "batch/distinct_results.h"
#include "batch/merge.h"
#include "batch/record.h"
#include "batch/record_name.h"
#include "common/distance_text.h"
#include "common/memory.h"
#include "common/output_folder.h"
#include "common/progress.h"
#include "common/provenance.h"
#include "common/sha256.h"
#include "common/signals.h"
#include "mesh/file_bytes.h"
#include "mesh/gltf_document.h"
#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

namespace fs = std::filesystem;

std::string checksum_of(const fs::path& path) {
  const FileBytes bytes(path);
  return sha256(bytes.bytes(), [] {
    if (interrupted()) throw Error("interrupted");
  });
}

/// "3: 2 within, 0 exceed, 0 undecided, 1 failed"
std::string listed(const BatchCounts& counts) {
  return std::to_string(counts.all()) + ": " + std::to_string(counts.within) + " within, " +
         std::to_string(counts.exceeds) + " exceed, " + std::to_string(counts.undecided) + " undecided, " +
         std::to_string(counts.failed) + " failed";
}

/// One run of the batch, in the order of its phases.
class BatchRun {
 public:
  BatchRun(const BatchOptions& options, const CommonOptions& common, const std::string& output_dir)
      : options_(options),
        common_(common),
        output_dir_(output_dir),
        shard_(parse_shard(options.shard)),
        words_(asset_options(provenance().command)) {
    if (!options.memory_limit.empty()) memory_limit_ = parse_memory("--memory-limit", options.memory_limit);
    if (options.jobs > 0) jobs_ = options.jobs;
  }

  int operator()() {
    const std::vector<Asset> assets = find_assets(options_.source, output_dir_);
    for (std::size_t i = 0; i < assets.size(); ++i)
      if (i % shard_.count == shard_.index) open_.push_back(assets[i]);
    require_distinct_results({options_.source, assets, open_, output_dir_, report_paths()});
    const OutputFolder folder(output_dir_);
    earlier_ = read_records(output_dir_);
    RecordFile report(report_path());
    work(report);
    if (interrupted())
      throw Error("interrupted with " + std::to_string(records_.size()) + " of " + std::to_string(open_.size()) +
                  " meshes done; the same command goes on from there");
    if (options_.shard.empty()) write_tables(output_dir_, records_);
    return conclude();
  }

 private:
  struct Job {
    std::size_t asset;
    AssetRecord record;
    Child child;
  };

  [[nodiscard]] fs::path report_path() const {
    const std::string share =
        options_.shard.empty() ? "" : "_" + std::to_string(shard_.index) + "_of_" + std::to_string(shard_.count);
    return output_dir_ / ("batch" + share + ".jsonl");
  }

  [[nodiscard]] std::vector<fs::path> report_paths() const {
    if (!options_.shard.empty()) return {report_path()};
    return {report_path(), output_dir_ / "batch.csv", output_dir_ / "batch.html"};
  }

  void work(RecordFile& report) {
    ProgressBar bar("simplifying " + std::to_string(open_.size()) + " meshes", common_.quiet);
    std::vector<Job> jobs;
    for (std::size_t next = 0; (next < open_.size() || !jobs.empty()) && !interrupted();) {
      while (next < open_.size() && jobs.size() < static_cast<std::size_t>(jobs_)) begin(next++, report, jobs);
      constexpr std::chrono::milliseconds pause(2);
      if (!end_some(report, jobs)) std::this_thread::sleep_for(pause);
      bar.show(static_cast<double>(records_.size()) / static_cast<double>(open_.size()));
    }
  }

  /// Starts the process of an asset, or takes the result of an earlier run.
  void begin(std::size_t index, RecordFile& report, std::vector<Job>& jobs) {
    const Asset& asset = open_[index];
    AssetRecord record;
    record.input = record_name(asset.name);
    try {
      if (!asset.fault.empty()) throw IoError(asset.fault);
      require_regular(asset.input);
      record.key = key_of(asset);
      if (const AssetRecord* const known = earlier(asset, record)) {
        ++reused_;
        const bool is_newest = known == &earlier_.at(record.input).back();
        if (!is_newest) report.add(*known);  // now it is, for --batch-merge
        records_.emplace(record.input, *known);
        return;
      }
      fs::create_directories((output_dir_ / asset.name).parent_path());
      jobs.push_back({index, record, Child(command_of(asset), memory_limit_, patience())});
    } catch (const std::exception& error) {
      if (interrupted()) return;
      record.status = "failed";
      record.message = error.what();
      add(report, std::move(record));
    }
  }

  void add(RecordFile& report, AssetRecord record) {
    record.message = utf8_text(record.message);
    report.add(record);
    records_.emplace(record.input, std::move(record));
  }

  /// Whether any process has ended.
  bool end_some(RecordFile& report, std::vector<Job>& jobs) {
    bool has_ended = false;
    for (std::size_t i = 0; i < jobs.size();) {
      const auto end = jobs[i].child.poll();
      if (!end) {
        ++i;
        continue;
      }
      has_ended = true;
      if (!interrupted()) {  // otherwise the signal may have ended the process
        fill(*end, jobs[i].asset, jobs[i].record);
        add(report, std::move(jobs[i].record));
      }
      jobs.erase(jobs.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return has_ended;
  }

  /// A FIFO or a device is not even opened: that may wait, or do something to it.
  static void require_regular(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
      throw InvalidInput(path.string() + ": cannot read: it is not a regular file");
  }

  /// A key that is equal for equal content, options, place and version.
  [[nodiscard]] std::string key_of(const Asset& asset) const {
    std::string text = provenance().version + '\n' + checksum_of(asset.input) + '\n' + asset.name + '\n';
    std::error_code error;
    for (const fs::path& beside : files_beside(asset.input))
      text += (fs::is_regular_file(beside, error) ? checksum_of(beside) : "missing") + '\n';
    for (const std::string& word : words_) text += word + '\n';
    return sha256(text);
  }

  /// The newest record by an earlier run with the name and the key of `record` whose result is there unchanged; null if
  /// there is none. Failures have no result: they are tried again.
  [[nodiscard]] const AssetRecord* earlier(const Asset& asset, const AssetRecord& record) const {
    const auto history = earlier_.find(record.input);
    if (history == earlier_.end()) return nullptr;
    const auto is_same = [&](const AssetRecord& known) {
      return known.key == record.key && !known.output_checksum.empty();
    };
    const auto known = std::find_if(history->second.rbegin(), history->second.rend(), is_same);
    if (known == history->second.rend()) return nullptr;
    std::error_code error;
    const fs::path output = output_dir_ / asset.name;
    const bool stands = fs::is_regular_file(output, error) && checksum_of(output) == known->output_checksum;
    return stands ? &*known : nullptr;
  }

  [[nodiscard]] std::vector<std::string> command_of(const Asset& asset) const {
    // The path of this program, wherever it was started from.
    std::vector<std::string> command{fs::read_symlink("/proc/self/exe").string()};
    command.insert(command.end(), words_.begin(), words_.end());
    const int threads = std::max(1, common_.threads / jobs_);
    command.insert(command.end(), {"--threads", std::to_string(threads), "--quiet", "--json", "-"});
    command.insert(command.end(), {"--", asset.input.string(), (output_dir_ / asset.name).string()});
    return command;
  }

  /// Time after which a process is killed: it should end by itself at its own time limit.
  [[nodiscard]] std::chrono::duration<double> patience() const {
    constexpr double least = 30;  // seconds
    return std::chrono::duration<double>(2 * common_.time_limit + least);
  }

  void fill(const ChildEnd& end, std::size_t asset, AssetRecord& record) const {
    record.exit_code = end.exit_code;
    record.seconds = end.seconds;
    record.cpu_seconds = end.cpu_seconds;
    record.peak_memory = end.peak_memory;
    record.message = last_line(end.err);
    record.status = status_of(end.exit_code);
    if (end.was_late)
      record.message = "it did not end by its time limit and was killed";
    else if (end.signal != 0)
      record.message = "ended by signal " + std::to_string(end.signal);
    if (!end.fault.empty()) {
      record.message = end.fault;
      return;
    }
    record.result = nlohmann::ordered_json::parse(end.out, nullptr, false);
    if (record.result.is_discarded()) record.result = nullptr;
    if (record.result.is_null()) return;
    std::error_code error;
    const fs::path output = output_dir_ / open_[asset].name;
    if (record.result["verdict"] == "within" && fs::exists(output, error)) record.output_checksum = checksum_of(output);
  }

  [[nodiscard]] static const char* status_of(int exit_code) {
    switch (exit_code) {
      case ExitDone:
        return "within";
      case ExitExceeds:
        return "exceeds";
      case ExitUndecided:
        return "undecided";
      default:
        return "failed";
    }
  }

  [[nodiscard]] static std::string last_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.rfind('\n') + 1);
  }

  [[nodiscard]] int conclude() const {
    const BatchCounts counts = count_by_status(records_);
    if (!common_.quiet) {
      print_line("meshes", listed(counts) + "; " + std::to_string(reused_) + " from an earlier run");
      for (const auto& [name, record] : records_)
        if (record.status != "within") print_line(record.status, name + ": " + record.message);
      print_line("wrote", report_path().string());
    }
    if (counts.failed > 0) return ExitBadInput;
    if (counts.exceeds > 0) return ExitExceeds;
    return counts.undecided > 0 ? ExitUndecided : ExitDone;
  }

  const BatchOptions& options_;
  const CommonOptions& common_;
  fs::path output_dir_;
  Shard shard_;
  std::vector<std::string> words_;  ///< options of each process that its result depends on
  std::uint64_t memory_limit_ = 0;
  int jobs_ = common_.threads;
  std::vector<Asset> open_;  ///< assets of this shard that are not done
  RecordHistory earlier_;
  std::map<std::string, AssetRecord> records_;
  std::size_t reused_ = 0;
};

int merge(const std::string& folder, const CommonOptions& common) {
  const auto records = newest_records(read_records(folder));
  if (records.empty()) throw InvalidInput("--batch-merge: there is no batch*.jsonl with a record in " + folder);
  write_tables(folder, records);
  const BatchCounts counts = count_by_status(records);
  if (!common.quiet) {
    print_line("meshes", listed(counts));
    print_line("wrote", (fs::path(folder) / "batch.csv").string() + ", batch.html");
  }
  return ExitDone;
}

}  // namespace

int run_batch(const BatchOptions& options, const CommonOptions& common, const std::string& output_dir) {
  if (!options.merge.empty()) return merge(options.merge, common);
  if (output_dir.empty()) throw InvalidInput("--batch: --output-dir is missing: the folder for the results");
  return BatchRun(options, common, output_dir)();
}

}  // namespace meshbound::tools
