// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "mesh_files.h"

namespace meshbound::test {
namespace read_ply_test {

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string corners = "property list uchar int vertex_indices\n";
const std::string ascii = "ply\nformat ascii 1.0\n";
const std::string triangle_header = ascii + "element vertex 3\n" + xyz + "element face 1\n" + corners + "end_header\n";
const std::string triangle = triangle_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

MeshFile read(const std::string& content) { return read_content("m.ply", content); }
std::string refused(const std::string& content) { return refusal("m.ply", content); }

/// Bytes of the data part of a binary file, in the byte order asked for. Tests run on little-endian machines.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}
  template <class T>
  Bytes& add(std::initializer_list<double> values) {
    for (const double number : values) {
      const T value = static_cast<T>(number);
      char raw[sizeof(T)];
      std::memcpy(raw, &value, sizeof(T));
      if (big_endian_) std::reverse(raw, raw + sizeof(T));
      text_.append(raw, sizeof(T));
    }
    return *this;
  }
  operator const std::string&() const { return text_; }  // NOLINT(google-explicit-constructor)

 private:
  bool big_endian_;
  std::string text_;
};

std::string start(bool big_endian) {
  return std::string("ply\nformat binary_") + (big_endian ? "big" : "little") + "_endian 1.0\n";
}

template <class Real>
void expect_binary(const std::string& real, bool big_endian) {
  const std::string header = start(big_endian) + "element vertex 3\nproperty " + real + " x\nproperty " + real +
                             " y\nproperty " + real + " z\nelement face 1\n" + corners + "end_header\n";
  Bytes bytes(big_endian);
  bytes.add<Real>({0, 0, 0, 1, 0, 0, 0, 1, 0}).template add<std::uint8_t>({3}).template add<std::int32_t>({0, 1, 2});
  SCOPED_TRACE(real);
  expect_triangle(read(header + std::string(bytes)));
}

TEST(ReadPly, ReadsText) {
  expect_triangle(read(triangle));
  expect_triangle(read("\xEF\xBB\xBF" + triangle));
}

TEST(ReadPly, ReadsCoordinatesOfEveryTypeInBothByteOrders) {
  for (const bool big_endian : {false, true}) {
    for (const char* name : {"float", "float32"}) expect_binary<float>(name, big_endian);
    for (const char* name : {"double", "float64"}) expect_binary<double>(name, big_endian);
    for (const char* name : {"char", "int8"}) expect_binary<std::int8_t>(name, big_endian);
    for (const char* name : {"uchar", "uint8"}) expect_binary<std::uint8_t>(name, big_endian);
    for (const char* name : {"short", "int16"}) expect_binary<std::int16_t>(name, big_endian);
    for (const char* name : {"ushort", "uint16"}) expect_binary<std::uint16_t>(name, big_endian);
    for (const char* name : {"int", "int32"}) expect_binary<std::int32_t>(name, big_endian);
    for (const char* name : {"uint", "uint32"}) expect_binary<std::uint32_t>(name, big_endian);
  }
}

template <class Count, class Index>
void expect_list(const std::string& count, const std::string& index, bool big_endian) {
  const std::string header = start(big_endian) + "element vertex 3\n" + xyz + "element face 1\nproperty list " + count +
                             " " + index + " vertex_index\nend_header\n";
  Bytes bytes(big_endian);
  bytes.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}).template add<Count>({3}).template add<Index>({0, 1, 2});
  SCOPED_TRACE(count + " " + index);
  expect_triangle(read(header + std::string(bytes)));
}

TEST(ReadPly, ReadsListsOfEveryType) {
  for (const bool big_endian : {false, true}) {
    expect_list<std::uint8_t, std::uint32_t>("uchar", "uint", big_endian);
    expect_list<std::int8_t, std::int16_t>("char", "short", big_endian);
    expect_list<std::int32_t, std::int32_t>("int", "int", big_endian);
    expect_list<std::uint16_t, std::uint8_t>("ushort", "uchar", big_endian);
    expect_list<std::uint32_t, std::uint16_t>("uint", "ushort", big_endian);
    expect_list<float, double>("float", "double", big_endian);
  }
}

