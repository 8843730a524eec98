// SPDX-License-Identifier: MIT
// generate_mesh through its command line.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "datasets/analytic_meshes.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace generate_mesh_test {

using meshbound::testing_tools::run_tool;
using meshbound::testing_tools::ToolRun;

class GenerateMesh : public testing::Test {
 protected:
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  static ToolRun run(const std::vector<std::string>& arguments) { return run_tool(GENERATE_MESH, arguments); }
  /// One line that says why.
  static void expect_refused(const std::vector<std::string>& arguments, const std::string& reason) {
    const ToolRun refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(meshbound::testing_tools::line_count(refused.err), 1) << refused.err;
    EXPECT_NE(refused.err.find(reason), std::string::npos) << refused.err;
  }

  meshbound::testing_tools::TemporaryFolder folder_;
};

TEST_F(GenerateMesh, WritesTheMeshOfTheLibraryBitForBit) {
  for (const char* name : {"mesh.off", "mesh.obj", "mesh.ply"}) {
    ASSERT_EQ(run({"gear", "--size", "5000", "-o", in(name)}).exit_code, 0);
    const meshbound::TriangleMesh expected = meshbound::datasets::mesh_of_size("gear", 5000);
    const meshbound::TriangleMesh read = meshbound::read_mesh(in(name)).mesh;
    EXPECT_EQ(read.vertices, expected.vertices) << name;
    EXPECT_EQ(read.triangles, expected.triangles) << name;
  }
}

TEST_F(GenerateMesh, RefusesWhatItCannotMakeAndWritesNothing) {
  expect_refused({"sphere", "-o", in("a.ply")}, "known are icosphere, uv-sphere, ");
  expect_refused({"cube", "--size", "3", "-o", in("b.ply")}, "give a size of 1,000 to 100,000,000");
  expect_refused({"cube", "-o", in("c.xyz")}, "c.xyz");
  expect_refused({"cube"}, "--output");
  for (const char* name : {"d.off", "d.stl"})
    expect_refused({"cube", "--texture", "-o", in(name)}, std::string(name) + " carries no texture coordinates");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(GenerateMesh, HelpDescribesEveryKind) {
  const std::string help = run({"--help"}).out;
  for (const meshbound::datasets::Kind& kind : meshbound::datasets::kinds())
    EXPECT_NE(help.find("  " + std::string(kind.name) + ": " + std::string(kind.description) + "\n"), std::string::npos)
        << help;
  EXPECT_NE(help.find("PLY, STL, GLB or glTF"), std::string::npos) << help;
}

TEST_F(GenerateMesh, WritesTextureCoordinatesOfTheBoundingBox) {
  ASSERT_EQ(run({"torus", "--size", "2000", "--texture", "-o", in("torus.obj")}).exit_code, 0);
  meshbound::ReadOptions options;
  options.attributes = true;
  for (const char* name : {"torus.ply", "torus.glb"}) {
    ASSERT_EQ(run({"torus", "--size", "2000", "--texture", "-o", in(name)}).exit_code, 0);
    EXPECT_FALSE(meshbound::read_mesh(in(name), options).attributes.texture_coordinates.index.empty()) << name;
  }
  const meshbound::MeshFile file = meshbound::read_mesh(in("torus.obj"), options);
  const meshbound::CornerAttribute& texture = file.attributes.texture_coordinates;
  ASSERT_EQ(texture.index.size(), file.mesh.triangles.size());
  for (std::size_t t = 0; t < texture.index.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = file.mesh.vertices[file.mesh.triangles[t][k]];
      const Eigen::Vector3d& uv = texture.values[texture.index[t][k]];
      EXPECT_NEAR(uv.x(), (p.x() + 1.4) / 2.8, 1e-9);  // the torus reaches from -1.4 to 1.4 in x and y
      EXPECT_NEAR(uv.y(), (p.y() + 1.4) / 2.8, 1e-9);
    }
  }
}

}  // namespace generate_mesh_test
