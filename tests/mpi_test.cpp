// SPDX-License-Identifier: MIT
// One mesh over ranks of MPI: the same bits for any number of ranks, the same documents, the same exit codes, and one
// process that speaks and writes.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "json_claims.h"
#include "ranks.h"

namespace {

using namespace meshbound::testing_tools;

TEST(TilesOverRanks, GiveTheSameBitsAsTilesOfOneProcess) {
  for (const int ranks : {1, 2, 3, 4}) {
    const ToolRun run = run_ranks(ranks, TILES_OVER_RANKS, {"simplify"});
    EXPECT_EQ(run.exit_code, 0) << ranks << " ranks: " << run.err;
  }
}

TEST(TilesOverRanks, MeasureTheSameDistance) {
  for (const int ranks : {1, 2, 4}) {
    const ToolRun run = run_ranks(ranks, TILES_OVER_RANKS, {"measure"});
    EXPECT_EQ(run.exit_code, 0) << ranks << " ranks: " << run.err;
  }
}

TEST(TilesOverRanks, DoEachJobOnce) {
  for (const int ranks : {1, 2, 5}) {
    const ToolRun run = run_ranks(ranks, TILES_OVER_RANKS, {"hand-out"});
    EXPECT_EQ(run.exit_code, 0) << ranks << " ranks: " << run.err;
  }
}

TEST(TilesOverRanks, ThrowOnAllRanksWhatAJobOfOneThrows) {
  for (const int ranks : {1, 3}) {
    const ToolRun run = run_ranks(ranks, TILES_OVER_RANKS, {"fail"});
    EXPECT_EQ(run.exit_code, 0) << ranks << " ranks: " << run.err;
  }
}

TEST(TilesOverRanks, ReadFilesByRanges) {
  const TemporaryFolder folder;
  for (const std::string name : {"mesh.ply", "mesh.stl", "mesh.obj"}) {
    ASSERT_EQ(run_tool(GENERATE_MESH, {"torus", "--output", folder / name, "--size", "3000"}).exit_code, 0);
    const ToolRun run = run_ranks(3, TILES_OVER_RANKS, {"read", folder / name});
    EXPECT_EQ(run.exit_code, 0) << name << ": " << run.err;
  }
}

/// A mesh of many tiles, and what the tools of one process make of it.
class ToolsOverRanks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    ASSERT_EQ(run_tool(GENERATE_MESH, {"torus", "--output", in("torus.ply"), "--size", "60000"}).exit_code, 0);
    const ToolRun alone =
        run_tool(SIMPLIFY_WITH_BOUND, {in("torus.ply"), in("alone.ply"), "--tolerance", "0.3%", "--tile-triangles",
                                       "4000", "--memory", "4G", "--json", in("alone.json")});
    ASSERT_EQ(alone.exit_code, 0) << alone.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string in(const std::string& name) { return *folder_ / name; }
  static ToolRun simplify(int ranks, const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{in("torus.ply"),    in(out), "--tolerance", "0.3%",
                                       "--tile-triangles", "4000",  "--threads",   "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_ranks(ranks, SIMPLIFY_WITH_BOUND_MPI, arguments);
  }

 private:
  static TemporaryFolder* folder_;
};

TemporaryFolder* ToolsOverRanks::folder_ = nullptr;

TEST_F(ToolsOverRanks, GiveTheFileOfOneProcessAndSayWhatTheySent) {
  const Json alone = Json::parse(content_of(in("alone.json")));
  EXPECT_FALSE(alone.contains("communication"));
  const auto input = static_cast<std::uint64_t>(std::filesystem::file_size(in("torus.ply")));
  for (const std::uint64_t ranks : {1, 2, 3, 4}) {
    const ToolRun run = simplify(static_cast<int>(ranks), "out.ply", {"--json", in("out.json")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(content_of(in("out.ply")), content_of(in("alone.ply"))) << ranks << " ranks";
    const Json report = checked_document(content_of(in("out.json")));
    EXPECT_EQ(report["distance"], alone["distance"]);
    EXPECT_EQ(report["collapses"], alone["collapses"]);
    EXPECT_EQ(report["communication"]["ranks"], ranks);
    EXPECT_EQ(report["communication"]["input_bytes"], 0);  // each rank reads the file
    EXPECT_LE(report["communication"]["bytes"].get<std::uint64_t>(), (ranks - 1) * 15 * input / 100)
        << ranks << " ranks";
  }
}

TEST_F(ToolsOverRanks, PrintOnce) {
  const ToolRun run = simplify(3, "printed.ply", {});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string verdict = "verdict ";
  EXPECT_NE(run.out.find(verdict), std::string::npos);
  EXPECT_EQ(run.out.find(verdict), run.out.rfind(verdict)) << run.out;
}

TEST_F(ToolsOverRanks, MeasureAndDecideAsOneProcess) {
  const auto question = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{in("torus.ply"), in("alone.ply"), "--json", "-", "--tile-triangles", "4000"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"--tolerance", "0.3%"}, {"--tolerance", "0.1%"}, {"--one-sided", "--tolerance", "0.3%", "--worst"}}) {
    std::vector<std::string> serial = question(more);
    serial.insert(serial.end(), {"--memory", "4G"});
    const ToolRun one = run_tool(HAUSDORFF_DISTANCE, serial);
    const ToolRun three = run_ranks(3, HAUSDORFF_DISTANCE_MPI, question(more));
    EXPECT_EQ(three.exit_code, one.exit_code) << three.err;
    EXPECT_EQ(Json::parse(three.out)["distance"], Json::parse(one.out)["distance"]) << more[0] << " " << more[1];
  }
}

TEST_F(ToolsOverRanks, SayHelpAndWhatIsWrongOnce) {
  const ToolRun help = run_ranks(3, SIMPLIFY_WITH_BOUND_MPI, {"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.out.find("Exit codes: 0 "), help.out.rfind("Exit codes: 0 "));
  EXPECT_EQ(help.out.find("--certificate"), std::string::npos);
  const ToolRun wrong = simplify(3, "none.ply", {"--levels", "1%"});
  EXPECT_EQ(wrong.exit_code, 2);
  const std::string line = "simplify_with_bound_mpi: ";
  EXPECT_NE(wrong.err.find(line), std::string::npos) << wrong.err;
  EXPECT_EQ(wrong.err.find(line), wrong.err.rfind(line)) << wrong.err;
}

/// What a rank that is killed leaves behind, and what is wrong for all ranks.
class FaultsOverRanks : public ToolsOverRanks {
 protected:
  /// Starts three ranks and kills one of them once `until`, a test of the shell, holds.
  static ToolRun killed(const std::string& until, bool kills_first, const std::vector<std::string>& more) {
    std::filesystem::create_directories(in("out"));
    std::vector<std::string> arguments{
        in("torus.ply"), in("out/killed.ply"), "--tolerance", "0.3%", "--tile-triangles", "1000", "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const std::string start = over_ranks(3, SIMPLIFY_WITH_BOUND_MPI, arguments);
    return run_shell("(" + start + ") & run=$!; until " + until +
                         "; do sleep 0.01; kill -0 $run || exit 99; done; kill -KILL $(pgrep -P $run | " +
                         (kills_first ? "head" : "tail") + " -n 1); wait $run",
                     100);
  }
};

TEST_F(FaultsOverRanks, EndTheRunWhereARankIsKilledWithoutAResult) {
  const std::string scratch = in("scratch");
  // Starting or reading, the first pass, a later pass, measuring what stands under a temporary name.
  const std::string stages[] = {"[ $(pgrep -c -P $run) = 3 ]", "[ -e " + scratch + "/*/0-3 ]",
                                "ls " + scratch + "/*/1-* >" + in("ls") + " 2>&1",
                                "ls -A " + in("out") + " | grep -q ."};
  for (const std::string& until : stages) {
    const ToolRun run = killed(until, false, {"--scratch", scratch});
    EXPECT_NE(run.exit_code, 99) << "too late: " << until;
    EXPECT_NE(run.exit_code, 0) << until;
    EXPECT_NE(run.err.find("signal 9"), std::string::npos) << until << ": " << run.err;
    // mpirun kills the other ranks in turn, so that one of them cannot remove a file under its temporary name.
    EXPECT_FALSE(std::filesystem::exists(in("out/killed.ply"))) << until;
  }
}

TEST(SlurmScripts, AreScriptsOfTheShell) {
  for (const auto& script : std::filesystem::directory_iterator(MESHBOUND_SOURCE_DIR "/examples/slurm"))
    EXPECT_EQ(run_shell("bash -n " + shell_quoted(script.path())).exit_code, 0) << script.path();
}

TEST_F(FaultsOverRanks, AreResumedWithTheSameResult) {
  const std::string scratch = in("resumed");
  const ToolRun run = killed("[ -e " + scratch + "/*/0-3 ]", true, {"--scratch", scratch});
  EXPECT_NE(run.exit_code, 99) << "too late";
  EXPECT_NE(run.exit_code, 0);
  std::vector<std::string> arguments{in("torus.ply"), in("resumed.ply"), "--tolerance", "0.3%",    "--tile-triangles",
                                     "1000",          "--scratch",       scratch,       "--resume"};
  const ToolRun resumed = run_ranks(2, SIMPLIFY_WITH_BOUND_MPI, arguments);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.out.find("finished tiles came from"), std::string::npos) << resumed.out;
  EXPECT_EQ(resumed.out.find("resumed     0 "), std::string::npos) << resumed.out;
  EXPECT_TRUE(std::filesystem::is_empty(scratch));
  arguments.resize(6);
  arguments[1] = in("uninterrupted.ply");
  arguments.insert(arguments.end(), {"--memory", "4G"});
  ASSERT_EQ(run_tool(SIMPLIFY_WITH_BOUND, arguments).exit_code, 0);
  EXPECT_EQ(content_of(in("resumed.ply")), content_of(in("uninterrupted.ply")));
}

TEST_F(FaultsOverRanks, AreSaidInOneLineOfTheTool) {
  std::filesystem::copy_file(in("torus.ply"), in("short.ply"));
  std::filesystem::resize_file(in("short.ply"), 500000);
  const std::vector<std::vector<std::string>> wrong{{in("short.ply"), in("none.ply")},
                                                    {in("not there.ply"), in("none.ply")},
                                                    {in("torus.ply"), in("no folder/none.ply")},
                                                    {in("torus.ply"), in("torus.ply")}};
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.end(), {"--tolerance", "1%"});
    const ToolRun run = run_ranks(3, SIMPLIFY_WITH_BOUND_MPI, arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    const std::string line = "simplify_with_bound_mpi: ";
    EXPECT_NE(run.err.find(line), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find(line), run.err.rfind(line)) << run.err;
    EXPECT_FALSE(std::filesystem::exists(in("none.ply")));
  }
}

}  // namespace
