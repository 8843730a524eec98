// SPDX-License-Identifier: MIT
// Wavefront OBJ (http://paulbourke.net/dataformats/obj/): v and f are read; groups, materials, normals and texture
// coordinates are read where they are asked for, else counted and stepped over.
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <unordered_set>
#include <vector>

#include "mesh/mesh_assembler.h"
#include "mesh/obj_attributes.h"
#include "mesh/readers.h"
#include "mesh/text_cursor.h"

namespace meshbound {
namespace {

/// Geometry that is no polygon: reported as ignored.
constexpr std::array<std::string_view, 5> other_geometry = {"l", "p", "curv", "curv2", "surf"};

/// Statements whose rest of the line is a name, '#' included: 3ds Max calls materials "Material #25".
constexpr std::array<std::string_view, 4> statements_of_names = {"usemtl", "mtllib", "g", "o"};

/// Counts the different names that statements of one kind give. The names point into the file's bytes.
class Names {
 public:
  void add(std::string_view name) {
    if (name.empty() || name == last_) return;
    names_.insert(name);
    last_ = name;
  }
  [[nodiscard]] std::size_t count() const { return names_.size(); }

 private:
  std::unordered_set<std::string_view> names_;
  std::string_view last_;  // skips the look-up in runs of equal names
};

class ObjReader {
 public:
  explicit ObjReader(const MeshSource& source) : source_(source), cursor_(source), assembler_(source, Position::Line) {}

  MeshFile read() {
    while (cursor_.find_word()) read_statement();
    if (largest_reference_ > assembler_.vertex_count())
      source_.fail_at_line(largest_reference_offset_,
                           "a face refers to vertex " + std::to_string(largest_reference_) + ", but there are only " +
                               std::to_string(assembler_.vertex_count()) + " (counted from 1)");
    count_names();
    MeshFile file = assembler_.finish();
    if (source_.with_attributes) file.attributes = attributes_.finish(file.mesh.triangles, file.dropped);
    return file;
  }

 private:
  void read_statement() {
    const std::size_t offset = cursor_.offset();
    const std::string_view keyword = cursor_.word();
    if (keyword == "v") {
      read_vertex(offset);
    } else if (keyword == "f" || keyword == "fo") {  // fo: the face statement of old versions
      read_face();
    } else {
      if (!is_letter(keyword.front()))
        source_.fail_at_line(offset, quote(keyword) + " does not start a statement of OBJ");
      if (std::find(other_geometry.begin(), other_geometry.end(), keyword) != other_geometry.end())
        assembler_.ignore_element();
      if (source_.with_attributes && (keyword == "vt" || keyword == "vn")) return read_value(keyword);
      const bool is_name =
          std::find(statements_of_names.begin(), statements_of_names.end(), keyword) != statements_of_names.end();
      const std::string_view argument = rest_of_statement(is_name);
      count_attribute(keyword, argument);
      if (source_.with_attributes) attributes_.set_label(keyword, argument);
    }
  }

  /// The rest of the statement, from the next word to the last one: read word by word, as it may span joined lines.
  /// `is_name`: a '#' in it starts no comment.
  std::string_view rest_of_statement(bool is_name) {
    const auto has_word = [&] { return is_name ? cursor_.find_part_of_name() : cursor_.find_word_in_line(); };
    if (!has_word()) return {};
    const std::size_t from = cursor_.offset();
    std::size_t to = from;
    while (has_word()) {
      cursor_.word();
      to = cursor_.offset();
    }
    return source_.bytes.substr(from, to - from);
  }

  void count_attribute(std::string_view keyword, std::string_view argument) {
    DroppedAttributes& dropped = assembler_.dropped();
    if (keyword == "vt")
      ++dropped.texture_coordinates;
    else if (keyword == "vn")
      ++dropped.normals;
    else if (keyword == "usemtl")
      materials_.add(argument);
    else if (keyword == "mtllib")
      material_libraries_.add(argument);
    else if (keyword == "g" || keyword == "o")
      groups_.add(argument);
    else if (keyword == "s" && argument != "off" && argument != "0")
      smoothing_groups_.add(argument);
  }

