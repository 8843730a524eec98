// SPDX-License-Identifier: MIT
// glTF is written again with new triangles and everything else as it was; copies of a mesh stay copies; seams stay
// closed.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "datasets.h"
#include "datasets/analytic_meshes.h"
#include "gltf_fixture.h"
#include "json_claims.h"
#include "levels/level_run.h"
#include "mesh/texture_transform.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/simplify.h"
#include "temporary_folder.h"

namespace meshbound {
namespace gltf_test {

using test::glb_content;
using test::GlbContent;
using test::Gltf;
using test::GltfFile;
using test::GltfJson;
using test::read_with_attributes;
using test::textured_sphere;
using testing_tools::content_of;

/// The bytes of a buffer view.
std::string view_bytes(const GlbContent& file, std::size_t view) {
  const GltfJson& of = file.json["bufferViews"][view];
  return file.bytes.substr(of.value("byteOffset", std::size_t{0}), of["byteLength"].get<std::size_t>());
}

TEST_F(Gltf, PassesThroughWhatIsNoTriangle) {
  GltfFile file = textured_sphere(48, 24);
  const std::size_t times = file.add_floats({0, 1}, 1), moves = file.add_floats({0, 0, 0, 1, 2, 3}, 3);
  file.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                              {"samplers", {{{"input", times}, {"output", moves}}}}}};
  file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.01}}}}};
  file.json["nodes"].push_back({{"camera", 0}, {"extras", {{"note", "keep \u00e9"}, {"list", {1, 2.5, nullptr}}}}});
  file.json["extensionsUsed"] = {"ACME_unknown"};
  file.json["extensions"] = {{"ACME_unknown", {{"deep", {{"er", {1, 2}}}}}}};
  file.write(in("in.glb"));
  (void)simplified(0.02);
  const GlbContent before = glb_content(content_of(in("in.glb"))), after = glb_content(content_of(in("out.glb")));
  for (const char* const key : {"asset", "scene", "scenes", "nodes", "materials", "textures", "images", "animations",
                                "cameras", "extensionsUsed", "extensions"})
    EXPECT_EQ(after.json[key], before.json[key]) << key;
  for (const std::size_t accessor : {times, moves}) {
    EXPECT_EQ(after.json["accessors"][accessor], before.json["accessors"][accessor]);
    const std::size_t view = before.json["accessors"][accessor]["bufferView"];
    EXPECT_EQ(view_bytes(after, view), view_bytes(before, view));
  }
  const std::size_t image = before.json["images"][0]["bufferView"];
  EXPECT_EQ(view_bytes(after, image), view_bytes(before, image));
  EXPECT_EQ(after.json["accessors"].size(), before.json["accessors"].size()) << "freed places are taken again";
  EXPECT_EQ(after.json["bufferViews"].size(), before.json["bufferViews"].size());
  EXPECT_LT(after.bytes.size(), before.bytes.size() / 2);
}

TEST_F(Gltf, SeamsStayClosedAndHaveTheCoordinatesOfTheirSides) {
  textured_sphere(64, 32).write(in("in.glb"));
  const MeshFile result = simplified(0.03);
  const CornerAttribute& uv = result.attributes.texture_coordinates;
  std::size_t on_seam = 0;
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
    double min = 2, max = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = result.mesh.vertices[result.mesh.triangles[t][k]];
      const double u = uv.values[uv.index[t][k]].x();
      if (p.head<2>().norm() < 1e-6) continue;  // a pole
      min = std::min(min, u), max = std::max(max, u);
      if (p.y() == 0 && p.x() > 0) ++on_seam;
      EXPECT_NEAR(std::abs(std::remainder(u - std::atan2(p.y(), p.x()) / (2 * M_PI), 1.0)), 0, 0.02);
      EXPECT_NEAR(result.attributes.normals.values[result.attributes.normals.index[t][k]].dot(p.normalized()), 1, 0.02);
    }
    EXPECT_LT(max - min, 0.6) << "no triangle reaches across the seam";
  }
  EXPECT_GT(on_seam, 4U);
  EXPECT_TRUE(summarise(result.mesh).closed) << "both sides of the seam have equal positions";
}

