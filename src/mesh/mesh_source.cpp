// SPDX-License-Identifier: MIT
#include "mesh/mesh_source.h"

#include <algorithm>

#include "mesh/file_stop.h"
#include "meshbound/error.h"

namespace meshbound {
namespace {

/// Lines end with LF, CR LF, or CR alone (as TextCursor sees them).
std::size_t line_number(std::string_view bytes, std::size_t offset) {
  std::size_t line = 1;
  for (std::size_t i = 0; i < std::min(offset, bytes.size()); ++i) {
    const bool lone_cr = bytes[i] == '\r' && (i + 1 == bytes.size() || bytes[i + 1] != '\n');
    if (bytes[i] == '\n' || lone_cr) ++line;
  }
  return line;
}

}  // namespace

void MeshSource::end_if_stopped() const { meshbound::end_if_stopped(stop, path, "read"); }

void MeshSource::fail_at_line(std::size_t offset, const std::string& defect) const {
  fail("line " + std::to_string(line_number(bytes, offset)) + ": " + defect);
}

void MeshSource::fail_at_byte(std::size_t offset, const std::string& defect) const {
  fail("byte " + std::to_string(offset) + ": " + defect);
}

void MeshSource::fail(const std::string& defect) const { throw InvalidInput(path.string() + ": " + defect); }

bool is_utf16(std::string_view bytes) {
  if (bytes.size() < 2) return false;
  return bytes.starts_with("\xFE\xFF") || bytes.starts_with("\xFF\xFE") || (bytes[0] == '\0') != (bytes[1] == '\0');
}

std::string quote(std::string_view text) {
  constexpr std::size_t longest = 40;  // characters: enough to recognise a word by
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += (c >= ' ' && c <= '~') ? c : '?';
  return result + (text.size() > longest ? "...'" : "'");
}

}  // namespace meshbound
