// SPDX-License-Identifier: MIT
// What a tool writes never destroys anything else: every output of every tool, written over links, FIFOs, nodes,
// protected files and the tool's own inputs. All of these are made in the test's own folder.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "datasets/analytic_meshes.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace outputs_test {

namespace fs = std::filesystem;
using namespace testing_tools;

/// One output of one tool. The tools run in a folder that holds in.off, other.off and in.proof.
struct Output {
  const char* name;
  const char* tool;
  std::vector<std::string> arguments;  ///< "@" stands for the path of the output
  std::string path;                    ///< where it is written unless a test says otherwise
  bool is_named = true;                ///< false: the tool makes up the name
};

void PrintTo(const Output& output, std::ostream* stream) { *stream << output.name; }

const std::vector<Output> outputs = {
    {"simplify", SIMPLIFY_WITH_BOUND, {"in.off", "@", "--tolerance", "2%"}, "out.off"},
    {"simplify_json", SIMPLIFY_WITH_BOUND, {"in.off", "out.off", "--tolerance", "2%", "--json", "@"}, "out.json"},
    {"simplify_proof", SIMPLIFY_WITH_BOUND, {"in.off", "out.off", "--tolerance", "2%", "--certificate", "@"}, "p"},
    {"simplify_level",
     SIMPLIFY_WITH_BOUND,
     {"in.off", "out.off", "--tolerance", "2%", "--levels", "1%"},
     "out_level_0.off",
     false},
    {"simplify_heatmap", SIMPLIFY_WITH_BOUND, {"in.off", "out.off", "--tolerance", "2%", "--heatmap", "@"}, "h.ply"},
    {"simplify_image", SIMPLIFY_WITH_BOUND, {"in.off", "out.off", "--tolerance", "2%", "--image", "@"}, "i.png"},
    {"chain_level", LOD_CHAIN, {"in.off", ".", "--levels", "1%,2%", "--format", "off"}, "lod_1.off", false},
    {"chain_report", LOD_CHAIN, {"in.off", ".", "--levels", "1%"}, "chain.json", false},
    {"chain_json", LOD_CHAIN, {"in.off", ".", "--levels", "1%", "--json", "@"}, "out.json"},
    {"distance_json", HAUSDORFF_DISTANCE, {"in.off", "other.off", "--json", "@"}, "out.json"},
    {"distance_proof", HAUSDORFF_DISTANCE, {"in.off", "other.off", "--tolerance", "9", "--certificate", "@"}, "p"},
    {"distance_heatmap", HAUSDORFF_DISTANCE, {"in.off", "other.off", "--heatmap-original", "@"}, "h.ply"},
    {"distance_image", HAUSDORFF_DISTANCE, {"in.off", "other.off", "--image", "@"}, "i.png"},
    {"verify_json", VERIFY_CERTIFICATE, {"in.off", "other.off", "in.proof", "--json", "@"}, "out.json"},
};

class Outputs : public testing::TestWithParam<Output> {
 protected:
  void SetUp() override {
    write_mesh(folder_ / "in.off", datasets::terrain(1, 12, 5));
    write_mesh(folder_ / "other.off", datasets::terrain(1, 12, 6));
    const ToolRun proof = run_shell("cd " + shell_quoted(folder_.path()) + " && " +
                                    command_line(HAUSDORFF_DISTANCE, {"in.off", "other.off", "--tolerance", "9",
                                                                      "--certificate", "in.proof", "--quiet"}));
    ASSERT_EQ(proof.exit_code, 0) << proof.err;
  }
  [[nodiscard]] ToolRun run(const std::string& path) const {
    std::vector<std::string> arguments = GetParam().arguments;
    for (std::string& argument : arguments)
      if (argument == "@") argument = path;
    return run_shell("cd " + shell_quoted(folder_.path()) + " && " + command_line(GetParam().tool, arguments));
  }
  [[nodiscard]] ToolRun run() const { return run(GetParam().path); }
  [[nodiscard]] fs::path path() const { return folder_ / GetParam().path; }

