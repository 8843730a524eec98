// SPDX-License-Identifier: MIT
// PLY (http://paulbourke.net/dataformats/ply/): vertices, faces and the triangle strips of the Stanford repository;
// every other element and property is counted and stepped over.
#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh_assembler.h"
#include "mesh/ply_attributes.h"
#include "mesh/ply_header.h"
#include "mesh/ply_values.h"
#include "mesh/readers.h"

namespace meshbound {
namespace {

/// What the reader takes from a property: a coordinate 0, 1 or 2, the corners of a face, or nothing.
enum Role : int { X = 0, Y = 1, Z = 2, Corners, Nothing };

bool lists_corners(const PlyProperty& p) { return p.name == "vertex_indices" || p.name == "vertex_index"; }

template <class Values>
class PlyReader {
 public:
  PlyReader(const MeshSource& source, const PlyHeader& header, Values values)
      : source_(source),
        header_(header),
        values_(values),
        assembler_(source, Values::is_text ? Position::Line : Position::Byte) {}

  MeshFile read() {
    reserve();
    for (const PlyElement& element : header_.elements) {
      refuse_count_beyond_file(element);
      if (source_.with_attributes && element.name == "face") attributes_.begin_faces(element);
      count_attributes(element, attributes_.collected(element), assembler_.dropped());
      read_element(element);
    }
    if (!values_.at_end()) values_.fail("the file goes on after the last element that its header declares");
    assembler_.dropped().texture_coordinates += texture_numbers_ / 2;
    assembler_.dropped().materials += header_.texture_files;
    MeshFile file = assembler_.finish();
    if (source_.with_attributes) file.attributes = attributes_.finish(file.mesh.triangles);
    return file;
  }

  /// Reads a share of each element, where an item of the element takes `sizes[i]` bytes.
  std::optional<MeshFile> read_share(const FileShare& share, const std::vector<std::size_t>& sizes) {
    reserve();
    std::size_t begin = header_.end;
    for (std::size_t i = 0; i < sizes.size(); begin += header_.elements[i].count * sizes[i], ++i) {
      PlyElement element = header_.elements[i];
      count_attributes(element, {}, assembler_.dropped());
      values_.seek(begin + share.begin(element.count) * sizes[i]);
      element.count = share.size(element.count);
      read_element(element);
    }
    assembler_.dropped().materials += header_.texture_files;
    return assembler_.finish_share();
  }

 private:
  void read_element(const PlyElement& element) {
    if (element.name == "vertex") {
      read_vertices(element);
    } else if (element.name == "face") {
      read_lists(element, false);
    } else if (element.name == "tristrips") {
      read_lists(element, true);
    } else {
      skip_element(element);
    }
  }

  void reserve() {
    std::size_t faces = 0;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        if (vertex_count_ != 0) source_.fail_at_line(element.declared_at, "a second element 'vertex'");
        vertex_roles_ = vertex_roles(element);
        if (source_.with_attributes) attributes_.begin_vertices(element);
        refuse_count_beyond_file(element);
        vertex_count_ = element.count;
      }
      if (element.name == "face") faces = element.count;
    }
    if (vertex_count_ > std::numeric_limits<std::uint32_t>::max()) values_.fail("more than 2^32-1 vertices");
    const std::size_t smallest_triangle = 4 * Values::smallest(PlyType::UInt8);  // bytes: its size and three corners
    assembler_.reserve(vertex_count_, std::min(faces, values_.remaining() / smallest_triangle));
  }

  /// Checks a count before anything is allocated or looped over: that many elements must fit into the rest of the file.
  /// In a text the last value may lack its separator.
  void refuse_count_beyond_file(const PlyElement& element) const {
    std::size_t smallest = 0;
    for (const PlyProperty& p : element.properties) smallest += Values::smallest(p.is_list ? p.count_type : p.type);
    if (smallest != 0 && element.count > (values_.remaining() + 1) / smallest)
      source_.fail_at_line(element.declared_at, "the header declares " + std::to_string(element.count) + " elements " +
                                                    quote(element.name) + ", more than the rest of the file (" +
                                                    std::to_string(values_.remaining()) + " bytes) can hold");
  }

