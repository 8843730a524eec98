// SPDX-License-Identifier: MIT
#include <array>
#include <map>
#include <string>
#include <vector>

#include "mesh/attribute_check.h"
#include "mesh/no_value.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"
#include "meshbound/texture_deviation.h"

namespace meshbound {
namespace {

void require_texture(const TriangleMesh& mesh, const MeshAttributes& attributes, const char* name) {
  if (attributes.texture_coordinates.empty())
    throw InvalidInput(std::string(name) + " has no texture coordinates, so there is no texture deviation to measure");
  try {
    validate(mesh);
    check_attributes(attributes, mesh.triangles.size());
  } catch (const InvalidInput& defect) {
    throw InvalidInput(std::string(name) + ": " + defect.what());
  }
}

/// Numbers for names of materials: equal names get equal numbers in both meshes.
class MaterialNumbers {
 public:
  explicit MaterialNumbers(bool are_told_apart) : are_told_apart_(are_told_apart) {}
  /// The number of each triangle's material.
  std::vector<std::uint32_t> of(const TriangleLabels& materials, std::size_t triangles) {
    std::vector<std::uint32_t> numbers(triangles, 0);
    if (!are_told_apart_) return numbers;
    std::vector<std::uint32_t> of_index;
    for (const std::string& name : materials.names) of_index.push_back(number_of(name));
    const std::uint32_t of_none = number_of({});
    for (std::size_t t = 0; t < triangles; ++t)
      numbers[t] = materials.index[t] == no_value ? of_none : of_index[materials.index[t]];
    return numbers;
  }

 private:
  std::uint32_t number_of(const std::string& name) {
    return numbers_.try_emplace(name, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }

  bool are_told_apart_;
  std::map<std::string, std::uint32_t> numbers_;
};

/// The precisions of the coordinates of two meshes: of both, each coordinate is rounded to the first and to the second.
using Precisions = std::array<TexturePrecision, 2>;

TexturedMesh textured_mesh(const TriangleMesh& mesh, const MeshAttributes& attributes, const Precisions& precisions,
                           MaterialNumbers& materials) {
  const CornerAttribute& uv = attributes.texture_coordinates;
  const std::vector<std::uint32_t> material = materials.of(attributes.materials, mesh.triangles.size());
  TexturedMesh result;
  result.triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TexturedTriangle triangle;
    bool is_textured = true;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = mesh.vertices[mesh.triangles[t][k]];
      const std::uint32_t index = uv.index[t][k];
      is_textured = is_textured && index != no_value;
      triangle.coordinates[k] = Eigen::Vector2d::Zero();
      if (index != no_value)
        triangle.coordinates[k] = rounded_to(precisions[1], rounded_to(precisions[0], uv.values[index].head<2>()));
    }
    triangle.triangle = static_cast<std::uint32_t>(t);
    triangle.material = material[t];
    if (is_textured)
      result.triangles.push_back(triangle);
    else
      result.bare.push_back(triangle.corners);
  }
  return result;
}

}  // namespace

std::array<TexturedMesh, 2> textured_meshes(const TriangleMesh& a, const MeshAttributes& a_attributes,
                                            const TriangleMesh& b, const MeshAttributes& b_attributes) {
  require_texture(a, a_attributes, "A");
  require_texture(b, b_attributes, "B");
  MaterialNumbers materials(!a_attributes.materials.empty() && !b_attributes.materials.empty());
  const Precisions precisions = {a_attributes.texture_precision, b_attributes.texture_precision};
  TexturedMesh first = textured_mesh(a, a_attributes, precisions, materials);
  return {std::move(first), textured_mesh(b, b_attributes, precisions, materials)};
}

}  // namespace meshbound
