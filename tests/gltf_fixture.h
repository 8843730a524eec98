// SPDX-License-Identifier: MIT
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "gltf_file.h"
#include "levels/level_run.h"
#include "meshbound/io.h"
#include "meshbound/simplify.h"
#include "temporary_folder.h"

namespace meshbound::test {

inline MeshFile read_with_attributes(const std::filesystem::path& path) {
  ReadOptions options;
  options.attributes = true;
  return read_mesh(path, options);
}

/// A sphere of radius 1 whose longitude is the texture coordinate, in one primitive: the seam has its vertices twice.
inline GltfFile textured_sphere(std::uint32_t around, std::uint32_t along) {
  GltfFile file;
  std::vector<float> positions, normals, coordinates;
  std::vector<std::uint16_t> indices;
  for (std::uint32_t j = 0; j <= along; ++j) {
    for (std::uint32_t i = 0; i <= around; ++i) {
      const double u = i / static_cast<double>(around), v = j / static_cast<double>(along);
      const double longitude = 2 * M_PI * (i % around) / around, latitude = M_PI * (v - 0.5);
      const bool is_pole = j == 0 || j == along;
      const double radius = is_pole ? 0 : std::cos(latitude);
      for (const double x : {radius * std::cos(longitude), radius * std::sin(longitude), std::sin(latitude)})
        positions.push_back(static_cast<float>(x)), normals.push_back(static_cast<float>(x));
      coordinates.push_back(static_cast<float>(u)), coordinates.push_back(static_cast<float>(v));
      if (i == around || j == along) continue;
      const auto a = static_cast<std::uint16_t>(j * (around + 1) + i), b = static_cast<std::uint16_t>(a + around + 1);
      if (j > 0)
        indices.insert(indices.end(), {a, static_cast<std::uint16_t>(a + 1), static_cast<std::uint16_t>(b + 1)});
      if (j + 1 < along) indices.insert(indices.end(), {a, static_cast<std::uint16_t>(b + 1), b});
    }
  }
  file.add_positions(positions);
  file.add_floats(normals, 3);
  file.add_floats(coordinates, 2);
  file.add_indices(indices);
  file.json["materials"] = {{{"name", "globe"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["images"] = {
      {{"bufferView", file.add_view<std::uint8_t>({0x89, 'P', 'N', 'G', 1, 2, 3, 4})}, {"mimeType", "image/png"}}};
  file.json["meshes"] = {
      {{"name", "sphere"},
       {"primitives",
        {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}, {"material", 0}}}}}};
  file.json["nodes"] = {{{"mesh", 0}}};
  return file;
}

/// Files of glTF in a folder of the test.
class Gltf : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path in(const std::string& name) const { return folder_ / name; }

  /// Simplifies `in.glb` to `out.glb` within a tolerance, both seen as scenes. Returns what was written, as read.
  MeshFile simplified(double tolerance) {
    const MeshFile from = read_with_attributes(in("in.glb"));
    SimplifyOptions options;
    options.tolerance = tolerance - placement_rounding(from.mesh, from.attributes);
    options.feature_edges = seams(from.mesh, from.attributes);
    options.looks = looks(from.mesh, from.attributes);
    options.precision = Precision::Single;
    if (placement_rounding(from.mesh, from.attributes) > 0) options.precision = Precision::Double;
    const SimplifiedLevel level = decimate_levels(from.mesh, options, from.attributes).last();
    const MeshAttributes attributes = transferred_attributes(from.mesh, from.attributes, level);
    const SimplifiedLevel placed = placed_as_written(level, attributes);
    write_mesh(in("out.glb"), placed.mesh, {}, attributes);
    MeshFile result = read_with_attributes(in("out.glb"));
    EXPECT_EQ(check_tolerance(Bvh(from.mesh), Bvh(result.mesh), tolerance).verdict, Verdict::Within);
    EXPECT_LT(result.mesh.triangles.size(), from.mesh.triangles.size() / 2);
    std::set<std::array<double, 3>> written;
    for (const Eigen::Vector3d& p : result.mesh.vertices) written.insert({p.x(), p.y(), p.z()});
    for (const Eigen::Vector3d& p : placed.mesh.vertices)
      EXPECT_TRUE(written.contains({p.x(), p.y(), p.z()})) << "the file has the vertices that were foreseen";
    return result;
  }

  TemporaryFolder folder_;
};

}  // namespace meshbound::test
