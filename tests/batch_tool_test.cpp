// SPDX-License-Identifier: MIT
// simplify_with_bound --batch by its command line: every mesh has a line and a row, failures stop nothing, a run that
// was killed goes on, shards make a whole.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "batch/child.h"
#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "tool_refusal.h"
#include "unreadable_folder.h"

namespace meshbound {
namespace batch_tool_test {

using nlohmann::json;
using namespace testing_tools;
namespace fs = std::filesystem;

class BatchTool : public testing::Test {
 protected:
  BatchTool() {
    fs::create_directories(in("models/deep"));
    write_mesh(in("models/cube.off"), datasets::cube(1, 6));
    write_mesh(in("models/torus.ply"), datasets::torus(1, 0.3, 40, 20));
    write_mesh(in("models/deep/sphere.stl"), datasets::icosphere(1, 3));
    std::ofstream(in("models/notes.txt")) << "no mesh\n";
  }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }

  ToolRun run(std::vector<std::string> options, const std::string& environment = "") const {
    options.insert(options.begin(), {"--batch", in("models"), "--output-dir", in("out"), "--tolerance", "1%"});
    return run_shell(environment + " " + command_line(SIMPLIFY_WITH_BOUND, options).substr(5));  // without "exec "
  }
  ToolRun run_at(const std::string& tolerance, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> all{"--batch", in("models"), "--output-dir", in("out"), "--tolerance", tolerance};
    all.insert(all.end(), options.begin(), options.end());
    return run_tool(SIMPLIFY_WITH_BOUND, all);
  }
  /// The row of a mesh in the table of all reports.
  [[nodiscard]] std::string merged_row(const std::string& name) const {
    const ToolRun merged = run_tool(SIMPLIFY_WITH_BOUND, {"--batch-merge", in("out")});
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    std::ifstream table(in("out/batch.csv"));
    for (std::string row; std::getline(table, row);)
      if (row.starts_with(name + ",")) return row;
    return "";
  }
  /// A glTF of one triangle whose buffer is the file face.bin.
  void write_gltf(double scale) const {
    std::string bytes;
    for (const float x : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, static_cast<float>(scale), 0.0F})
      bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
    std::ofstream(in("models/face.bin"), std::ios::binary) << bytes;
    std::ofstream(in("models/face.gltf")) << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "buffers": [{"byteLength": 36, "uri": "face.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                     "min": [0, 0, 0], "max": [1, 9, 0]}]})";
  }
  /// The records of a report, by name; those of one name must be one.
  [[nodiscard]] std::map<std::string, json> records(const std::string& report = "batch.jsonl") const {
    std::map<std::string, json> found;
    std::ifstream file(in("out/" + report));
    for (std::string line; std::getline(file, line);) {
      const json record = testing_tools::checked_document(line);
      EXPECT_EQ(record["schema"], "meshbound/batch/1");
      EXPECT_TRUE(found.emplace(record["input"], record).second) << line;
    }
    return found;
  }
  [[nodiscard]] std::map<std::string, std::string> results() const {
    std::map<std::string, std::string> contents;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(in("out")))
      if (entry.is_regular_file() && !entry.path().filename().string().starts_with("batch"))
        contents[entry.path().lexically_relative(in("out")).string()] = content_of(entry.path());
    return contents;
  }

  TemporaryFolder folder_;
};

TEST_F(BatchTool, SimplifiesEveryMeshBelowAFolder) {
  const ToolRun result = run({});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("3: 3 within, 0 exceed, 0 undecided, 0 failed; 0 from an earlier run"), std::string::npos)
      << result.out;
  const auto lines = records();
  ASSERT_EQ(lines.size(), 3u);
  for (const auto& [name, record] : lines) {
    EXPECT_EQ(record["status"], "within");
    EXPECT_EQ(record["exit_code"], 0);
    EXPECT_GT(record["peak_memory_bytes"], 1e6);
    const json& distance = record["result"]["distance"];
    const TriangleMesh before = read_mesh(in("models/" + name)).mesh, after = read_mesh(in("out/" + name)).mesh;
    EXPECT_EQ(record["result"]["simplified"]["faces"], after.triangles.size());
    EXPECT_LT(after.triangles.size(), before.triangles.size());
    EXPECT_EQ(check_tolerance(before, after, distance["upper"]).verdict, Verdict::Within) << name;
  }
  const std::string table = content_of(in("out/batch.csv")), page = content_of(in("out/batch.html"));
  EXPECT_EQ(line_count(table), 4) << table;
  EXPECT_NE(table.find("deep/sphere.stl,within,1280,"), std::string::npos) << table;
  EXPECT_NE(page.find("3 meshes: <span class=\"within\">3 within"), std::string::npos);
  EXPECT_NE(page.find("<td>deep/sphere.stl</td>"), std::string::npos);
}

