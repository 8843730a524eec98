// SPDX-License-Identifier: MIT
// hausdorff_distance by its command line: exit codes, JSON against the library and the schema, bad input.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "reference/small_meshes.h"
#include "run_tool.h"

namespace meshbound {
namespace {

using nlohmann::json;
using namespace testing_tools;
namespace fs = std::filesystem;

const std::string shifted = "1 0 0 0.25  0 1 0 0  0 0 1 0  0 0 0 1";

class HausdorffTool : public testing::Test {
 protected:
  HausdorffTool() {
    write_mesh(cube_, reference::cube(1));
    write_mesh(large_, reference::cube(2));
    write_mesh(sphere_, reference::icosphere(3));
    write_mesh(soup_, reference::random_soup(1, 100, 0.4));
  }
  static ToolRun run(const std::vector<std::string>& arguments) { return run_tool(HAUSDORFF_DISTANCE, arguments); }
  static void expect_one_line_and_exit_2(const ToolRun& result) {
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_EQ(result.out, "");
  }

  TemporaryFolder folder_;
  std::string cube_ = folder_ / "cube.off";
  std::string large_ = folder_ / "large.ply";
  std::string sphere_ = folder_ / "sphere.obj";
  std::string soup_ = folder_ / "soup.off";
};

/// Every required key of the schema is there, recursively. References point into the schema itself.
void expect_required_keys(const json& schema, const json& part, const json& value, const std::string& where) {
  if (part.contains("$ref")) {
    const std::string name = part["$ref"].get<std::string>().substr(std::string("#/$defs/").size());
    return expect_required_keys(schema, schema["$defs"][name], value, where);
  }
  if (part.contains("required")) {
    for (const auto& key : part["required"]) EXPECT_TRUE(value.contains(key)) << where << " lacks " << key;
  }
  if (!part.contains("properties") || !value.is_object()) return;
  for (const auto& [key, entry] : value.items()) {
    EXPECT_TRUE(part["properties"].contains(key)) << where << " has a key that the schema does not know: " << key;
    if (part["properties"].contains(key))
      expect_required_keys(schema, part["properties"][key], entry, where + "/" + key);
  }
}

json parsed(const ToolRun& result) {
  const json document = json::parse(result.out);
  const json schema = json::parse(content_of(MESHBOUND_SOURCE_DIR "/tools/schema/distance-1.schema.json"));
  expect_required_keys(schema, schema, document, "document");
  return document;
}

TEST_F(HausdorffTool, SaysWhatTheLibrarySays) {
  const ToolRun result = run({sphere_, soup_, "--json", "-", "--threads", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const json document = parsed(result);
  const TriangleMesh a = read_mesh(sphere_).mesh, b = read_mesh(soup_).mesh;
  const SymmetricDistance expected = symmetric_distance(Bvh(a), Bvh(b));
  EXPECT_EQ(document["schema"], "meshbound/distance/1");
  EXPECT_EQ(document["verdict"], "done");
  EXPECT_EQ(document["distance"]["lower"], expected.bounds.lower);
  EXPECT_EQ(document["distance"]["upper"], expected.bounds.upper);
  EXPECT_EQ(document["distance"]["a_to_b"]["upper"], expected.a_to_b.bounds.upper);
  EXPECT_EQ(document["distance"]["b_to_a"]["witness"]["from"][0], expected.b_to_a.witness.from.position.x());
  EXPECT_EQ(document["a"]["faces"], a.triangles.size());
  EXPECT_EQ(document["a"]["closed"], true);
  EXPECT_EQ(document["b"]["components"], 100);
  EXPECT_EQ(document["a"]["bbox_diagonal"], bounding_box_diagonal(a));
  EXPECT_EQ(document["error_bound"], 1e-6 * bounding_box_diagonal(a));
  EXPECT_EQ(document["threads"], 1);
}

TEST_F(HausdorffTool, DecidesByExitCode) {
  const ToolRun within = run({cube_, large_, "--tolerance", "1.8", "--json", "-"});
  EXPECT_EQ(within.exit_code, 0);
  EXPECT_EQ(parsed(within)["verdict"], "within");
  EXPECT_EQ(parsed(within)["tolerance"]["absolute"], 1.8);
  const ToolRun exceeds = run({cube_, large_, "--tolerance", "1.7", "--json", "-"});
  EXPECT_EQ(exceeds.exit_code, 1);
  EXPECT_EQ(parsed(exceeds)["verdict"], "exceeds");
  EXPECT_EQ(run({cube_, large_, "--tolerance", "1.1", "--one-sided"}).exit_code, 0);
  EXPECT_EQ(run({cube_, large_, "--tolerance", "0.9", "--one-sided"}).exit_code, 1);
  const ToolRun out_of_time = run({sphere_, soup_, "--time-limit", "0", "--error-bound", "1e-9", "--json", "-"});
  EXPECT_EQ(out_of_time.exit_code, 3);
  EXPECT_EQ(parsed(out_of_time)["verdict"], "undecided");
}

TEST_F(HausdorffTool, MeasuresAndDecidesAtOnce) {
  const ToolRun result = run({cube_, large_, "--tolerance", "1.8", "--error-bound", "1e-7", "--json", "-"});
  EXPECT_EQ(result.exit_code, 0);
  const json distance = parsed(result)["distance"];
  EXPECT_LE(distance["upper"].get<double>() - distance["lower"].get<double>(), 1e-7);
  EXPECT_EQ(run({cube_, large_, "--tolerance", "1.7", "--error-bound", "1e-7"}).exit_code, 1);
}

TEST_F(HausdorffTool, TakesPercentagesOfTheDiagonalOfA) {
  const double diagonal = 2 * std::sqrt(3.0);
  const json document = parsed(run({cube_, large_, "--tolerance", "60%", "--error-bound", "1%", "--json", "-"}));
  EXPECT_NEAR(document["tolerance"]["absolute"].get<double>(), 0.6 * diagonal, 1e-14);
  EXPECT_NEAR(document["tolerance"]["percent_of_diagonal"].get<double>(), 60, 1e-12);
  EXPECT_NEAR(document["error_bound"].get<double>(), 0.01 * diagonal, 1e-14);
  EXPECT_NE(run({cube_, large_, "--tolerance", "60%"}).out.find("60% of the diagonal"), std::string::npos);
}

TEST_F(HausdorffTool, TransformsB) {
  std::ofstream(folder_ / "matrix.txt") << "1 0 0 0.25\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  for (const std::string& matrix : {shifted, std::string(folder_ / "matrix.txt")}) {
    const json document = parsed(run({cube_, cube_, "--transform-b", matrix, "--json", "-"}));
    EXPECT_LE(document["distance"]["lower"], 0.25);
    EXPECT_GE(document["distance"]["upper"], 0.25);
    EXPECT_EQ(document["b"]["transform_displacement"], 0);
  }
  // Not rigid: the cube of half 1 becomes the one of half 2. A rounded map widens the interval by what it may move.
  EXPECT_EQ(run({large_, cube_, "--transform-b", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1", "--tolerance", "0"}).exit_code, 0);
  const json rounded =
      parsed(run({sphere_, sphere_, "--transform-b", "0.1 0 0 0.3 0 0.1 0 0 0 0 0.1 0 0 0 0 1", "--json", "-"}));
  EXPECT_GT(rounded["b"]["transform_displacement"], 0);
}

TEST_F(HausdorffTool, BuildsNoTreesForACopyThatHasHardlyMoved) {
  TriangleMesh copy = read_mesh(sphere_).mesh;
  for (Eigen::Vector3d& p : copy.vertices) p = p.cast<float>().cast<double>();
  const std::string rounded = folder_ / "rounded.off";
  write_mesh(rounded, copy);
  for (const std::vector<std::string>& asked : {std::vector<std::string>{}, {"--one-sided"}, {"--tolerance", "1e-6"}}) {
    std::vector<std::string> arguments{sphere_, rounded, "--json", "-"};
    arguments.insert(arguments.end(), asked.begin(), asked.end());
    const ToolRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json document = parsed(result);
    EXPECT_EQ(document["seconds"]["build"], 0.0);
    EXPECT_LE(document["distance"]["upper"], 2e-7);
    EXPECT_GT(document["distance"]["upper"], 1e-9);
  }
  EXPECT_EQ(run({sphere_, rounded, "--tolerance", "1e-10"}).exit_code, 1);
  EXPECT_GT(parsed(run({sphere_, cube_, "--json", "-"}))["seconds"]["build"], 0.0);
}

TEST_F(HausdorffTool, LeavesOutWhatWasNotAskedFor) {
  const json document = parsed(run({cube_, large_, "--one-sided", "--json", "-"}));
  EXPECT_FALSE(document["distance"].contains("b_to_a"));
  EXPECT_LE(document["distance"]["lower"], 1);
  EXPECT_GE(document["distance"]["upper"], 1);
}

TEST_F(HausdorffTool, WritesJsonToAFileAndASummaryToStdout) {
  const ToolRun result = run({cube_, large_, "--json", folder_ / "out.json"});
  EXPECT_NE(result.out.find("Hausdorff distance"), std::string::npos);
  EXPECT_EQ(json::parse(content_of(folder_ / "out.json"))["schema"], "meshbound/distance/1");
  const ToolRun quiet = run({cube_, large_, "--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_EQ(quiet.exit_code, 0);
}

TEST_F(HausdorffTool, PrintsAProfileWhenAsked) {
  const ToolRun plain = run({sphere_, soup_});
  EXPECT_EQ(plain.out.find("culled on A"), std::string::npos);
  const ToolRun profiled = run({sphere_, soup_, "--profile"});
  EXPECT_EQ(profiled.exit_code, 0) << profiled.err;
  for (const char* part : {"profile A to B", "profile B to A", "culled on B", "subdivisions into", "culling on A"})
    EXPECT_NE(profiled.out.find(part), std::string::npos) << part;
  const json stats = parsed(run({sphere_, soup_, "--json", "-", "--threads", "1"}))["stats"];
  EXPECT_GT(stats["pieces"], 0);
  EXPECT_GT(stats["phase_seconds"]["subdivision"], 0.0);
}

TEST_F(HausdorffTool, MeasuresByThePapersMethodToo) {
  const json walked = parsed(run({cube_, soup_, "--json", "-", "--error-bound", "1e-3"}))["distance"];
  const json paper =
      parsed(run({cube_, soup_, "--json", "-", "--error-bound", "1e-3", "--method", "cross-culling"}))["distance"];
  EXPECT_LE(walked["lower"], paper["upper"]);
  EXPECT_LE(paper["lower"], walked["upper"]);
  EXPECT_NE(walked["a_to_b"]["upper"], paper["a_to_b"]["upper"]) << "the method made no difference at all";
  expect_one_line_and_exit_2(run({cube_, soup_, "--method", "guessing"}));
}

TEST_F(HausdorffTool, GivesTheSameForAnyNumberOfThreads) {
  const json one = parsed(run({sphere_, soup_, "--threads", "1", "--json", "-"}));
  const json two = parsed(run({sphere_, soup_, "--threads", "2", "--json", "-"}));
  EXPECT_EQ(one["distance"], two["distance"]);
}

/// GNU's OpenMP says at its start how it will wait.
TEST_F(HausdorffTool, ItsThreadsWaitBrieflyUnlessToldOtherwise) {
  const std::string tool = shell_quoted(HAUSDORFF_DISTANCE) + " --version";
  const std::string clean = "env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT OMP_DISPLAY_ENV=verbose ";
  const ToolRun alone = run_shell(clean + tool);
  if (alone.err.find("GOMP_SPINCOUNT") == std::string::npos) GTEST_SKIP() << "not GNU's OpenMP";
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_NE(alone.err.find("GOMP_SPINCOUNT = '3000'"), std::string::npos) << alone.err;
  const ToolRun told = run_shell(clean + "GOMP_SPINCOUNT=77 " + tool);
  EXPECT_NE(told.err.find("GOMP_SPINCOUNT = '77'"), std::string::npos) << told.err;
  EXPECT_EQ(told.err.find("GOMP_SPINCOUNT = '3000'"), std::string::npos) << told.err;
}

TEST_F(HausdorffTool, RefusesBadUsageInOneLine) {
  const std::vector<std::vector<std::string>> bad = {
      {},
      {cube_},
      {cube_, large_, "third"},
      {cube_, large_, "--tolerance", "-1"},
      {cube_, large_, "--tolerance", "nan"},
      {cube_, large_, "--tolerance", "1e999"},
      {cube_, large_, "--tolerance", "0.1%%"},
      {cube_, large_, "--error-bound", "small"},
      {cube_, large_, "--threads", "0"},
      {cube_, large_, "--time-limit", "-3"},
      {cube_, large_, "--no-such-option"},
      {cube_, large_, "--transform-b", "1 2 3"},
      {cube_, large_, "--transform-b", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"},
      {cube_, large_, "--transform-b", "1 0 0 inf 0 1 0 0 0 0 1 0 0 0 0 1"},
      {cube_, large_, "--transform-b", folder_ / "no_such_file"},
      {cube_, folder_ / "missing.off"},
      {folder_.path().string(), cube_},
      {cube_, large_, "--json", folder_ / "no/such/folder/out.json"},
  };
  for (const auto& arguments : bad) {
    SCOPED_TRACE(arguments.empty() ? "no arguments" : arguments.back());
    expect_one_line_and_exit_2(run(arguments));
  }
}

TEST_F(HausdorffTool, ExplainsItself) {
  const ToolRun help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* option : {"--error-bound", "--tolerance", "--one-sided", "--transform-b", "--json", "--time-limit"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
  EXPECT_EQ(run({"--version"}).exit_code, 0);
}

TEST_F(HausdorffTool, AcceptsOrRefusesEveryBrokenFile) {
  const auto folder = test::dataset("broken");
  if (!folder) GTEST_SKIP() << "the folder of broken files is not on this machine (set MESHBOUND_DATASETS)";
  for (const auto& entry : fs::directory_iterator(*folder)) {
    SCOPED_TRACE(entry.path().filename().string());
    const std::string file = entry.path().string();
    const ToolRun itself = run({file, file, "--time-limit", "20", "--json", "-"});
    const ToolRun decision = run({cube_, file, "--tolerance", "10%", "--time-limit", "20"});
    if (itself.exit_code == 2) {
      expect_one_line_and_exit_2(itself);
      expect_one_line_and_exit_2(decision);
      continue;
    }
    EXPECT_EQ(itself.exit_code, 0) << itself.err;
    EXPECT_EQ(itself.err, "");
    EXPECT_EQ(parsed(itself)["distance"]["lower"], 0);
    EXPECT_TRUE(decision.exit_code == 0 || decision.exit_code == 1) << decision.out << decision.err;
    EXPECT_EQ(decision.err, "");
  }
}

}  // namespace
}  // namespace meshbound
