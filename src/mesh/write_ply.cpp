// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "mesh/no_value.h"
#include "mesh/split_vertices.h"
#include "mesh/writers.h"
#include "mesh/written_name.h"
#include "numeric/numbers_below.h"
#include "numeric/rounded_to_float.h"

namespace meshbound {
namespace {

/// The type of a property. `Byte` holds 255 times a number from 0 to 1.
enum class Kind { Double, Float, Byte, Int, UInt };

/// A property of the vertices: `numbers` by value, and the value of each vertex.
struct Column {
  std::string name;
  Kind kind = Kind::Double;
  const std::vector<Triangle>* index = nullptr;
  std::vector<double> values;
  double missing = 0;  ///< stands where a vertex has no value
};

bool are_whole(const std::vector<double>& values, double min, double max) {
  return std::all_of(values.begin(), values.end(),
                     [&](double x) { return x >= min && x <= max && x == std::trunc(x); });
}

/// The type for numbers that a vertex has one of each: integers, as labels are, stay integers.
Kind kind_of(const NamedAttribute& numbers, Kind real) {
  using Int = std::numeric_limits<std::int32_t>;
  if (numbers.interpolation != Interpolation::Nearest) return real;
  if (are_whole(numbers.values, Int::min(), Int::max())) return Kind::Int;
  return are_whole(numbers.values, 0, std::numeric_limits<std::uint32_t>::max()) ? Kind::UInt : real;
}

class PlyWriter {
 public:
  PlyWriter(AtomicFile& file, const TriangleMesh& mesh, const WriteOptions& options, const MeshAttributes& attributes)
      : file_(file), mesh_(mesh), options_(options) {
    add_columns(attributes);
    if (!columns_.empty()) split();
  }

  void write() {
    file_.write(header());
    write_vertices({});
    write_triangles({});
  }

  /// Writes a share of the file, which must be binary and without columns.
  void write_share(const FileShare& share) {
    const std::size_t vertex_size = 3 * (options_.single_precision ? sizeof(float) : sizeof(double));
    constexpr std::size_t triangle_size = 1 + 3 * sizeof(std::uint32_t);
    const std::string header = this->header();
    if (share.index == 0) file_.write(header);
    file_.seek(header.size() + share.begin(vertex_count()) * vertex_size);
    write_vertices(share);
    file_.seek(header.size() + vertex_count() * vertex_size + share.begin(triangles().size()) * triangle_size);
    write_triangles(share);
  }

 private:
  void add_columns(const MeshAttributes& attributes) {
    const Kind real = options_.single_precision ? Kind::Float : Kind::Double;
    add_columns(attributes.normals, {"nx", "ny", "nz"}, Kind::Float);
    if (has_all(attributes.texture_coordinates))
      add_columns(attributes.texture_coordinates, {"s", "t"}, Kind::Float);
    else
      listed_ = &attributes.texture_coordinates;
    for (const NamedAttribute& named : attributes.named) {
      if (&named == colours_of(attributes)) {
        constexpr double white_and_opaque = 1;
        add_columns(named, {"red", "green", "blue", "alpha"}, holds_bytes(named) ? Kind::Byte : Kind::Float,
                    white_and_opaque);
      } else if (named.width == 1) {
        add_columns(named, {name_as_a_word(named.name)}, kind_of(named, real), 0);
      }
    }
  }

  [[nodiscard]] static bool has_all(const CornerAttribute& attribute) {
    return std::all_of(attribute.index.begin(), attribute.index.end(), all_have_values);
  }

  void add_columns(const CornerAttribute& attribute, const std::vector<std::string>& names, Kind kind) {
    if (attribute.empty()) return;
    for (std::size_t k = 0; k < names.size(); ++k) {
      Column& column = columns_.emplace_back(Column{names[k], kind, &attribute.index, {}, 0});
      for (const Eigen::Vector3d& value : attribute.values)
        column.values.push_back(value[static_cast<Eigen::Index>(k)]);
    }
  }

  void add_columns(const NamedAttribute& attribute, const std::vector<std::string>& names, Kind kind, double missing) {
    for (std::size_t k = 0; k < std::min(names.size(), attribute.width); ++k) {
      Column& column = columns_.emplace_back(Column{names[k], kind, &attribute.index, {}, missing});
      for (std::size_t i = k; i < attribute.values.size(); i += attribute.width)
        column.values.push_back(attribute.values[i]);
    }
  }

  void split() {
    std::vector<const std::vector<Triangle>*> indices;
    for (const Column& column : columns_)
      if (indices.empty() || indices.back() != column.index) indices.push_back(column.index);
    split_ = split_vertices(mesh_, numbers_below(mesh_.triangles.size()), indices);
  }

  [[nodiscard]] std::size_t vertex_count() const {
    return columns_.empty() ? mesh_.vertices.size() : split_.corners.size();
  }
  [[nodiscard]] const std::vector<Triangle>& triangles() const {
    return columns_.empty() ? mesh_.triangles : split_.triangles;
  }