TEST_F(BatchTool, LeavesWhatIsDoneAlone) {
  ASSERT_EQ(run({}).exit_code, 0);
  const std::string report = content_of(in("out/batch.jsonl"));
  const auto written = fs::last_write_time(in("out/cube.off"));
  const ToolRun again = run({});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.out.find("3 from an earlier run"), std::string::npos) << again.out;
  EXPECT_EQ(content_of(in("out/batch.jsonl")), report);
  EXPECT_EQ(fs::last_write_time(in("out/cube.off")), written);
}

TEST_F(BatchTool, DoesAnewWhatHasChanged) {
  ASSERT_EQ(run({}).exit_code, 0);
  write_mesh(in("models/cube.off"), datasets::cube(2, 5));        // another input
  std::ofstream(in("out/torus.ply"), std::ios::app) << "spoilt";  // another result
  const ToolRun again = run({});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.out.find("1 from an earlier run"), std::string::npos) << again.out;
  EXPECT_NE(run({"--prune"}).out.find("; 0 from an earlier run"), std::string::npos) << "other options";
}

/// The buffers of a glTF are files of their own, and part of its content.
TEST_F(BatchTool, DoesAnewWhatHasOtherBuffers) {
  write_gltf(1);
  ASSERT_EQ(run({}).exit_code, 0);
  EXPECT_NE(run({}).out.find("4 from an earlier run"), std::string::npos);
  write_gltf(2);
  EXPECT_NE(run({}).out.find("3 from an earlier run"), std::string::npos);
  EXPECT_EQ(
      hausdorff_distance(read_mesh(in("models/face.gltf")).mesh, read_mesh(in("out/face.gltf")).mesh).bounds.upper, 0);
}

TEST_F(BatchTool, AFailureStopsNothing) {
  std::ofstream(in("models/broken.off")) << "OFF\n3 1 0\n0 0 0\n1 0 0\n";
  const ToolRun result = run({"--quiet"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  const auto lines = records();
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines.at("broken.off")["status"], "failed");
  EXPECT_NE(lines.at("broken.off")["message"].get<std::string>().find("broken.off"), std::string::npos);
  EXPECT_FALSE(fs::exists(in("out/broken.off")));
  for (const char* const name : {"cube.off", "torus.ply", "deep/sphere.stl"})
    EXPECT_EQ(lines.at(name)["status"], "within");
}

/// Where SIGCHLD is ignored the system discards exit codes, and a parent may have it so.
TEST_F(BatchTool, KnowsFailuresWhoeverStartsIt) {
  std::ofstream(in("models/broken.off")) << "OFF\n3 1 0\n0 0 0\n1 0 0\n";
  const ToolRun result = run({"--quiet"}, "env --ignore-signal=CHLD");
  EXPECT_EQ(result.exit_code, 2);
  const auto lines = records();
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines.at("broken.off")["status"], "failed");
  EXPECT_EQ(lines.at("cube.off")["status"], "within");
}

/// The document of each mesh is shorter than the limit, the report of all is longer.
TEST_F(BatchTool, SaysWhyItCannotRecord) {
  fs::remove_all(in("models"));
  fs::create_directories(in("models"));
  for (const char* const name : {"a", "b", "c", "d", "e", "f"})
    write_mesh(in("models/" + std::string(name) + ".off"), datasets::cube(1, 3));
  const ToolRun result = run({"--quiet", "--threads", "1"}, "ulimit -f 16;");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("batch.jsonl: File too large"), std::string::npos) << result.err;
}

TEST_F(BatchTool, AnExitCodeThatIsLostIsNotThatOfASuccess) {
  const auto command = [](const std::string& text) { return std::vector<std::string>{"/bin/sh", "-c", text}; };
  tools::Child child(command("exit 0"), 0, std::chrono::duration<double>(60));
  ASSERT_GT(::wait(nullptr), 0);  // this test takes it
  const auto end = child.poll();
  ASSERT_TRUE(end);
  EXPECT_EQ(end->exit_code, -1);
  EXPECT_NE(end->fault, "");
}

