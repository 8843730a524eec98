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

/// A cell of a CSV file: what is not there is empty, and what would be taken for several cells stands in quotes.
std::string csv_cell(const std::string& cell) {
  if (cell == "-") return "";
  if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_line(std::vector<std::string> cells) {
  for (std::string& cell : cells) cell = csv_cell(cell);
  return joined(cells, ",") + '\n';
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
  std::string text = "# " + machine + '\n' + csv_line(columns);
  for (const auto& row : rows) text += csv_line(row);
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
