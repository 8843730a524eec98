// SPDX-License-Identifier: MIT
// What the tools answer to command lines that do not say what was meant: one line that names what is wrong and what to
// write instead.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "meshbound/io.h"
#include "tool_refusal.h"

namespace meshbound {
namespace wrong_arguments_test {

using testing_tools::expect_refused;
using testing_tools::run_tool;
using testing_tools::ToolRun;

class WrongArguments : public testing::Test {
 protected:
  WrongArguments() { write_mesh(in("in.off"), datasets::torus(1, 0.3, 40, 16)); }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] ToolRun simplify(std::vector<std::string> options) const {
    options.insert(options.begin(), {in("in.off"), in("out.ply")});
    return run_tool(SIMPLIFY_WITH_BOUND, options);
  }

  testing_tools::TemporaryFolder folder_;
};

TEST_F(WrongArguments, LengthsThatAreNoneAreRefusedWithoutAWrongNumber) {
  expect_refused(simplify({"--tolerance", "1,5"}), "'1,5' is not a length; write 1.5");
  expect_refused(simplify({"--tolerance", "0,1%"}), "'0,1%' is not a length; write 0.1%");
  expect_refused(simplify({"--tolerance", "1,5mm"}), "give the number in the unit of the file (1.5)");
  for (const char* length : {"1/2", "1,000,000", "0.1.2", "1-2"})
    expect_refused(simplify({"--tolerance", length}), "give a number in model units (0.5)");
}

TEST_F(WrongArguments, TheFormatOfTheOutputIsToBlameForTextureThatIsNotKept) {
  std::ofstream(in("t.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n";
  for (const std::string extension : {".stl", ".off"})
    expect_refused(run_tool(SIMPLIFY_WITH_BOUND,
                            {in("t.obj"), in("out" + extension), "--tolerance", "1%", "--texture-tolerance", "1x"}),
                   "the format of the output, " + extension + ", does not carry");
  expect_refused(
      run_tool(LOD_CHAIN, {in("t.obj"), in("chain"), "--levels", "1%", "--texture-tolerance", "1x", "--format", "stl"}),
      "the format of the output, .stl, does not carry");
  expect_refused(
      run_tool(SIMPLIFY_WITH_BOUND, {in("t.obj"), in("out.obj"), "--tolerance", "1%", "--memory", "1G", "--strict"}),
      "--memory and MPI work on bare triangles");
}

TEST_F(WrongArguments, OptionsOfSeveralValuesLeaveTheFilesBehindThem) {
  EXPECT_EQ(run_tool(SIMPLIFY_WITH_BOUND, {"--tolerance", "1%", "--levels", "0.1%,0.5%", in("in.off"), in("o.ply")})
                .exit_code,
            0);
  EXPECT_TRUE(std::filesystem::exists(in("o_level_1.ply")));
  EXPECT_EQ(run_tool(LOD_CHAIN, {"--levels", "0.1%", "--levels", "0.5%,1%", in("in.off"), in("a")}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(in("a/lod_2.ply")));
  EXPECT_EQ(run_tool(LOD_CHAIN, {"--pixels", "1,2", "--distances", "3", in("in.off"), in("b")}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(in("b/lod_1.ply")));
}

TEST_F(WrongArguments, NumbersOutOfRangeAreRefusedWithTheirRange) {
  const auto refused = [&](const std::string& option, const std::string& value, const std::string& wanted) {
    const ToolRun run = simplify({"--tolerance", "1%", option, value});
    expect_refused(run, "'" + value + "' is not a number of " + wanted);
    EXPECT_LT(run.err.size(), 150u) << run.err;
  };
  for (const char* const faces : {"-5", "many", "1.5"}) refused("--target-faces", faces, "faces, 0 or more");
  for (const char* const size : {"0", "-1", "inf", "nan", "1k"}) refused("--texture-size", size, "texels, more than 0");
  for (const char* const option : {"--feature-angle", "--normal-tolerance"})
    for (const char* const angle : {"30deg", "-1", "181", "nan"}) refused(option, angle, "degrees from 0 to 180");
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("in.off"), "--texture", "--texture-size", "0"}),
                 "'0' is not a number of texels, more than 0");
}

TEST_F(WrongArguments, LimitsOfMemoryBelowAMebibyteHaveLostTheirUnit) {
  const std::string off = in("in.off");
  for (const auto& [limit, why] :
       {std::pair{"4", "4 is 4 bytes; did you mean 4G?"}, std::pair{"1000", "1000 is 1000 bytes; did you mean 1000G?"},
        std::pair{"4K", "less than 1 MiB; did you mean 4G?"}}) {
    expect_refused(simplify({"--tolerance", "1%", "--memory", limit}), why);
    expect_refused(run_tool(HAUSDORFF_DISTANCE, {off, off, "--memory", limit}), why);
    expect_refused(run_tool(SIMPLIFY_WITH_BOUND, {"--batch", folder_.path().string(), "--output-dir", in("small"),
                                                  "--tolerance", "1%", "--memory-limit", limit}),
                   why);
  }
}

TEST_F(WrongArguments, AnEstimateHasNoDocument) {
  expect_refused(simplify({"--tolerance", "1%", "--dry-run", "--json", in("r.json")}), "--dry-run prints an estimate");
  EXPECT_FALSE(std::filesystem::exists(in("r.json")));
}

TEST_F(WrongArguments, SayWhyNothingCollapsed) {
  std::ofstream(in("one.off")) << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const ToolRun run =
      run_tool(SIMPLIFY_WITH_BOUND, {in("one.off"), in("out.ply"), "--tolerance", "1%", "--preserve-boundary"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("every vertex is locked"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("out.ply, 1 face, "), std::string::npos) << run.out;
}

TEST_F(WrongArguments, AFileIsNoFolderForResults) {
  std::ofstream(in("file.ply")) << "ply";
  expect_refused(run_tool(LOD_CHAIN, {in("in.off"), in("file.ply"), "--levels", "1%"}),
                 "file.ply is a file; name a folder");
}

}  // namespace wrong_arguments_test
}  // namespace meshbound
