// SPDX-License-Identifier: MIT
#include "verify/texture_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <string>

#include "verify/certificate_reader.h"
#include "verify/checksum.h"
#include "verify/scaling.h"

namespace meshbound::verify {
namespace {

std::string material_of(const MeshAttributes& attributes, std::size_t triangle) {
  const std::uint32_t label = attributes.materials.index[triangle];
  return label < attributes.materials.names.size() ? attributes.materials.names[label] : std::string();
}

/// The number that a float holds in the place of `x`; kept in memory, so that no compiler leaves the rounding out.
double as_float(double x) {
  const volatile auto stored = static_cast<float>(x);
  return static_cast<double>(stored);
}

Eigen::Vector2d as_held_by(const TexturedFile& file, const Eigen::Vector2d& uv) {
  if (file.attributes->texture_precision == TexturePrecision::Float) return {as_float(uv.x()), as_float(uv.y())};
  if (file.attributes->texture_precision == TexturePrecision::FloatFromTop)
    return {as_float(uv.x()), 1 - as_float(1 - uv.y())};
  return uv;
}

using EdgeVectors = std::array<Eigen::Vector3d, 2>;

/// Half of the two edge vectors at the first corner of triangle `t`: halves do not overflow.
EdgeVectors half_edges(const TriangleMesh& mesh, std::size_t t) {
  const auto half = [&](std::size_t k) -> Eigen::Vector3d { return 0.5 * mesh.vertices[mesh.triangles[t][k]]; };
  return {half(1) - half(0), half(2) - half(0)};
}

/// The largest coordinate of all half edges.
double size_of_edges(const TriangleMesh& mesh) {
  double size = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Eigen::Vector3d& edge : half_edges(mesh, t)) size = std::max(size, edge.cwiseAbs().maxCoeff());
  return size;
}

/// The surface of `file`, which is one of the two that are compared.
TextureSurface surface_of(const TexturedFile& file, const char* name, const TexturedFile& original,
                          const TexturedFile& simplified) {
  const auto& indices = file.attributes->texture_coordinates.index;
  const auto& values = file.attributes->texture_coordinates.values;
  const std::size_t count = file.mesh->triangles.size();
  if (indices.size() != count)
    throw Rejected(std::string("the certificate speaks of texture, but the ") + name +
                   " mesh has no texture coordinates");
  TextureSurface surface;
  const double size = size_of_edges(*file.mesh), scale = size > 0 ? power_for(size) : 1;
  surface.of_index.assign(count, -1);
  for (std::size_t t = 0; t < count; ++t) {
    TextureSurface::Triangle triangle;
    triangle.index = static_cast<std::uint32_t>(t);
    bool is_textured = true;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = file.mesh->vertices[file.mesh->triangles[t][k]];
      if (indices[t][k] >= values.size())
        is_textured = false;
      else
        triangle.coordinates[k] = as_held_by(simplified, as_held_by(original, values[indices[t][k]].head<2>()));
    }
    const EdgeVectors edges = half_edges(*file.mesh, t);
    triangle.area = (scale * edges[0]).cross(scale * edges[1]).norm();
    surface.area += triangle.area;
    if (!is_textured) {
      surface.bare_area += triangle.area;
      continue;
    }
    for (const Eigen::Vector2d& uv : triangle.coordinates)
      if (!uv.allFinite())
        throw Rejected(std::string("the ") + name + " mesh has a texture coordinate that is not finite");
    surface.of_index[t] = static_cast<std::int64_t>(surface.triangles.size());
    surface.triangles.push_back(triangle);
  }
  return surface;
}

}  // namespace

std::array<TextureSurface, 2> texture_surfaces(const TexturedFile& original, const TexturedFile& simplified) {
  std::array surfaces = {surface_of(original, "original", original, simplified),
                         surface_of(simplified, "simplified", original, simplified)};
  if (original.attributes->materials.index.empty() || simplified.attributes->materials.index.empty()) return surfaces;
  std::map<std::string, std::uint32_t> number_of;
  const std::array files = {&original, &simplified};
  for (std::size_t i = 0; i < 2; ++i)
    for (TextureSurface::Triangle& triangle : surfaces[i].triangles)
      triangle.material =
          number_of.try_emplace(material_of(*files[i]->attributes, triangle.index), number_of.size()).first->second;
  return surfaces;
}

void scale_coordinates(std::array<TextureSurface, 2>& surfaces) {
  const auto for_each = [&](const auto& visit) {
    for (TextureSurface& surface : surfaces)
      for (TextureSurface::Triangle& triangle : surface.triangles)
        for (Eigen::Vector2d& uv : triangle.coordinates)
          for (double& x : uv) visit(x);
  };
  const double scale = common_scale(for_each);
  for_each([scale](double& x) { x *= scale; });
}

std::uint64_t checksum_of(const TextureSurface& surface) {
  Checksum checksum;
  for (const TextureSurface::Triangle& triangle : surface.triangles) {
    checksum.add_little_endian(triangle.index, 4);
    for (const Eigen::Vector2d& uv : triangle.coordinates)
      for (const double x : uv) checksum.add_little_endian(std::bit_cast<std::uint64_t>(x), 8);
  }
  return checksum.value();
}

}  // namespace meshbound::verify
