// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "mesh_files.h"

namespace meshbound::test {
namespace read_off_test {

const std::string three_vertices = "0 0 0\n1 0 0\n0 1 0\n";
const std::string triangle = "OFF\n3 1 0\n" + three_vertices + "3 0 1 2\n";

MeshFile read(const std::string& content) { return read_content("m.off", content); }
std::string refused(const std::string& content) { return refusal("m.off", content); }

TEST(ReadOff, ReadsTheTriangle) { expect_triangle(read(triangle)); }

TEST(ReadOff, TakesEveryKindOfWhitespaceAndComment) {
  expect_triangle(
      read("# first\n\n  OFF # here\n\n# there\n 3\t1 0 # counts\n\n 0 0 0 # v\n\n1 0\n0\n \t0 1 0\n\n3 0 1 2"));
  expect_triangle(read("OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n"));
  expect_triangle(read("OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r"));
  expect_triangle(read("\xEF\xBB\xBF" + triangle));
}

TEST(ReadOff, TakesCountsGluedToTheKeyword) { expect_triangle(read("OFF3 1 0\n" + three_vertices + "3 0 1 2\n")); }

TEST(ReadOff, TakesAMissingEdgeCount) {
  expect_triangle(read("OFF\n3 1\n" + three_vertices + "3 0 1 2\n"));
  expect_triangle(read("OFF\n3\n1\n0\n" + three_vertices + "3 0 1 2\n"));
  expect_triangle(read("OFF\n3\n1\n" + three_vertices + "3 0 1 2\n"));
}

TEST(ReadOff, StepsOverWhatFollowsCoordinatesAndCorners) {
  expect_triangle(read("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 255 255\n3 0 1 2\n"));
  expect_triangle(read("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n"));
  expect_triangle(read("STCNOFF\n3 1 0\n0 0 0 0 0 1 1 1 1 1 .5 .5\n1 0 0 0\n0 1 0\n3 0 1 2\n"));
  expect_triangle(read("STOFF\n3 1 0\n0 0 0 .1 .2\n1 0 0 .1 .2\n0 1 0 .1 .2\n3 0 1 2 0.5 0.5 0.5 # grey\n"));
  expect_triangle(read("OFF\n3 1 0\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2 7\n"));
}

TEST(ReadOff, SplitsAPolygonIntoAFanFromItsFirstCorner) {
  const MeshFile file = read("OFF\n5 1 0\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 4 0 1 2 3\n");
  EXPECT_EQ(file.triangulated_polygons, 1u);
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{4, 0, 1}, {4, 1, 2}, {4, 2, 3}}));
}

TEST(ReadOff, CountsFacesOfFewerThanThreeCornersAsIgnored) {
  const MeshFile file = read("OFF\n3 4 0\n" + three_vertices + "2 0 1\n3 0 1 2\n1 0\n0\n");
  EXPECT_EQ(file.ignored_elements, 3u);
  EXPECT_EQ(file.mesh.triangles.size(), 1u);
}

TEST(ReadOff, KeepsDegenerateAndDuplicateTriangles) {
  EXPECT_EQ(read("OFF\n3 3 0\n" + three_vertices + "3 0 1 2\n3 0 1 2\n3 1 1 2\n").mesh.triangles.size(), 3u);
}

TEST(ReadOff, ReadsNumbersToTheNearestDouble) {
  const MeshFile file = read(
      "OFF\n3 1 0\n+1.5 -.5 5.\n4.9406564584124654e-324 2.2250738585072011e-308 1E+2\n"
      "0.1 0.30000000000000004 -0\n3 0 1 2\n");
  EXPECT_EQ(file.mesh.vertices[0], Eigen::Vector3d(1.5, -.5, 5));
  EXPECT_EQ(file.mesh.vertices[1], Eigen::Vector3d(0x1p-1074, 0x0.fffffffffffffp-1022, 100));
  EXPECT_EQ(file.mesh.vertices[2], Eigen::Vector3d(0.1, 0.1 + 0.2, 0));
  EXPECT_TRUE(std::signbit(file.mesh.vertices[2].z()));
}

TEST(ReadOff, RefusesAnUnusableCoordinateOnlyWhereAFaceUsesIt) {
  for (const std::string bad : {"nan", "-inf", "inf", "NaN", "1e302", "-2e301"}) {
    const std::string unused = "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 " + bad + " 0\n3 0 1 2\n";
    EXPECT_EQ(read(unused).mesh.triangles.size(), 1u) << bad;
    const std::string used = "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 " + bad + " 0\n3 0 1 3\n";
    EXPECT_CONTAINS(refused(used), "line 6: vertex 3");
  }
}

