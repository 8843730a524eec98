// SPDX-License-Identifier: MIT
// "-" stands for standard input and output: what goes through a pipe is what a file would hold.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace standard_streams_test {

using namespace testing_tools;

class StandardStreams : public testing::Test {
 protected:
  StandardStreams() { write_mesh(in("in.off"), datasets::torus(1, 0.3, 40, 20)); }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  /// Runs a tool with these arguments, as the shell reads them, in the folder.
  [[nodiscard]] ToolRun shell(const std::string& command) const {
    return run_shell("cd " + shell_quoted(folder_.path().string()) +
                     " && simplify=" + shell_quoted(SIMPLIFY_WITH_BOUND) +
                     " measure=" + shell_quoted(HAUSDORFF_DISTANCE) + " && " + command);
  }
  void expect_refused(const std::string& command, const std::string& message) const {
    const ToolRun run = shell(command);
    EXPECT_EQ(run.exit_code, 2) << command;
    EXPECT_EQ(run.out, "") << command;
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  }

  test::TemporaryFolder folder_;
};

TEST_F(StandardStreams, CarryAMeshThroughAPipe) {
  ASSERT_EQ(shell("\"$simplify\" in.off file.off --tolerance 0.01").exit_code, 0);
  const ToolRun piped = shell("cat in.off | \"$simplify\" - - --format off --tolerance 0.01 --json r.json | cat");
  EXPECT_EQ(piped.out, content_of(in("file.off"))) << piped.err;
  EXPECT_EQ(piped.err, "");
  const Json json = checked_document(content_of(in("r.json")));
  EXPECT_EQ(json["original"]["path"], "-");
  EXPECT_EQ(json["simplified"]["path"], "-");
}

TEST_F(StandardStreams, AreNamedInMessages) {
  expect_refused("echo x | \"$simplify\" - out.off --format ply --tolerance 0.01",
                 "simplify_with_bound: standard input: ");
  expect_refused("echo x | \"$measure\" in.off - --format stl", "hausdorff_distance: standard input: ");
}

TEST_F(StandardStreams, MayDifferInFormat) {
  ASSERT_EQ(shell("\"$simplify\" in.off file.obj --tolerance 0.01").exit_code, 0);
  for (const char* formats : {"--input-format off --output-format obj", "--format obj --input-format off",
                              "--format off --output-format obj"}) {
    const ToolRun piped = shell(std::string("cat in.off | \"$simplify\" - - --tolerance 0.01 ") + formats);
    EXPECT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_EQ(piped.out, content_of(in("file.obj"))) << formats;
  }
}

TEST_F(StandardStreams, MayBeFiles) {
  const ToolRun run = shell("\"$simplify\" - - --format off --tolerance 0.01 <in.off >out.off");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(shell("\"$simplify\" in.off file.off --tolerance 0.01").exit_code, 0);
  EXPECT_EQ(content_of(in("out.off")), content_of(in("file.off")));
}

TEST_F(StandardStreams, HoldAMeshToMeasure) {
  const ToolRun named =
      shell("\"$simplify\" in.off out.off --tolerance 0.01 && \"$measure\" in.off out.off --json a.json");
  ASSERT_EQ(named.exit_code, 0) << named.err;
  for (const char* command : {"\"$measure\" - out.off --format off --json b.json <in.off",
                              "cat out.off | \"$measure\" in.off - --format off --json b.json"}) {
    const ToolRun run = shell(command);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(checked_document(content_of(in("b.json")))["distance"]["upper"],
              checked_document(content_of(in("a.json")))["distance"]["upper"]);
  }
}

/// The next file that is opened must not take the place of a closed one, and then be what text is printed to.
TEST_F(StandardStreams, MayBeClosed) {
  ASSERT_EQ(shell("\"$simplify\" in.off file.off --tolerance 0.01").exit_code, 0);
  for (const std::string closed : {">&-", "2>&-", "<&- >&- 2>&-"}) {
    for (const std::string wanted : {"--quiet", "", "--json -"}) {
      std::filesystem::remove(in("out.off"));
      const ToolRun run = shell("\"$simplify\" in.off out.off --tolerance 0.01 " + wanted + " " + closed);
      const bool prints_to_nothing = closed != "2>&-" && wanted != "--quiet";
      EXPECT_EQ(run.exit_code, prints_to_nothing ? 2 : 0) << wanted << closed << run.err;
      if (closed == ">&-" && prints_to_nothing) {
        EXPECT_NE(run.err.find("cannot write to standard output"), std::string::npos) << run.err;
      }
      const bool is_refused = closed != "2>&-" && wanted == "--json -";  // before any work
      EXPECT_EQ(std::filesystem::exists(in("out.off")), !is_refused) << wanted << closed;
      if (!is_refused) {
        EXPECT_EQ(content_of(in("out.off")), content_of(in("file.off"))) << wanted << closed;
      }
    }
  }
}

TEST_F(StandardStreams, MayBeClosedInABatch) {
  ASSERT_EQ(shell("\"$simplify\" in.off file.off --tolerance 0.01").exit_code, 0);
  const ToolRun run = shell(
      "mkdir models && cp in.off models && \"$simplify\" --batch models --output-dir out --tolerance 0.01 --quiet <&- "
      ">&- 2>&-");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(content_of(in("out/in.off")), content_of(in("file.off")));
}

TEST_F(StandardStreams, AreRefusedWhereTheyCannotBeUsed) {
  expect_refused("\"$simplify\" - out.ply --tolerance 1", "IN is standard input: say its format");
  expect_refused("\"$simplify\" in.off - --tolerance 1", "OUT is standard output: say its format");
  expect_refused("\"$simplify\" in.off out.ply --format ply --tolerance 1", "--format is for a mesh on standard input");
  expect_refused("\"$simplify\" in.off - --input-format off --tolerance 1",
                 "--input-format is for a mesh on standard input");
  expect_refused("\"$simplify\" - out.ply --output-format ply --tolerance 1", "--output-format is for");
  expect_refused("\"$simplify\" - - --input-format ply --tolerance 1", "OUT is standard output: say its format");
  expect_refused("\"$simplify\" in.off - --format ply --json - --tolerance 1", "cannot both be standard output");
  expect_refused("\"$simplify\" in.off - --format ply --levels 0.5 --tolerance 1", "name OUT");
  expect_refused("\"$simplify\" - - --format ply --tolerance 1", "the file is empty");
  expect_refused("\"$measure\" - - --format ply", "cannot both be standard input");
  expect_refused("\"$measure\" - in.off", "A is standard input: say its format");
}

}  // namespace standard_streams_test
}  // namespace meshbound
