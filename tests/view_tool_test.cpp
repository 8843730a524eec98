// SPDX-License-Identifier: MIT
// lod_chain --scene by its command line: the levels that it writes are within what they say, and scenes that are none
// are refused with the place in them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/analytic_meshes.h"
#include "gltf_file.h"
#include "json_claims.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace view_tool_test {

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
  for (const char* format : {"stl", "glb", "gltf"}) {
    const ToolRun result = run({"--format", format, "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json view = json::parse(content_of(folder_ / "out/view.json"));
    const json& level = view["models"][0]["levels"][1];
    const TriangleMesh mesh = read_mesh(folder_ / ("out/" + level["file"].get<std::string>())).mesh;
    EXPECT_EQ(check_tolerance(read_mesh(folder_ / "torus.ply").mesh, mesh, level["error"]).verdict, Verdict::Within);
  }
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
  refused("/instances/0/pose/12", 2, "instances[0].pose: the last four of the 16 numbers must be 0 0 0 1");
  scene_ = good;
  scene_.erase("models");
  expect_refused("scene.json: \"models\" is missing");
  scene_ = good;
  expect_refused("leave out --levels", {"--levels", "1%"});
  expect_refused("leave IN out", {folder_ / "more"});
  for (const std::string option : {"--line-tolerance", "--feature-edges", "--texture-tolerance", "--texture-size",
                                   "--normal-tolerance", "--error-bound", "--glb"})
    expect_refused("leave out " + option, {option, "1"});
  expect_refused("leave out --tileset", {"--tileset"});
  expect_refused("leave out --strict", {"--strict"});
}

TEST_F(ViewTool, LeavesVerticesWhereTheModelHasSome) {
  ASSERT_EQ(run({"--placement", "subset", "--quiet"}).exit_code, 0);
  const auto before = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::vector<Eigen::Vector3d> model = read_mesh(folder_ / "torus.ply").mesh.vertices;
  std::sort(model.begin(), model.end(), before);
  for (const Eigen::Vector3d& p : read_mesh(folder_ / "out/model_0_lod_2.ply").mesh.vertices)
    ASSERT_TRUE(std::binary_search(model.begin(), model.end(), p, before));
}

TEST_F(ViewTool, RefusesToReplaceItsInputs) {
  fs::create_directories(folder_ / "out");
  fs::rename(folder_ / "torus.ply", folder_ / "out/model_0_lod_1.ply");
  scene_["models"][0] = "out/model_0_lod_1.ply";
  const ToolRun result = run();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(line_count(result.err), 1) << result.err;
}

/// Positions as floats, as glTF has them.
TriangleMesh rounded(TriangleMesh mesh) {
  for (Eigen::Vector3d& p : mesh.vertices) p = p.cast<float>().cast<double>();
  return mesh;
}

void add_mesh(test::GltfFile& file, const TriangleMesh& mesh) {
  std::vector<float> positions;
  std::vector<std::uint16_t> indices;
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (const double x : p) positions.push_back(static_cast<float>(x));
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) indices.push_back(static_cast<std::uint16_t>(v));
  test::GltfJson primitive = {{"attributes", {{"POSITION", file.add_positions(positions)}}}};
  primitive["indices"] = file.add_indices(indices);
  file.json["meshes"].push_back({{"primitives", {primitive}}});
}