TEST(ReadPly, StepsOverOtherPropertiesAndElements) {
  const std::string elements =
      "comment made by hand\nobj_info none\nelement camera 2\nproperty float view\nproperty list uchar short shape\n"
      "element vertex 3\nproperty uchar red\nproperty float z\nproperty float y\nproperty list uchar double extra\n"
      "property float x\nelement marker 1000000000\nelement face 1\nproperty list uchar float texcoord\n" +
      corners + "property int flags\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  const MeshFile text = read(ascii + elements +
                             "1.5 2 7 8\nnan 0\n255 0 0 0 0\n0 0 0 2 1e999 x 1\n0 0 1 1 5 0\n2 .5 .5 3 0 1 2 9\n0 1\n");
  expect_triangle(text);
  const DroppedAttributes dropped{.texture_coordinates = 1, .colours = 3, .other_properties = 6};
  EXPECT_EQ(text.dropped, dropped);
  for (const bool big_endian : {false, true}) {
    Bytes b(big_endian);
    b.add<float>({1.5}).add<std::uint8_t>({2}).add<std::int16_t>({7, 8}).add<float>({2}).add<std::uint8_t>({0});
    b.add<std::uint8_t>({255}).add<float>({0, 0}).add<std::uint8_t>({0}).add<float>({0});
    b.add<std::uint8_t>({0}).add<float>({0, 0}).add<std::uint8_t>({2}).add<double>({8, 9}).add<float>({1});
    b.add<std::uint8_t>({0}).add<float>({0, 1}).add<std::uint8_t>({1}).add<double>({5}).add<float>({0});
    b.add<std::uint8_t>({2}).add<float>({.5, .5}).add<std::uint8_t>({3}).add<std::int32_t>({0, 1, 2, 9, 0, 1});
    const MeshFile file = read(start(big_endian) + elements + std::string(b));
    expect_triangle(file);
    EXPECT_EQ(file.dropped, dropped);
  }
}

TEST(ReadPly, CountsAttributesByTheNamesOfTheirProperties) {
  EXPECT_EQ(read(triangle).dropped, DroppedAttributes{});
  const std::string attributes =
      "comment TextureFile a b.png\ncomment \\\nelement material 2\nproperty int id\nelement vertex 3\n" + xyz +
      "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n"
      "property uchar alpha\nproperty float confidence\nelement face 1\n" +
      corners + "property uchar red\nend_header\n";
  EXPECT_EQ(
      read(ascii + attributes + "1\n2\n0 0 0 0 0 1 0 0 9 1\n1 0 0 0 0 1 0 0 9 1\n0 1 0 0 0 1 0 0 9 1\n3 0 1 2 255\n")
          .dropped,
      (DroppedAttributes{.texture_coordinates = 3, .normals = 3, .colours = 4, .materials = 3, .other_properties = 1}));
}

TEST(ReadPly, TakesFacesBeforeVertices) {
  expect_triangle(read(ascii + "element face 1\n" + corners + "element vertex 3\n" + xyz +
                       "end_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n"));
}

TEST(ReadPly, TakesEveryKindOfLineEnd) {
  std::string crlf;
  for (const char c : triangle) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_triangle(read(crlf));
  std::string cr = triangle;
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  expect_triangle(read(cr));
}

TEST(ReadPly, TakesALineFeedAsTheFirstByteOfDataWhereCarriageReturnsEndTheLines) {
  std::string header = start(false) +
                       "element vertex 11\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
                       "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  std::replace(header.begin(), header.end(), '\n', '\r');
  const MeshFile file = read(header + std::string(33, '\n') + std::string("\3\0\1\2", 4));
  EXPECT_EQ(file.mesh.vertices[0], Eigen::Vector3d(10, 10, 10));
}

TEST(ReadPly, SplitsPolygonsAndIgnoresFacesOfFewerCorners) {
  const MeshFile file = read(ascii + "element vertex 4\n" + xyz + "element face 4\n" + corners +
                             "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n2 0 1\n0\n3 3 2 1\n");
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}}));
  EXPECT_EQ(file.triangulated_polygons, 1u);
  EXPECT_EQ(file.ignored_elements, 2u);
}

