// SPDX-License-Identifier: MIT
// What goes wrong around a tool: interrupts, full disks, folders that cannot be written, too little memory, files that
// change while they are read. One line on stderr, exit 2, nothing half-written, nothing left behind.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace faults_test {

namespace fs = std::filesystem;
using namespace testing_tools;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif
#else
constexpr bool sanitized = false;
#endif

struct Command {
  const char* name;
  const char* tool;
  std::vector<std::string> arguments;  ///< run inside the folder, where in.off is
};

const std::vector<Command> commands = {
    {"simplify_with_bound", SIMPLIFY_WITH_BOUND, {"in.off", "out.off", "--tolerance", "0.5%", "--quiet"}},
    {"simplify_with_bound_levels",
     SIMPLIFY_WITH_BOUND,
     {"in.off", "out.ply", "--tolerance", "0.5%", "--levels", "0.1%,0.2%", "--json", "out.json", "--quiet"}},
    {"simplify_with_bound_certificate",
     SIMPLIFY_WITH_BOUND,
     {"in.off", "out.stl", "--tolerance", "0.5%", "--certificate", "out.proof", "--quiet"}},
    {"lod_chain", LOD_CHAIN, {"in.off", "out", "--levels", "0.1%,0.5%", "--quiet"}},
    {"hausdorff_distance", HAUSDORFF_DISTANCE, {"in.off", "other.off", "--json", "out.json", "--quiet"}},
};

class Faults : public testing::TestWithParam<Command> {
 protected:
  /// in.off and other.off, of about 2 n^2 triangles.
  void prepare(int n) {
    write_mesh(folder_ / "in.off", datasets::terrain(1, n, 5));
    write_mesh(folder_ / "other.off", datasets::terrain(1, n, 6));
    input_ = content_of(folder_ / "in.off");
    before_ = names();
  }
  [[nodiscard]] std::string command(const std::string& limits = "") const {
    return "cd " + shell_quoted(folder_.path()) + " && " + limits + command_line(GetParam().tool, GetParam().arguments);
  }
  /// Every file and folder, at any depth.
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> all;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path()))
      all.insert(entry.path().lexically_relative(folder_.path()));
    return all;
  }
  void expect_one_line_and_nothing_left(const ToolRun& run) const {
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(names(), before_);
    EXPECT_EQ(content_of(folder_ / "in.off"), input_) << "the input was touched";
  }

  test::TemporaryFolder folder_;
  std::string input_;
  std::set<std::string> before_;
};

/// Whether the process is the tool by now, no longer the shell that starts it, and has a handler for the signal.
bool catches(pid_t process, int signal) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line == "Name:\tsh" || line == "Name:\tfaults_test") return false;
    if (line.rfind("SigCgt:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1U) != 0;
  }
  return false;
}