  void write_vertices(const FileShare& share) {
    for (std::size_t v = share.begin(vertex_count()); v < share.end(vertex_count()); ++v) write_vertex(v);
  }

  void write_triangles(const FileShare& share) {
    const std::vector<Triangle>& all = triangles();
    for (std::size_t t = share.begin(all.size()); t < share.end(all.size()); ++t) {
      write_triangle(all[t]);
      if (listed_ != nullptr) write_texture_coordinates(listed_->index[t]);
    }
  }

  [[nodiscard]] std::string header() const {
    static constexpr std::array<const char*, 5> types = {"double", "float", "uchar", "int", "uint"};
    const bool fits_int = vertex_count() <= std::numeric_limits<std::int32_t>::max();
    std::string header = std::string("ply\nformat ") + (options_.ascii ? "ascii" : "binary_little_endian") +
                         " 1.0\nelement vertex " + std::to_string(vertex_count()) + "\n";
    for (const char* const axis : {"x", "y", "z"})
      header += std::string("property ") + (options_.single_precision ? "float " : "double ") + axis + "\n";
    for (const Column& column : columns_)
      header += std::string("property ") + types[static_cast<std::size_t>(column.kind)] + ' ' + column.name + "\n";
    return header + "element face " + std::to_string(mesh_.triangles.size()) + "\nproperty list uchar " +
           (fits_int ? "int" : "uint") + " vertex_indices\n" +
           (listed_ != nullptr ? "property list uchar float texcoord\n" : "") + "end_header\n";
  }

  void write_vertex(std::size_t v) {
    const Eigen::Vector3d& p = mesh_.vertices[columns_.empty() ? v : split_.source(mesh_, v)];
    for (Eigen::Index k = 0; k < 3; ++k)
      write_number(options_.single_precision ? Kind::Float : Kind::Double, p[k], k == 2 && columns_.empty());
    for (const Column& column : columns_) {
      const std::uint32_t value = split_.value(*column.index, v);
      write_number(column.kind, value == no_value ? column.missing : column.values[value], &column == &columns_.back());
    }
  }

  /// Floats are printed as the doubles they are equal to, so that readers of either kind get the same number.
  void write_number(Kind kind, double value, bool is_last) {
    const char after = is_last ? '\n' : ' ';
    if (kind == Kind::Byte) {
      write_integer(static_cast<std::uint8_t>(std::lround(255 * value)), after);
    } else if (kind == Kind::Int) {
      write_integer(static_cast<std::int32_t>(value), after);
    } else if (kind == Kind::UInt) {
      write_integer(static_cast<std::uint32_t>(value), after);
    } else if (options_.ascii) {
      put(file_, kind == Kind::Float ? rounded_to_float(value) : value, after);
    } else if (kind == Kind::Float) {
      put_little_endian(file_, static_cast<float>(value));
    } else {
      put_little_endian(file_, value);
    }
  }

  template <class Integer>
  void write_integer(Integer value, char after) {
    if (options_.ascii)
      put(file_, std::int64_t{value}, after);  // a byte is a number, no character
    else
      put_little_endian(file_, value);
  }

  void write_triangle(const Triangle& t) {
    if (options_.ascii) {
      file_.write("3 ");
      put(file_, t[0], ' ');
      put(file_, t[1], ' ');
      put(file_, t[2], listed_ != nullptr ? ' ' : '\n');
      return;
    }
    put_little_endian(file_, std::uint8_t{3});
    for (const std::uint32_t v : t) put_little_endian(file_, v);
  }

  /// The list of a triangle, empty where a corner lacks a coordinate.
  void write_texture_coordinates(const Triangle& indices) {
    std::vector<double> numbers;
    if (all_have_values(indices))
      for (const std::uint32_t i : indices)
        for (const double x : listed_->values[i].head<2>()) numbers.push_back(x);
    const auto count = static_cast<std::uint8_t>(numbers.size());
    if (options_.ascii)
      put(file_, std::uint32_t{count}, count > 0 ? ' ' : '\n');
    else
      put_little_endian(file_, count);
    for (const double& x : numbers) write_number(Kind::Float, x, &x == &numbers.back());
  }

  AtomicFile& file_;
  const TriangleMesh& mesh_;
  const WriteOptions& options_;
  std::vector<Column> columns_;
  const CornerAttribute* listed_ = nullptr;  ///< coordinates that not all corners have, and that faces list therefore
  SplitVertices split_;                      ///< where there are columns
};

}  // namespace

void write_ply(AtomicFile& file, const TriangleMesh& mesh, const WriteOptions& options,
               const MeshAttributes& attributes) {
  PlyWriter(file, mesh, options, attributes).write();
}

void write_ply_share(AtomicFile& file, const TriangleMesh& mesh, const WriteOptions& options, const FileShare& share) {
  PlyWriter(file, mesh, options, {}).write_share(share);
}

}  // namespace meshbound