TEST_F(Gltf, CopiesOfAMeshStayCopies) {
  GltfFile file = textured_sphere(48, 24);
  file.json["nodes"] = {{{"mesh", 0}, {"translation", {-5, 0, 0}}},
                        {{"mesh", 0}, {"translation", {5, 0, 0}}, {"scale", {2, 1, 0.5}}},
                        {{"mesh", 0}, {"translation", {0, 7, 0}}, {"scale", {-1, 1, 1}}}};
  file.json["scenes"][0]["nodes"] = {0, 1, 2};
  file.write(in("in.glb"));
  const MeshFile result = simplified(0.02);
  const std::size_t faces = result.mesh.triangles.size() / 3;
  EXPECT_EQ(result.mesh.triangles.size(), 3 * faces);
  const GlbContent after = glb_content(content_of(in("out.glb")));
  EXPECT_EQ(after.json["meshes"].size(), 1U);
  EXPECT_EQ(after.json["accessors"][3]["count"], 3 * faces);
  // The second copy is stretched to twice its length: within 0.01 in the frame of the mesh.
  TriangleMesh first;
  first.vertices = result.mesh.vertices;
  for (std::size_t t = 0; t < faces; ++t) first.triangles.push_back(result.mesh.triangles[t]);
  TriangleMesh original = read_mesh(in("in.glb")).mesh;
  original.triangles.resize(original.triangles.size() / 3);
  EXPECT_EQ(check_tolerance(Bvh(original), Bvh(first), 0.01).verdict, Verdict::Within);
}

/// Twelve meshes, each shown twice.
GltfFile many_copies() {
  GltfFile file = textured_sphere(24, 12);
  const GltfJson mesh = file.json["meshes"][0];
  file.json["nodes"] = GltfJson::array();
  file.json["scenes"][0]["nodes"] = GltfJson::array();
  for (int i = 0; i < 12; ++i) {
    if (i > 0) file.json["meshes"].push_back(mesh);
    for (int k = 0; k < 2; ++k) {
      file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
      file.json["nodes"].push_back({{"mesh", i}, {"translation", {3 * i, 3 * k, 0}}, {"scale", {1, 1 + 0.1 * i, 1}}});
    }
  }
  return file;
}

TEST_F(Gltf, ManyMeshesWithCopiesAreTheSameOnEveryNumberOfThreads) {
  many_copies().write(in("in.glb"));
  const MeshFile from = read_with_attributes(in("in.glb"));
  SimplifyOptions options;
  options.tolerance = 0.05;
  options.levels = {0.02};
  options.feature_edges = seams(from.mesh, from.attributes);
  options.threads = 1;
  double done = 0;
  options.progress = [&done](double share) {
    EXPECT_GE(share, done - 0.05) << "undone collapses are taken off, nothing else";
    EXPECT_LE(share, 1);
    done = std::max(done, share);
  };
  const SimplifyResult one = decimate_levels(from.mesh, options, from.attributes);
  EXPECT_EQ(done, 1);
  options.threads = 3;
  options.progress = {};
  const SimplifyResult three = decimate_levels(from.mesh, options, from.attributes);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(one.levels[i].faces(), from.mesh.triangles.size());
    EXPECT_EQ(one.levels[i].mesh.vertices, three.levels[i].mesh.vertices);
    EXPECT_EQ(one.levels[i].mesh.triangles, three.levels[i].mesh.triangles);
    EXPECT_EQ(one.levels[i].source_triangle, three.levels[i].source_triangle);
  }
}

