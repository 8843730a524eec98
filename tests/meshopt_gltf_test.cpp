// SPDX-License-Identifier: MIT
// glTF files compressed by EXT_meshopt_compression: decoded as meshoptimizer's own decoder does, written again without
// the extension, and refused with one line where they are malformed. The library serves as the encoder and the oracle.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include "gltf_validator.h"
#include "mesh/meshopt_decoder.h"
#include "read_gltf_file.h"

namespace meshbound {
namespace meshopt_gltf_test {

using test::GltfFile;
using test::GltfJson;

constexpr const char* extension = "EXT_meshopt_compression";

std::string bytes_of(const std::vector<unsigned char>& bytes) { return {bytes.begin(), bytes.end()}; }
const unsigned char* data_of(const std::string& bytes) { return reinterpret_cast<const unsigned char*>(bytes.data()); }

std::string encoded_attributes(const void* elements, std::size_t count, std::size_t stride) {
  std::vector<unsigned char> stream(meshopt_encodeVertexBufferBound(count, stride));
  stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), elements, count, stride));
  return bytes_of(stream);
}
std::string encoded_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  meshopt_encodeIndexVersion(1);
  std::vector<unsigned char> stream(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  stream.resize(meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), indices.size()));
  return bytes_of(stream);
}
std::string encoded_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  meshopt_encodeIndexVersion(1);
  std::vector<unsigned char> stream(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
  stream.resize(meshopt_encodeIndexSequence(stream.data(), stream.size(), indices.data(), indices.size()));
  return bytes_of(stream);
}

/// Indices of a grid of n x n squares, each as two triangles, with some triangles between random vertices.
std::vector<std::uint32_t> grid_indices(std::uint32_t n, std::uint32_t random_triangles) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
      indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  }
  std::mt19937 random(1);
  for (std::uint32_t i = 0; i < 3 * random_triangles; ++i)
    indices.push_back(static_cast<std::uint32_t>(random()) % ((n + 1) * (n + 1)));
  return indices;
}

TEST(MeshoptDecoder, DecodesAttributesAsTheLibraryDoes) {
  std::mt19937 random(7);
  for (const std::size_t stride : {4, 12, 16, 64, 256}) {
    for (const std::size_t count : {1, 15, 16, 17, 257, 1000}) {
      std::string elements(count * stride, '\0');
      // Smooth, noisy and constant bytes, for each of the four modes of a group.
      for (std::size_t i = 0; i < elements.size(); ++i)
        elements[i] = static_cast<char>(i % stride % 4 == 0 ? random() : i % stride % 4 == 1 ? i / stride * 3 : 7);
      const auto decoded = decode_meshopt_attributes(encoded_attributes(elements.data(), count, stride), count, stride);
      EXPECT_TRUE(decoded == elements) << count << " elements of " << stride;
    }
  }
}

TEST(MeshoptDecoder, DecodesIndicesAsTheLibraryDoes) {
  for (const std::uint32_t random_triangles : {0U, 5U, 300U}) {
    const std::vector<std::uint32_t> indices = grid_indices(30, random_triangles);
    const std::string triangles = encoded_triangles(indices, 961), sequence = encoded_indices(indices, 961);
    for (const std::size_t stride : {2, 4}) {
      std::string expected(indices.size() * stride, '\0');
      ASSERT_EQ(
          meshopt_decodeIndexBuffer(expected.data(), indices.size(), stride, data_of(triangles), triangles.size()), 0);
      EXPECT_TRUE(decode_meshopt_triangles(triangles, indices.size(), stride) == expected);
      ASSERT_EQ(
          meshopt_decodeIndexSequence(expected.data(), indices.size(), stride, data_of(sequence), sequence.size()), 0);
      EXPECT_TRUE(decode_meshopt_indices(sequence, indices.size(), stride) == expected);
    }
  }
}

/// Four numbers for each of `count` unit vectors, the fourth of them 0 where it is no quaternion.
std::vector<float> unit_vectors(std::size_t count, bool quaternions) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::vector<float> result;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = normal(random), y = normal(random), z = normal(random), w = quaternions ? normal(random) : 0;
    const float length = std::sqrt(x * x + y * y + z * z + w * w);
    result.insert(result.end(), {x / length, y / length, z / length, w / length});
  }
  return result;
}

/// The specification leaves one unit in the last place to the decoder.
template <class T>
void expect_equal_within_one(const std::string& a, const std::string& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); i += sizeof(T)) {
    T x, y;
    std::memcpy(&x, a.data() + i, sizeof(T)), std::memcpy(&y, b.data() + i, sizeof(T));
    ASSERT_LE(std::abs(x - y), 1) << "at byte " << i;
  }
}