  void read_vertices(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::size_t offset = values_.offset();
      Eigen::Vector3d p;
      for (std::size_t k = 0; k < vertex_roles_.size(); ++k) {
        if (vertex_roles_[k] == Nothing && source_.with_attributes && attributes_.wants_of_vertex(k)) {
          attributes_.add_to_vertex(k, values_.real(element.properties[k].type));
        } else if (vertex_roles_[k] == Nothing) {
          skip_property(element.properties[k]);
        } else {
          p[vertex_roles_[k]] = values_.real(element.properties[k].type);
          if (Values::is_text) offset = values_.offset();
        }
      }
      values_.end_element();
      assembler_.add_vertex(p, offset);
      if (source_.with_attributes) attributes_.end_vertex();
    }
  }

  std::vector<Role> vertex_roles(const PlyElement& element) const {
    static constexpr std::array<std::string_view, 3> axes = {"x", "y", "z"};
    std::vector<Role> roles(element.properties.size(), Nothing);
    for (int axis = X; axis <= Z; ++axis) {
      const std::string_view name = axes[static_cast<std::size_t>(axis)];
      const auto is_axis = [&](const PlyProperty& p) { return p.name == name; };
      const auto at = std::find_if(element.properties.begin(), element.properties.end(), is_axis);
      if (at == element.properties.end() || at->is_list ||
          std::find_if(at + 1, element.properties.end(), is_axis) != element.properties.end())
        source_.fail_at_line(element.declared_at, "vertices need exactly one number " + quote(name) + " each");
      roles[static_cast<std::size_t>(at - element.properties.begin())] = static_cast<Role>(axis);
    }
    return roles;
  }

  void read_lists(const PlyElement& element, bool strips) {
    const bool collects_faces = source_.with_attributes && !strips;
    const std::size_t found =
        static_cast<std::size_t>(std::count_if(element.properties.begin(), element.properties.end(), lists_corners));
    const auto list = std::find_if(element.properties.begin(), element.properties.end(), lists_corners);
    if (element.count > 0 && (found != 1 || !list->is_list))
      source_.fail_at_line(element.declared_at, "element " + quote(element.name) +
                                                    " needs exactly one list 'vertex_indices' or 'vertex_index'");
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const std::size_t triangle = assembler_.triangle_count();
      texture_coordinates_.clear();
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& p = element.properties[k];
        if (!lists_corners(p)) {
          read_property_of_face(p, k, collects_faces);
        } else if (strips) {
          read_strip(p);
        } else {
          read_face(p);
        }
      }
      values_.end_element();
      if (!collects_faces) continue;
      attributes_.end_face(triangle, corners_.size(), texture_coordinates_);
      if (texture_coordinates_.size() != 2 * corners_.size()) texture_numbers_ += texture_coordinates_.size();
    }
  }

  void read_property_of_face(const PlyProperty& p, std::size_t number, bool collects) {
    if (collects && lists_texture_coordinates(p) && attributes_.wants_texture_lists()) {
      for (std::uint64_t n = list_size(p); n > 0; --n) texture_coordinates_.push_back(values_.real(p.type));
    } else if (collects && attributes_.wants_of_face(number)) {
      attributes_.add_to_face(number, values_.real(p.type));
    } else {
      const std::uint64_t skipped = skip_property(p);
      if (lists_texture_coordinates(p)) texture_numbers_ += skipped;
    }
  }

  void read_face(const PlyProperty& list) {
    corners_.clear();
    for (std::uint64_t n = list_size(list); n > 0; --n) {
      const std::int64_t index = values_.integer(list.type);
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_) fail_index(index);
      corners_.push_back(static_cast<std::uint32_t>(index));
    }
    assembler_.add_polygon(corners_);
  }

  void read_strip(const PlyProperty& list) {
    strip_.clear();
    for (std::uint64_t n = list_size(list); n > 0; --n) {
      const std::int64_t index = values_.integer(list.type);
      if (index < -1 || (index >= 0 && static_cast<std::uint64_t>(index) >= vertex_count_)) fail_index(index);
      strip_.push_back(index);
    }
    assembler_.add_strips(strip_);
  }

  std::uint64_t list_size(const PlyProperty& list) {
    const std::int64_t size = values_.integer(list.count_type);
    if (size < 0) values_.fail("the length of a list is negative");
    if (static_cast<std::uint64_t>(size) > (values_.remaining() + 1) / Values::smallest(list.type))
      values_.fail("a list declares " + std::to_string(size) + " items, more than the rest of the file can hold");
    return static_cast<std::uint64_t>(size);
  }

  /// Returns the number of values.
  std::uint64_t skip_property(const PlyProperty& p) {
    const std::uint64_t count = p.is_list ? list_size(p) : 1;
    values_.skip(p.type, count);
    return count;
  }

  void skip_element(const PlyElement& element) {
    if (element.properties.empty()) return;           // takes no bytes, however many there are
    constexpr std::uint64_t look_interval = 1 << 16;  // elements: stepped over in some milliseconds
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % look_interval == 0) source_.end_if_stopped();
      for (const PlyProperty& p : element.properties) skip_property(p);
      values_.end_element();
    }
  }

  [[noreturn]] void fail_index(std::int64_t index) const {
    values_.fail("a face refers to vertex " + std::to_string(index) + ", but there are only " +
                 std::to_string(vertex_count_) + " (counted from 0)");
  }

  const MeshSource& source_;
  const PlyHeader& header_;
  Values values_;
  MeshAssembler assembler_;
  std::size_t vertex_count_ = 0;
  std::vector<Role> vertex_roles_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::int64_t> strip_;
  std::uint64_t texture_numbers_ = 0;  // numbers in skipped lists of texture coordinates
  PlyAttributes attributes_;
  std::vector<double> texture_coordinates_;  // of the face being read
};

