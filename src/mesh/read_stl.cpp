// SPDX-License-Identifier: MIT
// STL (http://www.fabbers.com/tech/STL_Format): text with any number of solids, or an 80-byte header, a count and 50
// bytes a triangle. The size tells them apart: binary headers that start with "solid" are common.
#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh/mesh_assembler.h"
#include "mesh/readers.h"
#include "mesh/stl_layout.h"
#include "mesh/text_cursor.h"
#include "mesh/weld.h"
#include "mesh/written_name.h"
#include "meshbound/triangle_mesh.h"
#include "numeric/byte_order.h"

namespace meshbound {
namespace {

constexpr std::size_t corners_offset = 12, attribute_offset = 48;  // bytes, in a record

bool equal_ignoring_case(std::string_view word, std::string_view lower_case) {
  return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
}

/// The vertices of a soup of corners, welded as they arrive.
class WeldedCorners {
 public:
  explicit WeldedCorners(MeshAssembler& assembler) : assembler_(assembler) {}

  std::uint32_t add(const Eigen::Vector3d& p, std::size_t offset) {
    const std::uint32_t index = welder_.index_of(p);
    if (index == assembler_.vertex_count()) assembler_.add_vertex(p, offset);
    return index;
  }

 private:
  MeshAssembler& assembler_;
  Welder welder_;
};

class StlTextReader {
 public:
  explicit StlTextReader(const MeshSource& source)
      : cursor_(source),
        assembler_(source, Position::Line),
        corners_(assembler_),
        bytes_(source.bytes),
        takes_names_(source.with_attributes && source.sink == nullptr) {}

  MeshFile read() {
    bool in_solid = false;
    while (cursor_.find_word()) {
      const std::string_view word = cursor_.peek_word();
      if (equal_ignoring_case(word, in_solid ? "endsolid" : "solid")) {
        in_solid = !in_solid;
        const std::string name = name_of_solid();
        if (in_solid) begin_solid(name);
      } else if (in_solid && equal_ignoring_case(word, "facet")) {
        read_facet();
      } else {
        cursor_.fail_expected(in_solid ? "'facet' or 'endsolid'" : "'solid'");
      }
    }
    if (in_solid) cursor_.fail("the file ends before 'endsolid'");
    const bool has_groups = solids_ > 1 || !first_name_.empty();
    if (has_groups && !takes_names_) assembler_.dropped().groups = solids_;
    MeshFile file = assembler_.finish();
    if (has_groups && takes_names_) file.attributes.groups = std::move(groups_);
    return file;
  }

 private:
  void read_facet() {
    expect("facet");
    expect("normal");
    for (int i = 0; i < 3; ++i) next_word("a normal");  // not used, and some writers print "-nan(ind)"
    expect("outer");
    expect("loop");
    polygon_.clear();
    while (!equal_ignoring_case(next_word("'vertex' or 'endloop'"), "endloop")) {
      cursor_.seek(word_);
      expect("vertex");
      const double x = read_coordinate();
      const double y = read_coordinate();
      const double z = read_coordinate();
      polygon_.push_back(corners_.add({x, y, z}, word_));
    }
    expect("endfacet");
    assembler_.add_polygon(polygon_);
    if (takes_names_) groups_.index.resize(assembler_.triangle_count(), number_);
  }

  /// Reads 'solid' or 'endsolid' and the rest of its line: any words, which no backslash joins with the next line.
  std::string name_of_solid() {
    cursor_.word();
    const std::size_t from = cursor_.offset();
    cursor_.skip_line();
    std::string_view name = bytes_.substr(from, cursor_.offset() - from);
    constexpr std::string_view blanks = " \t\v\f\r\n";
    name.remove_prefix(std::min(name.find_first_not_of(blanks), name.size()));
    name = name.substr(0, name.find_last_not_of(blanks) + 1);
    return name == name_of_unnamed_solid ? std::string() : std::string(name);
  }

  void begin_solid(const std::string& name) {
    if (++solids_ == 1) first_name_ = name;
    if (!takes_names_) return;
    const auto [at, is_new] = number_of_.try_emplace(name, static_cast<std::uint32_t>(groups_.names.size()));
    if (is_new) groups_.names.push_back(name);
    number_ = at->second;
  }

  double read_coordinate() {
    if (!cursor_.find_word()) cursor_.fail_expected("a vertex coordinate");
    return cursor_.number("a vertex coordinate");
  }

  std::string_view next_word(const char* what) {
    if (!cursor_.find_word()) cursor_.fail_expected(what);
    word_ = cursor_.offset();
    return cursor_.word();
  }