TEST_F(BatchTool, KeepsEachMeshToItsLimits) {
  write_mesh(in("models/large.ply"), datasets::torus(1, 0.3, 1200, 600));
  EXPECT_EQ(run({"--memory-limit", "96M"}).exit_code, 2);
  const auto by_memory = records();
  EXPECT_NE(by_memory.at("large.ply")["message"].get<std::string>().find(
                "out of memory within 96 MiB: allow more (--memory-limit of the batch"),
            std::string::npos)
      << by_memory.at("large.ply");
  EXPECT_EQ(by_memory.at("cube.off")["status"], "within");
  EXPECT_EQ(run({"--time-limit", "0"}).exit_code, 3);
}

/// Starts a run, kills it when the first mesh is done, and does the rest.
TEST_F(BatchTool, GoesOnAfterItWasKilled) {
  for (const char* const name : {"a.ply", "b.ply", "c.ply", "d.ply"})
    write_mesh(in(std::string("models/") + name), datasets::torus(1, 0.3, 120, 60));
  const std::vector<std::string> words{SIMPLIFY_WITH_BOUND,
                                       "--batch",
                                       in("models"),
                                       "--output-dir",
                                       in("out"),
                                       "--tolerance",
                                       "1%",
                                       "--jobs",
                                       "1",
                                       "--quiet"};
  const pid_t process = ::fork();
  if (process == 0) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    ::execv(argv[0], argv.data());
    ::_exit(99);
  }
  while (line_count(content_of(in("out/batch.jsonl"))) < 1 && ::waitpid(process, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ::kill(process, SIGKILL);
  ::waitpid(process, nullptr, 0);
  std::ofstream(in("out/batch.jsonl"), std::ios::app)
      << R"({"schema":"meshbound/batch/1","input":"d.p)";  // a torn line

  const ToolRun rest = run({"--jobs", "1"});
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(rest.out.find("; 0 from an earlier run"), std::string::npos) << rest.out;
  EXPECT_NE(rest.out.find("7: 7 within"), std::string::npos) << rest.out;
  EXPECT_NE(run({"--jobs", "1"}).out.find("; 7 from an earlier run"), std::string::npos) << "no record is lost";
  const auto after_a_kill = results();
  fs::remove_all(in("out"));
  ASSERT_EQ(run({}).exit_code, 0);
  EXPECT_EQ(results(), after_a_kill);
}

TEST_F(BatchTool, ShardsMakeAWhole) {
  EXPECT_EQ(run({"--shard", "0/2"}).exit_code, 0);
  EXPECT_EQ(run({"--shard", "auto"}, "SLURM_ARRAY_TASK_ID=8 SLURM_ARRAY_TASK_MIN=7 SLURM_ARRAY_TASK_COUNT=2").exit_code,
            0);
  EXPECT_EQ(records("batch_0_of_2.jsonl").size(), 2u);
  EXPECT_EQ(records("batch_1_of_2.jsonl").size(), 1u);
  EXPECT_FALSE(fs::exists(in("out/batch.csv")));
  EXPECT_NE(run({"--shard", "auto/3"}, "JOB_COMPLETION_INDEX=2").out.find("1 from an earlier run"), std::string::npos);
  const ToolRun merged = run_tool(SIMPLIFY_WITH_BOUND, {"--batch-merge", in("out")});
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(line_count(content_of(in("out/batch.csv"))), 4);
}

/// Indices of a Slurm array may be apart by more than one.
TEST_F(BatchTool, CountsTheTasksOfAnArrayInItsSteps) {
  const std::string array = "SLURM_ARRAY_TASK_MIN=7 SLURM_ARRAY_TASK_MAX=9 SLURM_ARRAY_TASK_STEP=2 ";
  EXPECT_EQ(run({"--shard", "auto"}, array + "SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_ID=9").exit_code, 0);
  EXPECT_EQ(records("batch_1_of_2.jsonl").size(), 1u);
  const ToolRun between = run({"--shard", "auto/3"}, array + "SLURM_ARRAY_TASK_ID=8");
  EXPECT_EQ(between.exit_code, 2);
  EXPECT_NE(between.err.find("in steps of SLURM_ARRAY_TASK_STEP 2"), std::string::npos) << between.err;
}