TEST(MeshoptDecoder, FiltersAsTheLibraryDoes) {
  constexpr std::size_t count = 500;
  const std::vector<float> normals = unit_vectors(count, false), rotations = unit_vectors(count, true);
  for (const std::size_t stride : {4, 8}) {
    for (const int bits : {4, 7, stride == 4 ? 8 : 16}) {
      std::string ours(count * stride, '\0');
      meshopt_encodeFilterOct(ours.data(), count, stride, bits, normals.data());
      std::string theirs = ours;
      apply_octahedral_filter(ours, stride);
      meshopt_decodeFilterOct(theirs.data(), count, stride);
      stride == 4 ? expect_equal_within_one<std::int8_t>(ours, theirs)
                  : expect_equal_within_one<std::int16_t>(ours, theirs);
    }
  }
  std::string ours(count * 8, '\0');
  meshopt_encodeFilterQuat(ours.data(), count, 8, 12, rotations.data());
  std::string theirs = ours;
  apply_quaternion_filter(ours);
  meshopt_decodeFilterQuat(theirs.data(), count, 8);
  expect_equal_within_one<std::int16_t>(ours, theirs);

  ours.resize(count * 16);
  meshopt_encodeFilterExp(ours.data(), count, 16, 15, rotations.data());
  theirs = ours;
  apply_exponential_filter(ours);
  meshopt_decodeFilterExp(theirs.data(), count, 16);
  EXPECT_TRUE(ours == theirs);
}

TEST(MeshoptDecoder, RefusesStreamsOfAnotherLengthAndSurvivesAnyByte) {
  const std::vector<std::uint32_t> indices = grid_indices(6, 10);
  const std::string elements(40 * 8, '\3');
  const std::string attributes = encoded_attributes(elements.data(), 40, 8);
  const std::string triangles = encoded_triangles(indices, 49), sequence = encoded_indices(indices, 49);
  const auto refuses = [](const auto& decode, const std::string& stream) {
    for (std::size_t size = 0; size < stream.size(); ++size) EXPECT_FALSE(decode(stream.substr(0, size))) << size;
    EXPECT_FALSE(decode(stream + stream[stream.size() - 1]));
    std::mt19937 random(11);
    for (int i = 0; i < 2000; ++i) {
      std::string broken = stream;
      broken[random() % broken.size()] = static_cast<char>(random());
      (void)decode(broken);
    }
  };
  refuses([](const std::string& s) { return decode_meshopt_attributes(s, 40, 8).has_value(); }, attributes);
  refuses([&](const std::string& s) { return decode_meshopt_triangles(s, indices.size(), 2).has_value(); }, triangles);
  refuses([&](const std::string& s) { return decode_meshopt_indices(s, indices.size(), 2).has_value(); }, sequence);
  EXPECT_FALSE(decode_meshopt_attributes(attributes, std::size_t{1} << 40U, 8)) << "no memory for what cannot be there";
  EXPECT_FALSE(decode_meshopt_triangles(triangles, std::size_t{3} << 40U, 4));
  EXPECT_FALSE(decode_meshopt_indices(sequence, std::size_t{1} << 40U, 4));
}

/// A wavy sheet of 12 x 12 squares with normals and texture coordinates.
class MeshoptGltf : public testing::Test, protected test::GltfReading {
 protected:
  static constexpr std::uint32_t n = 12, vertices = (n + 1) * (n + 1);

  MeshoptGltf() : indices_(grid_indices(n, 0)) {
    for (std::uint32_t v = 0; v < vertices; ++v) {
      const float x = static_cast<float>(v % (n + 1)) / n, y = static_cast<float>(v / (n + 1)) / n;
      positions_.insert(positions_.end(), {x, y, 0.1F * std::sin(7 * x) * std::cos(5 * y)});
      coordinates_.insert(coordinates_.end(), {x, y});
    }
  }

  [[nodiscard]] GltfFile plain() const {
    GltfFile file;
    file.add_positions(positions_);
    file.add_floats(coordinates_, 2);
    file.add_indices({indices_.begin(), indices_.end()});
    show(file);
    return file;
  }

