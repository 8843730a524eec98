// SPDX-License-Identifier: MIT
// Attributes come along: what OBJ files say of corners and triangles is read and written again, seams are found, and a
// level has on each side of a seam what the original has there.
#include "meshbound/attributes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "datasets.h"
#include "mesh/atomic_file.h"
#include "mesh/writers.h"
#include "mesh_files.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/texture_deviation.h"
#include "simplify_options.h"
#include "temporary_folder.h"

namespace meshbound {
namespace attributes_test {

constexpr std::uint32_t none = CornerAttribute::none;

MeshFile read_with_attributes(const std::filesystem::path& path) {
  ReadOptions options;
  options.attributes = true;
  return read_mesh(path, options);
}

void write_with_attributes(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshAttributes& what) {
  AtomicFile file(path);
  write_mesh(file, path, mesh, {}, what);
  file.commit();
}

/// n x n squares of the unit square, whose left half has u = x and whose right half u = x + 10, v = y in both.
struct Textured {
  TriangleMesh mesh;
  MeshAttributes attributes;
};

Textured two_charts(std::uint32_t n) {
  Textured result;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x)
      result.mesh.vertices.emplace_back(x / static_cast<double>(n), y / static_cast<double>(n),
                                        0.02 * std::sin(7.0 * x / n + 3.0 * y / n));
  CornerAttribute& uv = result.attributes.texture_coordinates;
  const std::size_t count = result.mesh.vertices.size();
  for (const double shift : {0.0, 10.0})
    for (const Eigen::Vector3d& p : result.mesh.vertices) uv.values.emplace_back(p.x() + shift, p.y(), 0);
  result.attributes.materials.names = {"left", "right"};
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      const bool is_right = 2 * x >= n;
      for (const Triangle& t : {Triangle{a, b, d}, Triangle{a, d, c}}) {
        result.mesh.triangles.push_back(t);
        const auto shift = static_cast<std::uint32_t>(is_right ? count : 0);
        uv.index.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
        result.attributes.materials.index.push_back(is_right ? 1 : 0);
      }
    }
  }
  return result;
}

/// A tube around z whose u runs once around: its one chart meets itself at angle 0.
Textured tube(std::uint32_t around, std::uint32_t along) {
  Textured result;
  CornerAttribute& uv = result.attributes.texture_coordinates;
  for (std::uint32_t z = 0; z <= along; ++z) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      result.mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), 2.0 * z / along);
    }
    for (std::uint32_t k = 0; k <= around; ++k)
      uv.values.emplace_back(k / static_cast<double>(around), z / static_cast<double>(along), 0);
  }
  for (std::uint32_t z = 0; z < along; ++z) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t next = (k + 1) % around, a = z * around, c = a + around;
      const std::uint32_t p = z * (around + 1) + k, q = p + around + 1;
      result.mesh.triangles.push_back({a + k, a + next, c + next});
      uv.index.push_back({p, p + 1, q + 1});
      result.mesh.triangles.push_back({a + k, c + next, c + k});
      uv.index.push_back({p, q + 1, q});
    }
  }
  return result;
}

SimplifiedLevel level_of(const Textured& textured, double tolerance) {
  SimplifyOptions options = test::within(tolerance);
  options.feature_edges = seams(textured.mesh, textured.attributes);
  return simplify_with_bound(textured.mesh, options).last();
}

