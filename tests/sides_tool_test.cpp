// SPDX-License-Identifier: MIT
// Faces that are wound the other way than their neighbours: the tools keep their sides where the output has normals,
// and say how many they turn over where it has none.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "json_claims.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace sides_tool_test {

using testing_tools::checked_document;
using testing_tools::content_of;
using testing_tools::Json;
using testing_tools::run_tool;
using testing_tools::ToolRun;

/// A flat square of 10 by 10 cells, each with two triangles and the normal (0 0 1). Those of the first 4 columns show
/// their lower side.
void write_half_turned(const std::string& path) {
  std::ofstream file(path);
  for (int y = 0; y <= 10; ++y)
    for (int x = 0; x <= 10; ++x) file << "v " << x << " " << y << " " << (x - 4) * (x - 4) * 0.01 << "\n";
  file << "vn 0 0 1\n";
  const auto add = [&](int a, int b, int c, bool is_turned) {
    if (is_turned) std::swap(b, c);
    file << "f " << a << "//1 " << b << "//1 " << c << "//1\n";
  };
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) {
      const int a = 11 * y + x + 1;
      add(a, a + 1, a + 12, x < 4);
      add(a, a + 12, a + 11, x < 4);
    }
  }
}

double area_that_shows_its_lower_side(const std::string& path) {
  const TriangleMesh mesh = read_mesh(path).mesh;
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d p = mesh.vertices[b] - mesh.vertices[a], q = mesh.vertices[c] - mesh.vertices[a];
    area += std::max(0.0, -p.cross(q).z() / 2);
  }
  return area;
}

class Sides : public testing::Test {
 protected:
  Sides() { write_half_turned(in("in.obj")); }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] ToolRun simplify(const std::string& out, std::vector<std::string> options) const {
    options.insert(options.begin(), {in("in.obj"), in(out), "--tolerance", "0.2"});
    return run_tool(SIMPLIFY_WITH_BOUND, options);
  }

 private:
  testing_tools::TemporaryFolder folder_;
};

TEST_F(Sides, AreKeptWhereTheOutputHasNormals) {
  const ToolRun run = simplify("out.obj", {"--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out.find("\nturned"), std::string::npos) << run.out;
  EXPECT_EQ(checked_document(content_of(in("r.json")))["turned_faces"], 0);
  EXPECT_LT(read_mesh(in("out.obj")).mesh.triangles.size(), 60U);
  EXPECT_NEAR(area_that_shows_its_lower_side(in("out.obj")), 40, 1e-9);
}

TEST_F(Sides, ThatAreTurnedOverAreCounted) {
  for (const char* const out : {"out.off", "out.stl"}) {
    const ToolRun run = simplify(out, {"--levels", "0.01", "--json", in("r.json")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json json = checked_document(content_of(in("r.json")));
    const std::size_t turned = json["turned_faces"], turned_before = json["levels"][0]["turned_faces"];
    EXPECT_GT(turned, 0U);
    EXPECT_GT(turned_before, turned);
    EXPECT_NE(run.out.find("\nturned      " + std::to_string(turned) + " face"), std::string::npos) << run.out;
    EXPECT_EQ(area_that_shows_its_lower_side(in(out)), 0);
  }
  const ToolRun chain =
      run_tool(LOD_CHAIN, {in("in.obj"), in("chain"), "--levels", "0.01", "--format", "off", "--json", in("l.json")});
  ASSERT_EQ(chain.exit_code, 0) << chain.err;
  EXPECT_GT(checked_document(content_of(in("l.json")))["levels"][0]["turned_faces"], 0);
  EXPECT_NE(chain.out.find("\nturned  "), std::string::npos) << chain.out;
}

TEST_F(Sides, ThatTilesTurnOverAreCounted) {
  const ToolRun run = simplify("out.ply", {"--memory", "200M", "--tile-triangles", "60", "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(checked_document(content_of(in("r.json")))["turned_faces"], 0);
}

}  // namespace sides_tool_test
}  // namespace meshbound
