// SPDX-License-Identifier: MIT
// Colours, normals, texture coordinates and other numbers of PLY and OFF come along, into the same format and others.
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "meshbound/error.h"
#include "meshbound/io.h"
#include "temporary_folder.h"

namespace meshbound {
namespace colours_test {

constexpr std::uint32_t none = CornerAttribute::none;

class Colours : public testing::Test {
 protected:
  MeshFile read(const std::string& name) {
    ReadOptions options;
    options.attributes = true;
    return read_mesh(folder_ / name, options);
  }
  MeshFile read(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return read(name);
  }
  /// What a file of this name gives back of a mesh and its attributes.
  MeshFile written(const std::string& name, const MeshFile& from, const WriteOptions& options = {}) {
    DroppedAttributes lost;
    write_mesh(folder_ / name, from.mesh, options, carried_by(format_of(name), from.attributes, lost));
    return read(name);
  }

  test::TemporaryFolder folder_;
};

/// The numbers of a value of an attribute at a corner.
std::vector<double> at(const MeshAttributes& attributes, const std::string& name, std::size_t t, std::size_t k) {
  for (const NamedAttribute& named : attributes.named) {
    if (named.name != name) continue;
    const std::uint32_t value = named.index[t][k];
    if (value == none) return {};
    const auto first = named.values.begin() + static_cast<std::ptrdiff_t>(value * named.width);
    return {first, first + static_cast<std::ptrdiff_t>(named.width)};
  }
  return {-1};
}

const std::string ply_of_vertices =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n"
    "property uchar blue\nproperty uchar alpha\nproperty float s\nproperty float t\nproperty double heat\n"
    "element face 2\nproperty list uchar int vertex_indices\nproperty int segment\nend_header\n"
    "0 0 0 0 0 1 255 0 0 255 0 0 1.5\n1 0 0 0 0 1 0 255 0 51 1 0 2.5\n1 1 0 0 0 1 0 0 255 255 1 1 3.5\n"
    "0 1 0 0 0 1 51 102 153 255 0 1 4.5\n3 0 1 2 7\n3 0 2 3 8\n";

TEST_F(Colours, OfPlyVerticesComeBack) {
  const MeshFile from = read("a.ply", ply_of_vertices);
  const DroppedAttributes segments{.other_properties = 1};
  EXPECT_EQ(from.dropped, segments) << "numbers of faces are not collected";
  for (const bool ascii : {false, true}) {
    const MeshFile back = written("b.ply", from, {.ascii = ascii, .single_precision = true});
    EXPECT_EQ(back.mesh.triangles, from.mesh.triangles);
    EXPECT_EQ(back.mesh.vertices, from.mesh.vertices);
    for (const MeshFile& file : {from, back}) {
      EXPECT_EQ(at(file.attributes, "COLOR_0", 0, 1), (std::vector<double>{0, 1, 0, 0.2}));
      EXPECT_EQ(at(file.attributes, "COLOR_0", 1, 2), (std::vector<double>{0.2, 0.4, 0.6, 1}));
      EXPECT_EQ(at(file.attributes, "heat", 1, 2), std::vector<double>{4.5});
      const CornerAttribute& uv = file.attributes.texture_coordinates;
      EXPECT_EQ(uv.values[uv.index[1][2]], Eigen::Vector3d(0, 1, 0));
      EXPECT_EQ(file.attributes.normals.values[file.attributes.normals.index[1][2]], Eigen::Vector3d(0, 0, 1));
    }
  }
}

TEST_F(Colours, OfPlyFacesAreOnTheirSideOfAnEdge) {
  const MeshFile from = read("a.ply",
                             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
                             "float z\nelement face 2\nproperty list uchar int vertex_indices\nproperty list uchar "
                             "float texcoord\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                             "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 8 0 0 1 0 1 1 0 1 255 0 0\n"
                             "3 0 2 1 0 0 0 255\n");
  ASSERT_EQ(from.mesh.triangles.size(), 3U);
  EXPECT_EQ(from.dropped, DroppedAttributes{});
  const CornerAttribute& uv = from.attributes.texture_coordinates;
  EXPECT_EQ(uv.values[uv.index[1][2]], Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(uv.index[2], (Triangle{none, none, none}));
  const MeshFile back = written("b.ply", from);
  EXPECT_EQ(back.mesh.vertices.size(), 7U) << "a vertex of two colours is two";
  for (const MeshFile& file : {from, back}) {
    EXPECT_EQ(at(file.attributes, "COLOR_0", 1, 0), (std::vector<double>{1, 0, 0}));
    EXPECT_EQ(at(file.attributes, "COLOR_0", 2, 0), (std::vector<double>{0, 0, 1}));
  }
}

TEST_F(Colours, OfOffVerticesAndFacesComeBack) {
  const MeshFile bytes =
      read("a.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 51 0 255\n0 1 0 0 0 102 255\n3 0 1 2\n");
  const MeshFile faces = read("b.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 0.5 0.25 1.0\n3 0 2 3\n");
  for (const MeshFile& file : {bytes, written("c.off", bytes)}) {
    EXPECT_EQ(at(file.attributes, "COLOR_0", 0, 1), (std::vector<double>{0, 0.2, 0, 1}));
    EXPECT_EQ(at(file.attributes, "COLOR_0", 0, 0), (std::vector<double>{1, 0, 0, 1}));
    EXPECT_EQ(file.dropped, DroppedAttributes{});
  }
  EXPECT_EQ(at(faces.attributes, "COLOR_0", 0, 2), (std::vector<double>{0.5, 0.25, 1, 1}));
  EXPECT_EQ(at(faces.attributes, "COLOR_0", 1, 0), std::vector<double>{});
  EXPECT_EQ(at(written("d.off", faces).attributes, "COLOR_0", 1, 0), (std::vector<double>{1, 1, 1, 1}));
  for (const bool ascii : {false, true})
    EXPECT_EQ(at(written("d.ply", faces, {.ascii = ascii}).attributes, "COLOR_0", 1, 0),
              (std::vector<double>{1, 1, 1, 1}));
  const MeshFile index = read("e.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2 17\n");
  EXPECT_TRUE(index.attributes.empty());
  EXPECT_EQ(index.dropped.colours, 1U) << "the index of a table that is not there";
  EXPECT_EQ(read("f.off", "STCOFF\n3 1 0\n0 0 0 1 1 1 1 0 0\n1 0 0 1 1 1 1 0 0\n1 1 0 1 1 1 1 0 0\n3 0 1 2\n")
                .dropped.texture_coordinates,
            3U);
}

/// Red of the first two vertices of a triangle.
std::vector<double> reds(const MeshFile& file) {
  return {at(file.attributes, "COLOR_0", 0, 0).at(0), at(file.attributes, "COLOR_0", 0, 1).at(0)};
}

/// "1 0 0 1" is red where other colours have fractions, and nearly black where they are from 0 to 255.
TEST_F(Colours, OfOffAreFromZeroToOneOr255InTheWholeFile) {
  const auto reds_of = [&](const std::string& first, const std::string& second) {
    return reds(read("a.off", "COFF\n3 1 0\n0 0 0 " + first + "\n1 0 0 " + second + "\n0 1 0 0 0 0\n3 0 1 2\n"));
  };
  using Reds = std::vector<double>;
  EXPECT_EQ(reds_of("1 0 0 1", "0.5 0 0 1"), (Reds{1, 0.5}));
  EXPECT_EQ(reds_of("1 0 0 1", "1e-1 0 0 1"), (Reds{1, 0.1}));
  EXPECT_EQ(reds_of("1 0 0 1", "1 1 0 1"), (Reds{1, 1}));
  EXPECT_EQ(reds_of("1 0 0", "255 0 0"), (Reds{1 / 255.0, 1}));
  EXPECT_EQ(reds_of("51 0 0 255", "0.5 0 0 1"), (Reds{0.2, 0.5})) << "whole numbers above 1 are of 255 in any file";
  EXPECT_EQ(at(read("b.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 1 0 0\n3 0 2 3 2 0 0\n").attributes,
               "COLOR_0", 0, 0),
            (std::vector<double>{1 / 255.0, 0, 0, 1}))
      << "opaque, as no number says otherwise";
}

/// A triangle with these properties of its vertices, of which each has `numbers`, and of its face.
std::string ply_triangle(const std::string& of_vertices, const std::string& numbers, const std::string& of_faces,
                         const std::string& numbers_of_face) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
         of_vertices + "element face 1\nproperty list uchar int vertex_indices\n" + of_faces + "end_header\n0 0 0 " +
         numbers + "\n1 0 0 " + numbers + "\n0 1 0 " + numbers + "\n3 0 1 2 " + numbers_of_face + "\n";
}

const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
const std::string st = "property float s\nproperty float t\n";
const std::string uv_list = "property list uchar float texcoord\n";

TEST_F(Colours, OfFacesAreCountedAsDroppedWhereVerticesHaveSome) {
  const MeshFile colours = read("a.ply", ply_triangle(rgb, "255 0 0", rgb, "0 0 255"));
  EXPECT_EQ(colours.dropped, DroppedAttributes{.colours = 1});
  EXPECT_EQ(at(colours.attributes, "COLOR_0", 0, 0), (std::vector<double>{1, 0, 0}));
  const MeshFile texture = read("b.ply", ply_triangle(st, "0.5 0.5", uv_list, "6 0 0 1 0 0 1"));
  EXPECT_EQ(texture.dropped, DroppedAttributes{.texture_coordinates = 3});
  const CornerAttribute& uv = texture.attributes.texture_coordinates;
  EXPECT_EQ(uv.values[uv.index[0][1]], Eigen::Vector3d(0.5, 0.5, 0));
  EXPECT_EQ(read("c.ply", ply_triangle("", "", uv_list, "4 0 0 1 0")).dropped,
            DroppedAttributes{.texture_coordinates = 2})
      << "a list that does not fit the corners";
}

TEST_F(Colours, ThatAFileGivesTwiceAreTheFirst) {
  const std::string diffuse = "property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n";
  for (const MeshFile& file : {read("a.ply", ply_triangle(rgb + diffuse, "255 0 0 0 0 255", "", "")),
                               read("b.ply", ply_triangle("", "", rgb + diffuse, "255 0 0 0 0 255"))}) {
    EXPECT_EQ(file.dropped.colours, file.attributes.named[0].values.size() / 3);
    EXPECT_EQ(at(file.attributes, "COLOR_0", 0, 2), (std::vector<double>{1, 0, 0}));
  }
  const MeshFile texture =
      read("c.ply", ply_triangle(st + "property float texture_u\nproperty float texture_v\n", "0 1 0.5 0.5", "", ""));
  EXPECT_EQ(texture.dropped, DroppedAttributes{.texture_coordinates = 3});
  EXPECT_EQ(texture.attributes.texture_coordinates.values[0], Eigen::Vector3d(0, 1, 0));
  const MeshFile heat = read("d.ply", ply_triangle("property float heat\nproperty float heat\n", "7 8", "", ""));
  EXPECT_EQ(heat.dropped, DroppedAttributes{.other_properties = 1});
  EXPECT_EQ(at(heat.attributes, "heat", 0, 0), std::vector<double>{7});
}

/// Faces of a second element may lack the colours of the first, or have an opacity besides.
TEST_F(Colours, OfFacesBehindStripsAndOtherFacesAreTheirs) {
  const std::string start =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string vertices = "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const std::string corners = "property list uchar int vertex_indices\n";
  const MeshFile strip = read("a.ply", start + "element tristrips 1\n" + corners + "element face 1\n" + corners + rgb +
                                           uv_list + vertices + "4 0 1 3 2\n3 0 1 2 255 0 0 6 0 0 1 0 1 1\n");
  ASSERT_EQ(strip.mesh.triangles.size(), 3U);
  const CornerAttribute& uv = strip.attributes.texture_coordinates;
  for (const std::size_t t : {0U, 1U}) {
    EXPECT_EQ(at(strip.attributes, "COLOR_0", t, 0), std::vector<double>{});
    EXPECT_EQ(uv.index[t], (Triangle{none, none, none}));
  }
  EXPECT_EQ(at(strip.attributes, "COLOR_0", 2, 0), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(uv.values[uv.index[2][1]], Eigen::Vector3d(1, 0, 0));

  const std::string faces = "element face 1\n" + corners;
  const MeshFile three = read("b.ply", start + faces + rgb + faces + faces + rgb + "property uchar alpha\n" + vertices +
                                           "3 0 1 2 255 0 0\n3 0 2 3\n3 0 1 3 0 0 255 51\n");
  EXPECT_EQ(at(three.attributes, "COLOR_0", 0, 0), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(at(three.attributes, "COLOR_0", 1, 0), std::vector<double>{});
  EXPECT_EQ(at(three.attributes, "COLOR_0", 2, 0), (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(three.dropped, DroppedAttributes{.colours = 1});
}

/// Labels have no mean: a vertex of a level takes that of the nearest corner.
TEST_F(Colours, OfPlyAreNoLabelsWhichStayIntegers) {
  const std::string labels = "property int label\nproperty uint serial\nproperty float heat\n";
  const MeshFile from = read("a.ply", ply_triangle(labels, "-20 4000000000 3", "", ""));
  for (const bool ascii : {false, true}) {
    const MeshFile back = written("b.ply", from, {.ascii = ascii, .single_precision = true});
    ASSERT_EQ(back.attributes.named.size(), 3U);
    for (const MeshFile& file : {from, back}) {
      EXPECT_EQ(file.attributes.named[0].interpolation, Interpolation::Nearest);
      EXPECT_EQ(file.attributes.named[1].interpolation, Interpolation::Nearest);
      EXPECT_EQ(file.attributes.named[2].interpolation, Interpolation::Linear);
      EXPECT_EQ(at(file.attributes, "label", 0, 2), std::vector<double>{-20});
      EXPECT_EQ(at(file.attributes, "serial", 0, 2), std::vector<double>{4000000000});
      EXPECT_EQ(at(file.attributes, "heat", 0, 2), std::vector<double>{3});
    }
  }
}

TEST_F(Colours, OfObjAreWrittenWithoutOpacityWhichIsCounted) {
  const MeshFile from =
      read("a.obj", "v 0 0 0 1 0 0 0.5\nv 1 0 0 0 1 0 1\nv 1 1 0 0 0 1\nvt 0 0 0\nvt 1 0 0.7\nf 1/1 2/2 3/2\n");
  EXPECT_EQ(from.dropped, DroppedAttributes{.texture_coordinates = 1}) << "the third number of a coordinate";
  EXPECT_EQ(from.attributes.texture_coordinates.values[1], Eigen::Vector3d(1, 0, 0));
  for (const std::string name : {"b.ply", "b.off", "b.glb"}) {
    const MeshFile there = written(name, from);
    EXPECT_NEAR(at(there.attributes, "COLOR_0", 0, 0).at(3), 0.5, 1e-7) << name;
    EXPECT_EQ(at(there.attributes, "COLOR_0", 0, 2).at(3), 1) << name;
  }
  DroppedAttributes lost;
  const MeshAttributes carried = carried_by(FileFormat::Obj, from.attributes, lost);
  EXPECT_EQ(lost, DroppedAttributes{.colours = 1});
  EXPECT_EQ(at(carried, "COLOR_0", 0, 1), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(at(written("b.obj", from).attributes, "COLOR_0", 0, 0), (std::vector<double>{1, 0, 0}));
}

TEST_F(Colours, AndSmoothingGroupsOfObjComeBack) {
  const MeshFile from =
      read("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 1 1 0\nv 0 1 0 0 0 1 1\ns 1\nf 1 2 3\ns off\nf 1 3 4\n");
  for (const MeshFile& file : {from, written("b.obj", from)}) {
    EXPECT_EQ(file.dropped, DroppedAttributes{});
    EXPECT_EQ(at(file.attributes, "COLOR_0", 0, 1), (std::vector<double>{0, 0.5, 0}));
    EXPECT_EQ(at(file.attributes, "COLOR_0", 0, 2), std::vector<double>{});
    EXPECT_EQ(at(file.attributes, "COLOR_0", 1, 2), (std::vector<double>{0, 0, 1}));
    EXPECT_EQ(file.attributes.smoothing_groups.names, (std::vector<std::string>{"1", "off"}));
    EXPECT_EQ(file.attributes.smoothing_groups.index, (std::vector<std::uint32_t>{0, 1}));
  }
  EXPECT_TRUE(read("c.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\ns 0\nf 1 2 3\n").attributes.empty());
}

TEST_F(Colours, TravelBetweenFormats) {
  const MeshFile from = read("a.ply", ply_of_vertices);
  for (const std::string name : {"b.obj", "b.off", "b.glb"}) {
    const MeshFile there = written(name, from);
    EXPECT_EQ(at(there.attributes, "COLOR_0", 1, 2).at(1), 0.4) << name;
    EXPECT_EQ(at(written("c.ply", there).attributes, "COLOR_0", 1, 2).at(1), 0.4) << name;
  }
  EXPECT_EQ(at(written("d.glb", from).attributes, "_HEAT", 1, 2), std::vector<double>{4.5});
}

TEST_F(Colours, ThatAFormatCannotCarryAreCounted) {
  const MeshFile from = read("a.ply", ply_of_vertices);
  DroppedAttributes lost;
  EXPECT_TRUE(carried_by(FileFormat::Stl, from.attributes, lost).empty());
  const DroppedAttributes all{.texture_coordinates = 4, .normals = 4, .colours = 4, .other_properties = 1};
  EXPECT_EQ(lost, all);
  DroppedAttributes lost_of_off;
  EXPECT_EQ(carried_by(FileFormat::Off, from.attributes, lost_of_off).named.size(), 1U);
  const DroppedAttributes but_colours{.texture_coordinates = 4, .normals = 4, .other_properties = 1};
  EXPECT_EQ(lost_of_off, but_colours);
}

TEST_F(Colours, DifferAcrossSeams) {
  const MeshFile faces =
      read("b.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 1.0 0.0 0.0\n3 0 2 3 0.0 1.0 0.0\n");
  const std::vector<Edge> found = seams(faces.mesh, faces.attributes);
  EXPECT_EQ(found.size(), 1U) << "the edge between the two colours; colours do not keep borders where they are";
}

}  // namespace colours_test
}  // namespace meshbound
