// SPDX-License-Identifier: MIT
// The Object File Format of Geomview (http://www.geomview.org/docs/html/OFF.html), as it is found in the wild: counts
// glued to the keyword ("OFF8 6 12", ModelNet), a missing edge count, colours after a vertex without a C in the
// keyword. A vertex may be spread over lines but shares its last line with no other, nor does a face.
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "mesh/mesh_assembler.h"
#include "mesh/readers.h"
#include "mesh/text_cursor.h"

namespace meshbound {
namespace {

struct Counts {
  std::size_t vertices = 0;
  std::size_t faces = 0;
};

/// The attributes that the keyword announces behind the coordinates of each vertex.
struct Announced {
  bool texture_coordinates = false, colours = false, normals = false;
};

/// Reads [ST][C][N][4][n]OFF; what ST, C and N announce is counted and skipped.
Announced read_keyword(TextCursor& cursor) {
  if (!cursor.find_word()) cursor.fail("the file holds no OFF keyword");
  const std::string_view word = cursor.peek_word();
  std::string_view rest = word;
  const auto announces = [&rest](std::string_view prefix) {
    const bool found = rest.starts_with(prefix);
    if (found) rest.remove_prefix(prefix.size());
    return found;
  };
  Announced announced;
  announced.texture_coordinates = announces("ST");
  announced.colours = announces("C");
  announced.normals = announces("N");
  if (rest.starts_with("4OFF") || rest.starts_with("nOFF") || rest.starts_with("4nOFF"))
    cursor.fail("vertices of " + quote(word) + " are not points in three dimensions");
  if (!rest.starts_with("OFF") && !rest.starts_with("off"))
    cursor.fail("expected the keyword OFF, but found " + quote(word));
  cursor.seek(cursor.offset() + word.size() - rest.size() + 3);
  if (cursor.find_word_in_line() && cursor.peek_word() == "BINARY")
    cursor.fail("binary OFF is not supported; convert it to text, PLY or STL");
  return announced;
}

std::size_t read_count(TextCursor& cursor, const char* what) {
  if (!cursor.find_word()) cursor.fail_expected(what);
  const std::int64_t count = cursor.integer(what);
  if (count < 0) cursor.fail(std::string("expected ") + what + ", but it is negative");
  return static_cast<std::size_t>(count);
}

/// The numbers from here to the end of the line.
struct NumbersInLine {
  std::vector<double> values;
  bool has_point = false;  ///< or an exponent, in one of them
};

void read_numbers_in_line(TextCursor& cursor, NumbersInLine& numbers) {
  numbers.values.clear();
  numbers.has_point = false;
  while (cursor.find_word_in_line()) {
    numbers.has_point = numbers.has_point || cursor.peek_word().find_first_of(".eE") != std::string_view::npos;
    numbers.values.push_back(cursor.number("a number"));
  }
  cursor.skip_line();
}

/// Collects the colours of vertices, or of faces where vertices have none. Three or four numbers are a colour; a single
/// number is an index into a table that no file provides, and is counted as dropped.
///
/// Colours are from 0 to 1 in lines with a decimal point or an exponent, and from 0 to 255 in other lines with a number
/// above 1. Lines of zeros and ones alone are read as the file's other lines: from 0 to 255 if these are without
/// exception, else from 0 to 1. Writers that leave out the point of whole numbers mean 1 by "1", others 1/255.
class OffColours {
 public:
  explicit OffColours(DroppedAttributes& dropped) : dropped_(dropped) {}

  void add_vertex(const NumbersInLine& numbers) {
    vertices_.push_back(add(numbers));
    has_vertex_colours_ = has_vertex_colours_ || vertices_.back() != CornerAttribute::none;
  }
  void add_face(const NumbersInLine& numbers, std::size_t corners) {
    if (has_vertex_colours_) {
      if (!numbers.values.empty()) ++dropped_.colours;
      return;
    }
    const std::uint32_t colour = add(numbers);
    if (corners > 2) faces_.insert(faces_.end(), corners - 2, colour);
  }

  /// Adds the colours to a mesh with these triangles, if there are any.
  void put_into(MeshAttributes& attributes, const std::vector<Triangle>& triangles) {
    if (values_.empty()) return;
    scale_undecided();
    NamedAttribute colours{.name = "COLOR_0", .width = width};
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto [a, b, c] = triangles[t];
      colours.index.push_back(has_vertex_colours_ ? Triangle{vertices_[a], vertices_[b], vertices_[c]}
                                                  : Triangle{faces_[t], faces_[t], faces_[t]});
    }
    colours.values = std::move(values_);
    attributes.named.push_back(std::move(colours));
  }

 private:
  static constexpr std::size_t width = 4;
  static constexpr double max_byte = 255;

  std::uint32_t add(const NumbersInLine& numbers) {
    if (numbers.values.empty()) return CornerAttribute::none;
    if (numbers.values.size() < 3) {
      ++dropped_.colours;
      return CornerAttribute::none;
    }
    const std::size_t size = std::min(numbers.values.size(), width);
    const bool in_bytes = !numbers.has_point && *std::max_element(numbers.values.begin(), numbers.values.end()) > 1;
    has_bytes_ = has_bytes_ || in_bytes;
    has_points_ = has_points_ || numbers.has_point;
    if (!numbers.has_point && !in_bytes) undecided_.push_back({values_.size(), size});
    for (std::size_t k = 0; k < width; ++k)
      values_.push_back(k >= size ? 1 : numbers.values[k] / (in_bytes ? max_byte : 1));
    return static_cast<std::uint32_t>(values_.size() / width - 1);
  }