TEST(ObjAttributes, AreReadAndWrittenAgain) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "in.obj") << "mtllib one.mtl two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\n"
                                      "vt 0 0\nvt 1 0 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0 1 0\n"
                                      "o quad\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"
                                      "g side a\nusemtl blue\nf 2//2 5//-1 3/-2\nf 1 2 5\n";
  const MeshFile file = read_with_attributes(folder / "in.obj");
  const MeshAttributes& a = file.attributes;
  EXPECT_EQ(file.dropped, DroppedAttributes{});
  EXPECT_EQ(a.material_libraries, std::vector<std::string>{"one.mtl two.mtl"});
  EXPECT_EQ(a.materials.names, (std::vector<std::string>{"red", "blue"}));
  EXPECT_EQ(a.materials.index, (std::vector<std::uint32_t>{0, 0, 1, 1}));
  EXPECT_EQ(a.groups.names, std::vector<std::string>{"side a"});
  EXPECT_EQ(a.objects.names, std::vector<std::string>{"quad"});
  EXPECT_EQ(a.objects.index, (std::vector<std::uint32_t>{0, 0, 0, 0}));
  EXPECT_EQ(a.groups.index, (std::vector<std::uint32_t>{none, none, 0, 0}));
  EXPECT_EQ(a.texture_coordinates.index,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {none, none, 2}, {none, none, none}}));
  EXPECT_EQ(a.normals.index, (std::vector<Triangle>{{0, 0, 0}, {0, 0, 0}, {1, 1, none}, {none, none, none}}));
  write_with_attributes(folder / "out.obj", file.mesh, a);
  const MeshFile again = read_with_attributes(folder / "out.obj");
  EXPECT_EQ(again.mesh.triangles, file.mesh.triangles);
  EXPECT_EQ(again.attributes.texture_coordinates.index, a.texture_coordinates.index);
  EXPECT_EQ(again.attributes.texture_coordinates.values, a.texture_coordinates.values);
  EXPECT_EQ(again.attributes.normals.index, a.normals.index);
  EXPECT_EQ(again.attributes.materials.index, a.materials.index);
  EXPECT_EQ(again.attributes.groups.names, a.groups.names);
  EXPECT_EQ(again.attributes.material_libraries, a.material_libraries);
  EXPECT_TRUE(read_mesh(folder / "in.obj").attributes.empty());
  EXPECT_EQ(read_mesh(folder / "in.obj").dropped.texture_coordinates, 4U);
}

/// Objects may have a group of the same name each: both names are those of a triangle.
TEST(ObjAttributes, ObjectsAndTheirGroupsComeBack) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "in.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\no A\ng x\nf 1 3 4\n"
                                      "g y\nf 1 2 4\no B\ng x\nf 2 3 4\no C\nf 4 3 2\n";
  const MeshFile from = read_with_attributes(folder / "in.obj");
  write_with_attributes(folder / "out.obj", from.mesh, from.attributes);
  for (const MeshFile& file : {from, read_with_attributes(folder / "out.obj")}) {
    EXPECT_EQ(file.dropped, DroppedAttributes{});
    EXPECT_EQ(file.attributes.objects.names, (std::vector<std::string>{"A", "B", "C"}));
    EXPECT_EQ(file.attributes.objects.index, (std::vector<std::uint32_t>{none, 0, 0, 1, 2}));
    EXPECT_EQ(file.attributes.groups.names, (std::vector<std::string>{"x", "y"}));
    EXPECT_EQ(file.attributes.groups.index, (std::vector<std::uint32_t>{none, 0, 1, 0, 0}));
  }
  DroppedAttributes lost;
  EXPECT_TRUE(carried_by(FileFormat::Ply, from.attributes, lost).empty());
  EXPECT_EQ(lost, (DroppedAttributes{.groups = 3 + 2}));
}

TEST(ObjAttributes, NamesMayHoldSignsOfComments) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "in.obj") << "mtllib a #1.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                      "usemtl Material #25\ng #2\ns 1 # smooth\nf 1 2 3 # first\n"
                                      "usemtl Material #26\nf 1 3 4\n";
  const MeshAttributes a = read_with_attributes(folder / "in.obj").attributes;
  EXPECT_EQ(a.material_libraries, std::vector<std::string>{"a #1.mtl"});
  EXPECT_EQ(a.materials.names, (std::vector<std::string>{"Material #25", "Material #26"}));
  EXPECT_EQ(a.groups.names, std::vector<std::string>{"#2"});
  EXPECT_EQ(a.smoothing_groups.names, std::vector<std::string>{"1"});
  EXPECT_EQ(read_mesh(folder / "in.obj").dropped.materials, 2U);
}

