// SPDX-License-Identifier: MIT
// glTF and GLB are read as a viewer shows them: the triangles of the default scene, placed by their nodes. Files that
// lie are refused with a line that says where.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "gltf_file.h"
#include "mesh/data_uri.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "temporary_folder.h"

namespace meshbound {
namespace read_gltf_test {

using test::GltfFile;
using test::GltfJson;

constexpr std::uint32_t none = CornerAttribute::none;

/// The unit square of the plane z = 0 as two triangles.
GltfFile square() {
  GltfFile file;
  file.add_positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  file.add_indices({0, 1, 2, 0, 2, 3});
  file.json["meshes"] = {{{"name", "square"}, {"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
  file.json["nodes"] = {{{"mesh", 0}}};
  return file;
}

class ReadGltf : public testing::Test {
 protected:
  MeshFile read(const GltfFile& file, bool attributes = false) {
    file.write(folder_ / "m.glb");
    ReadOptions options;
    options.attributes = attributes;
    return read_mesh(folder_ / "m.glb", options);
  }
  /// The one line that refuses a file.
  std::string refusal(const std::string& bytes, const std::string& name = "m.glb") {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    try {
      (void)read_mesh(folder_ / name);
    } catch (const Error& error) {
      return error.what();
    }
    return "not refused";
  }
  std::string refusal(const GltfFile& file) { return refusal(file.glb()); }

  test::TemporaryFolder folder_;
};

void expect_vertex(const MeshFile& file, std::size_t triangle, std::size_t corner, const Eigen::Vector3d& p) {
  EXPECT_LT((file.mesh.vertices[file.mesh.triangles[triangle][corner]] - p).norm(), 1e-14)
      << file.mesh.vertices[file.mesh.triangles[triangle][corner]].transpose();
}

TEST_F(ReadGltf, PlacesMeshesByTheirNodes) {
  GltfFile file = square();
  const double half = std::sqrt(0.5);  // a quarter turn about z
  file.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}},
                        {{"mesh", 0}, {"rotation", {0, 0, half, half}}, {"scale", {2, 3, 1}}}};
  const MeshFile read_back = read(file);
  ASSERT_EQ(read_back.mesh.triangles.size(), 2U);
  EXPECT_EQ(read_back.mesh.vertices.size(), 4U);
  expect_vertex(read_back, 0, 1, {10, 2, 0});
  expect_vertex(read_back, 0, 2, {7, 2, 0});
  file.json["nodes"] = {{{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}};
  expect_vertex(read(file), 0, 2, {6, 8, 7});
}

TEST_F(ReadGltf, ShowsAMeshOfSeveralNodesSeveralTimesAndNothingOfOtherScenes) {
  GltfFile file = square();
  file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 0, 4}}}, {{"mesh", 0}}};
  file.json["scenes"] = {{{"nodes", {2}}}, {{"nodes", {0, 1}}}};
  file.json["scene"] = 1;
  const MeshFile both = read(file);
  EXPECT_EQ(both.mesh.triangles.size(), 4U);
  expect_vertex(both, 2, 0, {0, 0, 4});
  file.json["nodes"][1]["scale"] = {-1, 1, 1};  // mirrored: the viewer turns the triangles over
  expect_vertex(read(file), 2, 1, {-1, 1, 4});
  expect_vertex(read(file), 2, 2, {-1, 0, 4});
}

