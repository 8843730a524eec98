// SPDX-License-Identifier: MIT
// Reports as a reader sees them: tests/browser/report.mjs opens them in headless Chromium, holds what they show against
// the JSON document, and uses every control.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "datasets/analytic_meshes.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace report_browser_test {

using namespace testing_tools;

class ReportInABrowser : public testing::Test {
 protected:
  void SetUp() override {
#ifndef CHROMIUM
    GTEST_SKIP() << "the build was configured without Chromium, or without npm";
#endif
  }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }

  void expect_faultless(const std::string& report, const std::string& json) const {
    look_at(report, json, {REPORT_MEASUREMENT});
  }
  /// Only that the page of r.html "repeats" the measurement of r.json, or "refuses" and says why.
  void expect_measurement(const std::string& measurement) const {
    look_at(in("r.html"), in("r.json"), {measurement, "alone"});
  }

 private:
  void look_at(const std::string& report, const std::string& json, const std::vector<std::string>& more) const {
#ifdef CHROMIUM
    std::filesystem::copy_file(MESHBOUND_SOURCE_DIR "/tests/browser/report.mjs", BROWSER_FOLDER "/report.mjs",
                               std::filesystem::copy_options::overwrite_existing);
    const char* const kept = std::getenv("MESHBOUND_SCREENSHOTS");  // a folder, for whoever wants to look at them
    std::vector<std::string> arguments = {BROWSER_FOLDER "/report.mjs", CHROMIUM, report, json,
                                          kept != nullptr ? kept : folder_.path().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ToolRun run = run_tool(NODE, arguments, 300);
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
#else
    (void)report, (void)json, (void)more;
#endif
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReportInABrowser, ShowsAResultWithItsLevels) {
  write_mesh(in("in.off"), datasets::torus(1, 0.3, 80, 32));
  const ToolRun run =
      run_tool(SIMPLIFY_WITH_BOUND, {in("in.off"), in("out.ply"), "--tolerance", "0.02", "--levels", "0.002,0.008",
                                     "--units", "mm", "--report", in("r.html"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  expect_faultless(in("r.html"), in("r.json"));
}

TEST_F(ReportInABrowser, ShowsAChainOfLevels) {
  write_mesh(in("in.off"), datasets::torus(1, 0.3, 80, 32));
  const ToolRun run = run_tool(LOD_CHAIN, {in("in.off"), in("lods"), "--levels", "0.002,0.008,0.02", "--units", "mm",
                                           "--report", in("r.html"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  expect_faultless(in("r.html"), in("r.json"));
}

TEST_F(ReportInABrowser, ShowsADistanceThatExceedsATolerance) {
  write_mesh(in("a.off"), datasets::gear(1, 0.4, 12, 12, 4));
  write_mesh(in("b.off"), datasets::gear(1.02, 0.4, 12, 12, 4));
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in("a.off"), in("b.off"), "--tolerance", "0.015", "--worst",
                                                    "--report", in("r.html"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 1) << run.err;
  expect_faultless(in("r.html"), in("r.json"));
}

/// With a decision before the measurement, only one direction, and coordinates that floats do not hold.
TEST_F(ReportInABrowser, RepeatsMeasurementsOfEveryKind) {
  write_mesh(in("a.off"), datasets::torus(1, 0.3, 60, 24));
  write_mesh(in("b.off"), datasets::torus(1.001, 0.3, 50, 20));
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--tolerance", "0.02"},
                                             {"--one-sided"},
                                             {"--tolerance", "0.02", "--error-bound", "0.001"},
                                             {"--tolerance", "0.001"}}) {
    std::vector<std::string> arguments{in("a.off"), in("b.off"), "--report", in("r.html"), "--json", in("r.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_LE(run_tool(HAUSDORFF_DISTANCE, arguments).exit_code, 1);
    expect_measurement(REPORT_MEASUREMENT);
  }
}

TEST_F(ReportInABrowser, SaysWhyItDoesNotMeasure) {
  write_mesh(in("a.off"), datasets::torus(1, 0.3, 60, 24));
  write_mesh(in("b.off"), datasets::torus(1.001, 0.3, 50, 20));
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in("a.off"), in("b.off"), "--method", "cross-culling", "--report",
                                                    in("r.html"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  expect_measurement("refuses");
}

/// Meshes that are too large to be in it are files that the reader chooses, the right ones by their checksums.
TEST_F(ReportInABrowser, StaysBelow20Megabytes) {
  write_mesh(in("a.ply"), datasets::torus(1, 0.3, 700, 250));
  write_mesh(in("b.ply"), datasets::torus(1, 0.3, 690, 250));
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in("a.ply"), in("b.ply"), "--error-bound", "1%", "--report",
                                                    in("r.html"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(std::filesystem::file_size(in("r.html")), 20'000'000U);
  const bool has_engine = std::string(REPORT_MEASUREMENT) == "repeats";
  expect_measurement(has_engine ? "chooses" : "refuses");
}

}  // namespace report_browser_test
}  // namespace meshbound
