// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace meshbound::bench {

/// `value` with `digits` significant ones; "-" for what is not a number.
[[nodiscard]] std::string format(double value, int digits = 3);

/// Rows of text under a header.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  /// Writes one line about the machine, starting with '#', then the table separated by commas, where a cell "-" is
  /// empty. Throws `std::runtime_error` when the file cannot be written.
  void write_csv(const std::filesystem::path& path, const std::string& machine) const;
  [[nodiscard]] std::string markdown() const;
};

/// Throws `std::runtime_error` when the file cannot be written.
void write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace meshbound::bench