TEST_F(ReadGltf, TakesStripsFansAndTrianglesWithoutIndices) {
  GltfFile file = square();
  GltfJson& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["mode"] = 6;
  primitive.erase("indices");
  const MeshFile fan = read(file);
  ASSERT_EQ(fan.mesh.triangles.size(), 2U);
  EXPECT_EQ(fan.decoded_strips, 1U);
  expect_vertex(fan, 1, 0, {1, 1, 0});
  expect_vertex(fan, 1, 2, {0, 0, 0});
  primitive["mode"] = 5;
  file.add_indices({0, 1, 3, 2, 2, 2});
  primitive["indices"] = 2;
  const MeshFile strip = read(file);
  ASSERT_EQ(strip.mesh.triangles.size(), 2U) << "triangles that repeat a corner only end the strip";
  expect_vertex(strip, 1, 0, {1, 0, 0});
  expect_vertex(strip, 1, 1, {1, 1, 0});
  primitive["mode"] = 4;
  primitive["indices"] = 1;
  file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  EXPECT_EQ(read(file).ignored_elements, 1U) << "lines are no triangles";
  EXPECT_EQ(read(file).dropped.other_elements, 1U);
  const MeshFile with_document = read(file, true);
  EXPECT_EQ(with_document.dropped.other_elements, 0U);
  DroppedAttributes lost;
  (void)carried_by(FileFormat::Glb, with_document.attributes, lost);
  EXPECT_EQ(lost.other_elements, 0U) << "the document has them";
  (void)carried_by(FileFormat::Obj, with_document.attributes, lost);
  EXPECT_EQ(lost.other_elements, 1U);
}

TEST_F(ReadGltf, DecodesSparseStridedAndNormalisedNumbers) {
  GltfFile file = square();
  const std::size_t where = file.add_view<std::uint8_t>({2});
  const std::size_t what = file.add_view<float>({7, 8, 9});
  file.json["accessors"][0]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", where}, {"componentType", 5121}}}, {"values", {{"bufferView", what}}}};
  expect_vertex(read(file), 0, 2, {7, 8, 9});

  GltfFile quantised = square();
  quantised.json["extensionsRequired"] = quantised.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  // Each position is followed by two bytes that belong to nothing.
  const std::size_t view = quantised.add_view<std::int16_t>({0, 0, 0, 99, 32767, 0, 0, 99, 32767, -32768, 0, 99}, 8);
  const std::size_t accessor = quantised.add_accessor(
      {{"bufferView", view}, {"componentType", 5122}, {"normalized", true}, {"count", 3}, {"type", "VEC3"}});
  quantised.add_indices({0, 1, 2});
  quantised.json["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", accessor}}}, {"indices", 3}};
  const MeshFile decoded = read(quantised);
  ASSERT_EQ(decoded.mesh.triangles.size(), 1U);
  expect_vertex(decoded, 0, 2, {1, -1, 0});
}

TEST_F(ReadGltf, FindsBuffersInDataUrisAndBesideTheFile) {
  GltfFile file = square();
  file.json["buffers"] = {{{"byteLength", file.bytes.size()}, {"uri", "my%20data.bin"}}};
  std::ofstream(folder_ / "my data.bin", std::ios::binary) << file.bytes;
  std::ofstream(folder_ / "m.gltf") << file.json.dump(2);
  EXPECT_EQ(read_mesh(folder_ / "m.gltf").mesh.triangles.size(), 2U);
  file.json["buffers"][0]["uri"] =
      "data:application/octet-stream;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA";
  std::ofstream(folder_ / "d.gltf") << file.json.dump();
  const MeshFile decoded = read_mesh(folder_ / "d.gltf");
  EXPECT_EQ(decoded.mesh.triangles.size(), 2U);
  expect_vertex(decoded, 1, 2, {0, 1, 0});
}

