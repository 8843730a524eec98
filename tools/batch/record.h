// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mesh/descriptor.h"

namespace meshbound::tools {

/// The record of an asset after its run: one line of a report, one row of the table.
struct AssetRecord {
  std::string input;            ///< its name below the folder of the batch, as `record_name` has it
  std::string key;              ///< SHA-256 of its content, the options and the version: equal keys have equal results
  std::string status;           ///< "within", "exceeds", "undecided", "failed"
  std::string message;          ///< the last line of standard error
  std::string output_checksum;  ///< SHA-256 of the result; empty where there is none
  int exit_code = -1;           ///< -1: ended from outside
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_memory = 0;            ///< bytes
  nlohmann::ordered_json result = nullptr;  ///< the document of the tool; null where there is none
  std::string
      recorded;  ///< when the line was written, UTC: later texts compare greater; empty in lines of earlier versions

  [[nodiscard]] std::string to_line() const;  ///< JSON with the line's end
  /// Throws `nlohmann::json::exception` for text that is no such line.
  [[nodiscard]] static AssetRecord of_line(const std::string& line);
};

/// All records of each asset, by name, the oldest first.
using RecordHistory = std::map<std::string, std::vector<AssetRecord>>;

/// The records of all reports (batch*.jsonl) of a folder. An incomplete line, such as the last one of a process that
/// was killed, is skipped. Throws `IoError` for a file that cannot be read.
[[nodiscard]] RecordHistory read_records(const std::filesystem::path& folder);

/// The newest record of each asset.
[[nodiscard]] std::map<std::string, AssetRecord> newest_records(RecordHistory history);

/// A report that gets a line for each asset; each line is on disk, complete, when `add` returns.
class RecordFile {
 public:
  /// Opens or makes the file, and ends an incomplete last line. Throws `IoError`, also if another run has the file
  /// open.
  explicit RecordFile(std::filesystem::path path);

  void add(AssetRecord record);  ///< with the time of now; throws `IoError`

 private:
  void append(const std::string& text);

  std::filesystem::path path_;
  Descriptor file_;
};

}  // namespace meshbound::tools
