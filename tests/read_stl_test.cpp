// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "mesh_files.h"

namespace meshbound::test {
namespace read_stl_test {

const std::string facet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
const std::string across =
    "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n";

MeshFile read(const std::string& content) { return read_content("m.stl", content); }
std::string refused(const std::string& content) { return refusal("m.stl", content); }

void append_little_endian(std::string& to, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) to += static_cast<char>(value >> shift & 255);
}

/// A binary file of these corners, nine numbers a triangle, whose header declares `count` triangles.
std::string binary(const std::string& header, std::uint32_t count, const std::vector<float>& corners) {
  std::string file = header;
  file.resize(80);
  append_little_endian(file, count);
  for (std::size_t i = 0; i < corners.size(); i += 9) {
    file.append(12, '\0');
    for (std::size_t k = 0; k < 9; ++k) append_little_endian(file, std::bit_cast<std::uint32_t>(corners[i + k]));
    file.append(2, '\0');
  }
  return file;
}

const std::vector<float> two_triangles = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

void expect_welded_square(const MeshFile& file) {
  EXPECT_EQ(file.mesh.vertices.size(), 4u);
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(ReadStl, WeldsTheCornersOfText) { expect_welded_square(read("solid a\n" + facet + across + "endsolid a\n")); }

TEST(ReadStl, WeldsTheCornersOfBinary) { expect_welded_square(read(binary("made by hand", 2, two_triangles))); }

TEST(ReadStl, JoinsAllSolidsOfAText) {
  expect_welded_square(
      read("solid a\n" + facet + "endsolid a\nsolid\nendsolid\nsolid b facet\n" + across + "endsolid"));
}

TEST(ReadStl, CountsSeveralSolidsAndAttributeBytes) {
  EXPECT_EQ(read("solid\n" + facet + across + "endsolid\n").dropped, DroppedAttributes{});
  EXPECT_EQ(read("solid a\n" + facet + across + "endsolid a\n").dropped, (DroppedAttributes{.groups = 1}));
  EXPECT_EQ(read("solid a\n" + facet + "endsolid a\nsolid b\n" + across + "endsolid").dropped,
            (DroppedAttributes{.groups = 2}));
  std::string bytes = binary("", 2, two_triangles);
  EXPECT_EQ(read(bytes).dropped, DroppedAttributes{});
  bytes.back() = '\x80';
  EXPECT_EQ(read(bytes).dropped, (DroppedAttributes{.facet_attributes = 1}));
}

/// Solids are groups, and a text file is written with the solids that it was read with; "meshbound" names none.
TEST(ReadStl, KeepsTheNamesOfSolids) {
  const TemporaryFolder folder;
  const auto round_trip = [&](const std::string& content) {
    write_file(folder / "in.stl", content);
    const MeshFile file = read_mesh(folder / "in.stl", {.attributes = true});
    EXPECT_EQ(file.dropped, DroppedAttributes{});
    write_mesh(folder / "out.stl", file.mesh, {.ascii = true}, file.attributes);
    const std::string written = content_of(folder / "out.stl");
    std::string names;
    std::istringstream lines(written);
    for (std::string line; std::getline(lines, line);)
      if (line.find("solid") != std::string::npos) names += line + '\n';
    return names;
  };
  EXPECT_EQ(round_trip("solid  part 7 \r\n" + facet + across + "endsolid\n"), "solid part 7\nendsolid part 7\n");
  EXPECT_EQ(round_trip("solid\n" + facet + across + "endsolid\n"), "solid meshbound\nendsolid meshbound\n");
  EXPECT_EQ(round_trip("solid a\n" + facet + "endsolid a\nsolid meshbound\n" + across + "endsolid meshbound\n"),
            "solid a\nendsolid a\nsolid meshbound\nendsolid meshbound\n");
  EXPECT_EQ(round_trip("solid C:\\parts\\\n" + facet + "endsolid C:\\parts\\\n"),
            "solid C:\\parts \nendsolid C:\\parts \n");
}

TEST(ReadStl, TakesAnyCaseAndSpacing) {
  expect_welded_square(
      read("\n SOLID #1 of 2\r\n  FACET Normal nan -nan(ind) 0\r\nOuter Loop vertex 0 0 0 Vertex 1 0 0\n"
           "vertex 0 1 0 EndLoop\nENDFACET " +
           across + "EndSolid x\n"));
}

TEST(ReadStl, TellsBinaryThatStartsWithSolidFromText) {
  expect_welded_square(read(binary("solid made by a CAD system", 2, two_triangles)));
}

TEST(ReadStl, WeldsNegativeZeroWithZero) {
  const MeshFile file = read(binary("", 2, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, -0.0f, 0, 1, 1, 0, -0.0f, 1, -0.0f}));
  expect_welded_square(file);
}

TEST(ReadStl, KeepsCornersThatDifferInTheLastBitApart) {
  std::vector<float> corners = two_triangles;
  corners[9] = std::nextafter(1.0f, 2.0f);
  EXPECT_EQ(read(binary("", 2, corners)).mesh.vertices.size(), 5u);
}

TEST(ReadStl, KeepsDegenerateFacets) {
  EXPECT_EQ(read(binary("", 1, std::vector<float>(9, 0.5f))).mesh.triangles, (std::vector<Triangle>{{0, 0, 0}}));
}

TEST(ReadStl, FansFacetsOfMoreCornersAndIgnoresFewer) {
  const MeshFile file = read(
      "solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0 "
      "endloop endfacet facet normal 0 0 1 outer loop vertex 0 0 0 endloop endfacet\nendsolid\n");
  EXPECT_EQ(file.mesh.triangles.size(), 2u);
  EXPECT_EQ(file.triangulated_polygons, 1u);
  EXPECT_EQ(file.ignored_elements, 1u);
}

TEST(ReadStl, RefusesATriangleCountThatLies) {
  EXPECT_CONTAINS(refused(binary("", 4000000000u, two_triangles)), "byte 80: the header declares 4000000000 triangles");
  EXPECT_CONTAINS(refused(binary("", 3, two_triangles)), "declares 3");
  EXPECT_CONTAINS(refused(binary("", 1, two_triangles)), "declares 1");
  EXPECT_CONTAINS(refused(binary("solid lies", 3, two_triangles)), "declares 3");
}

TEST(ReadStl, TakesBytesAfterTheLastTriangleThatCannotBeATriangle) {
  expect_welded_square(read(binary("", 2, two_triangles) + std::string(49, 'x')));
}

TEST(ReadStl, RefusesNonFiniteCorners) {
  std::vector<float> corners = two_triangles;
  corners[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_CONTAINS(refused(binary("", 2, corners)), "byte 108: vertex 1");
  EXPECT_CONTAINS(refused("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 inf 0\nvertex 0 1 0\nendloop\n"
                          "endfacet\nendsolid\n"),
                  "line 5: vertex 1");
}

TEST(ReadStl, RefusesFilesWithoutTriangles) {
  EXPECT_CONTAINS(refused("solid nothing\nendsolid\n"), "no faces");
  EXPECT_CONTAINS(refused(binary("", 0, {})), "no faces");
  EXPECT_CONTAINS(refused("hello"), "neither");
  EXPECT_CONTAINS(refused("\xFF\xFEs"), "UTF-16");
}

TEST(ReadStl, NamesTheLineOfADefectInText) {
  EXPECT_CONTAINS(refused("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"), "line 4");
  EXPECT_CONTAINS(refused("solid\nfacet normal 0 0 1\nloop\n"), "line 3: expected outer, but found 'loop'");
  EXPECT_CONTAINS(refused("solid\nface normal 0 0 1\n"), "line 2");
  EXPECT_CONTAINS(refused("solid\n" + facet), "endsolid");
}

TEST(ReadStl, NeverCrashesOnATruncatedFile) {
  const std::string text = "solid a\n" + facet + across + "endsolid a\n";
  for (std::size_t size = 0; size + 11 < text.size(); ++size) EXPECT_NE(refused(text.substr(0, size)), "") << size;
  const std::string bytes = binary("", 2, two_triangles);
  for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_NE(refused(bytes.substr(0, size)), "") << size;
}

}  // namespace read_stl_test
}  // namespace meshbound::test
