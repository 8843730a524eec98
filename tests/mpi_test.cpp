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

/// A mesh of several tiles of the usual size, and what the tools of one process make of it.
class ToolsOverRanks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    ASSERT_EQ(run_tool(GENERATE_MESH, {"torus", "--output", in("torus.ply"), "--size", "400000"}).exit_code, 0);
    const ToolRun alone = run_tool(SIMPLIFY_WITH_BOUND, {in("torus.ply"), in("alone.ply"), "--tolerance", "1%",
                                                         "--memory", "4G", "--json", in("alone.json")});
    ASSERT_EQ(alone.exit_code, 0) << alone.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string in(const std::string& name) { return *folder_ / name; }
  static ToolRun simplify(int ranks, const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{in("torus.ply"), in(out), "--tolerance", "1%", "--threads", "1"};
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
    const auto input_bytes = report["communication"]["input_bytes"].get<std::uint64_t>();
    EXPECT_GE(input_bytes, (ranks - 1) * input);
    EXPECT_LE(input_bytes, (ranks - 1) * input + 1000);
    EXPECT_LE(report["communication"]["bytes"].get<std::uint64_t>(), (ranks - 1) * 3 * input / 100)
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
    std::vector<std::string> arguments{in("torus.ply"), in("alone.ply"), "--json", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"--tolerance", "1%"}, {"--tolerance", "0.1%"}, {"--one-sided", "--tolerance", "1%", "--worst"}}) {
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

}  // namespace
