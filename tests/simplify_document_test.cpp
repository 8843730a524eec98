// SPDX-License-Identifier: MIT
// What the document of simplify_with_bound says beside the distance: the effort that had an effect, and the input.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/io.h"
#include "tool_refusal.h"

namespace meshbound {
namespace simplify_document_test {

using testing_tools::checked_document;
using testing_tools::expect_refused;
using testing_tools::Json;
using testing_tools::run_tool;
using testing_tools::ToolRun;

class SimplifyDocument : public testing::Test {
 protected:
  SimplifyDocument() { write_mesh(in("in.off"), datasets::torus(1, 0.3, 40, 16)); }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] ToolRun simplify(std::vector<std::string> options) const {
    options.insert(options.begin(), {in("in.off"), in("out.ply"), "--tolerance", "1%", "--json", "-"});
    return run_tool(SIMPLIFY_WITH_BOUND, options);
  }

  testing_tools::TemporaryFolder folder_;
};

TEST_F(SimplifyDocument, NamesTheEffortThatHadAnEffect) {
  EXPECT_EQ(checked_document(simplify({"--effort", "high"}).out)["effort"], "high");
  EXPECT_EQ(checked_document(simplify({"--effort", "high", "--normal-tolerance", "60"}).out)["effort"], "normal");
}

TEST_F(SimplifyDocument, HighEffortDoesNotGoWithAnEndAtTheFirstExcess) {
  expect_refused(simplify({"--effort", "high", "--on-exceed", "stop"}), "leave out one of them");
  expect_refused(run_tool(SIMPLIFY_WITH_BOUND, {"--batch", folder_.path().string(), "--output-dir", in("small"),
                                                "--tolerance", "1%", "--effort", "high", "--on-exceed", "stop"}),
                 "leave out one of them");
  EXPECT_EQ(simplify({"--effort", "high", "--on-exceed", "skip"}).exit_code, 0);
}

TEST_F(SimplifyDocument, SaysWhatBecameOfTheInput) {
  EXPECT_EQ(checked_document(simplify({}).out)["input"],
            Json({{"split", false}, {"dropped_triangles", 0}, {"kept_triangles", 0}}));
  std::ofstream(in("in.off")) << "OFF\n5 5 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n"
                                 "3 0 1 2\n3 0 1 2\n3 1 3 2\n3 0 1 4\n3 4 4 4\n";
  EXPECT_EQ(checked_document(simplify({}).out)["input"],
            Json({{"split", true}, {"dropped_triangles", 2}, {"kept_triangles", 0}}));
}

}  // namespace simplify_document_test
}  // namespace meshbound