  static void show(GltfFile& file) {
    const GltfJson attributes = {{"POSITION", 0}, {"TEXCOORD_0", 1}};
    file.json["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"indices", 2}}}}}};
    file.json["nodes"] = {{{"mesh", 0}}};
  }

  /// The sheet of `plain()` with every view compressed; the uncompressed buffer is a placeholder.
  [[nodiscard]] GltfFile compressed() const {
    GltfFile file = plain();
    file.bytes.clear();
    const GltfJson views = file.json["bufferViews"];
    file.json["bufferViews"] = GltfJson::array();
    std::size_t offset = 0;
    const auto add = [&](const std::string& stream, std::size_t count, std::size_t stride, const char* mode) {
      const std::size_t at = file.bytes.size();
      file.bytes += stream;
      file.json["bufferViews"].push_back({{"buffer", 1},
                                          {"byteOffset", offset},
                                          {"byteLength", count * stride},
                                          {"extensions",
                                           {{extension,
                                             {{"buffer", 0},
                                              {"byteOffset", at},
                                              {"byteLength", stream.size()},
                                              {"byteStride", stride},
                                              {"mode", mode},
                                              {"count", count}}}}}});
      offset += count * stride;
    };
    add(encoded_attributes(positions_.data(), vertices, 12), vertices, 12, "ATTRIBUTES");
    add(encoded_attributes(coordinates_.data(), vertices, 8), vertices, 8, "ATTRIBUTES");
    add(encoded_triangles(indices_, vertices), indices_.size(), 2, "TRIANGLES");
    file.json["buffers"] = {{{"byteLength", file.bytes.size()}},
                            {{"byteLength", offset}, {"extensions", {{extension, {{"fallback", true}}}}}}};
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {extension, "KHR_mesh_quantization"};
    return file;
  }

  std::vector<float> positions_, coordinates_;
  std::vector<std::uint32_t> indices_;
};

/// Positions of the corners of all triangles in the order of their first corner, since the encoder may turn a triangle.
std::vector<Eigen::Vector3d> sorted_corners(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> result;
  for (Triangle t : mesh.triangles) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    for (const std::uint32_t v : t) result.push_back(mesh.vertices[v]);
  }
  return result;
}

TEST_F(MeshoptGltf, IsReadAsTheUncompressedFile) {
  const MeshFile expected = read(plain()), file = read(compressed());
  EXPECT_EQ(file.mesh.triangles.size(), 2U * n * n);
  EXPECT_EQ(sorted_corners(file.mesh), sorted_corners(expected.mesh));
  EXPECT_EQ(file.attributes.texture_coordinates.values, expected.attributes.texture_coordinates.values);
}

TEST_F(MeshoptGltf, IsWrittenWithoutTheExtension) {
  const MeshFile file = read(compressed());
  write_mesh(folder_ / "out.glb", file.mesh, {}, file.attributes);
  std::ifstream in(folder_ / "out.glb", std::ios::binary);
  const std::string written((std::istreambuf_iterator<char>(in)), {});
  const GltfJson json = test::glb_content(written).json;
  EXPECT_EQ(json.dump().find(extension), std::string::npos) << json;
  EXPECT_EQ(json["extensionsRequired"], GltfJson({"KHR_mesh_quantization"}));
  EXPECT_EQ(json["buffers"].size(), 1U);
  EXPECT_EQ(sorted_corners(read_mesh(folder_ / "out.glb").mesh), sorted_corners(file.mesh));
}

TEST_F(MeshoptGltf, PassesTheValidatorOnceItIsWritten) {
  const MeshFile file = read(compressed());
  write_mesh(folder_ / "out.glb", file.mesh, {}, file.attributes);
  const auto errors = test::gltf_errors({folder_ / "out.glb"});
  if (!errors) GTEST_SKIP() << "node or the validator of glTF is not on this machine";
  EXPECT_EQ(*errors, "0 errors\n");
}

TEST_F(MeshoptGltf, RefusesLiesInOneLine) {
  const auto refused = [&](const char* key, const GltfJson& value, const std::string& because) {
    GltfFile file = compressed();
    file.json["bufferViews"][0]["extensions"][extension][key] = value;
    const std::string line = refusal(file);
    EXPECT_NE(line.find("m.glb: bufferViews[0].extensions.EXT_meshopt_compression"), std::string::npos) << line;
    EXPECT_NE(line.find(because), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  };
  refused("count", vertices + 1, "another length than 170 elements");
  refused("byteLength", 100, "the compressed data are malformed");
  refused("byteLength", 1e7, "reaches beyond");
  refused("byteStride", 6, "elements of 6 bytes have no mode 'ATTRIBUTES'");
  refused("buffer", 7, "refers to number 7");
  refused("mode", "SPLINES", "the mode 'SPLINES' is not known");
  refused("mode", "TRIANGLES", "elements of 12 bytes have no mode 'TRIANGLES'");
  refused("filter", "OCTAHEDRAL", "with the filter 'OCTAHEDRAL'");
  refused("filter", "COLOR", "with the filter 'COLOR'");
  GltfFile broken = compressed();
  broken.bytes[0] = '\1';
  EXPECT_NE(refusal(broken).find("the compressed data are malformed"), std::string::npos);
  GltfFile few = compressed();
  few.json["accessors"][0]["count"] = n;
  EXPECT_NE(refusal(few).find("refers to vertex"), std::string::npos) << "indices out of range";
}

}  // namespace meshopt_gltf_test
}  // namespace meshbound
