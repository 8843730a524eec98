// SPDX-License-Identifier: MIT
// lod_chain --scene by its command line: the levels that it writes are within what they say, and scenes that are none
// are refused with the place in them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace {

using nlohmann::json;
using namespace testing_tools;
namespace fs = std::filesystem;

class ViewTool : public testing::Test {
 protected:
  ViewTool() {
    write_mesh(folder_ / "torus.ply", datasets::torus(1, 0.3, 80, 40));
    write_mesh(folder_ / "sphere.off", datasets::icosphere(1, 4));
    scene_ = {{"schema", "meshbound/scene/1"},
              {"pixels", 1},
              {"screen", {{"height", 1000}, {"fov", 60}, {"aspect", 1.5}}},
              {"models", {"torus.ply", "sphere.off"}},
              {"instances",
               {{{"model", 0}, {"pose", at_depth(20)}, {"group", "tori"}},
                {{"model", 0}, {"pose", at_depth(300)}, {"group", "tori"}},
                {{"model", 1}, {"pose", at_depth(-5)}}}},
              {"cameras", {{{"position", {0, 0, 0}}, {"direction", {0, 0, -1}}}}}};
  }
  static json at_depth(double depth) { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -depth, 0, 0, 0, 1}; }
  ToolRun run(const std::vector<std::string>& options = {}) {
    std::ofstream(folder_ / "scene.json") << scene_;
    std::vector<std::string> all{"--scene", folder_ / "scene.json", folder_ / "out"};
    all.insert(all.end(), options.begin(), options.end());
    return run_tool(LOD_CHAIN, all);
  }
  void expect_refused(const std::string& why, const std::vector<std::string>& options = {}) {
    const ToolRun result = run(options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }

  TemporaryFolder folder_;
  json scene_;
};

TEST_F(ViewTool, WritesTheLevelsThatAreNeededWithinWhatItSays) {
  const ToolRun result = run({"--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json view = checked_document(result.out);
  EXPECT_EQ(checked_document(content_of(folder_ / "out/view.json"))["cameras"], view["cameras"]);
  const TriangleMesh torus = read_mesh(folder_ / "torus.ply").mesh;
  const json& levels = view["models"][0]["levels"];
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(view["levels_computed"], 2);
  EXPECT_EQ(view["models"][1]["levels"].size(), 0u);
  for (const json& level : levels) {
    const TriangleMesh mesh = read_mesh(folder_ / ("out/" + level["file"].get<std::string>())).mesh;
    EXPECT_EQ(mesh.triangles.size(), level["faces"]);
    EXPECT_EQ(check_tolerance(torus, mesh, level["error"]).verdict, Verdict::Within);
  }
  const json& camera = view["cameras"][0];
  EXPECT_EQ(camera["levels"][0], 1);
  EXPECT_EQ(camera["levels"][1], 2);
  EXPECT_TRUE(camera["levels"][2].is_null());
  EXPECT_EQ(camera["triangles"].get<int>(), levels[0]["faces"].get<int>() + levels[1]["faces"].get<int>());
  EXPECT_EQ(camera["groups"][0]["name"], "tori");
  EXPECT_GE(camera["groups"][0]["error"], levels[1]["error"]);
}

TEST_F(ViewTool, WritesFloatsThatAreWhatWasMeasured) {
  ASSERT_EQ(run({"--format", "stl", "--quiet"}).exit_code, 0);
  const json view = json::parse(content_of(folder_ / "out/view.json"));
  const json& level = view["models"][0]["levels"][1];
  const TriangleMesh mesh = read_mesh(folder_ / ("out/" + level["file"].get<std::string>())).mesh;
  EXPECT_EQ(check_tolerance(read_mesh(folder_ / "torus.ply").mesh, mesh, level["error"]).verdict, Verdict::Within);
}

TEST_F(ViewTool, SaysHowManyTrianglesAreDrawn) {
  const ToolRun result = run();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("of 12800 triangles drawn"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("2 computed, 22 that no instance needs skipped"), std::string::npos) << result.out;
}

TEST_F(ViewTool, RefusesAScenePointingAtWhatIsWrong) {
  const json good = scene_;
  const auto refused = [&](const char* pointer, const json& value, const std::string& why) {
    scene_ = good;
    scene_[json::json_pointer(pointer)] = value;
    expect_refused(why);
  };
  refused("/schema", "other", "scene.json: schema: expected \"meshbound/scene/1\"");
  refused("/instances/1/model", 2, "scene.json: instances[1].model: expected a number from 0 to 1");
  refused("/instances/0/pose", {1, 2}, "instances[0].pose: expected 16 numbers");
  refused("/instances/0/poze", 1, "instances[0]: unknown key \"poze\"");
  refused("/cameras", json::array(), "scene.json: cameras: there is none");
  refused("/cameras/0/direction", {0, 0, 0}, "cameras[0].direction: must have a length");
  refused("/screen/fov", 180, "screen.fov: expected degrees below 180");
  refused("/pixels", 0, "pixels: expected a positive number");
  refused("/instances/0/pose/0", 2, "instance 0: its pose is not a rigid motion and a scale");
  scene_ = good;
  scene_.erase("models");
  expect_refused("scene.json: \"models\" is missing");
  scene_ = good;
  expect_refused("leave out --levels", {"--levels", "1%"});
  expect_refused("leave IN out", {folder_ / "more"});
}

TEST_F(ViewTool, RefusesToReplaceItsInputs) {
  fs::create_directories(folder_ / "out");
  fs::rename(folder_ / "torus.ply", folder_ / "out/model_0_lod_1.ply");
  scene_["models"][0] = "out/model_0_lod_1.ply";
  const ToolRun result = run();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(line_count(result.err), 1) << result.err;
}

}  // namespace
}  // namespace meshbound
