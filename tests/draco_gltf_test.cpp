// SPDX-License-Identifier: MIT
// glTF files compressed by KHR_draco_mesh_compression: decoded, written again without the extension, and refused with
// one line where they are malformed. Draco's own encoder makes the files.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

#include "gltf_validator.h"
#include "mesh/draco_decoder.h"
#include "read_gltf_file.h"

namespace meshbound {
namespace draco_gltf_test {

using test::GltfFile;
using test::GltfJson;

constexpr const char* extension = "KHR_draco_mesh_compression";
constexpr int n = 9;  // squares of the sheet along each side

float height(float x, float y) { return 0.1F * std::sin(7 * x) * std::cos(5 * y); }

/// A wavy sheet of n x n squares, lifted along z, with texture coordinates and colours as bytes, losslessly compressed.
std::string compressed_sheet(int method, float lift = 0) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2 * n * n);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int coordinate = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int colour = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8, true);
  int face = 0;
  const auto add = [&](const std::array<std::array<int, 2>, 3>& corners) {
    std::array<std::array<float, 3>, 3> p;
    std::array<std::array<float, 2>, 3> uv;
    std::array<std::array<std::uint8_t, 4>, 3> rgba;
    for (std::size_t k = 0; k < 3; ++k) {
      const float x = static_cast<float>(corners[k][0]) / n, y = static_cast<float>(corners[k][1]) / n;
      p[k] = {x, y, height(x, y) + lift};
      uv[k] = {x, y};
      rgba[k] = {static_cast<std::uint8_t>(corners[k][0] * 20), 51, 0, 255};
    }
    const draco::FaceIndex f(static_cast<std::uint32_t>(face++));
    builder.SetAttributeValuesForFace(position, f, p[0].data(), p[1].data(), p[2].data());
    builder.SetAttributeValuesForFace(coordinate, f, uv[0].data(), uv[1].data(), uv[2].data());
    builder.SetAttributeValuesForFace(colour, f, rgba[0].data(), rgba[1].data(), rgba[2].data());
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      add({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
      add({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
    }
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*builder.Finalize(), &buffer).ok());
  return {buffer.data(), buffer.size()};
}

class DracoGltf : public testing::TestWithParam<int>, protected test::GltfReading {
 protected:
  static constexpr std::size_t vertices = (n + 1) * (n + 1);

  DracoGltf() : stream_(compressed_sheet(GetParam())) {}

  [[nodiscard]] GltfFile file_of(const std::string& stream) const {
    GltfFile file;
    const std::size_t view = file.add_view(std::vector<char>(stream.begin(), stream.end()));
    GltfJson attributes, identifiers;
    attributes["POSITION"] = file.add_accessor(
        {{"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}, {"min", {0, 0, -0.1}}, {"max", {1, 1, 0.1}}});
    attributes["TEXCOORD_0"] = file.add_accessor({{"componentType", 5126}, {"count", vertices}, {"type", "VEC2"}});
    attributes["COLOR_0"] =
        file.add_accessor({{"componentType", 5121}, {"normalized", true}, {"count", vertices}, {"type", "VEC4"}});
    identifiers = {{"POSITION", 0}, {"TEXCOORD_0", 1}, {"COLOR_0", 2}};
    const std::size_t indices = file.add_accessor({{"componentType", 5123}, {"count", 6 * n * n}, {"type", "SCALAR"}});
    file.json["meshes"] = {{{"primitives",
                             {{{"attributes", attributes},
                               {"indices", indices},
                               {"extensions", {{extension, {{"bufferView", view}, {"attributes", identifiers}}}}}}}}}};
    file.json["nodes"] = {{{"mesh", 0}}};
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {extension};
    return file;
  }
  [[nodiscard]] GltfFile compressed() const { return file_of(stream_); }

  std::string stream_;
};

TEST_P(DracoGltf, IsReadWithAllAttributes) {
  const MeshFile file = read(compressed());
  ASSERT_EQ(file.mesh.triangles.size(), 2U * n * n);
  EXPECT_EQ(file.mesh.vertices.size(), vertices);
  double area = 0;
  for (std::size_t t = 0; t < file.mesh.triangles.size(); ++t) {
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = file.mesh.vertices[file.mesh.triangles[t][k]];
      EXPECT_EQ(p[k].z(), height(static_cast<float>(p[k].x()), static_cast<float>(p[k].y())));
      const Eigen::Vector3d& uv =
          file.attributes.texture_coordinates.values[file.attributes.texture_coordinates.index[t][k]];
      EXPECT_EQ(uv.x(), p[k].x());
      EXPECT_EQ(1 - uv.y(), p[k].y());
      const NamedAttribute& colour = file.attributes.named.at(0);
      EXPECT_NEAR(colour.values[colour.index[t][k] * colour.width], p[k].x() * n * 20 / 255, 1e-6);
      EXPECT_EQ(colour.values[colour.index[t][k] * colour.width + 1], 0.2);
    }
    area += ((p[1] - p[0]).cross(p[2] - p[0])).z() / 2;
  }
  EXPECT_NEAR(area, 1, 1e-6) << "every triangle once, none turned over";
}

TEST_P(DracoGltf, IsWrittenWithoutTheExtension) {
  const MeshFile file = read(compressed());
  write_mesh(folder_ / "out.glb", file.mesh, {}, file.attributes);
  std::ifstream in(folder_ / "out.glb", std::ios::binary);
  const GltfJson json = test::glb_content({std::istreambuf_iterator<char>(in), {}}).json;
  EXPECT_EQ(json.dump().find("draco"), std::string::npos) << json;
  EXPECT_FALSE(json.contains("extensionsRequired"));
  EXPECT_FALSE(json.contains("extensionsUsed"));
  for (const GltfJson& view : json["bufferViews"])
    EXPECT_LE(view.value("byteOffset", std::size_t{0}) + view["byteLength"].get<std::size_t>(),
              json["buffers"][0]["byteLength"].get<std::size_t>());
  const MeshFile back = read_mesh(folder_ / "out.glb", [] {
    ReadOptions o;
    o.attributes = true;
    return o;
  }());
  EXPECT_EQ(back.mesh.triangles, file.mesh.triangles);
  EXPECT_EQ(back.mesh.vertices, file.mesh.vertices);
  EXPECT_EQ(back.attributes.named.at(0).values, file.attributes.named.at(0).values);
}

TEST_P(DracoGltf, KeepsPrimitivesThatTheSceneDoesNotShow) {
  GltfFile file = compressed();
  file.json["meshes"].push_back(file.json["meshes"][0]);  // shares the compressed data and all accessors
  const MeshFile read_back = read(file);
  write_mesh(folder_ / "out.glb", read_back.mesh, {}, read_back.attributes);
  std::ifstream in(folder_ / "out.glb", std::ios::binary);
  GltfFile other;
  const test::GlbContent content = test::glb_content({std::istreambuf_iterator<char>(in), {}});
  other.json = content.json;
  other.bytes = content.bytes;
  other.json["nodes"][0]["mesh"] = 1;
  EXPECT_EQ(read(other, "other.glb").mesh.triangles.size(), 2U * n * n);
}

TEST_P(DracoGltf, PassesTheValidatorOnceItIsWritten) {
  GltfFile compressed_file = compressed();
  compressed_file.json["meshes"].push_back(compressed_file.json["meshes"][0]);  // is not shown, and so passed through
  const MeshFile file = read(compressed_file);
  write_mesh(folder_ / "out.glb", file.mesh, {}, file.attributes);
  const auto errors = test::gltf_errors({folder_ / "out.glb"});
  if (!errors) GTEST_SKIP() << "node or the validator of glTF is not on this machine";
  EXPECT_EQ(*errors, "0 errors\n");
}

TEST_P(DracoGltf, TakesUncompressedDataWhereBothAreThere) {
  GltfFile file = compressed();
  file.json.erase("extensionsRequired");
  file.add_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  file.add_indices({0, 1, 2});
  GltfJson& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["attributes"] = {{"POSITION", 4}};
  primitive["indices"] = 5;
  primitive["extensions"][extension]["attributes"] = {{"POSITION", 0}};
  EXPECT_EQ(read(file).mesh.triangles.size(), 1U);
}

TEST_P(DracoGltf, GivesPrimitivesWithOneAccessorTheirOwnData) {
  GltfFile file = compressed();
  const std::string lifted = compressed_sheet(GetParam(), 1);
  const std::size_t view = file.add_view(std::vector<char>(lifted.begin(), lifted.end()));
  GltfJson& primitives = file.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["extensions"][extension]["bufferView"] = view;
  const MeshFile both = read(file);
  EXPECT_EQ(both.mesh.triangles.size(), 4U * n * n);
  EXPECT_EQ(both.mesh.vertices.size(), 2 * vertices);
}

TEST_P(DracoGltf, RefusesLiesInOneLine) {
  const auto refused = [&](const std::function<void(GltfJson&)>& break_it, const std::string& because) {
    GltfFile file = compressed();
    break_it(file.json);
    const std::string line = refusal(file);
    EXPECT_NE(line.find(because), std::string::npos) << line;
    EXPECT_NE(line.find("m.glb: "), std::string::npos);
    EXPECT_EQ(line.find('\n'), std::string::npos);
  };
  const auto draco = [](GltfJson& json) -> GltfJson& {
    return json["meshes"][0]["primitives"][0]["extensions"][extension];
  };
  refused([](GltfJson& json) { json["accessors"][0]["count"] = vertices + 1; },
          "accessors[0]: declares 101 elements, but 100 are compressed");
  refused([](GltfJson& json) { json["accessors"][3]["count"] = 3; }, "accessors[3]: declares 3 elements, but 486");
  refused([](GltfJson& json) { json["accessors"][0]["type"] = "VEC2"; }, "no such attribute of 2 numbers");
  refused([&](GltfJson& json) { draco(json)["attributes"]["POSITION"] = 9; }, "no such attribute of 3 numbers");
  refused([&](GltfJson& json) { draco(json)["attributes"]["NORMAL"] = 1; }, "'NORMAL' is missing");
  refused([&](GltfJson& json) { draco(json)["bufferView"] = 1; }, "refers to number 1");
  refused([&](GltfJson& json) { draco(json) = 3; }, "expected an object");
  refused([](GltfJson& json) { json["bufferViews"][0]["byteLength"] = 40; }, "the compressed mesh is malformed");
  refused([](GltfJson& json) { json["bufferViews"][0]["byteLength"] = 0; }, "bufferViews[0]: is empty");
  refused([](GltfJson& json) { json["meshes"][0]["primitives"][0]["mode"] = 1; }, "only triangles");
}

TEST_P(DracoGltf, EndsWithAMeshOrOneLineWhateverByteIsWrong) {
  for (std::size_t size = 0; size < stream_.size(); size += 1 + size / 40)
    EXPECT_NE(refusal(file_of(stream_.substr(0, size))), "not refused") << size;
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    std::string broken = stream_;
    broken[random() % std::min<std::size_t>(broken.size(), i % 2 == 0 ? 60 : broken.size())] =
        static_cast<char>(random());
    EXPECT_EQ(refusal(file_of(broken)).find('\n'), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, DracoGltf,
                         testing::Values(draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING));

/// Draco itself compares what Edgebreaker's header declares with other numbers of that header alone.
TEST(DracoMesh, IsNotAllocatedForTrianglesThatCannotBeThere) {
  const std::string stream = compressed_sheet(draco::MESH_EDGEBREAKER_ENCODING);
  // After 12 bytes: the number of vertices in one byte, of triangles in two, of attributes in one, of symbols in two.
  const std::string many = "\x80\x9c\xc9\x9b\x05";  // 1,400,000,000
  const std::string lying = stream.substr(0, 12) + many + many + stream[15] + many + stream.substr(18);
  EXPECT_FALSE(DracoMesh::decode(lying));
}

}  // namespace draco_gltf_test
}  // namespace meshbound