TEST(ReadPly, DecodesStripsWithEveryTriangleFacingTheSameWay) {
  const std::string header = ascii + "element vertex 6\n" + xyz +
                             "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  const MeshFile file = read(header + "13 0 1 2 3 4 -1 -1 4 3 5 -1 0 1\n");
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}));
  for (const Triangle& t : file.mesh.triangles) {
    const Eigen::Vector3d a = file.mesh.vertices[t[0]];
    EXPECT_GT((file.mesh.vertices[t[1]] - a).cross(file.mesh.vertices[t[2]] - a).z(), 0);
  }
  EXPECT_EQ(file.decoded_strips, 2u);
  EXPECT_EQ(file.ignored_elements, 1u);
}

TEST(ReadPly, DropsTrianglesThatOnlyJoinTheParts) {
  const MeshFile file = read(ascii + "element vertex 6\n" + xyz +
                             "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n5 1 0\n6 2 0\n5 2 0\n8 0 1 2 2 3 3 4 5\n");
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {4, 3, 5}}));
}

TEST(ReadPly, RefusesMalformedHeaders) {
  EXPECT_CONTAINS(refused("plx\n"), "does not start with the word 'ply'");
  EXPECT_CONTAINS(refused("ply\nformat ascii 1.0\nelement vertex 3\n"), "end_header");
  EXPECT_CONTAINS(refused("ply\nelement vertex 0\n" + xyz + "end_header\n"), "format");
  EXPECT_CONTAINS(refused("ply\nformat binary 1.0\n"), "line 2: 'binary'");
  EXPECT_CONTAINS(refused("ply\nformat ascii 2.0\n"), "line 2");
  EXPECT_CONTAINS(refused(ascii + "element vertex -1\n"), "line 3");
  EXPECT_CONTAINS(refused(ascii + "element vertex many\n"), "'many'");
  EXPECT_CONTAINS(refused(ascii + "element vertex 99999999999999999999\n"), "line 3");
  EXPECT_CONTAINS(refused(ascii + "property float x\n"), "before the first element");
  EXPECT_CONTAINS(refused(ascii + "element vertex 3\nproperty quad x\n"), "line 4: 'quad'");
  EXPECT_CONTAINS(refused(ascii + "element vertex 3\nproperty list list int x\n"), "'list'");
  EXPECT_CONTAINS(refused(ascii + "elements vertex 3\n"), "'elements'");
}

TEST(ReadPly, RefusesElementsWithoutWhatWeNeed) {
  EXPECT_CONTAINS(refused(ascii + "element vertex 3\nproperty float x\nproperty float y\nend_header\n"), "'z'");
  EXPECT_CONTAINS(refused(ascii + "element vertex 3\n" + xyz + "property float x\nend_header\n"), "'x'");
  EXPECT_CONTAINS(
      refused(ascii + "element vertex 1\n" + xyz + "element face 1\nproperty int flags\nend_header\n0 0 0\n1\n"),
      "vertex_indices");
  EXPECT_CONTAINS(
      refused(ascii + "element vertex 1\n" + xyz + "element vertex 1\n" + xyz + "end_header\n0 0 0\n0 0 0\n"),
      "line 7: a second");
  EXPECT_CONTAINS(refused(ascii + "element vertex 4000000000\nelement face 1\n" + corners + "end_header\n1 0\n"),
                  "'x'");
}

TEST(ReadPly, RefusesCountsThatTheFileCannotHoldBeforeAllocating) {
  for (const std::string& begin : {ascii, start(false), start(true)}) {
    EXPECT_CONTAINS(refused(begin + "element vertex 4000000000\n" + xyz + "end_header\n0 0 0\n"), "line 3");
    EXPECT_CONTAINS(refused(begin + "element vertex 9000000000000000000\n" + xyz + "end_header\n0 0 0\n"), "line 3");
    EXPECT_CONTAINS(
        refused(begin + "element vertex 0\n" + xyz + "element face 4000000000\n" + corners + "end_header\n3 0"),
        "line 7");
    EXPECT_CONTAINS(refused(begin + "element x 1\nproperty list uint double y\nelement vertex 0\n" + xyz +
                            "end_header\n\xF0\xF0\xF0\xF0"),
                    "");
  }
  EXPECT_CONTAINS(refused(triangle_header + "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"), "a list declares 4000000000");
  EXPECT_CONTAINS(refused(triangle_header + "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"), "negative");
}

