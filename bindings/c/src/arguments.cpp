// SPDX-License-Identifier: MIT
#include "arguments.h"

#include <cstdint>
#include <limits>

namespace meshbound::c_interface {
namespace {

template <class Coordinate>
MeshView typed_view(const mb_mesh& mesh, size_t stride, const std::string& name) {
  const auto* positions = static_cast<const Coordinate*>(mesh.positions);
  switch (mesh.index_type) {
    case MB_UINT16:
      return {positions, mesh.vertex_count, stride, static_cast<const std::uint16_t*>(mesh.indices),
              mesh.triangle_count};
    case MB_UINT32:
      return {positions, mesh.vertex_count, stride, static_cast<const std::uint32_t*>(mesh.indices),
              mesh.triangle_count};
  }
  throw InvalidInput(name + ".index_type is neither MB_UINT16 nor MB_UINT32");
}

size_t coordinate_size(const mb_mesh& mesh, const std::string& name) {
  switch (mesh.coordinate_type) {
    case MB_FLOAT32:
      return sizeof(float);
    case MB_FLOAT64:
      return sizeof(double);
  }
  throw InvalidInput(name + ".coordinate_type is neither MB_FLOAT32 nor MB_FLOAT64");
}

}  // namespace

MeshView view_of(const mb_mesh* mesh, const char* argument) {
  const std::string name = argument;
  if (mesh == nullptr) throw InvalidInput("the argument " + name + " is NULL");
  const size_t packed = 3 * coordinate_size(*mesh, name);
  const size_t stride = mesh->position_stride == 0 ? packed : mesh->position_stride;
  if (stride < packed)
    throw InvalidInput(name + ".position_stride is " + std::to_string(stride) + " bytes, less than the " +
                       std::to_string(packed) + " of a position");
  constexpr size_t max_count = std::numeric_limits<std::uint32_t>::max();
  if (mesh->vertex_count > max_count || mesh->triangle_count > max_count)
    throw InvalidInput(name + " has more than 2^32 - 1 vertices or triangles");
  if (mesh->positions == nullptr && mesh->vertex_count > 0) throw InvalidInput(name + ".positions is NULL");
  if (mesh->indices == nullptr && mesh->triangle_count > 0) throw InvalidInput(name + ".indices is NULL");
  return mesh->coordinate_type == MB_FLOAT32 ? typed_view<float>(*mesh, stride, name)
                                             : typed_view<double>(*mesh, stride, name);
}

MeshView valid_view_of(const mb_mesh* mesh, const char* argument) {
  const MeshView view = view_of(mesh, argument);
  validate(view);
  return view;
}

}  // namespace meshbound::c_interface
