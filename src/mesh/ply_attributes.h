// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesh/ply_header.h"
#include "meshbound/io.h"

namespace meshbound {

/// Whether a property is the list of texture coordinates of a face's corners, two numbers each, which MeshLab writes.
[[nodiscard]] bool lists_texture_coordinates(const PlyProperty& property);

/// Adds to `dropped` what an element has beyond positions and corners: texture coordinates, normals and colours by the
/// usual names of their properties, every other property as one. Lists of texture coordinates are left out, as the
/// header does not tell their length. `collected` says by property what is left out as well; empty: nothing.
void count_attributes(const PlyElement& element, const std::vector<bool>& collected, DroppedAttributes& dropped);

/// Collects texture coordinates, normals, colours and other numbers of vertices, and of faces the colours and texture
/// coordinates that vertices lack. Where several properties say the same, as "red" and "diffuse_red" do, the first one
/// is collected.
class PlyAttributes {
 public:
  /// Start the vertices, and later the faces; `element` declares the properties whose numbers follow. An opacity of
  /// faces is not collected where faces of an earlier element have colours without.
  void begin_vertices(const PlyElement& element);
  void begin_faces(const PlyElement& element);

  /// Whether the numbers of a property are wanted.
  [[nodiscard]] bool wants_of_vertex(std::size_t property) const {
    return vertex_roles_[property].kind != Kind::Nothing;
  }
  [[nodiscard]] bool wants_of_face(std::size_t property) const { return face_roles_[property].kind != Kind::Nothing; }
  [[nodiscard]] bool wants_texture_lists() const { return !has_texture_; }
  /// By property of the vertices or of the faces that were started last, whether its numbers are wanted; empty for any
  /// other element.
  [[nodiscard]] std::vector<bool> collected(const PlyElement& element) const;

  void add_to_vertex(std::size_t property, double value) { take(vertex_roles_[property], value); }
  void end_vertex();
  void add_to_face(std::size_t property, double value) { take(face_roles_[property], value); }
  /// Ends a face of `corners` corners, whose first triangle has this number. `texture_coordinates` has two numbers for
  /// each corner, or is not collected.
  void end_face(std::size_t triangle, std::size_t corners, const std::vector<double>& texture_coordinates);

  /// Returns what was collected, for a mesh with these triangles.
  [[nodiscard]] MeshAttributes finish(const std::vector<Triangle>& triangles);

 private:
  enum class Kind : std::uint8_t { Nothing, Texture, Normal, Colour, Scalar };
  struct Role {
    Kind kind = Kind::Nothing;
    std::size_t component = 0;  ///< of the value; for a scalar, which scalar
    double unit = 1;            ///< the number that the file writes for 1
  };

  [[nodiscard]] Role role_of(const PlyProperty& property) const;
  /// The role of a property of an element whose earlier properties have the roles `given`: none if one has the same.
  [[nodiscard]] Role new_role_of(const PlyProperty& property, const std::vector<Role>& given) const;
  /// Takes note of the type of numbers that texture coordinates have.
  void note_texture(PlyType type);
  void take(const Role& role, double value);
  void add_colour();

  std::vector<Role> vertex_roles_, face_roles_;
  bool has_texture_ = false, has_normals_ = false, has_vertex_colours_ = false;  // of vertices
  bool has_face_colours_ = false;                                                // of the element being read
  std::size_t colour_width_ = 3;
  std::array<double, 3> texture_{}, normal_{};  // of the vertex being read
  std::array<double, 4> colour_{};              // of the vertex or face being read
  std::vector<double> scalars_;                 // of the vertex being read
  MeshAttributes all_;
  NamedAttribute colours_;
  std::vector<Triangle> corner_texture_;  // by triangle, where faces list texture coordinates
};

}  // namespace meshbound