/// Names of other formats may hold anything: they must not become statements, nor join lines.
TEST(ObjAttributes, NamesStayOnTheirLine) {
  const test::TemporaryFolder folder;
  Textured textured = two_charts(2);
  textured.attributes.materials.names = {"left\nf 1 2 3", "C:\\right\\"};
  write_with_attributes(folder / "out.obj", textured.mesh, textured.attributes);
  const MeshFile again = read_with_attributes(folder / "out.obj");
  EXPECT_EQ(again.mesh.triangles.size(), textured.mesh.triangles.size());
  EXPECT_EQ(again.attributes.materials.names, (std::vector<std::string>{"left f 1 2 3", "C:\\right"}));
}

TEST(Attributes, OfTrianglesWithoutAreaAreThoseOfTheirCorners) {
  SimplifiedLevel level;
  level.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {8, 3, 0}, {6, 1, 0}}, {{0, 1, 2}, {3, 4, 5}}};
  level.source_vertex = {0, 1, 2, 3, 4, 5};
  level.source_triangle = {0, 1};
  MeshAttributes attributes;
  attributes.named = {{.name = "heat", .values = {0, 1, 2, 3, 4, 5}, .index = level.mesh.triangles}};
  TriangleMesh moved = level.mesh;
  moved.vertices[0].z() = 0.5;  // so that vertices are not all those of the original
  const MeshAttributes result = transferred_attributes(moved, attributes, level);
  const NamedAttribute& heat = result.named.at(0);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(heat.values[heat.index[1][k]], static_cast<double>(3 + k), 1e-9) << k;
}

/// Means of bytes are bytes, so that a file keeps the type of its colours.
TEST(Attributes, ColoursInBytesStayBytes) {
  Textured textured = two_charts(12);
  NamedAttribute colours{.name = "COLOR_0", .width = 3};
  for (std::size_t v = 0; v < textured.mesh.vertices.size(); ++v)
    for (const std::size_t factor : {7, 31, 101}) colours.values.push_back(static_cast<double>(factor * v % 256) / 255);
  colours.has_seams = false;
  colours.index = textured.mesh.triangles;
  textured.attributes = {};
  textured.attributes.named = {colours};
  const SimplifiedLevel level = level_of(textured, 0.05);
  ASSERT_LT(level.faces(), textured.mesh.triangles.size() / 2);
  const MeshAttributes result = transferred_attributes(textured.mesh, textured.attributes, level);
  for (const double value : result.named.at(0).values) EXPECT_NEAR(255 * value, std::round(255 * value), 1e-9);
  const test::TemporaryFolder folder;
  write_with_attributes(folder / "out.ply", level.mesh, result);
  EXPECT_NE(test::content_of(folder / "out.ply").find("property uchar red"), std::string::npos);
}

TEST(Attributes, OfAnotherMeshAreRefused) {
  const test::TemporaryFolder folder;
  const Textured textured = two_charts(4);
  const SimplifiedLevel level = level_of(textured, 0.1);
  ASSERT_LT(level.faces(), textured.mesh.triangles.size());
  const auto refuses = [&](const MeshAttributes& attributes, const TriangleMesh& mesh) {
    for (const char* const name : {"out.obj", "out.ply", "out.glb", "out.off"})
      EXPECT_THROW(write_mesh(folder / name, mesh, {}, attributes), InvalidInput) << name;
    EXPECT_THROW((void)seams(mesh, attributes), InvalidInput);
    EXPECT_THROW((void)textured_meshes(mesh, attributes, mesh, attributes), InvalidInput);
    EXPECT_THROW((void)transferred_attributes(mesh, attributes, level), InvalidInput);
  };
  refuses(textured.attributes, level.mesh);
  MeshAttributes wrong = textured.attributes;
  wrong.texture_coordinates.index[3][1] = 1000;
  refuses(wrong, textured.mesh);
  wrong = textured.attributes;
  wrong.materials.index[3] = 2;
  refuses(wrong, textured.mesh);
  wrong = textured.attributes;
  wrong.named = {{.name = "heat", .width = 2, .values = {1, 2, 3, 4}, .index = wrong.texture_coordinates.index}};
  refuses(wrong, textured.mesh);
  TriangleMesh broken = textured.mesh;
  broken.triangles[2][0] = 1000;
  refuses(textured.attributes, broken);
  SimplifiedLevel stray = level;
  stray.source_triangle[0] = 1000;
  EXPECT_THROW((void)transferred_attributes(textured.mesh, textured.attributes, stray), InvalidInput);
  EXPECT_EQ(transferred_attributes(textured.mesh, textured.attributes, level).materials.index.size(), level.faces());
}

