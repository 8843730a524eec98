// SPDX-License-Identifier: MIT
// simplify_with_bound --dry-run: it ends as the run would before its work, and where rounding to the format of the
// output alone exceeds a tolerance, and leaves nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace dry_run_test {

namespace fs = std::filesystem;
using testing_tools::run_tool;
using testing_tools::ToolRun;

class DryRun : public testing::Test {
 protected:
  DryRun() {
    write_mesh(in("torus.ply"), datasets::torus(1, 0.3, 40, 16));
    write_mesh(in("terrain.ply"), datasets::terrain(1, 20, 3));
  }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  testing_tools::TemporaryFolder folder_;
};

TEST_F(DryRun, RefusesWhatTheRunRefuses) {
  std::ofstream(in("protected.ply")) << "ply";
  fs::permissions(in("protected.ply"), fs::perms::owner_read);
  struct Case {
    std::string mesh, out;
    std::vector<std::string> options;
    int exit_code;
  };
  const std::vector<Case> cases = {
      {"torus.ply", "nosuch/o.ply", {"--tolerance", "1%"}, 2},
      {"torus.ply", "protected.ply", {"--tolerance", "1%"}, 2},
      {"torus.ply", "o.ply", {"--tolerance", "1%", "--certificate", in("nosuch/c")}, 2},
      {"torus.ply", "o.ply", {"--tolerance", "1%", "--levels", "0.5%", "--output-dir", in("protected.ply")}, 2},
      {"torus.ply", "o.ply", {"--tolerance", "1%", "--memory", "1G", "--on-exceed", "stop"}, 2},
      {"torus.ply", "o.glb", {"--tolerance", "1e-12"}, 1},
      {"torus.ply", "o.ply", {"--tolerance", "1e-12", "--single-precision"}, 1},
      {"torus.ply", "o.stl", {"--tolerance", "1%", "--levels", "1e-12"}, 1},
      {"torus.ply", "o.stl", {"--tolerance", "1e-12", "--memory", "1G"}, 1},
      {"terrain.ply", "o.stl", {"--tolerance", "1%", "--line-tolerance", "1e-12"}, 1}};
  const std::size_t before = files();
  for (const auto& [mesh, out, options, exit_code] : cases) {
    std::vector<std::string> arguments{in(mesh), in(out)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ToolRun real = run_tool(SIMPLIFY_WITH_BOUND, arguments);
    arguments.push_back("--dry-run");
    const ToolRun dry = run_tool(SIMPLIFY_WITH_BOUND, arguments);
    EXPECT_EQ(real.exit_code, exit_code) << real.err;
    EXPECT_EQ(dry.exit_code, exit_code) << out << " " << options.back() << ": " << dry.err;
    EXPECT_EQ(dry.err, real.err);
    EXPECT_EQ(dry.out, "");
  }
  EXPECT_EQ(files(), before);
}

TEST_F(DryRun, LeavesNothingWhereTheRunWouldWrite) {
  const std::size_t before = files();
  for (const char* const out : {"o.ply", "o.glb"}) {
    const ToolRun dry =
        run_tool(SIMPLIFY_WITH_BOUND, {in("torus.ply"), in(out), "--tolerance", "1%", "--levels", "1e-7,0.5%",
                                       "--output-dir", in("a/b"), "--certificate", in("c"), "--dry-run"});
    EXPECT_EQ(dry.exit_code, 0) << dry.err;
    EXPECT_NE(dry.out.find("nothing was written"), std::string::npos) << dry.out;
  }
  EXPECT_EQ(files(), before);
}

}  // namespace dry_run_test
}  // namespace meshbound
