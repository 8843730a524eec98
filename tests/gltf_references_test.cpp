// SPDX-License-Identifier: MIT
// What extensions and pointers of a document refer to is still what they mean once triangles are others.
#include "mesh/gltf_references.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "gltf_fixture.h"
#include "mesh/gltf_levels.h"
#include "meshbound/error.h"
#include "run_tool.h"

namespace meshbound {
namespace gltf_references_test {

using test::glb_content;
using test::GltfFile;
using test::GltfJson;
using test::read_with_attributes;
using test::textured_sphere;
using testing_tools::content_of;

class GltfReferences : public test::Gltf {
 protected:
  /// The sphere of a node as two levels of one file.
  static GltfJson two_levels(const GltfFile& file) {
    const std::string bytes = file.glb();
    std::vector<GltfLevel> levels;
    for (int i = 0; i < 2; ++i) {
      const MeshSource source{"level.glb", bytes, 0, {}, false};
      levels.push_back({source, read_gltf_document(source)});
    }
    return with_levels(levels, {{0, {0.5, 0}}}, LevelVertices::Apart).json;
  }
};

TEST_F(GltfReferences, WhatSpeaksOfTrianglesByOrderGoes) {
  GltfFile file = textured_sphere(48, 24);
  const GltfJson texture = {{"featureCount", 2}, {"texture", {{"index", 0}}}};
  file.json["meshes"][0]["primitives"][0]["extensions"] = {
      {"FB_ngon_encoding", GltfJson::object()},
      {"EXT_mesh_features", {{"featureIds", GltfJson::array({{{"featureCount", 9}}, texture})}}}};
  EXPECT_EQ(count_lists_of_vertices(file.json), 2U);
  file.write(in("in.glb"));
  (void)simplified(0.02);
  const GltfJson after = glb_content(content_of(in("out.glb"))).json["meshes"][0]["primitives"][0]["extensions"];
  EXPECT_EQ(after, (GltfJson{{"EXT_mesh_features", {{"featureIds", GltfJson::array({texture})}}}}));
}

TEST_F(GltfReferences, InstancesOfAnotherSceneKeepTheirNumbers) {
  GltfFile file = textured_sphere(48, 24);
  file.json["nodes"].push_back(
      {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", 0}}}}}}}});
  file.json["scenes"].push_back({{"nodes", {1}}});
  file.write(in("in.glb"));
  (void)simplified(0.02);
  const GltfJson after = glb_content(content_of(in("out.glb"))).json;
  const std::size_t number = after["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"];
  EXPECT_EQ(after["accessors"][number]["count"], file.json["accessors"][0]["count"]);
}

TEST_F(GltfReferences, LevelsAreBelowNodesThatAreMoreThanAMesh) {
  EXPECT_EQ(two_levels(textured_sphere(8, 4))["nodes"].size(), 2U) << "the node itself has the levels";
  const GltfJson light = {{"KHR_lights_punctual", {{"light", 0}}}}, further = {{"MSFT_lod", {{"ids", {0}}}}};
  for (const GltfJson& more : {GltfJson{{"extensions", light}}, GltfJson{{"extensions", further}},
                               GltfJson{{"camera", 0}}, GltfJson{{"extras", {1, 2}}}}) {
    GltfFile file = textured_sphere(8, 4);
    file.json["nodes"][0].update(more);
    const GltfJson nodes = two_levels(file)["nodes"];
    ASSERT_EQ(nodes.size(), 3U) << more;
    for (const auto& item : more.items()) EXPECT_EQ(nodes[0][item.key()], item.value()) << "as it was";
    EXPECT_FALSE(nodes[0].contains("mesh"));
    EXPECT_EQ(nodes[0]["children"], GltfJson::array({1}));
    EXPECT_EQ(nodes[1]["extensions"]["MSFT_lod"]["ids"], GltfJson::array({2}));
    EXPECT_EQ(nodes[1]["extras"]["MSFT_screencoverage"], GltfJson({0.5, 0.0}));
    for (const auto& item : more.items()) EXPECT_FALSE(nodes[2].contains(item.key()));
  }
}

TEST_F(GltfReferences, PointersMoveAllLevels) {
  for (const std::string property : {"translation", "weights"}) {
    GltfFile file = textured_sphere(8, 4);
    file.json["animations"] = {{{"channels", {{{"target", {{"path", "pointer"}}}}}}}};
    GltfJson& target = file.json["animations"][0]["channels"][0]["target"];
    target["extensions"]["KHR_animation_pointer"]["pointer"] = "/nodes/0/" + property;
    const GltfJson after = two_levels(file);
    EXPECT_EQ(after["nodes"].size(), 3U);
    EXPECT_EQ(after["animations"][0]["channels"][0]["target"]["extensions"]["KHR_animation_pointer"]["pointer"],
              property == "weights" ? "/nodes/1/weights" : "/nodes/0/translation");
  }
}

TEST_F(GltfReferences, TakesRequiredExtensionsThatLeaveTrianglesAlone) {
  GltfFile file = textured_sphere(8, 4);
  file.json["extensionsRequired"] = {"KHR_animation_pointer", "KHR_node_visibility", "EXT_structural_metadata"};
  file.write(in("in.glb"));
  EXPECT_FALSE(read_with_attributes(in("in.glb")).mesh.triangles.empty());
}

TEST_F(GltfReferences, SparseZerosAreJustifiedByAFileOfTheirOwn) {
  GltfFile file = textured_sphere(200, 60);
  const std::size_t where = file.add_view<std::uint16_t>({5}), what = file.add_view<float>({0, 0, 1});
  const std::size_t target =
      file.add_accessor({{"componentType", 5126}, {"count", file.json["accessors"][0]["count"]}, {"type", "VEC3"}});
  file.json["accessors"][target]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", where}, {"componentType", 5123}}}, {"values", {{"bufferView", what}}}};
  file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
  file.json["buffers"] = {{{"uri", "b.bin"}, {"byteLength", file.bytes.size()}}};
  std::ofstream(in("b.bin"), std::ios::binary) << file.bytes;
  std::ofstream(in("in.gltf")) << file.json.dump();
  EXPECT_GT(read_with_attributes(in("in.gltf")).attributes.named.size(), 0U);
  file.json["accessors"][target]["count"] = 100'000'000;
  std::ofstream(in("in.gltf")) << file.json.dump();
  EXPECT_THROW((void)read_with_attributes(in("in.gltf")), InvalidInput);
}

}  // namespace gltf_references_test
}  // namespace meshbound