TEST(PlyAttributes, NamesAreWords) {
  const test::TemporaryFolder folder;
  Textured textured = two_charts(2);
  textured.attributes = {};
  textured.attributes.named = {{.name = "_wet ness\n", .values = {0.5}, .index = {}}};
  textured.attributes.named[0].index.assign(textured.mesh.triangles.size(), {0, 0, 0});
  write_with_attributes(folder / "out.ply", textured.mesh, textured.attributes);
  const std::vector<NamedAttribute> again = read_with_attributes(folder / "out.ply").attributes.named;
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].name, "_wet_ness_");
  EXPECT_EQ(again[0].values, std::vector<double>(9, 0.5)) << "each vertex has its own";
}

TEST(ObjAttributes, WithoutAValueAreNone) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "in.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/7/9 2/0/-5 3/-1/1\n";
  EXPECT_TRUE(read_with_attributes(folder / "in.obj").attributes.empty());
}

TEST(TexturePrecision, IsThatOfTheNumbersInTheFile) {
  const Eigen::Vector2d tenth(0.1, 0.1);
  const auto as_float = [](float x) { return static_cast<double>(x); };
  EXPECT_EQ(rounded_to(TexturePrecision::Double, tenth), tenth);
  EXPECT_EQ(rounded_to(TexturePrecision::Float, tenth), Eigen::Vector2d(as_float(0.1F), as_float(0.1F)));
  EXPECT_EQ(rounded_to(TexturePrecision::FloatFromTop, tenth), Eigen::Vector2d(as_float(0.1F), 1 - as_float(0.9F)));
  EXPECT_NE(1 - as_float(0.9F), as_float(0.1F));
}

/// The first triangle has coordinates that no float has, the second has none, and the third lacks one.
TEST(TexturePrecision, AndMissingCoordinatesComeBackFromEachFormat) {
  const test::TemporaryFolder folder;
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}}};
  MeshAttributes given;
  given.texture_coordinates.values = {{0.1, 0.1, 0}, {0.7, 0.2, 0}, {0.3, 0.9, 0}};
  given.texture_coordinates.index = {{0, 1, 2}, {none, none, none}, {0, none, 1}};
  for (const std::string name : {"out.obj", "out.ply", "ascii.ply", "out.glb"}) {
    WriteOptions options;
    options.ascii = name == "ascii.ply";
    DroppedAttributes lost;
    const MeshAttributes carried = carried_by(format_of(name), given, lost);
    write_mesh(folder / name, mesh, options, carried);
    const MeshFile back = read_with_attributes(folder / name);
    EXPECT_EQ(back.attributes.texture_precision, carried.texture_precision) << name;
    const CornerAttribute& uv = back.attributes.texture_coordinates;
    ASSERT_EQ(uv.index.size(), 3U) << name;
    int with_coordinates = 0;
    for (std::size_t t = 0; t < 3; ++t) {
      if (std::find(uv.index[t].begin(), uv.index[t].end(), none) != uv.index[t].end()) continue;
      ++with_coordinates;
      EXPECT_EQ(back.mesh.vertices[back.mesh.triangles[t][1]], mesh.vertices[1]) << name;
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(uv.values[uv.index[t][k]], carried.texture_coordinates.values[k]) << name;
    }
    EXPECT_EQ(with_coordinates, 1) << name;
  }
}

