// SPDX-License-Identifier: MIT
#include "mesh/ply_header.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "mesh/text_cursor.h"

namespace meshbound {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> names = {{
      {"char", PlyType::Int8},
      {"int8", PlyType::Int8},
      {"uchar", PlyType::UInt8},
      {"uint8", PlyType::UInt8},
      {"short", PlyType::Int16},
      {"int16", PlyType::Int16},
      {"ushort", PlyType::UInt16},
      {"uint16", PlyType::UInt16},
      {"int", PlyType::Int32},
      {"int32", PlyType::Int32},
      {"uint", PlyType::UInt32},
      {"uint32", PlyType::UInt32},
      {"float", PlyType::Float32},
      {"float32", PlyType::Float32},
      {"double", PlyType::Float64},
      {"float64", PlyType::Float64},
  }};
  for (const auto& [known, type] : names)
    if (known == name) return type;
  return std::nullopt;
}

class HeaderReader {
 public:
  explicit HeaderReader(const MeshSource& source) : source_(source), cursor_(source) {}

  PlyHeader read() {
    if (next_word("the word 'ply'") != "ply")
      source_.fail_at_line(source_.begin, "the file does not start with the word 'ply'");
    lone_cr_ends_lines_ = line_ends_with_lone_cr();
    end_line();
    while (!ended_) read_line();
    if (!has_format_) cursor_.fail("the header has no 'format' line");
    header_.end = cursor_.offset();
    return std::move(header_);
  }

 private:
  void read_line() {
    while (!cursor_.find_word_in_line()) {
      if (cursor_.remaining() == 0) cursor_.fail("the file ends before 'end_header'");
      cursor_.skip_line();
    }
    line_ = cursor_.offset();
    const std::string_view keyword = cursor_.word();
    if (keyword == "comment" || keyword == "obj_info") {
      const std::size_t comment = cursor_.offset();
      if (cursor_.find_word_in_line() && cursor_.peek_word() == "TextureFile") ++header_.texture_files;
      cursor_.seek(comment);  // inside a comment, a backslash at the end of the line does not join lines
      return cursor_.skip_line();
    }
    if (keyword == "format") {
      read_format();
    } else if (keyword == "element") {
      read_element();
    } else if (keyword == "property") {
      read_property();
    } else if (keyword == "end_header") {
      ended_ = true;
    } else {
      source_.fail_at_line(line_, quote(keyword) + " does not start a line of a PLY header");
    }
    end_line();
  }

  void read_format() {
    const std::string_view name = next_word("a format");
    if (name == "ascii") {
      header_.format = PlyFormat::Ascii;
    } else if (name == "binary_little_endian") {
      header_.format = PlyFormat::LittleEndian;
    } else if (name == "binary_big_endian") {
      header_.format = PlyFormat::BigEndian;
    } else {
      cursor_.fail(quote(name) + " is not a PLY format (ascii, binary_little_endian, binary_big_endian)");
    }
    if (next_word("the version 1.0") != "1.0") cursor_.fail("only version 1.0 of PLY is known");
    has_format_ = true;
  }

  void read_element() {
    PlyElement element;
    element.declared_at = line_;
    element.name = next_word("the name of an element");
    next_word_starts("the number of elements");
    const std::int64_t count = cursor_.integer("the number of elements");
    if (count < 0) cursor_.fail("the number of elements is negative");
    element.count = static_cast<std::uint64_t>(count);
    header_.elements.push_back(std::move(element));
  }

  void read_property() {
    if (header_.elements.empty()) cursor_.fail("a property stands before the first element");
    PlyProperty property;
    next_word_starts("a property type");
    property.is_list = cursor_.peek_word() == "list";
    if (property.is_list) {
      cursor_.word();
      property.count_type = next_type();
    }
    property.type = next_type();
    property.name = next_word("the name of a property");
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType next_type() {
    const std::string_view name = next_word("a property type");
    const std::optional<PlyType> type = type_named(name);
    if (!type) cursor_.fail(quote(name) + " is not a PLY property type");
    return *type;
  }

  void next_word_starts(const char* what) {
    if (!cursor_.find_word_in_line()) cursor_.fail_expected(what);
  }

  std::string_view next_word(const char* what) {
    next_word_starts(what);
    return cursor_.word();
  }

  void end_line() {
    if (cursor_.find_word_in_line()) cursor_.fail("expected the end of the line, but found " + quote(cursor_.word()));
    // Where CR alone ends the lines, an LF after 'end_header' is the first byte of the data.
    if (lone_cr_ends_lines_ && cursor_.starts_with('\r')) return cursor_.advance();
    cursor_.skip_line();
  }

  [[nodiscard]] bool line_ends_with_lone_cr() const {
    const std::string_view rest = source_.bytes.substr(cursor_.offset());
    return rest.size() > 1 && rest[0] == '\r' && rest[1] != '\n';
  }

  const MeshSource& source_;
  TextCursor cursor_;
  PlyHeader header_;
  std::size_t line_ = 0;
  bool has_format_ = false;
  bool ended_ = false;
  bool lone_cr_ends_lines_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::UInt8:
      return 1;
    case PlyType::Int16:
    case PlyType::UInt16:
      return 2;
    case PlyType::Int32:
    case PlyType::UInt32:
    case PlyType::Float32:
      return 4;
    case PlyType::Float64:
      break;
  }
  return 8;
}

PlyHeader read_ply_header(const MeshSource& source) { return HeaderReader(source).read(); }

}  // namespace meshbound