TEST_F(ReadGltf, CollectsAttributesByName) {
  GltfFile file = square();
  GltfJson& primitive = file.json["meshes"][0]["primitives"][0];
  GltfJson& attributes = primitive["attributes"];
  attributes["NORMAL"] = file.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
  attributes["TEXCOORD_0"] = file.add_floats({0, 0, 1, 0, 1, 0.75, 0, 1}, 2);
  attributes["TEXCOORD_1"] = file.add_floats({5, 5, 6, 5, 6, 6, 5, 6}, 2);
  attributes["TANGENT"] = file.add_floats({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, 4);
  attributes["_HEAT"] = file.add_floats({1, 2, 3, 4}, 1);
  attributes["COLOR_0"] = file.add<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255, 51, 51, 51}, 5121, "VEC3", 3);
  file.json["accessors"].back()["normalized"] = true;
  primitive["targets"] = {{{"POSITION", file.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3)}}};
  primitive["material"] = 0;
  file.json["materials"] = {{{"name", "red\nbrick"}}};
  file.json["nodes"][0]["rotation"] = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // z becomes -y
  const MeshFile found = read(file, true);
  const MeshAttributes& a = found.attributes;
  EXPECT_EQ(found.rest_pose_parts, 1U);
  EXPECT_EQ(a.materials.names, std::vector<std::string>{"red_brick"});
  EXPECT_EQ(a.objects.names, std::vector<std::string>{"square"});
  EXPECT_EQ(a.texture_coordinates.values[2], Eigen::Vector3d(1, 0.25, 0)) << "v grows upwards";
  EXPECT_LT((a.normals.values[0] - Eigen::Vector3d(0, -1, 0)).norm(), 1e-14);
  EXPECT_EQ(a.part, (std::vector<std::uint32_t>{0, 0}));
  std::vector<std::string> names;
  for (const NamedAttribute& named : a.named) {
    names.push_back(named.name);
    EXPECT_EQ(named.index, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}})) << named.name;
    EXPECT_EQ(named.interpolation, named.name == "TANGENT" ? Interpolation::Direction : Interpolation::Linear);
    if (named.name != "COLOR_0") continue;
    EXPECT_EQ(named.values[15], 1) << "opaque where the file says nothing";
    EXPECT_EQ(named.values[12], 0.2);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"TEXCOORD_1", "TANGENT", "_HEAT", "COLOR_0", "targets/0/POSITION"}));
  const DroppedAttributes dropped = read(file).dropped;
  EXPECT_EQ(dropped.texture_coordinates, 8U);
  EXPECT_EQ(dropped.normals, 4U);
  EXPECT_EQ(dropped.colours, 4U);
  EXPECT_EQ(dropped.materials, 1U);
  EXPECT_EQ(dropped.other_properties, 3U);
}

TEST_F(ReadGltf, SaysOfPrimitivesWithoutAnAttributeThatTheyHaveNone) {
  GltfFile file = square();
  const std::size_t heat = file.add_floats({1, 2, 3, 4}, 1);
  GltfJson& primitives = file.json["meshes"][0]["primitives"];
  primitives.push_back({{"attributes", {{"POSITION", 0}, {"_HEAT", heat}}}, {"indices", 1}});
  primitives.push_back(primitives[0]);
  const MeshAttributes a = read(file, true).attributes;
  ASSERT_EQ(a.named.size(), 1U);
  const Triangle without = {none, none, none};
  EXPECT_EQ(a.named[0].index, (std::vector<Triangle>{without, without, {0, 1, 2}, {0, 2, 3}, without, without}));
}

TEST_F(ReadGltf, RefusesContainersThatLie) {
  const std::string good = square().glb();
  EXPECT_NE(refusal(good.substr(0, 10)).find("ends inside the header"), std::string::npos);
  EXPECT_NE(refusal(good.substr(0, good.size() - 1)).find("the header declares"), std::string::npos);
  std::string version = good;
  version[4] = 1;
  EXPECT_NE(refusal(version).find("version 1 of GLB"), std::string::npos);
  std::string chunk = good;
  chunk[13] = 0x7f;
  EXPECT_NE(refusal(chunk).find("a chunk of GLB reaches beyond"), std::string::npos);
  EXPECT_NE(refusal("{\"asset\": ", "m.gltf").find("byte 10: the JSON of glTF is malformed here"), std::string::npos);
  EXPECT_NE(refusal(std::string(5000, '['), "m.gltf").find("inside each other"), std::string::npos);
  EXPECT_NE(refusal("{}", "m.gltf").find("'asset' is missing"), std::string::npos);
}