TEST(ReadOff, RefusesNumbersThatAreNone) {
  for (const std::string bad : {"1e400", "-1e999", "0x10", "1,5", "1.5f", "+-1", "--1", "1e", ".", "+", "1.#IND"})
    EXPECT_CONTAINS(refused("OFF\n4 1 0\n" + three_vertices + "0 " + bad + " 0\n3 0 1 2\n"), "line 6");
}

TEST(ReadOff, CountsLinesHoweverTheyEnd) {
  for (const std::string end : {"\n", "\r\n", "\r"})
    EXPECT_CONTAINS(refused("OFF" + end + "3 1 0" + end + end + "0 0 zero 0 0 0 0 0 0" + end), "line 4");
}

TEST(ReadOff, RefusesIndicesThatAreNone) {
  for (const std::string bad : {"3", "-1", "4294967296", "99999999999999999999999999", "1.0", "x", "1/2"})
    EXPECT_CONTAINS(refused("OFF\n3 1 0\n" + three_vertices + "3 0 1 " + bad + "\n"), "line 6");
}

TEST(ReadOff, RefusesHeadersItCannotRead) {
  EXPECT_CONTAINS(refused("3 1 0\n" + three_vertices + "3 0 1 2\n"), "OFF");
  EXPECT_CONTAINS(refused("OFF BINARY\n3 1 0\n"), "binary OFF");
  EXPECT_CONTAINS(refused("4OFF\n3 1 0\n0 0 0 1\n"), "4OFF");
  EXPECT_CONTAINS(refused("nOFF\n2\n3 1 0\n"), "nOFF");
  EXPECT_CONTAINS(refused("OFF\n-3 1 0\n"), "line 2");
  EXPECT_CONTAINS(refused("OFF\n3 1 0 0\n"), "line 2");
  EXPECT_CONTAINS(refused("OFF\nthree 1 0\n"), "'three'");
  EXPECT_CONTAINS(refused("OFF"), "the file ends");
  EXPECT_CONTAINS(refused("# nothing\n"), "OFF");
}

TEST(ReadOff, RefusesCountsThatTheFileCannotHoldBeforeAllocating) {
  EXPECT_CONTAINS(refused("OFF\n4000000000 1 0\n" + three_vertices), "line 2: the header declares 4000000000 vertices");
  EXPECT_CONTAINS(refused("OFF\n3 9000000000000000000 0\n" + three_vertices), "9000000000000000000 faces");
  EXPECT_CONTAINS(refused("OFF\n3 99999999999999999999 0\n" + three_vertices), "too large for an integer");
  EXPECT_CONTAINS(refused("OFF\n3 1 0\n" + three_vertices + "4000000000 0 1 2\n"), "corners");
}

TEST(ReadOff, CountsWhatItSteppedOver) {
  EXPECT_EQ(read(triangle).dropped, DroppedAttributes{});
  const std::string vertices = "0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n", face = "3 0 1 2\n";
  EXPECT_EQ(read("OFF\n3 1 0\n" + vertices + face).dropped, (DroppedAttributes{.colours = 3}));
  EXPECT_EQ(read("NOFF\n3 1 0\n" + vertices + face).dropped, (DroppedAttributes{.normals = 3}));
  EXPECT_EQ(read("STCNOFF\n3 1 0\n" + vertices + face).dropped,
            (DroppedAttributes{.texture_coordinates = 3, .normals = 3, .colours = 3}));
  EXPECT_EQ(read("OFF\n3 1 0\n" + three_vertices + "3 0 1 2 255 0 0\n").dropped, (DroppedAttributes{.colours = 1}));
}

TEST(ReadOff, RefusesAFileThatEndsEarlyOrGoesOn) {
  EXPECT_CONTAINS(refused("OFF\n3 1 0\n0 0 0\n1 0 0.0000000\n0 1"), "the file ends");
  EXPECT_CONTAINS(refused("OFF\n3 2 0\n" + three_vertices + "3 0 1 2\n"), "the file ends");
  EXPECT_CONTAINS(refused("OFF\n3 1 0\n" + three_vertices + "3 0 1"), "the file ends");
  EXPECT_CONTAINS(refused(triangle + "3 0 2 1\n"), "line 7: the file goes on");
}

TEST(ReadOff, RefusesAFileWithoutFaces) {
  EXPECT_CONTAINS(refused("OFF\n3 0 0\n" + three_vertices), "no faces");
  EXPECT_CONTAINS(refused("OFF\n0 0 0\n"), "no vertices and no faces");
  EXPECT_CONTAINS(refused("OFF\n3 1 0\n" + three_vertices + "2 0 1\n"), "no faces");
}

TEST(ReadOff, NeverCrashesOnATruncatedFile) {
  for (std::size_t size = 0; size + 2 < triangle.size(); ++size)
    EXPECT_NE(refused(triangle.substr(0, size)), "") << size;
}

}  // namespace read_off_test
}  // namespace meshbound::test
