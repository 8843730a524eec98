// SPDX-License-Identifier: MIT
// hausdorff_distance --nearest by its command line: ranks against the known answer, its document against the schema.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/transform.h"
#include "tool_refusal.h"
#include "unreadable_folder.h"

namespace meshbound {
namespace nearest_tool_test {

using nlohmann::json;
using namespace testing_tools;
namespace fs = std::filesystem;

/// A folder of boxes, each at another scale; the query is a box of 4 x 2 x 1.
class NearestTool : public testing::Test {
 protected:
  NearestTool() {
    fs::create_directories(shapes_ + "/below");
    write_mesh(query_, box({4, 2, 1}));
    write(box({8, 4, 2}), shapes_ + "/twice.off");
    write(box({4.4, 2, 1}), shapes_ + "/below/longer.PLY");
    write(box({4, 4, 1}), shapes_ + "/wider.stl");
    write(box({1, 2, 4}), shapes_ + "/turned.obj");
    std::ofstream(shapes_ + "/notes.txt") << "no mesh\n";
  }
  static TriangleMesh box(const Eigen::Vector3d& size) { return datasets::box(size, {4, 4, 4}); }
  static void write(const TriangleMesh& mesh, const std::string& path) { write_mesh(path, mesh); }
  ToolRun run(std::vector<std::string> options) {
    options.insert(options.begin(), {query_, "--nearest", shapes_});
    return run_tool(HAUSDORFF_DISTANCE, options);
  }
  json document(std::vector<std::string> options) {
    options.insert(options.end(), {"--json", "-"});
    const ToolRun result = run(options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return checked_document(result.out);
  }

  TemporaryFolder folder_;
  std::string query_ = folder_ / "query.off";
  std::string shapes_ = folder_ / "shapes";
};

TEST_F(NearestTool, RanksWhateverTheScale) {
  const json found = document({"--count", "3"});
  EXPECT_EQ(found["candidates"], 4);
  ASSERT_EQ(found["nearest"].size(), 3u);
  EXPECT_EQ(found["nearest"][0]["path"], shapes_ + "/twice.off");
  EXPECT_LE(found["nearest"][0]["distance"]["upper"].get<double>(), 1e-3);
  EXPECT_EQ(found["nearest"][1]["path"], shapes_ + "/below/longer.PLY");
  EXPECT_EQ(found["nearest"][2]["path"], shapes_ + "/wider.stl");
}

TEST_F(NearestTool, FindsWhatIsTurnedWhenAskedAndSaysHow) {
  const json found = document({"--align", "--count", "2"});
  EXPECT_EQ(found["stats"]["alignments"], 16);
  for (const json& shape : found["nearest"]) {
    EXPECT_LE(shape["distance"]["upper"].get<double>(), 1e-3) << shape;
    // The map takes the mesh of the file onto that of the query.
    Eigen::Affine3d map;
    for (int i = 0; i < 16; ++i) map.matrix()(i / 4, i % 4) = shape["map_to_query"][static_cast<std::size_t>(i)];
    const TriangleMesh mesh = transformed(read_mesh(shape["path"].get<std::string>()).mesh, map).mesh;
    EXPECT_LE(hausdorff_distance(mesh, read_mesh(query_).mesh).bounds.upper, 1e-2);
  }
}

TEST_F(NearestTool, PrintsTheRanks) {
  const ToolRun result = run({"--count", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("verdict     done"), std::string::npos) << result.out;
  EXPECT_LT(result.out.find("twice.off"), result.out.find("longer.PLY")) << result.out;
}

TEST_F(NearestTool, CountsWhatItCannotReadAndLeavesTheQueryOut) {
  std::ofstream(shapes_ + "/broken.off") << "OFF\n1 1 0\n0 0 0\n3 0 1 2\n";
  fs::copy_file(query_, shapes_ + "/copy.off");
  query_ = shapes_ + "/copy.off";
  const json found = document({});
  EXPECT_EQ(found["candidates"], 4);
  ASSERT_EQ(found["unreadable"].size(), 1u);
  EXPECT_EQ(found["unreadable"][0]["path"], shapes_ + "/broken.off");
  EXPECT_EQ(found["nearest"][0]["path"], shapes_ + "/twice.off");
}

/// What a candidate lacks, or that it may not be read, ends nothing.
TEST_F(NearestTool, CountsWhatLacksItsBuffer) {
  std::ofstream(shapes_ + "/bare.gltf") << R"({"asset": {"version": "2.0"},
      "buffers": [{"byteLength": 36, "uri": "bare.bin"}]})";
  const json found = document({});
  EXPECT_EQ(found["candidates"], 4);
  ASSERT_EQ(found["unreadable"].size(), 1u);
  EXPECT_EQ(found["unreadable"][0]["path"], shapes_ + "/bare.gltf");
}

/// A path that is too long for the system stands for a folder of somebody else, which the superuser may read.
TEST_F(NearestTool, CountsFoldersThatItCannotRead) {
  const fs::path unreadable = make_unreadable_folder(shapes_ + "/below");
  const json found = document({});
  EXPECT_EQ(found["candidates"], 4);
  ASSERT_EQ(found["unreadable"].size(), 1u);
  EXPECT_EQ(found["unreadable"][0]["path"], unreadable.string());
  EXPECT_NE(run({}).out.find("1, the first: " + unreadable.string() + ": cannot read the folder: "), std::string::npos);
}

TEST_F(NearestTool, WritesOverNoCandidate) {
  const std::string before = content_of(shapes_ + "/twice.off");
  expect_refused(run({"--json", shapes_ + "/twice.off"}), "has the name of a mesh");
  fs::create_symlink(shapes_ + "/twice.off", folder_ / "link.json");
  expect_refused(run({"--json", folder_ / "link.json"}), "is the file that is read as a candidate");
  EXPECT_EQ(content_of(shapes_ + "/twice.off"), before);
}

TEST_F(NearestTool, RefusesBadUsageInOneLine) {
  expect_refused(run({"--tolerance", "1"}), "--nearest goes with");
  expect_refused(run({"--count", "0"}), "--count");
  expect_refused(run({"--error-bound", "1%"}), "in units of normalised shapes");
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {query_}), "B is missing");
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {query_, query_, "--nearest", shapes_}), "takes the place of B");
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {query_, "--nearest", query_}), "is no folder");
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {query_, query_, "--align"}), "--align");
  fs::create_directories(folder_ / "empty");
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {query_, "--nearest", folder_ / "empty"}), "there is no mesh file");
}

}  // namespace nearest_tool_test
}  // namespace meshbound
