// SPDX-License-Identifier: MIT
// The tool lod_chain through its command line: every file it names holds its tolerance, and none is there otherwise.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <string>

#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace lod_chain_tool_test {

namespace fs = std::filesystem;
using testing_tools::checked_document;
using testing_tools::content_of;
using testing_tools::Json;
using testing_tools::ToolRun;

class LodChainTool : public testing::Test {
 protected:
  LodChainTool() { write_mesh(in("torus.off"), datasets::torus(1, 0.3, 60, 24)); }

  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] ToolRun run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {in("torus.off"), in("chain")});
    return testing_tools::run_tool(LOD_CHAIN, arguments);
  }
  /// One line, exit 2, and no folder.
  void expect_refused(const std::vector<std::string>& arguments) const {
    const ToolRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(testing_tools::line_count(result.err), 1) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(fs::exists(in("chain")));
  }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(in("chain")), fs::directory_iterator()));
  }
  /// What chain.json says of each level, against the file itself.
  void expect_levels_hold(const Json& json) const {
    const TriangleMesh torus = read_mesh(in("torus.off")).mesh;
    const Bvh original(torus);
    for (const Json& level : json["levels"]) {
      const TriangleMesh mesh = read_mesh(level["path"].get<std::string>()).mesh;
      EXPECT_EQ(level["faces"], mesh.triangles.size());
      EXPECT_EQ(level["vertices"], mesh.vertices.size());
      EXPECT_TRUE(fs::exists(fs::path(in("chain")) / level["file"].get<std::string>()));
      const double tolerance = level["tolerance"];
      EXPECT_EQ(check_tolerance(original, Bvh(mesh), tolerance).verdict, Verdict::Within);
      EXPECT_LE(level["distance"]["upper"].get<double>(), tolerance);
      EXPECT_LE(level["distance"]["lower"].get<double>(), level["distance"]["upper"].get<double>());
      testing_tools::expect_nearest(level["distance"]["original_to_simplified"], mesh);
      testing_tools::expect_nearest(level["distance"]["simplified_to_original"], torus);
    }
  }

  testing_tools::TemporaryFolder folder_;
};

TEST_F(LodChainTool, WritesLevelsThatHoldInEveryFormat) {
  for (const std::string format : {"ply", "obj", "off", "stl"}) {
    SCOPED_TRACE(format);
    const ToolRun result = run({"--levels", "0.02,0.002,0.5%", "--format", format});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const Json json = checked_document(content_of(in("chain/chain.json")));
    EXPECT_EQ(json["schema"], "meshbound/lod/1");
    EXPECT_EQ(json["verdict"], "within");
    ASSERT_EQ(json["levels"].size(), 3u);
    EXPECT_EQ(json["levels"][0]["file"], "lod_0." + format);
    EXPECT_EQ(json["levels"][0]["tolerance"], 0.002);
    EXPECT_EQ(json["levels"][0]["stopped_by"], "tolerance");
    EXPECT_GT(json["levels"][0]["faces"], json["levels"][1]["faces"]);
    EXPECT_GT(json["levels"][1]["faces"], json["levels"][2]["faces"]);
    EXPECT_FALSE(json.contains("view"));
    expect_levels_hold(json);
    EXPECT_EQ(files(), 4u);
    fs::remove_all(in("chain"));
  }
}

