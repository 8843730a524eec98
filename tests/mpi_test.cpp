// SPDX-License-Identifier: MIT
// One mesh over ranks of MPI: the same bits for any number of ranks, the same documents, the same exit codes, and one
// process that speaks and writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "json_claims.h"
#include "ranks.h"

namespace mpi_test {

using namespace meshbound::testing_tools;

TEST(TilesOverRanks, HaveNoOptionsOfBatches) {
  const std::string help = run_ranks(1, SIMPLIFY_WITH_BOUND_MPI, {"--help"}).out;
  EXPECT_NE(help.find("--tolerance"), std::string::npos);
  for (const char* const option : {"--batch", "--jobs", "--shard", "--memory-limit"})
    EXPECT_EQ(help.find(option), std::string::npos) << option;
  const ToolRun run = run_ranks(1, SIMPLIFY_WITH_BOUND_MPI, {"in.off", "--tolerance", "1%"});
  EXPECT_NE(run.err.find("OUT is required"), std::string::npos) << run.err;
}

/// Each option that a help text names, also in passing, is one of the tool.
TEST(TilesOverRanks, SpeakOfNoOptionThatTheyLack) {
  for (const char* const tool : {SIMPLIFY_WITH_BOUND_MPI, HAUSDORFF_DISTANCE_MPI}) {
    const std::string help = run_ranks(1, tool, {"--help"}).out;
    const std::regex named("--[a-z][a-z-]+[a-z]");
    for (std::sregex_iterator it(help.begin(), help.end(), named), end; it != end; ++it) {
      const bool is_listed = std::regex_search(help, std::regex("\n  (-h,)?" + it->str() + " "));
      EXPECT_TRUE(is_listed) << tool << " lacks " << it->str();
    }
    for (const char* const other : {"texture", "nearest", "level"})
      EXPECT_EQ(help.find(other), std::string::npos) << tool << " speaks of " << other;
  }
}

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

TEST(TilesOverRanks, ThrowOnAllRanksWhatTheProgressOfOneThrows) {
  for (const int ranks : {1, 2}) {
    const ToolRun run = run_ranks(ranks, TILES_OVER_RANKS, {"fail-in-progress"});
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

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A binary PLY of a row of triangles with normals, materials before the vertices, and faces that have a quality.
std::string strip_ply(std::size_t triangles) {
  std::string file = "ply\nformat binary_little_endian 1.0\nelement material 2\nproperty uchar red\nelement vertex " +
                     std::to_string(triangles + 2) +
                     "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nelement face " +
                     std::to_string(triangles) +
                     "\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n";
  file += "ab";
  for (std::size_t v = 0; v < triangles + 2; ++v)
    file += bytes_of<float>({static_cast<float>(v), static_cast<float>(v % 2), 0, 1});
  for (int t = 0; t < static_cast<int>(triangles); ++t)
    file += '\3' + bytes_of<int>({t, t + 1, t + 2}) + bytes_of<float>({0.5});
  return file;
}

constexpr std::size_t strip_face = 1 + 3 * 4 + 4;  // bytes

/// A binary STL of a row of triangles, of which every third has attribute bytes.
std::string strip_stl(std::size_t triangles) {
  std::string file(80, ' ');
  file += bytes_of<std::uint32_t>({static_cast<std::uint32_t>(triangles)});
  for (std::size_t t = 0; t < triangles; ++t) {
    file += bytes_of<float>({0, 0, 1});
    for (std::size_t v = t; v < t + 3; ++v)  // 0 and -0 are one coordinate
      file += bytes_of<float>({static_cast<float>(v % 50), static_cast<float>(v % 2), t % 2 == 0 ? 0.0F : -0.0F});
    file += bytes_of<std::uint16_t>({static_cast<std::uint16_t>(t % 3)});
  }
  return file;
}

std::string with(std::string file, std::size_t at, const std::string& bytes) {
  return file.replace(at, bytes.size(), bytes);
}

TEST(FilesOverRanks, AreReadInSharesOrAsAWhole) {
  const TemporaryFolder folder;
  const std::string ply = strip_ply(1000), stl = strip_stl(1000), nan = bytes_of<float>({NAN});
  const std::size_t faces = ply.size() - 1000 * strip_face, records = 84;
  const std::size_t in_the_middle = faces + 700 * strip_face;
  struct Case {
    std::string name, content;
    bool in_shares;
  };
  // One face of four corners and one of two take as many bytes as two triangles.
  const std::string four_and_two = '\4' + bytes_of<int>({1, 2, 3, 4}) + bytes_of<float>({0.5}) + '\2' +
                                   bytes_of<int>({1, 2}) + bytes_of<float>({0.5});
  const std::vector<Case> cases{{"strip.ply", ply, true},
                                {"strip.stl", stl, true},
                                {"one.ply", strip_ply(1), true},  // some ranks have nothing
                                {"one.stl", strip_stl(1), true},
                                {"line end.ply", ply + "\n", false},
                                {"polygon.ply", with(ply, in_the_middle, four_and_two), false},
                                {"index.ply", with(ply, in_the_middle + 1, bytes_of<int>({5000})), false},
                                {"not a number.ply", with(ply, faces - 16, nan), false},
                                {"short.ply", ply.substr(0, ply.size() - 5), false},
                                {"long.ply", ply + "abc", false},
                                {"no faces.ply", strip_ply(0), false},
                                {"not a number.stl", with(stl, records + 500 * 50 + 12, nan), false},
                                {"short.stl", stl.substr(0, stl.size() - 51), false},
                                {"text.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", false}};
  for (const auto& [name, content, in_shares] : cases) {
    std::ofstream(folder / name, std::ios::binary) << content;
    for (const int ranks : {1, 2, 3, 4}) {
      if (!in_shares && ranks != 3) continue;
      const ToolRun run = run_ranks(ranks, TILES_OVER_RANKS, {in_shares ? "read-shares" : "read-whole", folder / name});
      EXPECT_EQ(run.exit_code, 0) << name << ", " << ranks << " ranks: " << run.err;
    }
  }
}

TEST(FilesOverRanks, HaveTheBytesThatOneProcessWrites) {
  for (const int ranks : {1, 2, 3, 4}) {
    const TemporaryFolder folder;
    const ToolRun run = run_ranks(ranks, TILES_OVER_RANKS, {"write", folder / ""});
    EXPECT_EQ(run.exit_code, 0) << ranks << " ranks: " << run.err;
  }
}

/// The program compares each result that comes with what was recorded.
TEST(TilesOverRanks, AreSimulatedByTheRealExchangeOnMoreRanksThanProcessors) {
  const ToolRun run = run_ranks(6, BENCH_RANKS,
                                {"--mesh", "torus", "--size", "20000", "--tolerance", "0.003", "--tile-triangles",
                                 "3000", "--tiles-per-rank", "3", "--pace", "0.02", "--triangles", "1e9"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::regex totals("6 ranks, [1-9][0-9]* jobs: [1-9][0-9]* bytes sent;");
  EXPECT_TRUE(std::regex_search(run.out, totals)) << run.out;
  EXPECT_NE(run.out.find("expected of 1e+09 triangles"), std::string::npos) << run.out;
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
    EXPECT_LE(report["communication"]["bytes"].get<std::uint64_t>(), (ranks - 1) * 6 * input / 100)
        << ranks << " ranks";
  }
}

/// What is written is other than the result in its bits, but all ranks know it: nothing more is sent.
TEST_F(ToolsOverRanks, ReadAndWriteStlAsOneProcess) {
  ASSERT_EQ(run_tool(GENERATE_MESH, {"torus", "--output", in("torus.stl"), "--size", "60000"}).exit_code, 0);
  const std::vector<std::string> arguments{in("torus.stl"),    in("out.stl"), "--tolerance", "0.3%",        "--quiet",
                                           "--tile-triangles", "4000",        "--json",      in("out.json")};
  std::vector<std::string> serial = arguments;
  serial.insert(serial.end(), {"--memory", "4G"});
  ASSERT_EQ(run_tool(SIMPLIFY_WITH_BOUND, serial).exit_code, 0);
  const std::string written = content_of(in("out.stl"));
  const Json alone = Json::parse(content_of(in("out.json")));
  for (const std::uint64_t ranks : {1, 2, 3, 4}) {
    const ToolRun run = run_ranks(static_cast<int>(ranks), SIMPLIFY_WITH_BOUND_MPI, arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(content_of(in("out.stl")), written) << ranks << " ranks";
    const Json report = Json::parse(content_of(in("out.json")));
    EXPECT_EQ(report["distance"], alone["distance"]);
    EXPECT_EQ(report["original"], alone["original"]);  // also the checksum of the file
    EXPECT_LE(report["communication"]["bytes"].get<std::uint64_t>(),
              (ranks - 1) * 3 * std::filesystem::file_size(in("torus.stl")) / 100)
        << ranks << " ranks";
  }
}

TEST_F(ToolsOverRanks, GiveTheCertificateOfOneProcess) {
  ASSERT_EQ(
      run_tool(SIMPLIFY_WITH_BOUND, {in("torus.ply"), in("certified.ply"), "--tolerance", "0.3%", "--tile-triangles",
                                     "4000", "--memory", "4G", "--certificate", in("alone.cert")})
          .exit_code,
      0);
  for (const int ranks : {1, 3}) {
    const ToolRun run = simplify(ranks, "certified.ply", {"--certificate", in("ranks.cert")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(content_of(in("ranks.cert")), content_of(in("alone.cert"))) << ranks << " ranks";
    const ToolRun measured = run_ranks(ranks, HAUSDORFF_DISTANCE_MPI,
                                       {in("torus.ply"), in("certified.ply"), "--tolerance", "0.3%", "--tile-triangles",
                                        "4000", "--threads", "1", "--certificate", in("measured.cert")});
    ASSERT_EQ(measured.exit_code, 0) << measured.err;
    EXPECT_EQ(content_of(in("measured.cert")), content_of(in("alone.cert"))) << ranks << " ranks";
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
  EXPECT_EQ(help.out.find("--levels"), std::string::npos);
  const ToolRun wrong = simplify(3, "none.ply", {"--levels", "1%"});
  EXPECT_EQ(wrong.exit_code, 2);
  const std::string line = "simplify_with_bound_mpi: ";
  EXPECT_NE(wrong.err.find(line), std::string::npos) << wrong.err;
  EXPECT_EQ(wrong.err.find(line), wrong.err.rfind(line)) << wrong.err;
}

/// What happens to ranks from outside while they work.
class FaultsOverRanks : public ToolsOverRanks {
 protected:
  static void SetUpTestSuite() {
    ToolsOverRanks::SetUpTestSuite();
    std::filesystem::create_directories(in("out"));
    std::vector<std::string> arguments = arguments_for(in("whole.ply"));
    arguments.insert(arguments.end(), {"--memory", "4G"});
    ASSERT_EQ(run_tool(SIMPLIFY_WITH_BOUND, arguments).exit_code, 0);
  }
  static std::vector<std::string> arguments_for(const std::string& out, const std::string& tolerance = "0.3%") {
    return {in("torus.ply"), out, "--tolerance", tolerance, "--tile-triangles", "1000", "--threads", "1"};
  }
  /// Starts three ranks, and does `then` once `until` holds: both are shell, where $ranks are the processes.
  static ToolRun disturbed(const std::string& until, const std::string& then, const std::string& scratch,
                           const std::string& out = "result.ply", const std::string& tolerance = "0.3%") {
    std::vector<std::string> arguments = arguments_for(in("out/" + out), tolerance);
    arguments.insert(arguments.end(), {"--scratch", scratch, "--quiet"});
    return run_shell("(" + over_ranks(3, SIMPLIFY_WITH_BOUND_MPI, arguments) + ") & run=$!; until " + until +
                         "; do sleep 0.01; kill -0 $run || exit 99; done; ranks=$(pgrep -P $run); " + then +
                         "; wait $run",
                     100);
  }
  /// Whether results of tiles are kept: files named by pass and tile.
  static bool has_results(const std::string& scratch) {
    const auto is_result = [](const auto& entry) { return entry.path().filename().string().find('-') == 1; };
    const std::filesystem::recursive_directory_iterator files(scratch);
    return std::any_of(begin(files), end(files), is_result);
  }
  static void expect_resumed(const std::string& scratch, bool takes_tiles) {
    std::vector<std::string> arguments = arguments_for(in("resumed.ply"));
    arguments.insert(arguments.end(), {"--scratch", scratch, "--resume"});
    const ToolRun run = run_ranks(2, SIMPLIFY_WITH_BOUND_MPI, arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("finished tiles came from"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("resumed     0 ") == std::string::npos, takes_tiles) << run.out;
    EXPECT_EQ(content_of(in("resumed.ply")), content_of(in("whole.ply")));
    EXPECT_TRUE(std::filesystem::is_empty(scratch));
  }
  /// All ranks end by themselves with one line of rank 0, beside what mpirun says.
  static void expect_refused_together(const ToolRun& run) {
    EXPECT_EQ(run.exit_code, 2);
    const std::string line = "simplify_with_bound_mpi: ";
    EXPECT_NE(run.err.find(line), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find(line), run.err.rfind(line)) << run.err;
    EXPECT_EQ(run.err.find("MPI_ABORT"), std::string::npos) << run.err;
    EXPECT_TRUE(std::filesystem::is_empty(in("out")));
  }
};

/// When a rank is disturbed. Not within MPI_Init: mpirun of Open MPI 4 may say that the rank was killed, and then wait
/// for ever for processes that are gone (PMIX ERROR: UNREACHABLE).
struct Stage {
  const char* name;
  std::string until;  ///< shell; $scratch is the folder
  const char* rank;   ///< that is killed: "head" or "tail" of them all
  bool has_tiles;     ///< results of tiles are kept by then
};
const Stage stages[] = {
    {"reading", "find /proc/[0-9]*/fd -lname \"$scratch/*\" 2>/dev/null | grep -q .", "tail", false},
    {"the first pass", "[ -e $scratch/*/0-3 ]", "head", true},
    {"a later pass", "ls $scratch/*/1-* >$scratch/ls 2>&1", "tail", true},
    {"writing or measuring", "find /proc/[0-9]*/fd -lname \"$out/*\" 2>/dev/null | grep -q .", "tail", true}};

TEST_F(FaultsOverRanks, EndTheRunWhereARankIsKilledAndLeaveNothingButResultsOfTiles) {
  for (const Stage& stage : stages) {
    SCOPED_TRACE(stage.name);
    const std::string scratch = in("killed");
    std::filesystem::create_directories(scratch);
    const ToolRun run =
        disturbed("scratch=" + scratch + " out=" + in("out") + "; " + stage.until,
                  "kill -KILL $(echo $ranks | tr ' ' '\\n' | " + std::string(stage.rank) + " -n 1)", scratch);
    EXPECT_NE(run.exit_code, 99) << "too late";
    EXPECT_NE(run.exit_code, 0);
    EXPECT_NE(run.err.find("signal 9"), std::string::npos) << run.err;
    EXPECT_TRUE(std::filesystem::is_empty(in("out")));
    std::filesystem::remove(scratch + "/ls");
    const bool has_tiles = has_results(scratch);
    if (std::string(stage.name) != "reading") {  // which is over on a busy machine before the rank is killed
      EXPECT_EQ(has_tiles, stage.has_tiles);
    }
    expect_resumed(scratch, has_tiles);
  }
}

/// mpirun sends the first rank a signal when another one dies, and kills it a second later if it lives then.
TEST_F(FaultsOverRanks, ThatAreASignalToTheFirstRankLeaveResultsOfTiles) {
  const std::string scratch = in("signalled");
  std::filesystem::create_directories(scratch);
  const ToolRun run =
      disturbed("scratch=" + scratch + "; " + stages[2].until,
                "ls -d $scratch/*/* >$scratch/ls; kill -TERM $(echo $ranks | cut -d ' ' -f 1)", scratch);
  EXPECT_NE(run.exit_code, 99) << "too late";
  EXPECT_NE(run.exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_empty(in("out")));
  std::ifstream finished(scratch + "/ls");
  for (std::string file; std::getline(finished, file);) EXPECT_TRUE(std::filesystem::exists(file)) << file;
  std::filesystem::remove(scratch + "/ls");
  EXPECT_TRUE(has_results(scratch));
  expect_resumed(scratch, true);
}

TEST_F(FaultsOverRanks, ThatAreAFullDiskOfOneRankAreSaidOnceAndCanBeResumed) {
  // No result of a tile fits, or none of what passes share.
  for (const auto& [stage, size] : {std::pair(1, "100"), std::pair(2, "200000")}) {
    SCOPED_TRACE(stages[stage].name);
    const std::string scratch = in("full");
    std::filesystem::create_directories(scratch);
    const ToolRun run =
        disturbed("scratch=" + scratch + "; " + stages[stage].until,
                  std::string("prlimit --fsize=") + size + " --pid $(echo $ranks | cut -d ' ' -f 2)", scratch);
    expect_refused_together(run);
    std::filesystem::remove(scratch + "/ls");
    expect_resumed(scratch, true);
  }
}

/// The text of a result that keeps most triangles is longer than any file that was written before.
TEST_F(FaultsOverRanks, ThatAreNoRoomForTheResultAreSaidOnce) {
  const std::string scratch = in("no room");
  std::filesystem::create_directories(scratch);
  const ToolRun run =
      disturbed("ls " + shell_quoted(scratch) + "/*/0-3 >" + shell_quoted(in("ls")) + " 2>&1",
                "for rank in $ranks; do prlimit --fsize=2000000 --pid $rank; done", scratch, "result.obj", "0.001%");
  expect_refused_together(run);
  EXPECT_NE(run.err.find("result.obj"), std::string::npos) << run.err;
  EXPECT_TRUE(has_results(scratch));
}

/// Each rank writes a share of a PLY; that of the last one does not fit.
TEST_F(FaultsOverRanks, ThatAreNoRoomForTheShareOfARankAreSaidOnce) {
  const std::string scratch = in("no room for a share");
  std::filesystem::create_directories(scratch);
  const ToolRun run =
      disturbed("ls " + shell_quoted(scratch) + "/*/0-3 >" + shell_quoted(in("ls")) + " 2>&1",
                "prlimit --fsize=1300000 --pid $(echo $ranks | cut -d ' ' -f 3)", scratch, "result.ply", "0.001%");
  expect_refused_together(run);
  EXPECT_NE(run.err.find("result.ply: cannot write: File too large"), std::string::npos) << run.err;
  EXPECT_TRUE(has_results(scratch));
}

/// Open MPI itself needs files of more than 4 MB.
TEST_F(FaultsOverRanks, ThatAreAFullDiskOfAllRanksAreSaidOnce) {
  const auto limited = [](const std::string& input) {
    return run_ranks(3, "prlimit",
                     {"--fsize=6000000", SIMPLIFY_WITH_BOUND_MPI, in(input), in("out/result.ply"), "--tolerance", "1%",
                      "--threads", "1"});
  };
  // The first one does not fit while it is read, the second one while it is cut into tiles.
  for (const std::string size : {"600000", "450000"}) {
    ASSERT_EQ(run_tool(GENERATE_MESH, {"torus", "--output", in("large.ply"), "--size", size}).exit_code, 0);
    const ToolRun run = limited("large.ply");
    expect_refused_together(run);
    EXPECT_NE(run.err.find("cannot write a temporary file"), std::string::npos) << run.err;
  }
}

TEST_F(FaultsOverRanks, KeepOneCopyOfTheOriginalOnAMachine) {
  const std::string scratch = in("shared");
  const std::string size = "$(( 12 * 59536 ))";  // bytes of the triangles, and of the vertices
  const ToolRun run =
      disturbed("[ -e " + scratch + "/*/0-3 ]",
                "for rank in $ranks; do stat -Lc '%i %s' /proc/$rank/fd/* 2>/dev/null; done | grep \" " + size +
                    "$\" | sort | uniq -c",
                scratch);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream lines(run.out);
  std::size_t files = 0;
  for (std::string line; std::getline(lines, line); ++files)
    EXPECT_EQ(std::stoi(line), 3) << "ranks that have the file open: " << line;
  EXPECT_EQ(files, 2u) << run.out;
  std::filesystem::remove(in("out/result.ply"));
}

TEST(SlurmScripts, AreScriptsOfTheShell) {
  for (const auto& script : std::filesystem::directory_iterator(MESHBOUND_SOURCE_DIR "/examples/slurm"))
    EXPECT_EQ(run_shell("bash -n " + shell_quoted(script.path())).exit_code, 0) << script.path();
}

TEST_F(FaultsOverRanks, AreSaidInOneLineOfTheTool) {
  std::filesystem::copy_file(in("torus.ply"), in("short.ply"));
  std::filesystem::resize_file(in("short.ply"), 500000);
  std::ofstream(in("short.stl"), std::ios::binary) << strip_stl(1000).substr(0, 40000);
  const std::string ply = strip_ply(1000);
  std::ofstream(in("wrong.ply"), std::ios::binary) << with(ply, ply.size() - strip_face, "\5");
  const std::vector<std::vector<std::string>> wrong{
      {in("short.ply"), in("none.ply")},           {in("short.stl"), in("none.ply")},
      {in("wrong.ply"), in("none.ply")},           {in("not there.ply"), in("none.ply")},
      {in("torus.ply"), in("no folder/none.ply")}, {in("torus.ply"), in("torus.ply")}};
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.end(), {"--tolerance", "1%"});
    const ToolRun run = run_ranks(3, SIMPLIFY_WITH_BOUND_MPI, arguments);
    expect_refused_together(run);
    EXPECT_FALSE(std::filesystem::exists(in("none.ply")));
    arguments.insert(arguments.end(), {"--memory", "4G"});
    const std::string said = run_tool(SIMPLIFY_WITH_BOUND, arguments).err.substr(sizeof "simplify_with_bound" - 1);
    EXPECT_NE(run.err.find(said), std::string::npos) << run.err << "alone" << said;
  }
}

}  // namespace mpi_test
