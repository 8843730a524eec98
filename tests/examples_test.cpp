// SPDX-License-Identifier: MIT
// The programs in examples/ do what they say; what they write is measured here.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "datasets/analytic_meshes.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace examples_test {

using testing_tools::run_tool;
using testing_tools::TemporaryFolder;
using testing_tools::ToolRun;

#ifdef BOUNDED_EDGE_COLLAPSE
TEST(Examples, EdgeCollapseWithOwnCostAndPlacementKeepsTheBound) {
  const TemporaryFolder folder;
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  write_mesh(folder / "in.off", torus);
  const ToolRun run = run_tool(BOUNDED_EDGE_COLLAPSE, {folder / "in.off", folder / "out.off", "0.02"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const TriangleMesh result = read_mesh(folder / "out.off").mesh;
  EXPECT_LT(result.triangles.size(), torus.triangles.size() / 4);
  EXPECT_EQ(check_tolerance(Bvh(torus), Bvh(result), 0.02).verdict, Verdict::Within);
}
#endif

/// 16-bit indices for the small model, 32-bit ones for the large.
TEST(Examples, EngineBuffersGetLevelsThatHold) {
  const TemporaryFolder folder;
  write_mesh(folder / "small.off", datasets::icosphere(1, 4));
  write_mesh(folder / "large.ply", datasets::terrain(1, 257, 3));
  const ToolRun small = run_tool(ENGINE_LODS, {folder / "small.off"});
  EXPECT_EQ(small.exit_code, 0) << small.out << small.err;
  EXPECT_NE(small.out.find("2-byte indices"), std::string::npos) << small.out;
  EXPECT_EQ(testing_tools::line_count(small.out), 3) << small.out;
  const ToolRun large = run_tool(ENGINE_LODS, {folder / "large.ply"});
  EXPECT_EQ(large.exit_code, 0) << large.out << large.err;
  EXPECT_EQ(large.out.find("4-byte indices"), std::string::npos) << "levels have fewer vertices: " << large.out;
  // Tetrahedra with a vertex in common: cut into manifolds, each has its own.
  TriangleMesh tetrahedra{{{0, 0, 0}}, {}};
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const double angle = 2.4 * i, z = 1 - (i + 0.5) / 10000, r = std::sqrt(1 - z * z);
    const Eigen::Vector3d out(r * std::cos(angle), r * std::sin(angle), z);
    const Eigen::Vector3d side = 100 * out.unitOrthogonal();
    const auto first = static_cast<std::uint32_t>(tetrahedra.vertices.size());
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(1000 * out), Eigen::Vector3d(1000 * out + side),
                                     Eigen::Vector3d(1000 * out + out.cross(side))})
      tetrahedra.vertices.push_back(p);
    tetrahedra.triangles.insert(
        tetrahedra.triangles.end(),
        {{first, first + 1, first + 2}, {0, first + 1, first}, {0, first + 2, first + 1}, {0, first, first + 2}});
  }
  write_mesh(folder / "tetrahedra.ply", tetrahedra);
  const ToolRun many = run_tool(ENGINE_LODS, {folder / "tetrahedra.ply"});
  EXPECT_EQ(many.exit_code, 0) << many.out << many.err;
  EXPECT_NE(many.out.find("80000 of 80000 faces, 4-byte indices"), std::string::npos) << many.out;
}

#ifdef SIMPLIFY_IN_C
TEST(Examples, ASheetIsSimplifiedAndCheckedInC) {
  const ToolRun run = run_tool(SIMPLIFY_IN_C, {});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_EQ(run.out.substr(0, 8), "6962 -> ") << run.out;
}
#endif

#ifdef CHECK_OTHER_SIMPLIFIER
TEST(Examples, LevelsOfAnotherSimplifierAreTightenedUntilTheyHold) {
  const TemporaryFolder folder;
  write_mesh(folder / "torus.off", datasets::torus(1, 0.3, 60, 24));
  const ToolRun run = run_tool(CHECK_OTHER_SIMPLIFIER, {folder / "torus.off", "0.005", "0.02", "0.05"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::regex line("tolerance (\\S+): (\\d+) of 2880 faces, at most (\\S+), attempts (\\d+)\n");
  std::sregex_iterator found(run.out.begin(), run.out.end(), line), none;
  std::size_t before = 2881;
  int max_attempts = 0;
  for (const double tolerance : {0.005, 0.02, 0.05}) {
    ASSERT_NE(found, none) << run.out;
    const std::smatch& match = *found;
    const std::size_t faces = std::stoul(match[2]);
    EXPECT_EQ(std::stod(match[1]), tolerance);
    EXPECT_LE(std::stod(match[3]), tolerance);
    EXPECT_LT(faces, before);
    before = faces;
    max_attempts = std::max(max_attempts, std::stoi(match[4]));
    ++found;
  }
  EXPECT_GT(max_attempts, 1) << "the first try of each level held: nothing shows that they are tightened\n" << run.out;
}
#endif

}  // namespace examples_test
}  // namespace meshbound