/// Whatever the reports of the shards are called, the table has the last run of each mesh, and so has a resumed run.
TEST_F(BatchTool, MergesTheNewestRecords) {
  ASSERT_EQ(run_at("5%", {"--shard", "0/2"}).exit_code, 0);
  ASSERT_EQ(run_at("5%", {"--shard", "1/2"}).exit_code, 0);
  ASSERT_EQ(run_at("1%", {"--shard", "0/1"}).exit_code, 0);
  for (const char* const name : {"torus.ply", "deep/sphere.stl"}) {
    const std::string faces = std::to_string(read_mesh(in(std::string("out/") + name)).mesh.triangles.size());
    EXPECT_NE(merged_row(name).find("," + faces + ","), std::string::npos) << faces << ": " << merged_row(name);
  }
  const ToolRun again = run_at("1%", {"--shard", "0/1"});
  EXPECT_NE(again.out.find("; 3 from an earlier run"), std::string::npos) << again.out;

  json record = records("batch_0_of_1.jsonl").at("torus.ply");  // as an earlier version wrote it
  record.erase("recorded");
  record["message"] = "an old record";
  std::ofstream(in("out/batch_9_of_9.jsonl")) << record << "\n";
  EXPECT_EQ(merged_row("torus.ply").find("an old record"), std::string::npos) << merged_row("torus.ply");
}

/// The cube is left with the same triangles at both tolerances, so that its first record holds again in the third run.
TEST_F(BatchTool, MergesARecordThatHoldsAgainAsTheNewest) {
  ASSERT_EQ(run_at("1%").exit_code, 0);
  const std::string row = merged_row("cube.off"), cube = content_of(in("out/cube.off"));
  ASSERT_EQ(run_at("2%").exit_code, 0);
  EXPECT_NE(merged_row("cube.off"), row);
  ASSERT_EQ(content_of(in("out/cube.off")), cube);
  const ToolRun third = run_at("1%");
  EXPECT_NE(third.out.find("; 1 from an earlier run"), std::string::npos) << third.out;
  EXPECT_EQ(merged_row("cube.off"), row);
}

/// Names that are no UTF-8, as archives of other systems leave them: each has a record of its own.
TEST_F(BatchTool, TellsNamesApartThatAreNoText) {
  const std::map<std::string, std::string> names{
      {"\xFE.off", "\\xFE.off"},
      {"\xFF.off", "\\xFF.off"},
      {"\\xFF.off", "\\\\xFF.off"},
      {"\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80.off", "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80.off"},
      {"\xC1\x81.off", "\\xC1\\x81.off"},                    // a long form of "A"
      {"\xE0\x80\x80.off", "\\xE0\\x80\\x80.off"},           // a long form of 0
      {"\xED\xA0\x80.off", "\\xED\\xA0\\x80.off"},           // half of a surrogate pair
      {"\xF4\x90\x80\x80.off", "\\xF4\\x90\\x80\\x80.off"},  // beyond U+10FFFF
      {"\xE2\x82.off", "\\xE2\\x82.off"},                    // an incomplete character
  };
  fs::remove_all(in("models"));
  fs::create_directories(in("models"));
  for (const auto& [name, shown] : names) write_mesh(in("models/" + name), datasets::cube(1, 3));
  EXPECT_EQ(run({}).exit_code, 0);
  const auto lines = records();
  for (const auto& [name, shown] : names) EXPECT_EQ(lines.count(shown), 1u) << shown;
  const ToolRun again = run({});
  EXPECT_NE(again.out.find("9: 9 within, 0 exceed, 0 undecided, 0 failed; 9 from an earlier run"), std::string::npos)
      << again.out;
}

/// A FIFO is not opened, not even to look for the buffers of a glTF that a result of the second run could replace.
TEST_F(BatchTool, RecordsWhatCannotBeReadAsAFile) {
  fs::create_symlink("nowhere", in("models/dangling.ply"));
  fs::create_symlink("nowhere", in("models/\xFF.ply"));
  fs::create_directory_symlink("..", in("models/folder.ply"));
  ASSERT_EQ(::mkfifo(in("models/fifo.gltf").c_str(), 0600), 0);
  const int watch = ::inotify_init1(IN_NONBLOCK);
  ASSERT_GE(::inotify_add_watch(watch, in("models/fifo.gltf").c_str(), IN_OPEN), 0);
  EXPECT_EQ(run({}).exit_code, 2);
  const auto lines = records();
  EXPECT_EQ(lines.size(), 6u);
  EXPECT_EQ(content_of(in("out/batch.csv")).find('\xFF'), std::string::npos) << "the table is UTF-8";
  ASSERT_TRUE(lines.contains("dangling.ply") && lines.contains("fifo.gltf"));
  EXPECT_EQ(lines.at("dangling.ply")["status"], "failed");
  EXPECT_NE(lines.at("dangling.ply")["message"].get<std::string>().find("No such file"), std::string::npos);
  EXPECT_NE(lines.at("fifo.gltf")["message"].get<std::string>().find("not a regular file"), std::string::npos);
  EXPECT_EQ(run({}).exit_code, 2);
  std::array<char, 4096> events{};
  EXPECT_EQ(::read(watch, events.data(), events.size()), -1) << "it was opened";
  ::close(watch);
}