TEST_F(ReadGltf, RefusesReferencesBeyondWhatIsThere) {
  const auto refused = [&](const std::function<void(GltfJson&)>& break_it, const std::string& because) {
    GltfFile file = square();
    break_it(file.json);
    const std::string line = refusal(file);
    EXPECT_NE(line.find(because), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_NE(line.find("m.glb: "), std::string::npos);
  };
  refused([](GltfJson& json) { json["nodes"][0]["mesh"] = 1; }, "nodes[0].mesh: refers to number 1");
  refused([](GltfJson& json) { json["nodes"][0]["children"] = {0}; }, "nodes[0]: the node has two parents");
  refused([](GltfJson& json) { json["accessors"][1]["count"] = 7; }, "accessors[1]: its 7 elements reach beyond");
  refused([](GltfJson& json) { json["accessors"][0]["count"] = 3; }, "refers to vertex 3");
  refused([](GltfJson& json) { json["bufferViews"][0]["byteLength"] = 1e6; }, "bufferViews[0]: reaches beyond");
  refused([](GltfJson& json) { json["accessors"][0].erase("bufferView"), json["accessors"][0]["count"] = 1e9; },
          "without any data");
  refused([](GltfJson& json) { json["accessors"][0]["type"] = "MAT4"; }, "'MAT4' are not read");
  refused([](GltfJson& json) { json["accessors"][0]["count"] = -1; }, "an integer that is not negative");
  refused([](GltfJson& json) { json["meshes"] = 5; }, "expected an array");
  refused([](GltfJson& json) { json["scenes"][0]["nodes"] = GltfJson::array(); }, "no vertices and no faces");
  refused([](GltfJson& json) { json["extensionsRequired"] = {"ACME_folded_triangles"}; }, "'ACME_folded_triangles'");
  refused(
      [](GltfJson& json) {
        json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = GltfJson::object();
      },
      "KHR_draco_mesh_compression: 'attributes' is missing");
  refused([](GltfJson& json) { json["extensionsRequired"] = {"KHR_meshopt_compression"}; },
          "'KHR_meshopt_compression'");
  refused([](GltfJson& json) { json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = 1; },
          "EXT_meshopt_compression");
  refused([](GltfJson& json) { json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = 1; },
          "EXT_mesh_gpu_instancing");
}

TEST_F(ReadGltf, RefusesPositionsThatAreNotFinite) {
  GltfFile file = square();
  const float infinite = std::numeric_limits<float>::infinity();
  std::memcpy(file.bytes.data() + 16, &infinite, sizeof(float));
  EXPECT_NE(refusal(file).find("the position of vertex 1 is not finite"), std::string::npos);
}

TEST_F(ReadGltf, ReadsNoFileOutsideOfRelativeNames) {
  GltfFile file = square();
  for (const char* const uri : {"/etc/passwd", "file:///etc/passwd", "http://example.org/a.bin", "%00"}) {
    file.json["buffers"] = {{{"byteLength", file.bytes.size()}, {"uri", uri}}};
    EXPECT_NE(refusal(file.json.dump(), "m.gltf").find("neither a data URI nor the relative name"), std::string::npos);
  }
  file.json["buffers"][0]["uri"] = "missing.bin";
  EXPECT_NE(refusal(file.json.dump(), "m.gltf").find("missing.bin: cannot read"), std::string::npos);
}

/// RFC 4648, section 10, and bytes that give the last two letters of the alphabet.
TEST(EncodeBase64, GivesTheVectorsOfRfc4648) {
  const std::map<std::string, std::string> vectors = {{"", ""},
                                                      {"f", "Zg=="},
                                                      {"fo", "Zm8="},
                                                      {"foo", "Zm9v"},
                                                      {"foob", "Zm9vYg=="},
                                                      {"fooba", "Zm9vYmE="},
                                                      {"foobar", "Zm9vYmFy"},
                                                      {std::string("\xff\x00\xfe", 3), "/wD+"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(encode_base64(bytes), text);
}

}  // namespace read_gltf_test
}  // namespace meshbound