TEST(Seams, AreWhereTextureCoordinatesOrMaterialsDiffer) {
  Textured square = two_charts(8);
  const auto interior = [&] {
    std::size_t count = 0;
    for (const auto& [a, b] : seams(square.mesh, square.attributes)) {
      const bool is_middle = square.mesh.vertices[a].x() == 0.5 && square.mesh.vertices[b].x() == 0.5;
      count += is_middle ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(interior(), 8U);
  EXPECT_EQ(seams(square.mesh, square.attributes).size(), 8U + 32U);
  const CornerAttribute coordinates = square.attributes.texture_coordinates;
  square.attributes.texture_coordinates = {};
  EXPECT_EQ(interior(), 8U) << "by materials alone";
  square.attributes.texture_coordinates = coordinates;
  square.attributes.materials = {};
  EXPECT_EQ(interior(), 8U) << "by texture coordinates alone";
  square.attributes.texture_coordinates = {};
  EXPECT_TRUE(seams(square.mesh, square.attributes).empty());
  EXPECT_EQ(seams(tube(24, 6).mesh, tube(24, 6).attributes).size(), 6U + 2 * 24U);
  square.attributes.normals.index.resize(3);
  EXPECT_THROW((void)seams(square.mesh, square.attributes), InvalidInput);
}

TEST(TransferredAttributes, AreThoseOfTheRightSideOfASeam) {
  const Textured square = two_charts(24);
  const SimplifiedLevel level = level_of(square, 0.01);
  EXPECT_LT(level.faces(), square.mesh.triangles.size() / 4);
  const MeshAttributes attributes = transferred_attributes(square.mesh, square.attributes, level);
  const CornerAttribute& uv = attributes.texture_coordinates;
  ASSERT_EQ(uv.index.size(), level.faces());
  for (std::size_t t = 0; t < level.faces(); ++t) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : level.mesh.triangles[t]) middle += level.mesh.vertices[v] / 3;
    const bool is_right = middle.x() > 0.5;
    EXPECT_EQ(attributes.materials.index[t], is_right ? 1U : 0U);
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = level.mesh.vertices[level.mesh.triangles[t][k]];
      ASSERT_NE(uv.index[t][k], none);
      const Eigen::Vector3d value = uv.values[uv.index[t][k]];
      EXPECT_NEAR(value.x(), p.x() + (is_right ? 10 : 0), 0.011);
      EXPECT_NEAR(value.y(), p.y(), 0.011);
    }
  }
  EXPECT_LT(uv.values.size(), level.mesh.vertices.size() * 3 / 2) << "corners of one side share their value";
}

/// Products of such coordinates overflow or underflow.
TEST(TransferredAttributes, DoNotDependOnTheUnitOfLength) {
  const Textured square = two_charts(24);
  const SimplifiedLevel level = level_of(square, 0.001);
  const MeshAttributes plain = transferred_attributes(square.mesh, square.attributes, level);
  for (const double unit : {0x1p-600, 0x1p600}) {
    TriangleMesh mesh = square.mesh;
    SimplifiedLevel same = level;
    for (Eigen::Vector3d& p : mesh.vertices) p *= unit;
    for (Eigen::Vector3d& p : same.mesh.vertices) p *= unit;
    const MeshAttributes scaled = transferred_attributes(mesh, square.attributes, same);
    EXPECT_EQ(scaled.texture_coordinates.index, plain.texture_coordinates.index);
    EXPECT_EQ(scaled.texture_coordinates.values, plain.texture_coordinates.values);
  }
}