/// A glTF scene with two tori, one of them stretched and below another node, a sphere behind the camera, a mesh of
/// points, and a camera that its node moves and turns; and the same as a scene of JSON.
class GltfViewTool : public ViewTool {
 protected:
  GltfViewTool() {
    const TriangleMesh torus = rounded(datasets::torus(1, 0.3, 80, 40)), sphere = rounded(datasets::icosphere(1, 4));
    write_mesh(folder_ / "torus.ply", torus);
    write_mesh(folder_ / "sphere.off", sphere);
    add_mesh(file_, torus);
    file_.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"mode", 0}}}}});
    add_mesh(file_, sphere);
    file_.json["cameras"] = {{{"type", "orthographic"}},
                             {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 1.5}}}}};
    // The camera looks along +x from (7, 0, 0).
    file_.json["nodes"] = {{{"mesh", 1}},
                           {{"mesh", 0}, {"translation", {20, 0, 0}}},
                           {{"children", {3}}, {"translation", {100, 0, 0}}},
                           {{"mesh", 0}, {"translation", {50, 0, 0}}, {"scale", {1, 3, -1}}},
                           {{"mesh", 2}, {"translation", {-9, 0, 0}}},
                           {{"camera", 0}},
                           {{"camera", 1}, {"translation", {7, 0, 0}}}};
    const double half = std::sqrt(0.5);
    file_.json["nodes"][6]["rotation"] = {0, -half, 0, half};
    file_.json["scenes"][0]["nodes"] = {0, 1, 2, 4, 5, 6};
    scene_["pixels"] = 2;
    scene_["screen"] = {{"height", 900}, {"fov", 180 / std::acos(-1)}, {"aspect", 1.5}};
    scene_["instances"] = {{{"model", 0}, {"pose", {1, 0, 0, 20, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}},
                           {{"model", 0}, {"pose", {1, 0, 0, 150, 0, 3, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}}},
                           {{"model", 1}, {"pose", {1, 0, 0, -9, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}};
    scene_["cameras"] = {{{"position", {7, 0, 0}}, {"direction", {1, 0, 0}}}};
  }
  ToolRun run_gltf(const std::vector<std::string>& options = {}) {
    file_.write(folder_ / "scene.glb");
    std::vector<std::string> all{"--scene", folder_ / "scene.glb", folder_ / "of_gltf"};
    all.insert(all.end(), options.begin(), options.end());
    return run_tool(LOD_CHAIN, all);
  }
  void expect_gltf_refused(const std::string& why, const std::vector<std::string>& options = {}) {
    const ToolRun result = run_gltf(options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "of_gltf"));
  }

  test::GltfFile file_;
};

TEST_F(GltfViewTool, ASceneOfGltfGetsTheLevelsOfTheSameSceneInJson) {
  ASSERT_EQ(run({"--quiet"}).exit_code, 0);
  const ToolRun result = run_gltf({"--pixels", "2", "--screen-height", "900"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("scene.glb, mesh 2, 5120 faces"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("left out    orthographic cameras: 1"), std::string::npos) << result.out;
  const json of_json = json::parse(content_of(folder_ / "out/view.json")),
             view = checked_document(content_of(folder_ / "of_gltf/view.json"));
  EXPECT_EQ(view["pixels"], 2);
  ASSERT_EQ(view["models"].size(), 2u);
  EXPECT_EQ(view["models"][1]["mesh"], 2);
  ASSERT_GE(view["models"][0]["levels"].size(), 2u);
  for (std::size_t model = 0; model < 2; ++model)
    EXPECT_EQ(view["models"][model]["levels"], of_json["models"][model]["levels"]);
  EXPECT_EQ(view["instances"],
            json::parse(R"([{"node": 1, "model": 0}, {"node": 3, "model": 0}, {"node": 4, "model": 1}])"));
  ASSERT_EQ(view["cameras"].size(), 1u);
  EXPECT_EQ(view["cameras"][0]["node"], 6);
  EXPECT_EQ(view["cameras"][0]["levels"], of_json["cameras"][0]["levels"]);
  EXPECT_TRUE(view["cameras"][0]["levels"][2].is_null());
  EXPECT_NE(view["cameras"][0]["levels"][0], view["cameras"][0]["levels"][1]);
  EXPECT_EQ(view["cameras"][0]["triangles"], of_json["cameras"][0]["triangles"]);
}

TEST_F(GltfViewTool, RefusesASceneThatNothingIsSeenFrom) {
  expect_gltf_refused("leave out --levels", {"--levels", "1%"});
  expect_gltf_refused("one number of --pixels", {"--pixels", "1,2"});
  file_.json["cameras"][1]["perspective"]["yfov"] = 4;
  expect_gltf_refused("cameras[1].perspective.yfov: expected radians between 0 and pi");
  file_.json["cameras"][1]["type"] = "orthographic";
  expect_gltf_refused("the default scene has no perspective camera");
  file_.json["scenes"][0]["nodes"] = {0, 5};
  expect_gltf_refused("the default scene shows no triangles");
}

}  // namespace view_tool_test
}  // namespace meshbound