  void expect_no_temporary_files() const {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path()))
      EXPECT_NE(entry.path().filename().string()[0], '.') << entry.path();
  }
  static void expect_refused(const ToolRun& run, const std::string& named) {
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find(".meshbound"), std::string::npos) << "a name that the user never gave: " << run.err;
  }

  test::TemporaryFolder folder_;
};

TEST_P(Outputs, FollowALinkToAFileThatIsNotThereYet) {
  fs::create_directory(folder_ / "elsewhere");
  fs::create_symlink("elsewhere/target", path());
  const ToolRun result = run();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::is_symlink(path()));
  EXPECT_GT(fs::file_size(folder_ / "elsewhere/target"), 0u);
  expect_no_temporary_files();
}

TEST_P(Outputs, KeepTheModeOfAFileTheyReplace) {
  std::ofstream(path()) << "old";
  fs::permissions(path(), fs::perms(0640));
  const ToolRun result = run();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(content_of(path()), "old");
  EXPECT_EQ(fs::status(path()).permissions(), fs::perms(0640));
  expect_no_temporary_files();
}

TEST_P(Outputs, AreRefusedWhereTheFileIsWriteProtected) {
  std::ofstream(path()) << "old";
  fs::permissions(path(), fs::perms(0444));
  expect_refused(run(), GetParam().path);
  EXPECT_EQ(content_of(path()), "old");
  expect_no_temporary_files();
}

TEST_P(Outputs, GoIntoAFifo) {
  ASSERT_EQ(::mkfifo(path().c_str(), 0600), 0);
  const std::string copy = folder_ / "copy";
  std::vector<std::string> arguments = GetParam().arguments;
  for (std::string& argument : arguments)
    if (argument == "@") argument = GetParam().path;
  const ToolRun result = run_shell("cd " + shell_quoted(folder_.path()) + "; cat " + shell_quoted(path()) + " >" +
                                       shell_quoted(copy) + " & cd " + shell_quoted(folder_.path()) + " && (" +
                                       command_line(GetParam().tool, arguments) + "); code=$?; wait; exit $code",
                                   60);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::is_fifo(path()));
  EXPECT_GT(fs::file_size(copy), 0u);
  expect_no_temporary_files();
}

/// A node of the null device, in our own folder.
TEST_P(Outputs, GoIntoADevice) {
  if (::mknod(path().c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0) GTEST_SKIP() << "nodes cannot be made here";
  if (!std::ofstream(path())) GTEST_SKIP() << "nodes cannot be opened in this file system";
  const ToolRun result = run();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::is_character_file(path()));
  expect_no_temporary_files();
}

TEST_P(Outputs, MayHaveTheLongestLegalName) {
  if (!GetParam().is_named) GTEST_SKIP() << "its name is not for the user to choose";
  const std::string extension = fs::path(GetParam().path).extension();
  const std::string name = std::string(255 - extension.size(), 'n') + extension;
  const ToolRun result = run(name);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(fs::file_size(folder_ / name), 0u);
  expect_no_temporary_files();
}

TEST_P(Outputs, NeverReplaceAnInput) {
  for (const std::string& input : GetParam().arguments) {
    if (!input.starts_with("in.") && input != "other.off") continue;
    const std::string content = content_of(folder_ / input);
    fs::create_symlink(input, folder_ / "link.off");
    fs::create_hard_link(folder_ / input, folder_ / "same.off");
    for (const std::string& name : std::vector<std::string>{
             input, "link.off", "same.off", "./../" + folder_.path().filename().string() + "/" + input}) {
      SCOPED_TRACE(input + " as " + name);
      if (GetParam().is_named) {
        expect_refused(run(name), name);
      } else {
        fs::create_symlink(name, path());
        expect_refused(run(), GetParam().path);
        fs::remove(path());
      }
      EXPECT_EQ(content_of(folder_ / input), content);
    }
    fs::remove(folder_ / "link.off");
    fs::remove(folder_ / "same.off");
  }
  expect_no_temporary_files();
}

