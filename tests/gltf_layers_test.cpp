// SPDX-License-Identifier: MIT
// Triangles with the same corners that do not look alike are layers: all of them stay, and all are simplified.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "gltf_fixture.h"

namespace meshbound {
namespace gltf_layers_test {

using test::GltfFile;
using test::GltfJson;
using test::read_with_attributes;
using test::textured_sphere;

class GltfLayers : public test::Gltf {
 protected:
  /// Simplifies a sphere and a second primitive with all of its triangles, and returns the faces of both.
  std::array<std::size_t, 2> faces_with(GltfFile file, const GltfJson& second) {
    file.json["meshes"][0]["primitives"].push_back(second);
    file.write(in("in.glb"));
    const MeshFile result = simplified(0.02);
    std::array<std::size_t, 2> faces{};
    for (const std::uint32_t part : result.attributes.part) ++faces.at(part);
    before_ = read_with_attributes(in("in.glb")).mesh.triangles.size() / 2;
    return faces;
  }

  void expect_both_simplified(const std::array<std::size_t, 2>& faces) const {
    for (const std::size_t count : faces) {
      EXPECT_GT(count, before_ / 20);
      EXPECT_LT(count, before_ / 2);
    }
  }

  std::size_t before_ = 0;  ///< triangles of each primitive
};

TEST_F(GltfLayers, ADecalStaysOnItsWall) {
  GltfFile file = textured_sphere(48, 24);
  GltfJson decal = file.json["meshes"][0]["primitives"][0];
  file.json["materials"].push_back({{"name", "graffiti"}, {"alphaMode", "BLEND"}});
  decal["material"] = 1;
  expect_both_simplified(faces_with(file, decal));
}

TEST_F(GltfLayers, TheBackOfASheetStays) {
  GltfFile file = textured_sphere(48, 24);
  GltfJson back = file.json["meshes"][0]["primitives"][0];
  const MeshFile front = [&] {
    file.write(in("front.glb"));
    return read_with_attributes(in("front.glb"));
  }();
  std::vector<std::uint16_t> indices;
  std::vector<float> positions;
  for (const Triangle& t : front.mesh.triangles)
    for (const std::size_t k : {0, 2, 1}) {
      indices.push_back(static_cast<std::uint16_t>(indices.size()));
      for (const double x : front.mesh.vertices[t[k]]) positions.push_back(static_cast<float>(x));
    }
  back = {{"attributes", {{"POSITION", file.add_positions(positions)}}}, {"material", 0}};
  back["indices"] = file.add_indices(indices);
  expect_both_simplified(faces_with(file, back));
}

TEST_F(GltfLayers, PartsThatMorphTargetsMoveApartStay) {
  GltfFile file = textured_sphere(48, 24);
  const std::size_t vertices = file.json["accessors"][0]["count"];
  GltfJson moved = file.json["meshes"][0]["primitives"][0];
  const std::size_t still = file.add_floats(std::vector<float>(3 * vertices, 0), 3);
  const std::size_t away = file.add_floats(std::vector<float>(3 * vertices, 5), 3);
  file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", still}}};
  moved["targets"] = {{{"POSITION", away}}};
  expect_both_simplified(faces_with(file, moved));
}

TEST_F(GltfLayers, OfTrianglesThatAreAlikeOneStays) {
  GltfFile file = textured_sphere(48, 24);
  file.json["nodes"] = {{{"mesh", 0}, {"translation", {1, 2, 3}}}};
  file.write(in("in.glb"));
  MeshFile twice = read_with_attributes(in("in.glb"));
  const std::size_t count = twice.mesh.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    twice.mesh.triangles.push_back(twice.mesh.triangles[t]);
    twice.attributes.part.push_back(twice.attributes.part[t]);
    for (auto* const index : {&twice.attributes.texture_coordinates.index, &twice.attributes.normals.index})
      index->push_back((*index)[t]);
    twice.attributes.materials.index.push_back(twice.attributes.materials.index[t]);
    twice.attributes.objects.index.push_back(twice.attributes.objects.index[t]);
  }
  const MeshFile once = read_with_attributes(in("in.glb"));
  EXPECT_EQ(seams(twice.mesh, twice.attributes), seams(once.mesh, once.attributes)) << "what goes makes no lines";
  SimplifyOptions options;
  options.tolerance = 0.02;
  options.looks = looks(twice.mesh, twice.attributes);
  options.feature_edges = seams(twice.mesh, twice.attributes);
  EXPECT_EQ(decimate_levels(twice.mesh, options, {}).dropped_triangles, count);
  EXPECT_TRUE(looks(once.mesh, once.attributes).empty());
}

}  // namespace gltf_layers_test
}  // namespace meshbound
