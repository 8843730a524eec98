// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace meshbound::tools {

/// What is known of an asset after its run: one line of a report, one row of the table.
struct AssetRecord {
  std::string input;            ///< its name below the folder of the batch
  std::string key;              ///< SHA-256 of its content, the options and the version: equal keys have equal results
  std::string status;           ///< "within", "exceeds", "undecided", "failed"
  std::string message;          ///< the last line of standard error
  std::string output_checksum;  ///< SHA-256 of the result; empty where there is none
  int exit_code = -1;           ///< -1: ended from outside
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_memory = 0;            ///< bytes
  nlohmann::ordered_json result = nullptr;  ///< the document of the tool; null where there is none

  [[nodiscard]] std::string to_line() const;  ///< JSON with the line's end
  /// Throws `nlohmann::json::exception` where the text is no such line.
  [[nodiscard]] static AssetRecord of_line(const std::string& line);
};

/// The last record of each asset in all reports (batch*.jsonl) of a folder, by name. A line that is torn, as the last
/// one of a process that was killed may be, counts as none. Throws `IoError` for a file that cannot be read.
[[nodiscard]] std::map<std::string, AssetRecord> read_records(const std::filesystem::path& folder);

/// A report that grows by a line for each asset, whole and on disk as soon as it is written.
class RecordFile {
 public:
  /// Opens the file or makes it, and puts an end to a torn last line. Throws `IoError`, also where another run holds
  /// it.
  explicit RecordFile(std::filesystem::path path);
  ~RecordFile();
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;

  void add(const AssetRecord& record);  ///< throws `IoError`

 private:
  void append(const std::string& text);

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace meshbound::tools