/// A round wall with its texture from above. What rounding makes of a coordinate would not be that of the edge any
/// more, so that no other point has it.
TEST(TransferredAttributes, StayTheSameAlongAnEdgeThatHasOneValue) {
  Textured wall = tube(21, 9);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t t = 0; t < wall.mesh.triangles.size(); ++t)
      wall.attributes.texture_coordinates.index[t][k] = wall.mesh.triangles[t][k];
  std::vector<Eigen::Vector3d>& values = wall.attributes.texture_coordinates.values;
  values.clear();
  for (const Eigen::Vector3d& p : wall.mesh.vertices) values.emplace_back(p.x(), p.y(), 0);
  SimplifiedLevel level = level_of(wall, 0);
  for (Eigen::Vector3d& p : level.mesh.vertices) p.z() *= 0.9;  // most are between two vertices then, above one another
  const CornerAttribute uv = transferred_attributes(wall.mesh, wall.attributes, level).texture_coordinates;
  for (std::size_t t = 0; t < level.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = level.mesh.vertices[level.mesh.triangles[t][k]];
      EXPECT_EQ(uv.values[uv.index[t][k]], Eigen::Vector3d(p.x(), p.y(), 0));
    }
}

TEST(TransferredAttributes, DoNotWrapAroundWhereAChartMeetsItself) {
  const Textured around = tube(48, 12);
  const SimplifiedLevel level = level_of(around, 0.03);
  EXPECT_LT(level.faces(), around.mesh.triangles.size() / 4);
  const CornerAttribute uv = transferred_attributes(around.mesh, around.attributes, level).texture_coordinates;
  for (std::size_t t = 0; t < level.faces(); ++t) {
    double min = 2, max = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d value = uv.values[uv.index[t][k]];
      const Eigen::Vector3d& p = level.mesh.vertices[level.mesh.triangles[t][k]];
      min = std::min(min, value.x()), max = std::max(max, value.x());
      EXPECT_NEAR(value.y(), p.z() / 2, 0.02);
      const double angle = std::atan2(p.y(), p.x()) / (2 * std::numbers::pi);
      EXPECT_NEAR(std::abs(std::remainder(value.x() - angle, 1.0)), 0, 0.02);
    }
    EXPECT_LT(max - min, 0.5) << "triangle " << t << " from " << min << " to " << max;
  }
}

TEST(TransferredAttributes, KeepNormalsOnTheirSideOfASharpEdge) {
  Textured roof = two_charts(12);
  roof.attributes = {};
  for (Eigen::Vector3d& p : roof.mesh.vertices) p.z() = 0.5 - std::abs(p.x() - 0.5);
  CornerAttribute& normals = roof.attributes.normals;
  normals.values = {Eigen::Vector3d(-1, 0, 1).normalized(), Eigen::Vector3d(1, 0, 1).normalized()};
  for (const Triangle& t : roof.mesh.triangles) {
    double x = 0;
    for (const std::uint32_t v : t) x += roof.mesh.vertices[v].x() / 3;
    const std::uint32_t side = x < 0.5 ? 0 : 1;
    normals.index.push_back({side, side, side});
  }
  const SimplifiedLevel level = level_of(roof, 0.001);
  EXPECT_LE(level.faces(), 8U);
  const CornerAttribute result = transferred_attributes(roof.mesh, roof.attributes, level).normals;
  for (std::size_t t = 0; t < level.faces(); ++t) {
    const Triangle& v = level.mesh.triangles[t];
    const Eigen::Vector3d normal = (level.mesh.vertices[v[1]] - level.mesh.vertices[v[0]])
                                       .cross(level.mesh.vertices[v[2]] - level.mesh.vertices[v[0]])
                                       .normalized();
    for (const std::uint32_t i : result.index[t]) EXPECT_GT(result.values[i].dot(normal), 0.99);
  }
}

