// SPDX-License-Identifier: MIT
// generate_mesh through its command line.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "meshbound/io.h"

namespace {

namespace fs = std::filesystem;

int run(const std::string& arguments) {
  const int status = std::system((std::string(GENERATE_MESH) + ' ' + arguments + " >/dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class GenerateMesh : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_ = fs::temp_directory_path() / ("meshbound_generate_" + std::to_string(::getpid()));
};

TEST_F(GenerateMesh, WritesTheMeshOfTheLibraryBitForBit) {
  for (const char* name : {"mesh.off", "mesh.obj", "mesh.ply"}) {
    const fs::path path = folder_ / name;
    ASSERT_EQ(run("gear --size 5000 -o " + path.string()), 0);
    const meshbound::TriangleMesh expected = meshbound::datasets::mesh_of_size("gear", 5000);
    const meshbound::TriangleMesh read = meshbound::read_mesh(path).mesh;
    EXPECT_EQ(read.vertices, expected.vertices) << name;
    EXPECT_EQ(read.triangles, expected.triangles) << name;
  }
}

TEST_F(GenerateMesh, RefusesWhatItCannotMakeAndWritesNothing) {
  EXPECT_EQ(run("klein-bottle -o " + (folder_ / "a.ply").string()), 2);
  EXPECT_EQ(run("cube --size 3 -o " + (folder_ / "b.ply").string()), 2);
  EXPECT_EQ(run("cube -o " + (folder_ / "c.xyz").string()), 2);
  EXPECT_EQ(run("cube"), 2);
  try {
    (void)meshbound::datasets::mesh_of_size("sphere", 5000);
    FAIL() << "made a mesh of an unknown kind";
  } catch (const meshbound::Error& error) {
    EXPECT_NE(std::string(error.what()).find("known are "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("icosphere"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