  void count_names() {
    DroppedAttributes& dropped = assembler_.dropped();
    dropped.materials = materials_.count() > 0 ? materials_.count() : material_libraries_.count();
    dropped.groups = groups_.count();
    dropped.smoothing_groups = smoothing_groups_.count();
  }

  void read_vertex(std::size_t offset) {
    const double x = read_coordinate();
    const double y = read_coordinate();
    const double z = read_coordinate();
    Eigen::Vector4d colour(0, 0, 0, 1);
    Eigen::Index more = 0;
    for (; cursor_.find_word_in_line(); ++more) {
      const double number = cursor_.number("a weight or a colour");
      if (more < 4) colour[more] = number;
    }
    if (more >= 3) {
      ++assembler_.dropped().colours;
      if (source_.with_attributes) attributes_.add_colour(assembler_.vertex_count(), colour);
    }
    if (assembler_.vertex_count() == std::numeric_limits<std::uint32_t>::max())
      cursor_.fail("more than 2^32-1 vertices");
    assembler_.add_vertex({x, y, z}, offset);
  }

  double read_coordinate() {
    if (!cursor_.find_word_in_line()) cursor_.fail_expected("a vertex coordinate");
    return cursor_.number("a vertex coordinate");
  }

  /// Reads the three numbers of a texture coordinate or a normal; missing ones are 0, further ones are skipped.
  void read_value(std::string_view keyword) {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; cursor_.find_word_in_line(); ++i) {
      const double number = cursor_.number("a texture coordinate or a normal");
      if (i < 3) value[i] = number;
    }
    attributes_.add_value(keyword, value);
    count_attribute(keyword, {});
  }

  void read_face() {
    corners_.clear();
    attributes_.begin_polygon();
    while (cursor_.find_word_in_line()) {
      corners_.push_back(read_corner());
      read_texture_and_normal();
    }
    assembler_.add_polygon(corners_);
    if (source_.with_attributes) attributes_.end_polygon();
  }

  /// Positive indices count from 1 and may refer to vertices further down, negative ones count back from here.
  std::uint32_t read_corner() {
    const std::size_t offset = cursor_.offset();
    const std::int64_t index = cursor_.leading_integer("a vertex index");
    const auto count = static_cast<std::int64_t>(assembler_.vertex_count());
    if (index == 0) cursor_.fail("a face refers to vertex 0, but OBJ counts vertices from 1");
    if (index < -count || index > std::numeric_limits<std::uint32_t>::max())
      cursor_.fail("a face refers to vertex " + std::to_string(index) + ", but there are only " +
                   std::to_string(count) + " so far");
    if (index > count && static_cast<std::size_t>(index) > largest_reference_) {
      largest_reference_ = static_cast<std::size_t>(index);
      largest_reference_offset_ = offset;
    }
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
  }

  /// a/b, a/b/c or a//c: the form is checked, and an index without a value means none.
  void read_texture_and_normal() {
    std::array<std::int64_t, 2> index = {0, 0};
    for (std::size_t i = 0; i < 2 && cursor_.starts_with('/'); ++i) {
      cursor_.advance();
      if (!cursor_.at_word_end() && !cursor_.starts_with('/'))
        index[i] = cursor_.leading_integer("a texture or normal index");
    }
    if (source_.with_attributes) attributes_.add_corner(index[0], index[1]);
    if (!cursor_.at_word_end()) cursor_.fail_expected("a face corner of the form v, v/vt, v//vn or v/vt/vn");
  }

  static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

  const MeshSource& source_;
  TextCursor cursor_;
  MeshAssembler assembler_;
  std::vector<std::uint32_t> corners_;
  Names materials_, material_libraries_, groups_, smoothing_groups_;
  ObjAttributes attributes_;
  std::size_t largest_reference_ = 0;  // to a vertex not yet read, counted from 1
  std::size_t largest_reference_offset_ = 0;
};

}  // namespace

MeshFile read_obj(const MeshSource& source) { return ObjReader(source).read(); }

}  // namespace meshbound