TEST_F(Gltf, OptionsThatDoNotFitASceneAreRefused) {
  many_copies().write(in("in.glb"));
  const MeshFile from = read_with_attributes(in("in.glb"));
  const auto refuses = [&](const auto& set) {
    SimplifyOptions options;
    options.tolerance = 0.05;
    set(options);
    EXPECT_THROW((void)decimate_levels(from.mesh, options, from.attributes), InvalidInput);
  };
  const auto vertices = static_cast<std::uint32_t>(from.mesh.vertices.size());
  refuses([&](SimplifyOptions& options) { options.feature_edges = {{0, vertices}}; });
  refuses([](SimplifyOptions& options) { options.locked_vertices = {true}; });
  refuses([](SimplifyOptions& options) { options.face_tolerances = {0.1}; });
  refuses([&](SimplifyOptions& options) { options.face_tolerances.assign(from.mesh.triangles.size(), -1); });
  refuses([](SimplifyOptions& options) { options.texture_coordinates.resize(1); });
  refuses([](SimplifyOptions& options) { options.materials = {0}; });
}

TEST_F(Gltf, PartsInTheSameFrameStayTogether) {
  GltfFile file = textured_sphere(48, 24);
  // The half of the triangles with another material.
  const std::size_t half = file.json["accessors"][3]["count"].get<std::size_t>() / 6 * 3;
  const std::size_t total = file.json["accessors"][3]["count"];
  GltfJson second = file.json["accessors"][3];
  file.json["accessors"][3]["count"] = half;
  second["count"] = total - half;
  second["byteOffset"] = 2 * half;
  GltfJson primitive = file.json["meshes"][0]["primitives"][0];
  primitive["indices"] = file.add_accessor(second);
  primitive["material"] = 1;
  file.json["meshes"][0]["primitives"].push_back(primitive);
  file.json["materials"].push_back({{"name", "north"}});
  file.json["nodes"][0]["translation"] = {1000, 0, 0};
  file.write(in("in.glb"));
  const MeshFile result = simplified(0.03);
  EXPECT_TRUE(summarise(result.mesh).closed) << "the border between materials has equal positions on both sides";
  EXPECT_EQ(glb_content(content_of(in("out.glb"))).json["meshes"][0]["primitives"].size(), 2U);
  EXPECT_EQ(std::set<std::uint32_t>(result.attributes.materials.index.begin(), result.attributes.materials.index.end()),
            (std::set<std::uint32_t>{0, 1}));
}

TEST_F(Gltf, JointsComeFromOneVertexAndTargetsAreBlended) {
  GltfFile file = textured_sphere(48, 24);
  const std::size_t vertices = file.json["accessors"][0]["count"];
  std::vector<std::uint8_t> joints, weights;
  std::vector<float> target;
  for (std::size_t v = 0; v < vertices; ++v) {
    joints.insert(joints.end(), {static_cast<std::uint8_t>(v % 2), static_cast<std::uint8_t>(2 + v % 3), 0, 0});
    weights.insert(weights.end(), {static_cast<std::uint8_t>(v % 200), static_cast<std::uint8_t>(255 - v % 200), 0, 0});
    target.insert(target.end(), {2, 0, 0});
  }
  GltfJson attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = file.add(joints, 5121, "VEC4", 4);
  attributes["WEIGHTS_0"] = file.add(weights, 5121, "VEC4", 4);
  file.json["accessors"].back()["normalized"] = true;
  file.json["meshes"][0]["primitives"][0]["attributes"] = attributes;
  file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", file.add_positions(target)}}};
  file.json["meshes"][0]["weights"] = {0.5};
  file.write(in("in.glb"));
  const MeshFile result = simplified(0.02);
  EXPECT_EQ(result.rest_pose_parts, 1U);
  std::map<std::string, const NamedAttribute*> named;
  for (const NamedAttribute& one : result.attributes.named) named[one.name] = &one;
  ASSERT_TRUE(named.contains("JOINTS_0") && named.contains("WEIGHTS_0") && named.contains("targets/0/POSITION"));
  const std::vector<double>& written = named["WEIGHTS_0"]->values;
  for (std::size_t v = 0; v < written.size(); v += 4) {
    const double first = std::round(written[v] * 255), second = std::round(written[v + 1] * 255);
    EXPECT_EQ(first + second, 255);
    const double joint = named["JOINTS_0"]->values[v];
    EXPECT_EQ(joint, std::fmod(first, 2)) << "joints and weights are those of one vertex";
  }
  for (std::size_t i = 0; i < named["targets/0/POSITION"]->values.size(); i += 3)
    EXPECT_EQ(named["targets/0/POSITION"]->values[i], 2);
}