  void expect(const char* keyword) {
    if (equal_ignoring_case(next_word(keyword), keyword)) return;
    cursor_.seek(word_);
    cursor_.fail_expected(keyword);
  }

  TextCursor cursor_;
  MeshAssembler assembler_;
  WeldedCorners corners_;
  std::vector<std::uint32_t> polygon_;
  std::string_view bytes_;
  bool takes_names_;
  std::size_t solids_ = 0;
  std::string first_name_;
  TriangleLabels groups_;  // the solids
  std::unordered_map<std::string, std::uint32_t> number_of_;
  std::uint32_t number_ = 0;  // of the solid at hand
  std::size_t word_ = 0;      // where the last word starts
};

std::size_t declared_triangles(std::string_view start) {
  return load_number<std::uint32_t>(start.data() + stl_count_offset, std::endian::little);
}

Eigen::Vector3d corner_at(const char* at) {
  const auto coordinate = [at](std::size_t k) {
    return load_number<float>(at + k * sizeof(float), std::endian::little);
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

void read_records(const MeshSource& source, const FileShare& share, MeshAssembler& assembler) {
  WeldedCorners corners(assembler);
  const std::size_t count = declared_triangles(source.bytes), end = share.end(count);
  assembler.reserve(share.size(count) / 2, share.size(count));  // a closed surface has half as many vertices
  for (std::size_t i = share.begin(count); i < end; ++i) {
    Triangle triangle;
    const char* const record = source.at(stl_records_offset + i * stl_record_size, stl_record_size).data();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t offset_in_record = corners_offset + k * 3 * sizeof(float);
      const std::size_t offset = stl_records_offset + i * stl_record_size + offset_in_record;
      const Eigen::Vector3d p = corner_at(record + offset_in_record);
      if (assembler.vertex_count() == std::numeric_limits<std::uint32_t>::max())
        source.fail_at_byte(offset, "more than 2^32-1 vertices");
      triangle[k] = corners.add(p, offset);
    }
    assembler.add_polygon(triangle);
    if (load_number<std::uint16_t>(record + attribute_offset, std::endian::little) != 0)
      ++assembler.dropped().facet_attributes;
  }
}

MeshFile read_binary(const MeshSource& source) {
  MeshAssembler assembler(source, Position::Byte);
  read_records(source, {}, assembler);
  return assembler.finish();
}

bool starts_with_solid(const MeshSource& source) {
  TextCursor cursor(source);
  return cursor.find_word() && equal_ignoring_case(cursor.peek_word(), "solid");
}

}  // namespace

/// The size must be what the count asks for. Fewer bytes than a record may follow, as they cannot hold a triangle. In a
/// text file the four bytes of the count are characters, which would ask for 25 GB at least.
bool is_binary_stl(std::string_view start, std::size_t size) {
  if (size < stl_records_offset) return false;
  return (size - stl_records_offset) / stl_record_size == declared_triangles(start);
}

MeshFile read_stl(const MeshSource& source) {
  if (is_binary_stl(source.bytes, source.size())) return read_binary(source);
  if (is_utf16(source.bytes)) source.fail_at_byte(0, "the text is UTF-16; save it as ASCII or UTF-8");
  MeshSource text = source;
  if (text.bytes.starts_with("\xEF\xBB\xBF")) text.begin = 3;
  const bool has_zero_byte = source.bytes.substr(0, stl_records_offset).find('\0') != std::string_view::npos;
  if (starts_with_solid(text) && !has_zero_byte) return StlTextReader(text).read();
  if (source.bytes.size() < stl_records_offset)
    source.fail_at_byte(source.bytes.size(),
                        "the file is neither text that starts with 'solid' nor long enough for the " +
                            std::to_string(stl_records_offset) + " bytes that a binary STL starts with");
  const std::size_t count = declared_triangles(source.bytes);
  source.fail_at_byte(stl_count_offset, "the header declares " + std::to_string(count) + " triangles, which take " +
                                            std::to_string(stl_records_offset + count * stl_record_size) +
                                            " bytes, but the file has " + std::to_string(source.bytes.size()));
}

std::optional<MeshCounts> stl_counts(const MeshSource& source) {
  if (!is_binary_stl(source.bytes, source.size())) return std::nullopt;
  return MeshCounts{std::nullopt, declared_triangles(source.bytes)};
}

std::optional<MeshFile> read_stl_share(const MeshSource& source, const FileShare& share) {
  MeshAssembler assembler(source, Position::Byte);
  read_records(source, share, assembler);
  return assembler.finish_share();
}

}  // namespace meshbound