  void scale_undecided() {
    if (has_points_ || !has_bytes_) return;
    for (const Numbers& numbers : undecided_)
      for (std::size_t i = 0; i < numbers.size; ++i) values_[numbers.first + i] /= max_byte;
  }

  /// Numbers among `values_`.
  struct Numbers {
    std::size_t first, size;
  };

  DroppedAttributes& dropped_;
  bool has_vertex_colours_ = false;
  std::vector<std::uint32_t> vertices_, faces_;  // by vertex and by triangle: the colour, or `none`
  std::vector<double> values_;
  std::vector<Numbers> undecided_;               // lines of zeros and ones
  bool has_points_ = false, has_bytes_ = false;  // lines that are certainly from 0 to 1, or to 255
};

/// Counts numbers behind the coordinates that no keyword announces as colours.
void count_attributes(const Announced& announced, DroppedAttributes& dropped) {
  if (announced.texture_coordinates) ++dropped.texture_coordinates;
  if (announced.normals) ++dropped.normals;
  if (announced.colours || !(announced.texture_coordinates || announced.normals)) ++dropped.colours;
}

/// Skips the edge count, which some writers leave out: it is there when a number follows on the same line or stands
/// alone on the next.
void skip_edge_count(TextCursor& cursor) {
  if (!cursor.find_word_in_line()) {
    if (!cursor.find_word()) return;
    const std::size_t next_line = cursor.offset();
    cursor.word();
    const bool alone = !cursor.find_word_in_line();
    cursor.seek(next_line);
    if (!alone) return;
  }
  cursor.integer("the number of edges");
  if (cursor.find_word_in_line()) cursor.fail("expected the end of the line after the three counts");
}

Counts read_counts(TextCursor& cursor) {
  Counts counts;
  counts.vertices = read_count(cursor, "the number of vertices");
  counts.faces = read_count(cursor, "the number of faces");
  const std::size_t after = cursor.offset();
  skip_edge_count(cursor);
  // "0 0 0\n" and "0\n" are the shortest vertex and face there are.
  const std::size_t room = cursor.remaining() + 1;
  if (counts.vertices > room / 6 || counts.faces > room / 2) {
    cursor.seek(after);
    cursor.fail("the header declares " + std::to_string(counts.vertices) + " vertices and " +
                std::to_string(counts.faces) + " faces, more than the rest of the file (" + std::to_string(room - 1) +
                " bytes) can hold");
  }
  if (counts.vertices > std::numeric_limits<std::uint32_t>::max()) cursor.fail("more than 2^32-1 vertices");
  return counts;
}

double read_coordinate(TextCursor& cursor) {
  if (!cursor.find_word()) cursor.fail_expected("a vertex coordinate");
  return cursor.number("a vertex coordinate");
}

/// Numbers behind the corners are the colour of the face.
void read_face(TextCursor& cursor, std::size_t vertex_count, std::vector<std::uint32_t>& corners,
               NumbersInLine& colour) {
  corners.clear();
  const std::size_t size = read_count(cursor, "the number of corners of a face");
  if (size > cursor.remaining() / 2 + 1)
    cursor.fail("a face declares " + std::to_string(size) + " corners, more than the rest of the file can hold");
  for (std::size_t i = 0; i < size; ++i) {
    if (!cursor.find_word()) cursor.fail_expected("a vertex index");
    const std::int64_t index = cursor.integer("a vertex index");
    if (index < 0 || static_cast<std::size_t>(index) >= vertex_count)
      cursor.fail("a face refers to vertex " + std::to_string(index) + ", but there are only " +
                  std::to_string(vertex_count) + " (counted from 0)");
    corners.push_back(static_cast<std::uint32_t>(index));
  }
  read_numbers_in_line(cursor, colour);
}

}  // namespace

MeshFile read_off(const MeshSource& source) {
  TextCursor cursor(source);
  MeshAssembler assembler(source, Position::Line);
  const Announced announced = read_keyword(cursor);
  const Counts counts = read_counts(cursor);
  constexpr std::size_t shortest_triangle = 8;  // bytes: "3 0 1 2\n"
  assembler.reserve(counts.vertices, std::min(counts.faces, cursor.remaining() / shortest_triangle + 1));
  // Texture coordinates and normals are not collected, nor are colours that stand between them.
  const bool are_colours = !announced.texture_coordinates && !announced.normals;
  const bool collects = source.with_attributes;
  OffColours colours(assembler.dropped());
  NumbersInLine numbers;
  for (std::size_t i = 0; i < counts.vertices; ++i) {
    const double x = read_coordinate(cursor);
    const std::size_t offset = cursor.offset();
    const double y = read_coordinate(cursor);
    const double z = read_coordinate(cursor);
    assembler.add_vertex({x, y, z}, offset);
    read_numbers_in_line(cursor, numbers);
    if (collects && are_colours)
      colours.add_vertex(numbers);
    else if (!numbers.values.empty())
      count_attributes(announced, assembler.dropped());
  }
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < counts.faces; ++i) {
    read_face(cursor, counts.vertices, corners, numbers);
    if (collects)
      colours.add_face(numbers, corners.size());
    else if (!numbers.values.empty())
      ++assembler.dropped().colours;
    assembler.add_polygon(corners);
  }
  if (cursor.find_word())
    cursor.fail("the file goes on after the " + std::to_string(counts.faces) + " faces that its header declares");
  MeshFile file = assembler.finish();
  if (collects) colours.put_into(file.attributes, file.mesh.triangles);
  return file;
}

}  // namespace meshbound