TEST_F(Gltf, PrimitivesOfOtherKindsKeepTheirData) {
  GltfFile file = textured_sphere(48, 24);
  file.json["meshes"][0]["primitives"].push_back(
      {{"attributes", {{"POSITION", 0}}}, {"indices", file.add_indices({0, 1, 1, 2})}, {"mode", 1}});
  file.write(in("in.glb"));
  (void)simplified(0.02);
  const GlbContent before = glb_content(content_of(in("in.glb"))), after = glb_content(content_of(in("out.glb")));
  EXPECT_EQ(after.json["meshes"][0]["primitives"][1], before.json["meshes"][0]["primitives"][1]);
  EXPECT_EQ(after.json["accessors"][0], before.json["accessors"][0]);
  EXPECT_EQ(view_bytes(after, 0), view_bytes(before, 0)) << "the lines use the vertices that the triangles had";
}

TEST_F(Gltf, IsMadeFromOtherFormatsAndTurnedIntoThem) {
  std::ofstream(in("in.obj")) << "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\n"
                                 "vt 0 0\nvt 1 0\nvt 1 0.75\nvt 0 1\nvn 0 0 1\nusemtl red\nf 1/1/1 2/2/1 3/3/1\n"
                                 "usemtl blue\ns 3\nf 1/1/1 3/3/1 4/4/1\n";
  const MeshFile from = read_with_attributes(in("in.obj"));
  DroppedAttributes lost;
  for (const std::string name : {"out.glb", "out.gltf"}) {
    write_mesh(in(name), from.mesh, {}, carried_by(format_of(name), from.attributes, lost));
    const MeshFile back = read_with_attributes(in(name));
    ASSERT_EQ(back.mesh.triangles.size(), 2U);
    EXPECT_EQ(back.mesh.vertices, from.mesh.vertices);
    EXPECT_EQ(back.attributes.materials.names, (std::vector<std::string>{"red", "blue"}));
    EXPECT_EQ(back.attributes.materials.index, (std::vector<std::uint32_t>{0, 1}));
    const CornerAttribute& uv = back.attributes.texture_coordinates;
    EXPECT_EQ(uv.values[uv.index[0][2]], Eigen::Vector3d(1, 0.75, 0));
    ASSERT_EQ(back.attributes.named.size(), 1U);
    const NamedAttribute& colours = back.attributes.named[0];
    EXPECT_EQ(colours.values[4 * colours.index[0][1] + 1], 1);
    EXPECT_EQ(colours.values[4 * colours.index[0][1] + 0], 0);
  }
  EXPECT_EQ(lost, (DroppedAttributes{.materials = 2, .smoothing_groups = 2})) << "what the library says of materials";

  const MeshFile glb = read_with_attributes(in("out.glb"));
  DroppedAttributes lost_again;
  write_mesh(in("again.obj"), glb.mesh, {}, carried_by(FileFormat::Obj, glb.attributes, lost_again));
  EXPECT_EQ(lost_again, DroppedAttributes{});
  const MeshAttributes again = read_with_attributes(in("again.obj")).attributes;
  EXPECT_EQ(again.materials.names, (std::vector<std::string>{"red", "blue"}));
  EXPECT_EQ(again.texture_coordinates.values[again.texture_coordinates.index[0][2]], Eigen::Vector3d(1, 0.75, 0));
  EXPECT_EQ(again.named.at(0).name, "COLOR_0");
}