/// What a batch writes may replace the results of its earlier runs, and nothing else that it reads or writes.
TEST_F(BatchTool, RefusesToReplaceWhatItReads) {
  write_gltf(1);
  const auto refused = [&](const std::string& source, const std::string& output_dir, const std::string& why) {
    const ToolRun result = run_shell("cd " + shell_quoted(in("")) + " && " +
                                     command_line(SIMPLIFY_WITH_BOUND, {"--batch", source, "--output-dir", output_dir,
                                                                        "--tolerance", "1%", "--jobs", "1"}));
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(in(output_dir + "/batch.jsonl")));
  };
  refused("models", "models", "models/cube.off is the file that is read as mesh models/cube.off of --batch");

  fs::create_directories(in("small"));
  write_mesh(in("small/cube.off"), datasets::icosphere(1, 2));
  const std::string sphere = content_of(in("small/cube.off"));
  fs::copy_file(in("models/cube.off"), in("cube.off"));
  std::ofstream(in("list.txt")) << "cube.off\nsmall/cube.off\n";
  refused("list.txt", "small",
          "--output-dir for cube.off: small/cube.off is the file that is read as mesh small/cube.off");
  EXPECT_EQ(content_of(in("small/cube.off")), sphere);

  const auto with_output = [&](const std::string& name, const std::string& target, const std::string& why) {
    fs::remove_all(in("linked"));
    fs::create_directories(in("linked"));
    fs::create_symlink(target, in("linked/" + name));
    refused("models", "linked", why);
  };
  with_output("cube.off", "../models/torus.ply", "is read as mesh models/torus.ply");
  with_output("cube.off", "torus.ply", "is written as --output-dir for models/cube.off");
  with_output("cube.off", "../models/face.bin", "is read as mesh models/face.gltf");
  with_output("batch.csv", "../models/cube.off", "linked/batch.csv is the file that is read as mesh models/cube.off");
}

