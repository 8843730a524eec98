// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "mesh_files.h"

namespace meshbound::test {
namespace read_obj_test {

const std::string three_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

MeshFile read(const std::string& content) { return read_content("m.obj", content); }
std::string refused(const std::string& content) { return refusal("m.obj", content); }

TEST(ReadObj, ReadsEveryFormOfCorner) {
  for (const std::string face : {"1 2 3", "1/1 2/2 3/3", "1/1/1 2/2/2 3/3/3", "1//1 2//2 3//3", "1/ 2// 3/1/",
                                 "-3 -2 -1", "-3/-1/-1 -2//-2 -1/9", "\t1  2\t3 "})
    expect_triangle(read(three_vertices + "f " + face + "\n"));
}

TEST(ReadObj, CountsNegativeIndicesBackFromWhereTheyStand) {
  const MeshFile file = read(three_vertices + "f -3 -2 -1\nv 0 0 1\nf -4 -3 -1\n");
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}));
}

TEST(ReadObj, TakesFacesBeforeTheirVertices) { expect_triangle(read("f 1 2 3\n" + three_vertices)); }

TEST(ReadObj, StepsOverWeightsAndColours) {
  expect_triangle(read("v 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 0 0 1\nf 1 2 3\n"));
}

TEST(ReadObj, StepsOverStatementsThatAreNoGeometry) {
  const MeshFile file = read("# c:\\folder\\\nmtllib a b.mtl\no name\ng one two\ns off\nusemtl x\n" + three_vertices +
                             "vn 0 0 1\nvt 0 0\nvp 0 0\n#f 9 9 9\n\nf 1 2 3 # last\n");
  expect_triangle(file);
  EXPECT_EQ(file.ignored_elements, 0u);
}

TEST(ReadObj, CountsWhatItSteppedOver) {
  EXPECT_EQ(read(three_vertices + "f 1 2 3\n").dropped, DroppedAttributes{});
  const std::string names =
      "mtllib a.mtl\no name\ng one two\ng one\ng one two\ns off\ns 0\ns 1\ns 2\ns 1\nusemtl x y\nusemtl x\nusemtl x y\n"
      "g\nusemtl\n";
  EXPECT_EQ(
      read(names + three_vertices + "vn 0 0 1\nvn 0 0 \\\n-1\nvt 0 0\nvp 0 0\nf 1/1/1 2//2 3\n").dropped,
      (DroppedAttributes{.texture_coordinates = 1, .normals = 2, .materials = 2, .groups = 3, .smoothing_groups = 2}));
  EXPECT_EQ(read("v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 0 1 0 1 0 0 1\nf 1 2 3\n").dropped, (DroppedAttributes{.colours = 2}));
  EXPECT_EQ(read("mtllib a.mtl\nmtllib b.mtl\n" + three_vertices + "f 1 2 3\n").dropped,
            (DroppedAttributes{.materials = 2}));
}

TEST(ReadObj, CountsLinesAndPointsAsIgnored) {
  const MeshFile file = read(three_vertices + "l 1 2\np 1 2 3\nf\nf 1 2\nf 1 2 3\n");
  expect_triangle(file);
  EXPECT_EQ(file.ignored_elements, 4u);
  EXPECT_EQ(file.dropped, DroppedAttributes{.other_elements = 4});
}

TEST(ReadObj, JoinsLinesThatEndWithABackslash) {
  expect_triangle(read("v 0 0 0\nv 1 \\\n 0 0\nv 0\\\n 1 0\nf 1 \\\n2 \\\n3\n"));
  expect_triangle(read("v 0 0 0\r\nv 1 \\\r\n 0 0\r\nv 0 1 0\r\nf 1 \\\r\n2 3\r\n"));
  expect_triangle(read("g a \\\nb\n" + three_vertices + "f 1 2 3 \\"));
}

TEST(ReadObj, TakesEveryKindOfLineEnd) {
  expect_triangle(read("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n"));
  expect_triangle(read("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3"));
  expect_triangle(read("\xEF\xBB\xBF" + three_vertices + "f 1 2 3"));
}

