// SPDX-License-Identifier: MIT
// --memory: tile by tile within a limit that holds, with the same result for every limit.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "json_claims.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace tiles_tool_test {

using meshbound::testing_tools::checked_document;
using meshbound::testing_tools::command_line;
using meshbound::testing_tools::content_of;
using meshbound::testing_tools::run_shell;
using meshbound::testing_tools::run_tool;
using meshbound::testing_tools::shell_quoted;
using meshbound::testing_tools::TemporaryFolder;
using meshbound::testing_tools::ToolRun;
using Json = nlohmann::json;

/// A mesh of several tiles of the usual size, made once.
class Tiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const ToolRun made = run_tool(GENERATE_MESH, {"torus", "--output", *folder_ / "torus.ply", "--size", "400000"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string in_folder(const std::string& name) { return *folder_ / name; }
  static ToolRun simplify(const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{in_folder("torus.ply"), in_folder(out), "--tolerance", "1%"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(SIMPLIFY_WITH_BOUND, arguments, 500);
  }

 private:
  static TemporaryFolder* folder_;
};

TemporaryFolder* Tiles::folder_ = nullptr;

/// What a summary says under "memory", in MiB.
double peak_of(const ToolRun& run) {
  std::smatch found;
  return std::regex_search(run.out, found, std::regex("memory +(\\d+) MiB at most")) ? std::stod(found[1]) : -1;
}

TEST_F(Tiles, StayWithinTheMemoryAndGiveTheSameFileForEveryLimit) {
  const ToolRun small =
      simplify("small.ply", {"--memory", "420M", "--threads", "2", "--json", in_folder("small.json")});
  ASSERT_EQ(small.exit_code, 0) << small.err;
  EXPECT_GT(peak_of(small), 0) << small.out;
  EXPECT_LT(peak_of(small), 420);
  const Json report = Json::parse(content_of(in_folder("small.json")));
  EXPECT_EQ(report["verdict"], "within");
  EXPECT_EQ(report["threads"], 1);
  EXPECT_LT(report["simplified"]["faces"], 10000);
  const ToolRun large = simplify("large.ply", {"--memory", "8G", "--threads", "3"});
  ASSERT_EQ(large.exit_code, 0) << large.err;
  EXPECT_EQ(content_of(in_folder("small.ply")), content_of(in_folder("large.ply")));

  const ToolRun whole =
      run_tool(HAUSDORFF_DISTANCE, {in_folder("torus.ply"), in_folder("small.ply"), "--tolerance", "1%"});
  EXPECT_EQ(whole.exit_code, 0) << whole.out;
  const ToolRun tiled =
      run_tool(HAUSDORFF_DISTANCE, {in_folder("torus.ply"), in_folder("small.ply"), "--memory", "400M", "--json", "-"});
  ASSERT_EQ(tiled.exit_code, 0) << tiled.err;
  const Json distance = Json::parse(tiled.out);
  EXPECT_LE(distance["distance"]["upper"], report["tolerance"]["absolute"]);
}

TEST_F(Tiles, SayHowMuchMemoryIsNeededAndWriteNothing) {
  const ToolRun run = simplify("none.ply", {"--memory", "200M"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--memory 200M: 39"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("need at least"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(in_folder("none.ply")));
  const ToolRun distance =
      run_tool(HAUSDORFF_DISTANCE, {in_folder("torus.ply"), in_folder("torus.ply"), "--memory", "10M"});
  EXPECT_EQ(distance.exit_code, 2);
  EXPECT_EQ(std::count(distance.err.begin(), distance.err.end(), '\n'), 1) << distance.err;
}

/// An OBJ is held as a whole while it is parsed.
TEST_F(Tiles, SayWithinWhichLimitMemoryHasRunOut) {
  const std::string large = in_folder("large.obj");
  std::ofstream(large) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::filesystem::resize_file(large, std::uintmax_t{200} << 20);  // the rest takes no room on the disk
  const auto says = [&](const std::string& limit, const std::vector<std::string>& options, const std::string& text) {
    std::vector<std::string> arguments{large, in_folder("none.ply"), "--tolerance", "1%"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ToolRun run = run_shell(limit + command_line(SIMPLIFY_WITH_BOUND, arguments));
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(std::filesystem::exists(in_folder("none.ply")));
  };
  says("", {"--memory", "100M"}, "out of memory within 100 MiB: allow more (--memory)");
  says("ulimit -d 65536; ", {}, "out of memory within 64 MiB: allow more (--memory-limit of the batch, or ulimit -d)");
  const ToolRun measured = run_shell("ulimit -d 65536; " + command_line(HAUSDORFF_DISTANCE, {large, large}));
  EXPECT_EQ(measured.err, "hausdorff_distance: out of memory within 64 MiB: allow more (ulimit -d)\n");
}

/// Two copies of this mesh take 84 MB in memory, the plan of the limit 76.
TEST_F(Tiles, CompareEquallyManyTrianglesWithinTheMemory) {
  constexpr std::uint32_t count = 500'000;
  meshbound::TriangleMesh soup;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = i % 1000, y = i / 1000;
    soup.vertices.insert(soup.vertices.end(), {{x, y, 0}, {x + 0.9, y, 0}, {x, y + 0.9, 0}});
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  meshbound::write_mesh(in_folder("soup.ply"), soup);
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in_folder("soup.ply"), in_folder("soup.ply"), "--tolerance", "1%",
                                                    "--threads", "1", "--tile-triangles", "10000", "--memory", "80M"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("within"), std::string::npos) << run.out;
  std::filesystem::remove(in_folder("soup.ply"));
}

TEST_F(Tiles, DoNotGoWithWhatNeedsTheWholeMesh) {
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--target-faces", "10"}, {"--prune"}, {"--on-exceed", "stop"}}) {
    std::vector<std::string> arguments = more;
    arguments.insert(arguments.end(), {"--memory", "1G"});
    const ToolRun run = simplify("none.ply", arguments);
    EXPECT_EQ(run.exit_code, 2) << more[0];
    EXPECT_FALSE(std::filesystem::exists(in_folder("none.ply")));
  }
}

TEST_F(Tiles, HaveABenchmarkOfLargeMeshesThatEndsWithinOnSmallOnes) {
  const std::string tools = std::filesystem::path(SIMPLIFY_WITH_BOUND).parent_path().parent_path();
  const ToolRun run = run_shell(MESHBOUND_SOURCE_DIR "/tools/bench/large/run --share 0.0005 --tools " +
                                    shell_quoted(tools) + " --scratch " + shell_quoted(in_folder("")),
                                100);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string within = "| within |";
  std::size_t runs = 0;
  for (std::size_t at = run.out.find(within); at != std::string::npos; at = run.out.find(within, at + 1)) ++runs;
  EXPECT_EQ(runs, 7u) << run.out;
}

TEST_F(Tiles, EndAtTheTimeLimitWithAMeshThatHolds) {
  const ToolRun run = simplify("late.ply", {"--memory", "2G", "--time-limit", "0.8"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  const ToolRun distance =
      run_tool(HAUSDORFF_DISTANCE, {in_folder("torus.ply"), in_folder("late.ply"), "--tolerance", "1%"});
  EXPECT_EQ(distance.exit_code, 0) << distance.out;
}

/// Results of tiles in a folder, from which a run goes on.
class TileScratch : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    ASSERT_EQ(run_tool(GENERATE_MESH, {"torus", "--output", in("torus.ply"), "--size", "60000"}).exit_code, 0);
    ASSERT_EQ(simplify("whole.ply", {}).exit_code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string in(const std::string& name) { return *folder_ / name; }
  static std::vector<std::string> arguments(const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> all{in("torus.ply"), in(out), "--tolerance",      "0.3%", "--memory", "4G",
                                 "--threads",     "1",     "--tile-triangles", "1000"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  static ToolRun simplify(const std::string& out, const std::vector<std::string>& more) {
    return run_tool(SIMPLIFY_WITH_BOUND, arguments(out, more));
  }
  /// Kills a run once it has finished some tiles.
  static void kill_run(const std::string& scratch) {
    const ToolRun run = meshbound::testing_tools::run_shell(
        "(" + meshbound::testing_tools::command_line(SIMPLIFY_WITH_BOUND, arguments("k.ply", {"--scratch", scratch})) +
        ") & run=$!; until [ -e " + scratch +
        "/*/0-3 ]; do sleep 0.01; kill -0 $run || exit 99; done; kill -KILL $run; "
        "wait $run");
    ASSERT_EQ(run.exit_code, 137) << run.err;
  }
  static std::size_t reused(const ToolRun& run) {
    std::smatch found;
    return std::regex_search(run.out, found, std::regex("resumed +(\\d+) finished")) ? std::stoul(found[1]) : 0;
  }
  /// Files of finished tiles.
  static std::vector<std::filesystem::path> files(const std::string& scratch) {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch))
      if (entry.is_regular_file() && entry.path().extension() != ".lock") found.push_back(entry.path());
    return found;
  }

 private:
  static TemporaryFolder* folder_;
};

TemporaryFolder* TileScratch::folder_ = nullptr;

TEST_F(TileScratch, IsEmptyAfterARunThatEnds) {
  ASSERT_EQ(simplify("kept.ply", {"--scratch", in("ends")}).exit_code, 0);
  EXPECT_EQ(content_of(in("kept.ply")), content_of(in("whole.ply")));
  EXPECT_FALSE(std::filesystem::exists(in("ends"))) << "the run made it";
}

TEST_F(TileScratch, GoesWithACertificateThatVerifies) {
  ASSERT_EQ(simplify("kept.ply", {"--scratch", in("ends"), "--certificate", in("kept.cert")}).exit_code, 0);
  const ToolRun run =
      run_tool(VERIFY_CERTIFICATE, {in("torus.ply"), in("kept.ply"), in("kept.cert"), "--tolerance", "0.3%"});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_FALSE(std::filesystem::exists(in("ends"))) << "the run made it";
}

TEST_F(TileScratch, ResultIsCertifiedByItsMeasurementToo) {
  const std::string a = in("torus.ply"), b = in("whole.ply"), certificate = in("measured.cert");
  const ToolRun exceeded = run_tool(
      HAUSDORFF_DISTANCE, {a, b, "--tolerance", "0.01%", "--memory", "2G", "--certificate", certificate, "--quiet"});
  EXPECT_EQ(exceeded.exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(certificate));
  const ToolRun within =
      run_tool(HAUSDORFF_DISTANCE, {a, b, "--tolerance", "0.3%", "--memory", "2G", "--certificate", certificate});
  ASSERT_EQ(within.exit_code, 0) << within.err;
  const ToolRun verified = run_tool(VERIFY_CERTIFICATE, {a, b, certificate, "--tolerance", "0.3%"});
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

TEST_F(TileScratch, ResumesARunThatWasKilledWithTheSameResult) {
  kill_run(in("killed"));
  const ToolRun run = simplify("resumed.ply", {"--scratch", in("killed"), "--resume", "--json", in("resumed.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GE(reused(run), 1u) << run.out;
  const Json document = checked_document(content_of(in("resumed.json")));
  EXPECT_EQ(document["resumed_tiles"], reused(run));
  EXPECT_EQ(document["memory"]["limit_bytes"], std::uint64_t{4} << 30);
  EXPECT_GT(document["memory"]["peak_bytes"], 1'000'000);
  EXPECT_EQ(content_of(in("resumed.ply")), content_of(in("whole.ply")));
  EXPECT_TRUE(std::filesystem::is_empty(in("killed")));
}

/// The first run stands still, with some tiles finished, while the second one is started.
TEST_F(TileScratch, IsOfOneRunAtATime) {
  using namespace meshbound::testing_tools;
  const std::string scratch = in("two runs");
  const auto command = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> all{"--scratch", scratch, "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return "(" + command_line(SIMPLIFY_WITH_BOUND, arguments(out, all)) + ")";
  };
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--resume"}}) {
    const ToolRun run =
        run_shell(command("first.ply", {}) + " & run=$!; until [ -e " + shell_quoted(scratch) +
                  "/*/0-3 ]; do sleep 0.01; kill -0 $run || exit 99; done; kill -STOP $run; " +
                  command("second.ply", more) + "; code=$?; kill -CONT $run; wait $run || exit 98; exit $code");
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find("--scratch: another run of the same mesh and options"), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(in("second.ply")));
    EXPECT_TRUE(content_of(in("first.ply")) == content_of(in("whole.ply")));
    EXPECT_FALSE(std::filesystem::exists(scratch)) << "the first run made it";
  }
}

TEST_F(TileScratch, ComputesAnewWhatIsDamagedOrOfAnotherRun) {
  kill_run(in("damaged"));
  const std::vector<std::filesystem::path> finished = files(in("damaged"));
  ASSERT_GE(finished.size(), 2u);
  for (std::size_t i = 0; i < finished.size(); ++i) {
    std::string bytes = content_of(finished[i]);
    if (i % 3 == 0) bytes[0] ^= 1;                        // the checksum
    if (i % 3 == 1) bytes.resize(bytes.size() - 1);       // the end
    if (i % 3 == 2) bytes = content_of(finished[i - 1]);  // another tile
    std::ofstream(finished[i], std::ios::binary) << bytes;
  }
  const ToolRun run = simplify("anew.ply", {"--scratch", in("damaged"), "--resume"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(reused(run), 0u);
  EXPECT_EQ(content_of(in("anew.ply")), content_of(in("whole.ply")));
}

TEST_F(TileScratch, IsOfOneMeshAndItsOptions) {
  kill_run(in("other"));
  const ToolRun run = simplify("other.ply", {"--scratch", in("other"), "--resume", "--preserve-boundary"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(reused(run), 0u);
  EXPECT_FALSE(files(in("other")).empty());  // those of the run that was killed
  ASSERT_EQ(simplify("again.ply", {"--scratch", in("other")}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_empty(in("other")));
}

TEST_F(TileScratch, ThatIsFullEndsTheRunInOneLineAndCanBeResumed) {
  const ToolRun run = meshbound::testing_tools::run_shell(
      "ulimit -f 1; " + meshbound::testing_tools::command_line(
                            SIMPLIFY_WITH_BOUND, arguments("full.ply", {"--scratch", in("full"), "--quiet"})));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_FALSE(std::filesystem::exists(in("full.ply")));
  const ToolRun resumed = simplify("full.ply", {"--scratch", in("full"), "--resume"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(content_of(in("full.ply")), content_of(in("whole.ply")));
}

/// All tiles are finished by then.
TEST_F(TileScratch, StaysUntilTheResultHasBeenWritten) {
  const std::string in_mesh = in("torus.ply"), scratch = in("no room");
  const ToolRun run = meshbound::testing_tools::run_shell(
      meshbound::testing_tools::command_line(
          SIMPLIFY_WITH_BOUND, {in_mesh, "-", "--format", "ply", "--tolerance", "0.3%", "--memory", "4G", "--threads",
                                "1", "--tile-triangles", "1000", "--scratch", scratch}) +
      " <" + in_mesh + " >/dev/full");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  ASSERT_TRUE(std::filesystem::exists(scratch)) << run.err;
  const std::size_t tiles = files(scratch).size();
  const ToolRun resumed = simplify("room.ply", {"--scratch", scratch, "--resume"});
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(reused(resumed), tiles);
  EXPECT_GT(tiles, 0u);
  EXPECT_EQ(content_of(in("room.ply")), content_of(in("whole.ply")));
}

}  // namespace tiles_tool_test