PlyReader<BinaryPlyValues> binary_reader(const MeshSource& source, const PlyHeader& header) {
  const std::endian order = header.format == PlyFormat::LittleEndian ? std::endian::little : std::endian::big;
  return PlyReader(source, header, BinaryPlyValues(source, header.end, order));
}

/// By element of a binary file: bytes of each item, if all faces are triangles. Nothing where there are other lists, or
/// the elements do not end where the file does.
std::optional<std::vector<std::size_t>> item_sizes(const PlyHeader& header, std::size_t size_of_file) {
  std::vector<std::size_t> sizes;
  std::size_t end = header.end;
  for (const PlyElement& element : header.elements) {
    std::size_t& size = sizes.emplace_back(0);
    for (const PlyProperty& p : element.properties) {
      if (p.is_list && (element.name != "face" || !lists_corners(p))) return std::nullopt;
      size += p.is_list ? size_of(p.count_type) + 3 * size_of(p.type) : size_of(p.type);
    }
    if (size > 0 && element.count > (size_of_file - end) / size) return std::nullopt;
    end += element.count * size;
  }
  if (end != size_of_file) return std::nullopt;
  return sizes;
}

}  // namespace

MeshFile read_ply(const MeshSource& source) {
  const PlyHeader header = read_ply_header(source);
  if (header.format == PlyFormat::Ascii) return PlyReader(source, header, AsciiPlyValues(source, header.end)).read();
  return binary_reader(source, header).read();
}

std::optional<MeshCounts> ply_counts(const MeshSource& source) {
  const PlyHeader header = read_ply_header(source);
  if (!item_sizes(header, source.size())) return std::nullopt;
  MeshCounts counts{0, 0};
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") counts.vertices = element.count;
    if (element.name != "face") continue;
    if (counts.triangles > 0) return std::nullopt;  // shares of two lists are not in the order of the file
    counts.triangles = element.count;
  }
  return counts;
}

std::optional<MeshFile> read_ply_share(const MeshSource& source, const FileShare& share) {
  const PlyHeader header = read_ply_header(source);
  const auto sizes = item_sizes(header, source.size());
  if (!sizes) return std::nullopt;
  return binary_reader(source, header).read_share(share, *sizes);
}

}  // namespace meshbound