TEST_F(LodChainTool, TakesItsTolerancesFromPixelsAndDistances) {
  const ToolRun result =
      run({"--pixels", "1", "--screen-height", "1080", "--fov", "90", "--distances", "10,2.5,40", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = checked_document(result.out);
  EXPECT_EQ(result.out, content_of(in("chain/chain.json")));
  EXPECT_NEAR(json["view"]["fov_degrees"].get<double>(), 90, 1e-9);
  const double distances[] = {2.5, 10, 40};
  ASSERT_EQ(json["levels"].size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(json["levels"][i]["tolerance"].get<double>(), distances[i] / 540, 1e-12);
    EXPECT_NEAR(json["levels"][i]["view_distance"].get<double>(), distances[i], 1e-9);
  }
  expect_levels_hold(json);
}

/// What an engine asks: how many pixels the error may cover, at one distance. The screen is one of 1080 pixels and 60
/// degrees unless it is said otherwise.
TEST_F(LodChainTool, TakesSeveralPixelsAtOneDistance) {
  const ToolRun result = run({"--pixels", "8,1,2,4", "--distances", "3", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = checked_document(result.out);
  EXPECT_EQ(json["view"]["screen_height"], 1080);
  EXPECT_NEAR(json["view"]["fov_degrees"].get<double>(), 60, 1e-9);
  EXPECT_EQ(json["view"]["pixels"], 1);
  ASSERT_EQ(json["levels"].size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const double pixels = std::exp2(i);
    EXPECT_EQ(json["levels"][i]["pixels"], pixels);
    EXPECT_NEAR(json["levels"][i]["tolerance"].get<double>(), pixels * 6 * std::tan(std::numbers::pi / 6) / 1080,
                1e-12);
    EXPECT_NEAR(json["levels"][i]["view_distance"].get<double>(), 3, 1e-9);
  }
  expect_levels_hold(json);
}

TEST_F(LodChainTool, NamesTheOptionOfAViewThatIsMissing) {
  EXPECT_NE(run({"--pixels", "1"}).err.find("missing: --distances"), std::string::npos);
  EXPECT_NE(run({"--distances", "1"}).err.find("missing: --pixels"), std::string::npos);
  EXPECT_NE(run({"--fov", "60"}).err.find("missing: --pixels"), std::string::npos);
  EXPECT_NE(run({"--pixels", "1,2", "--distances", "1,2"}).err.find("several --pixels"), std::string::npos);
}

TEST_F(LodChainTool, DoubtsAFieldOfViewThatMayBeInRadians) {
  const ToolRun radians = run({"--pixels", "1", "--distances", "3", "--fov", "1.0471975511965976"});
  EXPECT_EQ(radians.exit_code, 0);
  EXPECT_NE(radians.err.find("taken as degrees; a field of view given in radians would be 60\n"), std::string::npos)
      << radians.err;
  EXPECT_EQ(run({"--pixels", "1", "--distances", "3", "--fov", "5"}).err, "");
  EXPECT_EQ(run({"--pixels", "1", "--distances", "3", "--fov", "1", "--quiet"}).err, "");
}

/// A second run leaves no levels beside a chain.json that does not know them, and takes nothing else away.
TEST_F(LodChainTool, RemovesTheLevelsOfAnEarlierRunAndNothingElse) {
  const auto is_there = [&](const char* name) { return fs::exists(in("chain") + "/" + name); };
  ASSERT_EQ(run({"--levels", "0.002,0.004,0.008,0.016"}).exit_code, 0);
  std::ofstream(in("chain/lod_3.ply"), std::ios::app) << "changed by somebody";
  std::ofstream(in("chain/lod_7.ply")) << "of somebody else";
  std::ofstream(in("chain/notes.txt")) << "of somebody else";
  ASSERT_EQ(run({"--levels", "0.01"}).exit_code, 0);
  EXPECT_TRUE(is_there("lod_0.ply"));
  EXPECT_FALSE(is_there("lod_1.ply"));
  EXPECT_FALSE(is_there("lod_2.ply"));
  for (const char* kept : {"lod_3.ply", "lod_7.ply", "notes.txt", "chain.json"}) EXPECT_TRUE(is_there(kept)) << kept;
}

TEST_F(LodChainTool, KeepsTheFileOfAllLevelsWhereAnEarlierLevelWas) {
  ASSERT_EQ(run({"--levels", "0.1%,0.3%,1%", "--format", "glb"}).exit_code, 0);
  ASSERT_EQ(run({"--levels", "1%", "--format", "glb", "--glb", in("chain/lod_1.glb")}).exit_code, 0);
  EXPECT_TRUE(fs::exists(in("chain/lod_1.glb")));
  EXPECT_FALSE(fs::exists(in("chain/lod_2.glb")));
}

TEST_F(LodChainTool, KeepsAnEarlierLevelThatIsReadOrCannotBeWritten) {
  ASSERT_EQ(run({"--levels", "0.002,0.004,0.008"}).exit_code, 0);
  fs::permissions(in("chain/lod_1.ply"), fs::perms::owner_read);
  const ToolRun result =
      testing_tools::run_tool(LOD_CHAIN, {in("chain/lod_2.ply"), in("chain"), "--levels", "0.02", "--format", "obj"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(fs::exists(in("chain/lod_0.ply")));
  EXPECT_TRUE(fs::exists(in("chain/lod_1.ply")));
  EXPECT_TRUE(fs::exists(in("chain/lod_2.ply")));
}

/// A chain.json of somebody else may name anything.
TEST_F(LodChainTool, RemovesNothingForADocumentThatIsNotItsOwn) {
  fs::create_directory(in("chain"));
  std::ofstream(in("lod_1.ply")) << "precious";
  const std::string checksum = testing_tools::run_shell("sha256sum " + in("lod_1.ply")).out.substr(0, 64);
  for (const char* file : {"../lod_1.ply", "lod_1.ply", "/etc/hostname"}) {
    fs::copy_file(in("lod_1.ply"), in("chain/lod_1.ply"), fs::copy_options::overwrite_existing);
    const Json level = {{"file", file}, {"sha256", checksum}};
    std::ofstream(in("chain/chain.json")) << Json{{"schema", "other/1"}, {"levels", {level}}};
    ASSERT_EQ(run({"--levels", "0.01"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(in("chain/lod_1.ply")));
    std::ofstream(in("chain/chain.json")) << Json{{"schema", "meshbound/lod/1"}, {"levels", {level}}};
    ASSERT_EQ(run({"--levels", "0.01"}).exit_code, 0);
    EXPECT_EQ(fs::exists(in("chain/lod_1.ply")), std::string(file) != "lod_1.ply");
    EXPECT_TRUE(fs::exists(in("lod_1.ply")));
  }
  for (const char* text :
       {"", "{", "[]", "{\"schema\":\"meshbound/lod/1\"}", "{\"schema\":\"meshbound/lod/1\",\"levels\":3}"}) {
    std::ofstream(in("chain/chain.json")) << text;
    EXPECT_EQ(run({"--levels", "0.01"}).exit_code, 0) << text;
  }
}

TEST_F(LodChainTool, KeepsToTheOptionsThatAllToolsHave) {
  EXPECT_EQ(run({"--levels", "0.01", "--quiet", "--threads", "1", "--driver", "core"}).out, "");
  expect_levels_hold(checked_document(content_of(in("chain/chain.json"))));
  EXPECT_EQ(testing_tools::run_tool(LOD_CHAIN, {"--version"}).exit_code, 0);
  const std::string help = testing_tools::run_tool(LOD_CHAIN, {"--help"}).out;
  for (const char* option :
       {"--levels", "--pixels", "--screen-height", "--fov", "--distances", "--format", "--json", "--quiet", "--threads",
        "--driver", "--cost", "--preserve-boundary", "--time-limit", "Exit codes: 0 "})
    EXPECT_NE(help.find(option), std::string::npos) << option;
}

/// It makes no pictures, which the option is for elsewhere.
TEST_F(LodChainTool, SaysWhatTheAxisThatPointsUpIsFor) {
  const ToolRun refused = run({"--levels", "1%", "--up", "z"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--up is for the report and the tileset: add --report or --tileset"), std::string::npos)
      << refused.err;
  EXPECT_EQ(run({"--levels", "1%", "--up", "z", "--tileset", "--format", "glb"}).exit_code, 0);
  EXPECT_EQ(testing_tools::run_tool(LOD_CHAIN, {"--help"}).out.find("picture"), std::string::npos);
}

TEST_F(LodChainTool, SaysDistancesInPercentToo) {
  const std::string out = run({"--levels", "1%"}).out;
  EXPECT_TRUE(std::regex_search(out, std::regex("\n +distance \\[.*\\]\n +[0-9.]+% to [0-9.]+% of the diagonal\n")))
      << out;
}

TEST_F(LodChainTool, RefusesBadUsageInOneLineAndMakesNoFolder) {
  expect_refused({});
  expect_refused({"--levels", "x"});
  expect_refused({"--levels", "-1"});
  expect_refused({"--levels", "0.1", "--pixels", "1"});
  expect_refused({"--pixels", "1", "--screen-height", "1080", "--fov", "60"});
  expect_refused({"--pixels", "1,2", "--distances", "1,2"});
  expect_refused({"--pixels", "1", "--screen-height", "1080", "--fov", "180", "--distances", "1"});
  expect_refused({"--pixels", "0", "--screen-height", "1080", "--fov", "60", "--distances", "1"});
  expect_refused({"--pixels", "1", "--screen-height", "1080", "--fov", "60", "--distances", "0"});
  expect_refused({"--levels", "0.1", "--format", "xyz"});
  EXPECT_EQ(testing_tools::run_tool(LOD_CHAIN, {in("absent.off"), in("chain"), "--levels", "1"}).exit_code, 2);
  EXPECT_EQ(testing_tools::run_tool(LOD_CHAIN, {in("torus.off"), in("torus.off"), "--levels", "1"}).exit_code, 2);
  EXPECT_FALSE(fs::exists(in("chain")));
}

/// The first level can be written, the second cannot be proven: neither appears, and an old chain stays.
TEST_F(LodChainTool, WritesAllLevelsOrNone) {
  const ToolRun below = run({"--levels", "1e-12,0.01", "--format", "stl"});
  EXPECT_EQ(below.exit_code, 1);
  EXPECT_EQ(testing_tools::line_count(below.err), 1) << below.err;
  EXPECT_FALSE(fs::exists(in("chain")));
  ASSERT_EQ(run({"--levels", "0.01,0.02"}).exit_code, 0);
  const std::string old = content_of(in("chain/chain.json"));
  EXPECT_EQ(run({"--levels", "1e-12,0.01", "--format", "stl"}).exit_code, 1);
  EXPECT_EQ(content_of(in("chain/chain.json")), old);
  EXPECT_EQ(files(), 3u);
}

TEST_F(LodChainTool, SaysWhatItDrops) {
  std::ofstream(in("painted.obj"))
      << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\ng side\nf 1//1 2//1 3//1\nf 2 4 3\n";
  const ToolRun result =
      testing_tools::run_tool(LOD_CHAIN, {in("painted.obj"), in("chain"), "--levels", "0.1", "--threads", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("\ndropped: 1 group\n"), std::string::npos) << result.out;
  const Json json = checked_document(content_of(in("chain/chain.json")));
  EXPECT_EQ(json["original"]["dropped"]["normals"], 0);
  EXPECT_EQ(json["original"]["dropped"]["groups"], 1);
}

/// No level is left out: where the time ended before its own mesh was proven, it has the best one that was.
TEST_F(LodChainTool, ReportsItsLevelsOnOnePage) {
  const ToolRun result = run({"--levels", "0.002,0.008,0.02", "--units", "mm", "--report", in("r.html")});
  if (result.err.find("npm") != std::string::npos) GTEST_SKIP() << "the tools were built without the page of reports";
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string document = content_of(in("chain/chain.json"));
  const Json json = checked_document(document);
  EXPECT_EQ(json["deviation"]["scale"], 0.02);
  EXPECT_EQ(json["deviation"]["unit"], "mm");
  for (const char* direction : {"original_to_simplified", "simplified_to_original"})
    EXPECT_LE(json["deviation"][direction]["largest_sample"].get<double>(),
              json["levels"][2]["distance"][direction]["upper"].get<double>())
        << direction;
  const std::string page = content_of(in("r.html"));
  EXPECT_NE(page.find(document), std::string::npos) << "the page does not hold the document";
  for (const char* name : {"level 0", "level 1", "level 2"})
    EXPECT_NE(page.find("\"name\":\"" + std::string(name) + "\""), std::string::npos) << name;
}

TEST_F(LodChainTool, RefusesReportsThatItCannotWrite) {
  expect_refused({"--levels", "0.01", "--report", in("torus.off")});
  expect_refused({"--levels", "0.01", "--report", in("missing/r.html")});
  const ToolRun scene =
      testing_tools::run_tool(LOD_CHAIN, {"--scene", in("s.json"), in("chain"), "--report", in("r.html")});
  EXPECT_EQ(scene.exit_code, 2);
  EXPECT_NE(scene.err.find("leave it out with --scene"), std::string::npos) << scene.err;
}

TEST_F(LodChainTool, HasAProvenMeshForEveryLevelWhenItIsOutOfTime) {
  for (const std::string format : {"ply", "stl"}) {
    const ToolRun late = run({"--levels", "0.001,0.002", "--time-limit", "0", "--format", format});
    ASSERT_EQ(late.exit_code, 3) << late.err;
    EXPECT_EQ(testing_tools::line_count(late.err), 1) << late.err;
    const Json json = checked_document(content_of(in("chain/chain.json")));
    ASSERT_EQ(json["levels"].size(), 2u);
    for (const Json& level : json["levels"]) {
      EXPECT_EQ(level["stopped_by"], "time_limit");
      EXPECT_EQ(level["faces"], read_mesh(in("torus.off")).mesh.triangles.size());
    }
    expect_levels_hold(json);
  }
}

/// A FIFO that nobody reads: the levels have appeared, which no signal separates, and the document waits.
TEST_F(LodChainTool, EndsByASignalWhereNobodyReadsTheDocument) {
  for (const std::string name : {"chain.json", "tileset.json"}) {
    fs::remove_all(in("chain"));
    fs::create_directory(in("chain"));
    ASSERT_EQ(::mkfifo((in("chain") + "/" + name).c_str(), 0600), 0);
    const std::string command = testing_tools::command_line(
        LOD_CHAIN, {in("torus.off"), in("chain"), "--levels", "1%", "--format", "glb", "--tileset", "--quiet"});
    const ToolRun result = testing_tools::run_shell(
        "(" + command + ") & run=$!; until [ -e " + testing_tools::shell_quoted(in("chain/lod_0.glb")) +
            " ]; do sleep 0.01; kill -0 $run || exit 99; done; kill -TERM $run; wait $run",
        60);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "lod_chain: " + in("chain/") + name + ": interrupted while it was written\n");
  }
}

}  // namespace lod_chain_tool_test
}  // namespace meshbound
