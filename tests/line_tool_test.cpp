// SPDX-License-Identifier: MIT
// Line tolerances of the tools beside the rounding of a file.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace line_tool_test {

using testing_tools::run_tool;
using testing_tools::ToolRun;

/// 6 x 6 squares whose corners are no floats.
TriangleMesh uneven_sheet() {
  constexpr std::uint32_t n = 6;
  TriangleMesh sheet;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j)
      sheet.vertices.emplace_back(i + (i % n == 0 ? 0 : 0.2 * std::sin(7 * i + 3 * j)),
                                  j + (j % n == 0 ? 0 : 0.2 * std::sin(5 * i + 11 * j)), 0);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      sheet.triangles.push_back({a, b, b + 1});
      sheet.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return sheet;
}

/// No line keeps its place to 0 where coordinates are rounded to floats. That is said after some seconds.
TEST(LineTool, EndsBelowTheRoundingOfAFile) {
  const testing_tools::TemporaryFolder folder;
  write_mesh(folder / "sheet.ply", uneven_sheet());
  const ToolRun run = run_tool(SIMPLIFY_WITH_BOUND, {folder / "sheet.ply", folder / "out.ply", "--tolerance", "0.3",
                                                     "--line-tolerance", "0", "--single-precision"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("--line-tolerance is smaller than the rounding"), std::string::npos) << run.err;
}

}  // namespace line_tool_test
}  // namespace meshbound