TEST_F(Gltf, ANormalOfLengthZeroStandsForThatOfItsTriangle) {
  GltfFile file = textured_sphere(48, 24);
  const std::size_t normals = file.json["bufferViews"][1]["byteOffset"];
  std::fill_n(file.bytes.begin() + static_cast<std::ptrdiff_t>(normals), 48 * 12 * 12, '\0');  // of the south
  file.write(in("in.glb"));
  const MeshFile result = simplified(0.03);
  ASSERT_EQ(result.attributes.normals.index.size(), result.mesh.triangles.size());
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t normal = result.attributes.normals.index[t][k];
      ASSERT_NE(normal, CornerAttribute::none);
      const Eigen::Vector3d p = result.mesh.vertices[result.mesh.triangles[t][k]].normalized();
      EXPECT_GT(result.attributes.normals.values[normal].dot(p), 0.9);
    }
}

TEST_F(Gltf, WhatNodesFlattenStaysAsItIs) {
  GltfFile file = textured_sphere(48, 24);
  file.json["meshes"].push_back(file.json["meshes"][0]);
  file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}, {"scale", {1, 1, 0}}, {"translation", {5, 0, 0}}}};
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.write(in("in.glb"));
  const MeshFile from = read_with_attributes(in("in.glb"));
  SimplifyOptions options;
  options.tolerance = 0.02;
  options.precision = Precision::Single;
  options.feature_edges = seams(from.mesh, from.attributes);
  const SimplifyResult result = decimate_levels(from.mesh, options, from.attributes);
  const auto is_flat = [](const Eigen::Vector3d& p) { return p.x() > 3; };
  for (const auto& [a, b] : result.lines) EXPECT_FALSE(is_flat(from.mesh.vertices[a]));
  const SimplifiedLevel& level = result.last();
  for (const auto& [a, b] : level.lines) EXPECT_FALSE(is_flat(level.mesh.vertices[a]));
  std::size_t flat = 0;
  for (const Triangle& t : level.mesh.triangles) flat += is_flat(level.mesh.vertices[t[0]]) ? 1 : 0;
  EXPECT_EQ(2 * flat, from.mesh.triangles.size());
  EXPECT_LT(level.faces(), flat + flat / 2);
  write_mesh(in("out.glb"), level.mesh, {}, transferred_attributes(from.mesh, from.attributes, level));
  EXPECT_EQ(read_mesh(in("out.glb")).mesh.triangles.size(), level.faces());
  file.json["nodes"][0]["scale"] = {1, 0, 1};
  file.write(in("flat.glb"));
  const MeshFile all_flat = read_with_attributes(in("flat.glb"));
  options.feature_edges = {};
  const SimplifyResult unchanged = decimate_levels(all_flat.mesh, options, all_flat.attributes);
  EXPECT_EQ(unchanged.last().faces(), all_flat.mesh.triangles.size());
  EXPECT_EQ(unchanged.last().ended_by, EndedBy::NothingFits);
}

TEST_F(Gltf, ListsOfVerticesGoWithTheVertices) {
  GltfFile file = textured_sphere(48, 24);
  const std::size_t outline = file.add_indices({0, 1, 1, 2});
  GltfJson& mesh = file.json["meshes"][0];
  mesh["primitives"][0]["extensions"] = {{"CESIUM_primitive_outline", {{"indices", outline}}}, {"ACME", {{"x", 1}}}};
  mesh["extensions"] = {{"EXT_mesh_manifold", {{"manifoldPrimitive", {{"indices", 3}}}}}};
  file.write(in("in.glb"));
  (void)simplified(0.02);
  const GltfJson after = glb_content(content_of(in("out.glb"))).json["meshes"][0];
  EXPECT_FALSE(after.contains("extensions"));
  EXPECT_EQ(after["primitives"][0]["extensions"], (GltfJson{{"ACME", {{"x", 1}}}}));
  DroppedAttributes lost;
  (void)carried_by(FileFormat::Glb, read_with_attributes(in("in.glb")).attributes, lost);
  EXPECT_EQ(lost, (DroppedAttributes{.other_properties = 2}));
}

