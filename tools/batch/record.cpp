// SPDX-License-Identifier: MIT
#include "batch/record.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>
#include <vector>

#include "meshbound/error.h"

namespace meshbound::tools {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string AssetRecord::to_line() const {
  const Json line = {{"schema", "meshbound/batch/1"},
                     {"input", input},
                     {"key", key},
                     {"status", status},
                     {"message", message},
                     {"exit_code", exit_code},
                     {"output_sha256", output_checksum},
                     {"seconds", seconds},
                     {"cpu_seconds", cpu_seconds},
                     {"peak_memory_bytes", peak_memory},
                     {"result", result}};
  return line.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

AssetRecord AssetRecord::of_line(const std::string& text) {
  const Json line = Json::parse(text);
  AssetRecord record;
  line.at("input").get_to(record.input);
  line.at("key").get_to(record.key);
  line.at("status").get_to(record.status);
  line.at("message").get_to(record.message);
  line.at("exit_code").get_to(record.exit_code);
  line.at("output_sha256").get_to(record.output_checksum);
  line.at("seconds").get_to(record.seconds);
  line.at("cpu_seconds").get_to(record.cpu_seconds);
  line.at("peak_memory_bytes").get_to(record.peak_memory);
  record.result = line.at("result");
  return record;
}

std::map<std::string, AssetRecord> read_records(const fs::path& folder) {
  std::vector<fs::path> reports;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".jsonl" && entry.path().filename().string().starts_with("batch"))
      reports.push_back(entry.path());
  std::sort(reports.begin(), reports.end());
  std::map<std::string, AssetRecord> records;
  for (const fs::path& path : reports) {
    std::ifstream file(path);
    if (!file) throw IoError("cannot read " + path.string());
    for (std::string line; std::getline(file, line);) {
      try {
        AssetRecord record = AssetRecord::of_line(line);
        records.insert_or_assign(record.input, std::move(record));
      } catch (const Json::exception&) {
        continue;
      }
    }
  }
  return records;
}

RecordFile::RecordFile(fs::path path)
    : path_(std::move(path)), file_(::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (file_ < 0) throw IoError("cannot write to " + path_.string() + ": " + std::strerror(errno));
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(file_);
    throw IoError(path_.string() + ": another run writes to it; wait for that, or take another --output-dir");
  }
  char last = '\n';
  if (const off_t size = ::lseek(file_, 0, SEEK_END);
      size > 0 && ::pread(file_, &last, 1, size - 1) == 1 && last != '\n')
    append("\n");
}

RecordFile::~RecordFile() { ::close(file_); }

void RecordFile::add(const AssetRecord& record) { append(record.to_line()); }

void RecordFile::append(const std::string& text) {
  if (::write(file_, text.data(), text.size()) != static_cast<ssize_t>(text.size()) || ::fdatasync(file_) != 0)
    throw IoError("cannot write to " + path_.string() + ": " + std::strerror(errno));
}

}  // namespace meshbound::tools