/// A low wall on a floor, leaning away from where it stood: the floor is nearer to it than the wall of the original.
TEST(TransferredAttributes, KeepNormalsOfATriangleThatOneOfAnotherDirectionIsNearestTo) {
  Textured room;
  room.mesh.vertices = {{0, 0, 0}, {0, 1, 0}, {0, 0, 0.05}, {0, 1, 0.05}, {1, 0, 0}, {1, 1, 0}};
  room.mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 4, 1}, {4, 5, 1}};
  room.attributes.normals.values = {{1, 0, 0}, {0, 0, 1}};
  room.attributes.normals.index = {{0, 0, 0}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}};
  SimplifiedLevel level;
  level.mesh = room.mesh;
  level.mesh.vertices[0].x() = level.mesh.vertices[1].x() = 0.01;
  level.source_vertex = {0, 1, 2, 3, 4, 5};
  level.source_triangle = {0, 1, 2, 3};
  const CornerAttribute result = transferred_attributes(room.mesh, room.attributes, level).normals;
  for (std::size_t t = 0; t < 4; ++t)
    for (const std::uint32_t i : result.index[t]) EXPECT_EQ(result.values[i], room.attributes.normals.values[t / 2]);
}

/// A triangle whose corners all look elsewhere, as it was but for the corner that it starts with.
TEST(TransferredAttributes, KeepNormalsOfATriangleThatStays) {
  Textured cap;
  cap.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  cap.mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  for (const Eigen::Vector3d& p : cap.mesh.vertices)
    cap.attributes.normals.values.push_back(Eigen::Vector3d(p.x() - 0.4, p.y() - 0.3, 0.5).normalized());
  cap.attributes.normals.index = cap.mesh.triangles;
  SimplifiedLevel level;
  level.mesh = cap.mesh;
  level.mesh.vertices[3] = {1.2, 1.3, 0};  // of the second triangle alone
  level.mesh.triangles[0] = {2, 0, 1};
  level.source_triangle = {0, 1};
  const CornerAttribute result = transferred_attributes(cap.mesh, cap.attributes, level).normals;
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT((result.values[result.index[0][k]] - cap.attributes.normals.values[level.mesh.triangles[0][k]]).norm(),
              1e-15);
}

/// A level with six vertices of a tube, at uneven distances.
TEST(TransferredAttributes, KeepNormalsOfVerticesOfASmoothSurface) {
  Textured round = tube(48, 1);
  const auto radial = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.y(), 0).normalized(); };
  round.attributes = {};
  for (const Eigen::Vector3d& p : round.mesh.vertices) round.attributes.normals.values.push_back(radial(p));
  round.attributes.normals.index = round.mesh.triangles;
  SimplifiedLevel level;
  for (const std::uint32_t v : {0, 2, 10, 48, 50, 58}) level.mesh.vertices.push_back(round.mesh.vertices[v]);
  level.mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  level.source_triangle = {0, 1, 4, 5};
  const CornerAttribute result = transferred_attributes(round.mesh, round.attributes, level).normals;
  for (std::size_t t = 0; t < 4; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = level.mesh.vertices[level.mesh.triangles[t][k]];
      EXPECT_NEAR(result.values[result.index[t][k]].dot(radial(p)), 1, 1e-12);
    }
  }
}

/// Texture coordinates of real models: no triangle of a level spans more of the texture than the originals around it.
TEST(TransferredAttributes, OfRealModelsAreFoundAtEveryCorner) {
  std::size_t found = 0;
  for (const char* const name : {"game/gltf_Duck.obj", "organic/c3d_spot.obj", "game/mopt_pirate.obj"}) {
    const auto path = test::dataset(name);
    if (!path) continue;
    ++found;
    const MeshFile file = read_with_attributes(*path);
    Textured textured{file.mesh, file.attributes};
    const SimplifiedLevel level = level_of(textured, 0.003 * bounding_box_diagonal(file.mesh));
    EXPECT_EQ(level.verdict, Verdict::Within) << name;
    const CornerAttribute uv = transferred_attributes(textured.mesh, textured.attributes, level).texture_coordinates;
    ASSERT_EQ(uv.index.size(), level.faces()) << name;
    for (const Triangle& t : uv.index)
      for (const std::uint32_t i : t) ASSERT_NE(i, none) << name;
  }
  if (found == 0) GTEST_SKIP() << "no real meshes on this machine";
}

}  // namespace attributes_test
}  // namespace meshbound