TEST_F(Gltf, IdentifiersHaveNoMean) {
  GltfFile file = textured_sphere(48, 24);
  const std::size_t vertices = file.json["accessors"][0]["count"];
  std::vector<float> identifiers;
  std::vector<std::uint16_t> kinds;
  for (std::size_t v = 0; v < vertices; ++v) {
    identifiers.push_back(static_cast<float>(v % 7 * 10));
    kinds.push_back(static_cast<std::uint16_t>(v % 5 * 100));
  }
  GltfJson& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  const std::size_t identifier = file.add_floats(identifiers, 1), kind = file.add(kinds, 5123, "SCALAR", 1);
  attributes["_FEATURE_ID_0"] = identifier;
  attributes["_KIND"] = kind;
  file.write(in("in.glb"));
  MeshFile from = read_with_attributes(in("in.glb"));
  SimplifyOptions options;
  options.tolerance = 0.02;
  const SimplifiedLevel level = decimate_levels(from.mesh, options, from.attributes).last();
  const MeshAttributes result = transferred_attributes(from.mesh, from.attributes, level);
  ASSERT_EQ(result.named.size(), 2U);
  for (const NamedAttribute& named : result.named)
    for (const double value : named.values)
      EXPECT_EQ(std::fmod(value, named.name == "_KIND" ? 100 : 10), 0) << named.name;
}

TEST_F(Gltf, NamesAreToldApart) {
  GltfFile file = textured_sphere(24, 12);
  file.json["meshes"].push_back(file.json["meshes"][0]);
  file.json["meshes"][1]["primitives"][0]["material"] = 1;
  file.json["materials"].push_back(file.json["materials"][0]);
  file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}, {"translation", {5, 0, 0}}}};
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.write(in("in.glb"));
  const MeshFile from = read_with_attributes(in("in.glb"));
  EXPECT_EQ(from.attributes.materials.names, (std::vector<std::string>{"globe", "globe_2"}));
  DroppedAttributes lost;
  (void)carried_by(FileFormat::Obj, from.attributes, lost);
  EXPECT_EQ(lost.materials, 2U) << "OBJ has their names, but not what they look like";

  MeshAttributes scalars;
  for (const std::string name : {"quality", "Quality", "COLOR_1"})
    scalars.named.push_back(
        {.name = name, .values = {1}, .index = std::vector<Triangle>(from.mesh.triangles.size(), {0, 0, 0})});
  write_mesh(in("scalars.glb"), from.mesh, {}, scalars);
  std::set<std::string> names;
  for (const NamedAttribute& named : read_with_attributes(in("scalars.glb")).attributes.named) names.insert(named.name);
  EXPECT_EQ(names, (std::set<std::string>{"_QUALITY", "_QUALITY_2", "_COLOR_1"}));
}