INSTANTIATE_TEST_SUITE_P(Of, Outputs, testing::ValuesIn(outputs), [](const auto& output) { return output.param.name; });

class OutputPairs : public testing::Test {
 protected:
  void SetUp() override {
    write_mesh(folder_ / "in.off", datasets::terrain(1, 12, 5));
    write_mesh(folder_ / "lod_0.off", datasets::terrain(1, 12, 5));
  }
  void expect_refused_before_work(const std::string& tool, const std::vector<std::string>& arguments) const {
    const std::string command = command_line(tool, arguments);
    const auto files = std::distance(fs::recursive_directory_iterator(folder_.path()), {});
    const ToolRun run = run_shell("cd " + shell_quoted(folder_.path()) + " && " + command);
    EXPECT_EQ(run.exit_code, 2) << command << run.err;
    EXPECT_EQ(line_count(run.err), 1) << command << run.err;
    EXPECT_EQ(std::distance(fs::recursive_directory_iterator(folder_.path()), {}), files) << command;
  }
  test::TemporaryFolder folder_;
};

TEST_F(OutputPairs, NeverShareAFile) {
  fs::create_directory(folder_ / "sub");
  fs::create_symlink("../out.off", folder_ / "sub/link.off");
  const std::vector<std::string> simplify{"in.off", "out.off", "--tolerance", "2%"};
  const auto with = [](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  for (const std::string option : {"--json", "--certificate", "--image"})
    for (const std::string path : {"out.off", "sub/../out.off", "sub/link.off"})
      expect_refused_before_work(SIMPLIFY_WITH_BOUND, with(simplify, {option, path}));
  expect_refused_before_work(SIMPLIFY_WITH_BOUND, with(simplify, {"--json", "x", "--certificate", "./x"}));
  expect_refused_before_work(SIMPLIFY_WITH_BOUND, with(simplify, {"--levels", "1%", "--json", "out_level_0.off"}));
  expect_refused_before_work(SIMPLIFY_WITH_BOUND,
                             with(simplify, {"--levels", "1%", "--certificate", "x", "--json", "x_level_0"}));
  expect_refused_before_work(HAUSDORFF_DISTANCE,
                             {"in.off", "lod_0.off", "--tolerance", "9", "--json", "x", "--certificate", "x"});
  for (const std::string path : {"new/lod_0.off", "new/lod_1.off", "new/chain.json"})
    expect_refused_before_work(LOD_CHAIN, {"in.off", "new", "--levels", "1%,2%", "--format", "off", "--json", path});
}

TEST_F(OutputPairs, AChainDoesNotReplaceItsOwnInput) {
  const std::string before = content_of(folder_ / "lod_0.off");
  expect_refused_before_work(LOD_CHAIN, {"lod_0.off", ".", "--levels", "1%", "--format", "off"});
  EXPECT_EQ(content_of(folder_ / "lod_0.off"), before);
}

/// Appending to what the shell has opened: neither replaced nor overwritten from the start.
TEST_F(OutputPairs, StandardOutputByItsPathIsAppendedTo) {
  if (!fs::exists("/proc/self/fd/1")) GTEST_SKIP() << "this system does not show descriptors as files";
  fs::create_symlink("/proc/self/fd/1", folder_ / "stdout");  // as /dev/stdout is, which no test may put at risk
  std::ofstream(folder_ / "log") << "first line\n";
  const ToolRun run = run_shell("cd " + shell_quoted(folder_.path()) + " && " +
                                command_line(HAUSDORFF_DISTANCE, {"in.off", "in.off", "--json", "stdout"}) + " >>log");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(content_of(folder_ / "log").rfind("first line\n{", 0), 0u) << content_of(folder_ / "log");
}

}  // namespace outputs_test
}  // namespace meshbound
