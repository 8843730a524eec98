// SPDX-License-Identifier: MIT
#include "common/affine_argument.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "meshbound/error.h"

namespace meshbound::tools {
namespace {

constexpr const char* separators = " \t\r\n,;";

/// The numbers of a list; nothing when some word is not a finite number.
std::optional<std::vector<double>> numbers(const std::string& text) {
  std::vector<double> result;
  for (std::size_t at = text.find_first_not_of(separators); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    const std::size_t first = text[at] == '+' ? at + 1 : at;
    double value = 0;
    const auto [rest, error] = std::from_chars(text.data() + first, text.data() + end, value);
    if (error != std::errc{} || rest != text.data() + end || !std::isfinite(value)) return std::nullopt;
    result.push_back(value);
    at = text.find_first_not_of(separators, end);
  }
  return result;
}

std::string content(const std::string& option, const std::string& path) {
  // 16 numbers fit many times over; what is larger was named by mistake.
  constexpr std::streamsize largest_file = 65536;
  std::ifstream file(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(largest_file), '\0');
  if (!file || std::filesystem::is_directory(path)) throw IoError(option + ": cannot read " + path);
  file.read(text.data(), largest_file);
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

AffineMap affine_of(const std::string& where, const std::optional<std::vector<double>>& entries, const char* advice) {
  if (!entries || entries->size() != 16)
    throw InvalidInput(where + ": expected 16 finite numbers in row-major order" +
                       (entries ? ", got " + std::to_string(entries->size()) : "") + advice);
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(entries->data());
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw InvalidInput(where + ": the last four of the 16 numbers must be 0 0 0 1 (row-major order)");
  return AffineMap(matrix);
}

}  // namespace

AffineMap parse_affine(const std::string& option, const std::string& numbers_or_file) {
  std::optional<std::vector<double>> entries = numbers(numbers_or_file);
  if (!entries) entries = numbers(content(option, numbers_or_file));
  return affine_of(option, entries, "; give them in quotes or name a file that holds them");
}

AffineMap parse_affine_numbers(const std::string& where, const std::string& text) {
  return affine_of(where, numbers(text), "");
}

}  // namespace meshbound::tools