TEST_F(Gltf, TheLargestScaleOfTexturesCounts) {
  GltfFile file = textured_sphere(24, 12);
  const auto scale = [&] {
    file.write(in("in.glb"));
    return texture_scale(read_with_attributes(in("in.glb")).attributes);
  };
  EXPECT_EQ(scale(), 1);
  const GltfJson::json_pointer transform(
      "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale");
  file.json[transform] = {0.25, -0.5};
  EXPECT_EQ(scale(), 0.5);
  file.json["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
  EXPECT_EQ(scale(), 0.5) << "the normals are on other coordinates";
  file.json["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatTexture"] = {{"index", 0}};
  EXPECT_EQ(scale(), 1);
  file.json[transform] = {10, 1};
  EXPECT_EQ(scale(), 10);
}

TEST_F(Gltf, TakesImageFilesIntoTheFile) {
  GltfFile file = textured_sphere(24, 12);
  std::filesystem::create_directories(in("maps"));
  const std::string png = "\x89PNG and more";
  std::ofstream(in("maps/skin 1.png"), std::ios::binary) << png;
  file.json["images"] = {
      {{"uri", "maps/skin%201.png"}, {"name", "skin"}}, {{"uri", "lost.png"}}, {{"uri", "maps/odd.tga"}}};
  std::ofstream(in("maps/odd.tga"), std::ios::binary) << "unknown";
  file.write(in("in.glb"));
  (void)simplified(0.05);
  const GlbContent after = glb_content(content_of(in("out.glb")));
  EXPECT_EQ(after.json["images"][0]["mimeType"], "image/png");
  EXPECT_EQ(after.json["images"][0]["name"], "skin");
  EXPECT_EQ(view_bytes(after, after.json["images"][0]["bufferView"]), png);
  EXPECT_EQ(after.json["images"][1]["uri"], "lost.png") << "what is not there keeps its name";
  EXPECT_EQ(after.json["images"][2]["mimeType"], "image/tga");
  EXPECT_EQ(view_bytes(after, after.json["images"][2]["bufferView"]), "unknown");
}

/// Accessors without a view are all zeros. The array of views is new in the document then.
TEST_F(Gltf, AddsViewsToADocumentWithoutAny) {
  GltfFile file;
  file.add_accessor({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  file.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}};
  file.json["nodes"] = {{{"mesh", 0}}};
  file.write(in("in.glb"));
  const MeshFile zeros = read_with_attributes(in("in.glb"));
  write_mesh(in("out.glb"), zeros.mesh, {}, zeros.attributes);
  const MeshFile again = read_with_attributes(in("out.glb"));
  EXPECT_EQ(again.mesh.triangles.size(), 1U);
  EXPECT_EQ(glb_content(content_of(in("out.glb"))).json["bufferViews"].size(), 2U);
}

TEST_F(Gltf, LeavesAPointOfAPrimitiveOfWhichNothingIsLeft) {
  GltfFile file = textured_sphere(24, 12);
  file.json["meshes"].push_back(file.json["meshes"][0]);
  file.json["meshes"][0]["primitives"].push_back(file.json["meshes"][0]["primitives"][0]);
  file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}, {"translation", {5, 0, 0}}, {"name", "empty"}}};
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.write(in("in.glb"));
  const MeshFile from = read_with_attributes(in("in.glb"));
  // Keeps the triangles of the second primitive alone.
  TriangleMesh kept{from.mesh.vertices, {}};
  SimplifiedLevel level;
  for (std::uint32_t t = 0; t < from.mesh.triangles.size(); ++t) {
    if (from.attributes.part[t] != 1) continue;
    level.mesh.triangles.push_back(from.mesh.triangles[t]);
    level.source_triangle.push_back(t);
  }
  level.mesh.vertices = from.mesh.vertices;
  write_mesh(in("out.glb"), level.mesh, {}, transferred_attributes(from.mesh, from.attributes, level));
  const GltfJson after = glb_content(content_of(in("out.glb"))).json;
  ASSERT_EQ(after["meshes"].size(), 2U) << "whatever refers to a mesh by its number still does";
  EXPECT_EQ(after["meshes"][0]["primitives"].size(), 2U);
  EXPECT_EQ(after["nodes"], file.json["nodes"]);
  const MeshFile again = read_with_attributes(in("out.glb"));
  ASSERT_EQ(again.mesh.triangles.size(), level.mesh.triangles.size() + 2);
  std::size_t points = 0;
  for (std::size_t t = 0; t < again.mesh.triangles.size(); ++t) {
    const auto [a, b, c] = again.mesh.triangles[t];
    if (a != b || b != c) continue;
    ++points;
    const std::uint32_t part = again.attributes.part[t];
    const auto first = std::find(from.attributes.part.begin(), from.attributes.part.end(), part);
    ASSERT_NE(first, from.attributes.part.end());
    const Triangle& before = from.mesh.triangles[static_cast<std::size_t>(first - from.attributes.part.begin())];
    EXPECT_EQ(again.mesh.vertices[a], from.mesh.vertices[before[0]]) << "a vertex of the original of this part";
  }
  EXPECT_EQ(points, 2U);
}

}  // namespace gltf_test
}  // namespace meshbound