TEST(ReadObj, SplitsAPolygonIntoAFan) {
  const MeshFile file = read(three_vertices + "v 1 1 0\nf 1 2 4 3\n");
  EXPECT_EQ(file.triangulated_polygons, 1u);
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}}));
}

TEST(ReadObj, RefusesIndicesOutOfRangeWithTheirLine) {
  EXPECT_CONTAINS(refused(three_vertices + "f 1 2 4\n"), "line 4: a face refers to vertex 4");
  EXPECT_CONTAINS(refused("f 1 2 7\n\nf 1 2 9\n" + three_vertices), "line 3: a face refers to vertex 9");
  EXPECT_CONTAINS(refused(three_vertices + "f 0 1 2\n"), "counts vertices from 1");
  EXPECT_CONTAINS(refused(three_vertices + "f -4 1 2\n"), "line 4");
  EXPECT_CONTAINS(refused(three_vertices + "f 1 2 4294967299\n"), "line 4");
  EXPECT_CONTAINS(refused("v 0 0 0\nf 4294967295 1 1\n"), "line 2");
  EXPECT_CONTAINS(refused(three_vertices + "f 1 2 99999999999999999999\n"), "line 4");
  EXPECT_CONTAINS(refused(three_vertices + "f 1 2 -9223372036854775808\n"), "line 4");
}

TEST(ReadObj, RefusesMalformedCorners) {
  for (const std::string face : {"1 2 x", "1 2 3.0", "1 2 3/a", "1 2 3/1/1/1", "1 2 /3", "1 2 3-", "1 2 -"})
    EXPECT_CONTAINS(refused(three_vertices + "f " + face + "\n"), "line 4");
}

TEST(ReadObj, RefusesMalformedVertices) {
  EXPECT_CONTAINS(refused("v 0 0\nv 0 0 0\n"), "line 1: expected a vertex coordinate, but the line ends");
  EXPECT_CONTAINS(refused("v 0 0 zero\n"), "'zero'");
  EXPECT_CONTAINS(refused("v 0 0 0 red\n"), "'red'");
  EXPECT_CONTAINS(refused("v 1e400 0 0\n"), "too large for a double");
  EXPECT_CONTAINS(refused("v 0 0 3.1+e2\n"), "'3.1+e2'");
}

TEST(ReadObj, RefusesAnUnusableCoordinateOnlyWhereAFaceUsesIt) {
  expect_triangle(read(three_vertices + "f 1 2 3\n"));
  EXPECT_EQ(read(three_vertices + "v nan inf 1e302\nf 1 2 3\n").mesh.triangles.size(), 1u);
  EXPECT_CONTAINS(refused("v 0 0 0\n\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"), "line 3: vertex 1");
}

TEST(ReadObj, RefusesWhatIsNoMesh) {
  EXPECT_CONTAINS(refused("<html><body>404</body></html>\n"), "line 1");
  EXPECT_CONTAINS(refused(three_vertices), "no faces");
  EXPECT_CONTAINS(refused("Not found\n"), "no vertices and no faces");
  EXPECT_CONTAINS(refused(std::string("\xFE\xFF\0v\0 ", 6)), "UTF-16");
  EXPECT_CONTAINS(refused(std::string("\xFF\xFEv\0 \0", 6)), "UTF-16");
  EXPECT_CONTAINS(refused(std::string("v\0 \0", 4)), "UTF-16");
  EXPECT_CONTAINS(refused(std::string("v 0 0 \0\x01\n", 9)), "line 1");
}

TEST(ReadObj, KeepsAMessageToOnePrintableLine) {
  const std::string line = refused("v 0 0 \x1b[31m" + std::string(10000, 'x') + "\n");
  EXPECT_LT(line.size(), 300u);
  EXPECT_EQ(line.find('\x1b'), std::string::npos);
}

}  // namespace read_obj_test
}  // namespace meshbound::test