TEST_F(BatchTool, TakesAListOfFiles) {
  std::ofstream(in("list.txt")) << "# two of three\n"
                                << in("models/cube.off") << "\n\n"
                                << in("models/torus.ply") << "\n";
  const ToolRun result =
      run_tool(SIMPLIFY_WITH_BOUND, {"--batch", in("list.txt"), "--output-dir", in("out"), "--tolerance", "1%"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(records().size(), 2u);
  EXPECT_TRUE(fs::exists(in("out/cube.off")));
}

TEST_F(BatchTool, RefusesBadUsageInOneLine) {
  const auto refused = [&](const std::vector<std::string>& options, const std::string& why) {
    const ToolRun result = run_tool(SIMPLIFY_WITH_BOUND, options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(in("out")));
  };
  const std::string models = in("models"), out = in("out");
  refused({"--batch", models, "--tolerance", "1%"}, "--output-dir is missing");
  refused({"--batch", models, "--output-dir", out, "--tolerance", "1%", "--shard", "2/2"}, "INDEX from 0 to COUNT - 1");
  refused({"--batch", models, "--output-dir", out, "--tolerance", "1%", "--shard", "auto/2"}, "JOB_COMPLETION_INDEX");
  refused({"--batch", models, "--output-dir", out, "--tolerance", "1%", "--memory-limit", "4X"}, "such as 4G");
  refused({"--batch", models, "--output-dir", out, "--tolerance", "1%", "--json", in("x.json")},
          "--json is for a single mesh");
  refused({"--batch", models, "--output-dir", out, "--tolerance", "1%", "--units", "mm"},
          "--units is for a single mesh");
  refused({"a.ply", "b.ply", "--batch", models, "--output-dir", out, "--tolerance", "1%"}, "IN is for a single mesh");
  refused({"--batch", in("nothing"), "--output-dir", out, "--tolerance", "1%"}, "cannot read");
  refused({"a.ply", "b.ply", "--tolerance", "1%", "--jobs", "2"}, "goes with --batch only");
  refused({"--tolerance", "1%"}, "IN is required");
  fs::create_directories(in("empty"));
  refused({"--batch", in("empty"), "--output-dir", out, "--tolerance", "1%"}, "there is no mesh file");
  std::ofstream(in("list.txt")) << in("models/cube.off") << "\n" << in("empty/cube.off") << "\n";
  refused({"--batch", in("list.txt"), "--output-dir", out, "--tolerance", "1%"}, "would both be written to");
  refused({"--batch-merge", in("empty")}, "there is no batch*.jsonl");
}

TEST_F(BatchTool, RefusesWhatIsNoListOfFiles) {
  write_mesh(in("cube.obj"), datasets::cube(1, 1));
  std::ofstream(in("bytes.txt"), std::ios::binary) << std::string("models/cube.off\n\0\1", 18);
  for (const auto& [source, why] :
       {std::pair{"models/torus.ply", "models/torus.ply is a mesh: give it as IN"},
        std::pair{"cube.obj", "cube.obj is a mesh: give it as IN"}, std::pair{"bytes.txt", "it has bytes of 0"}}) {
    const ToolRun result =
        run_tool(SIMPLIFY_WITH_BOUND, {"--batch", in(source), "--output-dir", in("out"), "--tolerance", "1%"});
    expect_refused(result, why);
    EXPECT_NE(result.err.find("--batch takes a folder or a list of files; "), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(in("out")));
  }
}

/// Once, before the first mesh, and not for each of them.
TEST_F(BatchTool, ChecksLengthsBeforeTheFirstMesh) {
  const auto refused = [&](const std::vector<std::string>& options, const std::string& why) {
    std::vector<std::string> all{"--batch", in("models"), "--output-dir", in("out")};
    all.insert(all.end(), options.begin(), options.end());
    expect_refused(run_tool(SIMPLIFY_WITH_BOUND, all), why);
    EXPECT_FALSE(fs::exists(in("out")));
  };
  refused({}, "--tolerance is missing");
  refused({"--tolerance", "0.1mm"}, "mesh files carry no unit");
  refused({"--tolerance", "1%", "--line-tolerance", "x"}, "--line-tolerance: 'x' is not a length");
  refused({"--tolerance", "1%", "--target-ratio", "2"}, "--target-ratio: '2' is no share");
  refused({"--tolerance", "1%", "--texture-tolerance", "2texels"}, "needs --texture-size");
}

TEST_F(BatchTool, IsNamedWhereINIsAFolder) {
  expect_refused(run_tool(SIMPLIFY_WITH_BOUND, {in("models"), in("out.ply"), "--tolerance", "1%"}),
                 "is a folder; name a mesh in it, or simplify all with --batch ");
  expect_refused(run_tool(SIMPLIFY_WITH_BOUND, {in("models"), "--tolerance", "1%"}), "is a folder");
}

/// A path that is too long for the system stands for a folder of somebody else, which the superuser may read.
TEST_F(BatchTool, RecordsFoldersThatCannotBeRead) {
  const fs::path unreadable = make_unreadable_folder(in("models/deep"));
  EXPECT_EQ(run({}).exit_code, 2);
  const auto lines = records();
  ASSERT_EQ(lines.size(), 4u);
  const json& record = lines.at(unreadable.lexically_relative(in("models")).string());
  EXPECT_EQ(record["status"], "failed");
  EXPECT_NE(record["message"].get<std::string>().find(": cannot read the folder: "), std::string::npos);
  EXPECT_EQ(lines.at("deep/sphere.stl")["status"], "within");
}

/// The example for GNU parallel, as it stands in the document.
TEST_F(BatchTool, RunsUnderGnuParallelAsDocumented) {
  if (run_shell("command -v parallel").exit_code != 0) GTEST_SKIP() << "GNU parallel is not installed";
  const std::string document = content_of(MESHBOUND_SOURCE_DIR "/docs/batch.md");
  const std::regex block("```sh\n((?:seq [^\n]*parallel[^`]*))```");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(document, found, block));
  const ToolRun result = run_shell("cd " + shell_quoted(folder_.path().string()) +
                                   " && PATH=" + shell_quoted(fs::path(SIMPLIFY_WITH_BOUND).parent_path().string()) +
                                   ":$PATH && " + found[1].str());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(line_count(content_of(in("small/batch.csv"))), 4);
}

}  // namespace batch_tool_test
}  // namespace meshbound
