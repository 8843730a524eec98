// SPDX-License-Identifier: MIT
// hausdorff_distance --poses by its command line: each step against the known answer, its document against the schema.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/io.h"
#include "tool_refusal.h"

namespace meshbound {
namespace motion_tool_test {

using nlohmann::json;
using namespace testing_tools;

/// A cube and its copy, which moves by t away from it: a corner is exactly |t| away.
class MotionTool : public testing::Test {
 protected:
  MotionTool() {
    write_mesh(cube_, datasets::cube(1, 8));
    std::ofstream file(poses_);
    file << "# t = (x, 0, 0)\n";
    for (int step = 0; step < steps; ++step) file << "1 0 0 " << x_at(step) << "  0 1 0 0  0 0 1 0  0 0 0 1\n\n";
  }
  static double x_at(int step) { return 0.5 + 0.0625 * step; }
  ToolRun run(std::vector<std::string> options) {
    options.insert(options.begin(), {cube_, cube_, "--poses", poses_});
    return run_tool(HAUSDORFF_DISTANCE, options);
  }

  static constexpr int steps = 12;
  TemporaryFolder folder_;
  std::string cube_ = folder_ / "cube.off";
  std::string poses_ = folder_ / "poses.txt";
};

TEST_F(MotionTool, MeasuresEachPose) {
  const ToolRun result = run({"--error-bound", "1e-5", "--json", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json document = checked_document(result.out);
  EXPECT_EQ(document["verdict"], "done");
  EXPECT_EQ(document["poses"], steps);
  ASSERT_EQ(document["steps"].size(), static_cast<std::size_t>(steps));
  for (int step = 0; step < steps; ++step) {
    const json& distance = document["steps"][static_cast<std::size_t>(step)]["distance"];
    EXPECT_LE(distance["lower"].get<double>(), x_at(step));
    EXPECT_GE(distance["upper"].get<double>(), x_at(step));
    EXPECT_LE(distance["upper"].get<double>() - distance["lower"].get<double>(), 1e-5);
  }
}

TEST_F(MotionTool, ExitCodeIsThatOfTheWorstStep) {
  EXPECT_EQ(run({"--tolerance", "2"}).exit_code, 0);
  const ToolRun exceeds = run({"--tolerance", "0.7"});
  EXPECT_EQ(exceeds.exit_code, 1);
  EXPECT_NE(exceeds.out.find("verdict     exceeds"), std::string::npos) << exceeds.out;
  EXPECT_NE(exceeds.out.find(" within\n"), std::string::npos) << exceeds.out;
}

TEST_F(MotionTool, ATimeThatIsOverLeavesStepsOpen) {
  const ToolRun result = run({"--time-limit", "0"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.out.find("0 of 12 poses"), std::string::npos) << result.out;
}

TEST_F(MotionTool, RefusesWhatIsNoPoseAndNamesTheLine) {
  std::ofstream(poses_) << "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n2 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n";
  expect_refused(run({}), "poses.txt line 2: not a rigid motion");
  std::ofstream(poses_) << "# nothing\n\n1 2 3\n";
  expect_refused(run({}), "line 3: expected 16 finite numbers");
  std::ofstream(poses_) << "# nothing\n";
  expect_refused(run({}), "has no pose");
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {cube_, cube_, "--poses", folder_ / "missing"}), "cannot read");
}

TEST_F(MotionTool, RefusesWhatDoesNotGoWithPoses) {
  for (const char* option : {"--one-sided", "--worst", "--profile"}) expect_refused(run({option}), "--poses goes with");
}

TEST_F(MotionTool, EndsWithALineForAGateThatFails) {
  const ToolRun quiet = run({"--tolerance", "0.9", "--quiet"});  // x is 0.875 at step 6, 0.9375 at step 7
  EXPECT_EQ(quiet.exit_code, 1);
  EXPECT_EQ(line_count(quiet.err), 1) << quiet.err;
  EXPECT_EQ(quiet.err.rfind("FAIL step 7: 0.93", 0), 0u) << quiet.err;
  EXPECT_NE(quiet.err.find(" > 0.9\n"), std::string::npos) << quiet.err;
  EXPECT_EQ(quiet.out, "");
  EXPECT_TRUE(run({"--tolerance", "0.9"}).out.ends_with(quiet.err));
  EXPECT_EQ(run({"--tolerance", "2", "--quiet"}).err, "");
}

}  // namespace motion_tool_test
}  // namespace meshbound