TEST(ReadPly, RefusesIndicesOutOfRange) {
  for (const std::string bad : {"3", "-1", "4294967296", "1.0", "x"})
    EXPECT_CONTAINS(refused(triangle_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 " + bad + "\n"), "line 13");
  Bytes bytes(false);
  bytes.add<float>({0, 0, 0}).add<std::uint8_t>({3}).add<std::int32_t>({0, 0, 1});
  const std::string header = start(false) + "element vertex 1\n" + xyz + "element face 1\n" + corners + "end_header\n";
  EXPECT_CONTAINS(refused(header + std::string(bytes)), "byte " + std::to_string(header.size() + 25));
  EXPECT_CONTAINS(refused(ascii + "element vertex 1\n" + xyz +
                          "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n3 0 0 -2\n"),
                  "vertex -2");
}

TEST(ReadPly, RefusesIndicesThatAreNotWhole) {
  const std::string header = ascii + "element vertex 1\n" + xyz +
                             "element face 1\nproperty list uchar float vertex_indices\nend_header\n0 0 0\n";
  EXPECT_EQ(read(header + "3 0 0 0\n").mesh.triangles.size(), 1u);
  for (const std::string bad : {"0.5", "nan", "1e300"})
    EXPECT_CONTAINS(refused(header + "3 0 0 " + bad + "\n"), "line 11");
}

TEST(ReadPly, RefusesLinesThatHoldMoreThanDeclaredAndFilesThatGoOn) {
  EXPECT_CONTAINS(refused(triangle_header + "0 0 0 1\n1 0 0\n0 1 0\n3 0 1 2\n"), "line 10: the line holds more");
  EXPECT_CONTAINS(refused(triangle + "3 0 1 2\n"), "line 14: the file goes on");
  Bytes bytes(false);
  bytes.add<float>({0, 0, 0}).add<std::uint8_t>({3}).add<std::int32_t>({0, 0, 0, 1});
  const std::string header = start(false) + "element vertex 1\n" + xyz + "element face 1\n" + corners + "end_header\n";
  EXPECT_CONTAINS(refused(header + std::string(bytes)), "goes on");
}

TEST(ReadPly, RefusesAnUnusableCoordinateOnlyWhereAFaceUsesIt) {
  for (const std::string bad : {"nan", "inf", "2e301"}) {
    const std::string header = ascii + "element vertex 4\n" + xyz + "element face 1\n" + corners +
                               "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 " + bad + "\n";
    EXPECT_EQ(read(header + "3 0 1 2\n").mesh.triangles.size(), 1u);
    EXPECT_CONTAINS(refused(header + "3 0 1 3\n"), "line 13: vertex 3");
  }
  EXPECT_CONTAINS(refused(triangle_header + "0 0 0\n1 0 1e400\n0 1 0\n3 0 1 2\n"), "too large for a double");
}

TEST(ReadPly, RefusesFilesWithoutFaces) {
  EXPECT_CONTAINS(refused(ascii + "element vertex 1\n" + xyz + "end_header\n0 0 0\n"), "no faces");
  EXPECT_CONTAINS(refused(ascii + "element vertex 1\n" + xyz + "element face 0\n" + corners + "end_header\n0 0 0\n"),
                  "no faces");
  EXPECT_CONTAINS(refused(ascii + "element other 5\nend_header\n"), "no vertices and no faces");
  EXPECT_CONTAINS(refused(std::string("\xFF\xFEp\0l\0y\0", 8)), "UTF-16");
}

TEST(ReadPly, NeverCrashesOnATruncatedFile) {
  for (std::size_t size = 0; size + 2 < triangle.size(); ++size) EXPECT_NE(refused(triangle.substr(0, size)), "");
  Bytes bytes(true);
  bytes.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}).add<std::uint8_t>({3}).add<std::int32_t>({0, 1, 2});
  const std::string whole =
      start(true) + "element vertex 3\n" + xyz + "element face 1\n" + corners + "end_header\n" + std::string(bytes);
  expect_triangle(read(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_NE(refused(whole.substr(0, size)), "") << size;
}

}  // namespace read_ply_test
}  // namespace meshbound::test
