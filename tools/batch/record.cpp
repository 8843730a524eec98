// SPDX-License-Identifier: MIT
#include "batch/record.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "meshbound/error.h"

namespace meshbound::tools {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// "2026-11-30T19:02:03.123Z": of texts of this form the later one compares greater.
std::string utc_now() {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto second = std::chrono::floor<std::chrono::seconds>(now);
  const std::time_t time = std::chrono::system_clock::to_time_t(second);
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  std::array<char, 32> text{};
  const std::string whole(text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S.", &parts));
  const std::string thousandths = std::to_string(1000 + (now - second).count());
  return whole + thousandths.substr(1) + 'Z';
}

}  // namespace

std::string AssetRecord::to_line() const {
  const Json line = {{"schema", "meshbound/batch/1"},
                     {"input", input},
                     {"key", key},
                     {"recorded", recorded},
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
  record.recorded = line.value("recorded", "");
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

RecordHistory read_records(const fs::path& folder) {
  std::vector<fs::path> reports;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".jsonl" && entry.path().filename().string().starts_with("batch"))
      reports.push_back(entry.path());
  std::sort(reports.begin(), reports.end());
  RecordHistory history;
  for (const fs::path& path : reports) {
    std::ifstream file(path);
    if (!file) throw IoError("cannot read " + path.string());
    for (std::string line; std::getline(file, line);) {
      try {
        AssetRecord record = AssetRecord::of_line(line);
        history[record.input].push_back(std::move(record));
      } catch (const Json::exception&) {
        continue;
      }
    }
  }
  for (auto& [name, records] : history)
    std::stable_sort(records.begin(), records.end(),
                     [](const AssetRecord& a, const AssetRecord& b) { return a.recorded < b.recorded; });
  return history;
}

std::map<std::string, AssetRecord> newest_records(RecordHistory history) {
  std::map<std::string, AssetRecord> newest;
  for (auto& [name, records] : history) newest.emplace(name, std::move(records.back()));
  return newest;
}

RecordFile::RecordFile(fs::path path)
    : path_(std::move(path)), file_(::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (!file_.is_open()) throw IoError("cannot write to " + path_.string() + ": " + std::strerror(errno));
  if (::flock(file_.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw IoError(path_.string() + ": another run writes to it; wait for that, or take another --output-dir");
  char last = '\n';
  if (const off_t size = ::lseek(file_.number(), 0, SEEK_END);
      size > 0 && ::pread(file_.number(), &last, 1, size - 1) == 1 && last != '\n')
    append("\n");
}

void RecordFile::add(AssetRecord record) {
  record.recorded = utc_now();
  append(record.to_line());
}

void RecordFile::append(const std::string& text) {
  const auto fail = [this] { throw IoError("cannot write to " + path_.string() + ": " + std::strerror(errno)); };
  for (std::string_view left = text; !left.empty();) {
    const ssize_t written = ::write(file_.number(), left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail();
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fdatasync(file_.number()) != 0) fail();
}

}  // namespace meshbound::tools