/// Runs the command through the shell and sends the signal as soon as the tool listens for it.
ToolRun run_and_interrupt(const std::string& command, int signal) {
  const test::TemporaryFolder folder;
  const std::string redirected =
      command + " >" + shell_quoted(folder / "out") + " 2>" + shell_quoted(folder / "err") + " </dev/null";
  const pid_t process = fork();
  if (process == 0) {
    std::signal(signal, SIG_DFL);  // a shell that runs the tests in the background ignores SIGINT
    execl("/bin/sh", "sh", "-c", redirected.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  while (!catches(process, signal) && waitpid(process, &status, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(process, signal);
  waitpid(process, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content_of(folder / "out"),
          content_of(folder / "err")};
}

TEST_P(Faults, AnInterruptEndsItInOneLine) {
  prepare(150);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const ToolRun run = run_and_interrupt(command(), signal);
    expect_one_line_and_nothing_left(run);
    EXPECT_NE(run.err.find("interrupted"), std::string::npos) << run.err;
  }
}

/// A limit on the size of files stands for the full disk, which a test may not have.
TEST_P(Faults, AFullDiskEndsItInOneLine) {
  prepare(40);
  const ToolRun run = run_shell(command("ulimit -f 1; "));
  expect_one_line_and_nothing_left(run);
  EXPECT_NE(run.err.find("cannot write"), std::string::npos) << run.err;
}

TEST_P(Faults, TooLittleMemoryEndsItInOneLine) {
  if (sanitized) GTEST_SKIP() << "a sanitizer needs more address space than any limit leaves";
  prepare(100);
  int out_of_memory = 0, done = 0;
  // From what little the image of the largest tool fits into to enough for every tool.
  for (const int megabytes : {11, 12, 13, 14, 16, 18, 20, 22, 25, 28, 32, 400}) {
    SCOPED_TRACE(std::to_string(megabytes) + " MiB");
    for (const std::string& name : names())
      if (!before_.contains(name)) fs::remove_all(folder_ / name);
    const ToolRun run = run_shell(command("ulimit -v " + std::to_string(1024 * megabytes) + "; "));
    if (run.err.find("error while loading shared libraries") != std::string::npos) continue;
    if (run.exit_code == 0) {
      ++done;
      EXPECT_EQ(run.err, "");
      continue;
    }
    expect_one_line_and_nothing_left(run);
    EXPECT_NE(run.err.find("out of memory"), std::string::npos) << run.err;
    ++out_of_memory;
  }
  EXPECT_GT(out_of_memory, 2) << "no limit was short";
  EXPECT_GT(done, 0) << "no limit was enough";
}

INSTANTIATE_TEST_SUITE_P(Of, Faults, testing::ValuesIn(commands),
                         [](const auto& command) { return command.param.name; });

TEST(Faults, AFolderThatCannotBeWrittenIsSaid) {
  const test::TemporaryFolder folder;
  write_mesh(folder / "in.off", datasets::icosphere(1, 3));
  fs::create_directory(folder / "closed");
  fs::permissions(folder / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  // No permission stops the superuser, but /proc lets nobody make files.
  const std::string closed = geteuid() == 0 ? "/proc" : (folder / "closed").string();
  for (const auto& [tool, arguments] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {SIMPLIFY_WITH_BOUND, {folder / "in.off", closed + "/out.off", "--tolerance", "1%"}},
           {SIMPLIFY_WITH_BOUND, {folder / "in.off", folder / "out.off", "--tolerance", "1%", "--json", closed + "/j"}},
           {LOD_CHAIN, {folder / "in.off", closed + "/chain", "--levels", "1%"}},
           {HAUSDORFF_DISTANCE, {folder / "in.off", folder / "in.off", "--json", closed + "/j"}},
           {HAUSDORFF_DISTANCE,
            {folder / "in.off", folder / "in.off", "--tolerance", "1", "--certificate", closed + "/c"}}}) {
    const ToolRun run = run_tool(tool, arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find(closed), std::string::npos) << run.err;
  }
}

/// There is room for the meshes, but not for what is written beside them.
TEST(Faults, AFullDiskForADocumentOrAPictureLeavesNoFile) {
  const test::TemporaryFolder folder;
  write_mesh(folder / "in.off", datasets::cube(1, 4));
  const std::vector<std::string> simplify{"in.off", "out.ply", "--tolerance", "1%", "--quiet"};
  const auto with = [](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  for (const auto& [tool, arguments] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {SIMPLIFY_WITH_BOUND, with(simplify, {"--json", "out.json"})},
           {SIMPLIFY_WITH_BOUND, with(simplify, {"--image", "out.png", "--levels", "0.5%"})},
           {LOD_CHAIN, {"in.off", "chain", "--levels", "1%", "--quiet"}},
           {HAUSDORFF_DISTANCE,
            {"in.off", "in.off", "--tolerance", "1", "--certificate", "c", "--json", "j", "--quiet"}}}) {
    const ToolRun run =
        run_shell("cd " + shell_quoted(folder.path()) + " && ulimit -f 4; " + command_line(tool, arguments));
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find("cannot write: File too large"), std::string::npos) << run.err;
    EXPECT_EQ(std::distance(fs::recursive_directory_iterator(folder.path()), {}), 1) << tool;
  }
}

TEST(Faults, AFullStandardOutputIsSaid) {
  const test::TemporaryFolder folder;
  write_mesh(folder / "in.off", datasets::icosphere(1, 2));
  for (const std::string json : {"", " --json -"}) {
    const ToolRun run =
        run_shell(command_line(HAUSDORFF_DISTANCE, {folder / "in.off", folder / "in.off"}) + json + " >/dev/full");
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find("standard output"), std::string::npos) << run.err;
  }
}

TEST(Faults, AFullStandardOutputOfTextOrAMeshIsSaid) {
  const test::TemporaryFolder folder;
  write_mesh(folder / "in.off", datasets::icosphere(1, 2));
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--help"},
                                             {"--version"},
                                             {"--completion", "bash"},
                                             {folder / "in.off", "-", "--format", "off", "--tolerance", "1%"}}) {
    const ToolRun run = run_shell(command_line(SIMPLIFY_WITH_BOUND, arguments) + " >/dev/full");
    EXPECT_EQ(run.exit_code, 2) << arguments[0];
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_EQ(run.err.find("simplify_with_bound: "), 0u) << run.err;
    EXPECT_NE(run.err.find("standard output"), std::string::npos) << run.err;
  }
}

TEST(Faults, AMissingFolderForTemporaryFilesIsSaid) {
  const test::TemporaryFolder folder;
  write_mesh(folder / "in.off", datasets::icosphere(1, 2));
  const std::string absent = folder / "absent";
  const ToolRun run =
      run_shell("export TMPDIR=" + shell_quoted(absent) + "; " +
                command_line(SIMPLIFY_WITH_BOUND, {folder / "in.off", "-", "--format", "off", "--tolerance", "1%"}));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "simplify_with_bound: " + absent + ": not a folder for temporary files; set TMPDIR to one\n");
}

TEST(Faults, AFileThatShrinksWhileItIsReadIsRefused) {
  const test::TemporaryFolder folder;
  const fs::path path = folder / "mesh.off";
  write_mesh(path, datasets::terrain(1, 60, 5));
  const std::string whole = content_of(path);
  std::atomic<bool> done = false;
  std::thread writer([&] {
    while (!done) {
      fs::resize_file(path, 10);
      std::ofstream(path, std::ios::binary) << whole;
    }
  });
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    try {
      EXPECT_FALSE(read_mesh(path).mesh.triangles.empty());
    } catch (const Error&) {
      ++refused;
    }
  }
  done = true;
  writer.join();
  EXPECT_GT(refused, 0) << "no read met a shortened file";
  // A file of /sys says that it has a page of bytes, and gives fewer.
  const fs::path short_file = "/sys/kernel/mm/transparent_hugepage/enabled";
  if (!fs::exists(short_file)) return;
  fs::create_symlink(short_file, folder / "short.off");
  try {
    (void)read_mesh(folder / "short.off");
    ADD_FAILURE() << "read a file that ends before its size";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("became shorter"), std::string::npos) << error.what();
  }
}

}  // namespace faults_test
}  // namespace meshbound
