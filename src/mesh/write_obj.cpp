// SPDX-License-Identifier: MIT

#include "mesh/no_value.h"
#include "mesh/split_vertices.h"
#include "mesh/writers.h"
#include "mesh/written_name.h"
#include "numeric/numbers_below.h"

namespace meshbound {
namespace {

void put_values(AtomicFile& file, const MeshAttributes& attributes) {
  for (const Eigen::Vector3d& uv : attributes.texture_coordinates.values) {
    file.write("vt ");
    put(file, uv.x(), ' ');
    put(file, uv.y(), '\n');
  }
  for (const Eigen::Vector3d& normal : attributes.normals.values) {
    file.write("vn ");
    put(file, normal, '\n');
  }
}

/// Whether triangle t has a label, and another one than the triangle before.
bool begins_label(const TriangleLabels& labels, std::size_t t) {
  return !labels.empty() && labels.index[t] != no_value && (t == 0 || labels.index[t - 1] != labels.index[t]);
}

void put_label(AtomicFile& file, const TriangleLabels& labels, std::size_t t, const char* keyword) {
  if (labels.empty() || labels.index[t] == no_value) return;
  file.write(keyword);
  file.write(name_on_a_line(labels.names[labels.index[t]]));
  file.write("\n");
}

/// Writes the labels of triangle t that differ from those of the triangle before. The group is repeated behind a new
/// object, for readers to whom a group ends with its object.
void put_labels(AtomicFile& file, const MeshAttributes& attributes, std::size_t t) {
  const bool begins_object = begins_label(attributes.objects, t);
  if (begins_object) put_label(file, attributes.objects, t, "o ");
  if (begins_object || begins_label(attributes.groups, t)) put_label(file, attributes.groups, t, "g ");
  if (begins_label(attributes.smoothing_groups, t)) put_label(file, attributes.smoothing_groups, t, "s ");
  if (begins_label(attributes.materials, t)) put_label(file, attributes.materials, t, "usemtl ");
}

/// Writes v, v/vt, v//vn or v/vt/vn, and then `after`.
void put_corner(AtomicFile& file, std::uint32_t vertex, std::uint32_t texture, std::uint32_t normal, char after) {
  const bool has_texture = texture != no_value, has_normal = normal != no_value;
  put(file, std::uint64_t{vertex} + 1, has_texture || has_normal ? '/' : after);
  if (has_texture) put(file, std::uint64_t{texture} + 1, has_normal ? '/' : after);
  if (!has_normal) return;
  if (!has_texture) file.write("/");
  put(file, std::uint64_t{normal} + 1, after);
}

/// Writes the vertices, one for each colour that a vertex of the mesh has, and returns the triangles by the vertices
/// written.
std::vector<Triangle> put_vertices(AtomicFile& file, const TriangleMesh& mesh, const NamedAttribute* colours) {
  if (colours == nullptr) {
    for (const Eigen::Vector3d& p : mesh.vertices) {
      file.write("v ");
      put(file, p, '\n');
    }
    return mesh.triangles;
  }
  SplitVertices vertices = split_vertices(mesh, numbers_below(mesh.triangles.size()), {&colours->index});
  for (std::size_t v = 0; v < vertices.corners.size(); ++v) {
    file.write("v ");
    const std::uint32_t colour = vertices.value(colours->index, v);
    put(file, mesh.vertices[vertices.source(mesh, v)], colour == no_value ? '\n' : ' ');
    if (colour == no_value) continue;
    const double* const rgb = colours->values.data() + colour * colours->width;
    put(file, Eigen::Vector3d(rgb[0], rgb[1], rgb[2]), '\n');
  }
  return std::move(vertices.triangles);
}

}  // namespace

void write_obj(AtomicFile& file, const TriangleMesh& mesh, const MeshAttributes& attributes) {
  for (const std::string& library : attributes.material_libraries)
    file.write("mtllib " + name_on_a_line(library) + "\n");
  const std::vector<Triangle> triangles = put_vertices(file, mesh, colours_of(attributes));
  put_values(file, attributes);
  const auto value = [](const CornerAttribute& attribute, std::size_t t, std::size_t k) {
    return attribute.empty() ? no_value : attribute.index[t][k];
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    put_labels(file, attributes, t);
    file.write("f ");
    for (std::size_t k = 0; k < 3; ++k)
      put_corner(file, triangles[t][k], value(attributes.texture_coordinates, t, k), value(attributes.normals, t, k),
                 k == 2 ? '\n' : ' ');
  }
}

}  // namespace meshbound
