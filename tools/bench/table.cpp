// SPDX-License-Identifier: GPL-3.0-or-later
#include "table.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace meshbound::bench {
namespace {

std::string joined(const std::vector<std::string>& cells, const char* separator) {
  std::string line;
  for (const std::string& cell : cells) line += (&cell == cells.data() ? "" : separator) + cell;
  return line;
}

}  // namespace

std::string format(double value, int digits) {
  if (std::isnan(value)) return "-";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out) throw std::runtime_error("cannot write " + path.string());
}

void Table::write_csv(const std::filesystem::path& path, const std::string& machine) const {
  std::string text = "# " + machine + '\n' + joined(columns, ",") + '\n';
  for (const auto& row : rows) text += joined(row, ",") + '\n';
  write_file(path, text);
}

std::string Table::markdown() const {
  std::string text = "| " + joined(columns, " | ") + " |\n|";
  for (std::size_t i = 0; i < columns.size(); ++i) text += "---|";
  text += '\n';
  for (const auto& row : rows) text += "| " + joined(row, " | ") + " |\n";
  return text;
}

}  // namespace meshbound::bench
