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
namespace {

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
#ifdef CHROMIUM
    std::filesystem::copy_file(MESHBOUND_SOURCE_DIR "/tests/browser/report.mjs", BROWSER_FOLDER "/report.mjs",
                               std::filesystem::copy_options::overwrite_existing);
    const char* const kept = std::getenv("MESHBOUND_SCREENSHOTS");  // a folder, for whoever wants to look at them
    const ToolRun run = run_tool(
        NODE, {BROWSER_FOLDER "/report.mjs", CHROMIUM, report, json, kept != nullptr ? kept : folder_.path().string()},
        300);
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
#else
    (void)report, (void)json;
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

}  // namespace
}  // namespace meshbound
