// SPDX-License-Identifier: MIT
#include "mesh/writers.h"

namespace meshbound {
namespace {

constexpr std::uint32_t none = CornerAttribute::none;

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

/// Says what triangle t belongs to where that is not what the one before belongs to.
void put_label(AtomicFile& file, const TriangleLabels& labels, std::size_t t, const char* keyword) {
  if (labels.empty() || labels.index[t] == none || (t > 0 && labels.index[t - 1] == labels.index[t])) return;
  file.write(keyword);
  file.write(labels.names[labels.index[t]]);
  file.write("\n");
}

/// v, v/vt, v//vn or v/vt/vn, and then `after`.
void put_corner(AtomicFile& file, std::uint32_t vertex, std::uint32_t texture, std::uint32_t normal, char after) {
  const bool has_texture = texture != none, has_normal = normal != none;
  put(file, std::uint64_t{vertex} + 1, has_texture || has_normal ? '/' : after);
  if (has_texture) put(file, std::uint64_t{texture} + 1, has_normal ? '/' : after);
  if (!has_normal) return;
  if (!has_texture) file.write("/");
  put(file, std::uint64_t{normal} + 1, after);
}

}  // namespace

void write_obj(AtomicFile& file, const TriangleMesh& mesh, const MeshAttributes& attributes) {
  for (const std::string& library : attributes.material_libraries) file.write("mtllib " + library + "\n");
  for (const Eigen::Vector3d& p : mesh.vertices) {
    file.write("v ");
    put(file, p, '\n');
  }
  put_values(file, attributes);
  const auto value = [](const CornerAttribute& attribute, std::size_t t, std::size_t k) {
    return attribute.empty() ? none : attribute.index[t][k];
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    put_label(file, attributes.groups, t, "");
    put_label(file, attributes.materials, t, "usemtl ");
    file.write("f ");
    for (std::size_t k = 0; k < 3; ++k)
      put_corner(file, mesh.triangles[t][k], value(attributes.texture_coordinates, t, k),
                 value(attributes.normals, t, k), k == 2 ? '\n' : ' ');
  }
}

}  // namespace meshbound
