// SPDX-License-Identifier: MIT
// penetration_depth by its command line: exit codes, JSON against the library and the schema, the file of the parts,
// bad input.
#include <gtest/gtest.h>

#include <filesystem>

#include "json_claims.h"
#include "meshbound/io.h"
#include "meshbound/penetration_depth.h"
#include "reference/small_meshes.h"
#include "solids.h"
#include "tool_refusal.h"

namespace meshbound {
namespace penetration_tool_test {

using namespace testing_tools;
using solids::box;
namespace fs = std::filesystem;

class PenetrationTool : public testing::Test {
 protected:
  PenetrationTool() {
    write_mesh(unit_, box({0, 0, 0}, {1, 1, 1}));
    write_mesh(peg_, box({0.4, 0.4, 0.5}, {0.6, 0.6, 2}));
    write_mesh(sphere_, reference::icosphere(3));
    write_mesh(fork_, reference::both(box({0.1, 0.1, 0.75}, {0.2, 0.9, 3}), box({0.7, 0.1, 0.5}, {0.9, 0.9, 3})));
  }
  static ToolRun run(const std::vector<std::string>& arguments) { return run_tool(PENETRATION_DEPTH, arguments); }

  TemporaryFolder folder_;
  std::string unit_ = folder_ / "unit.off";
  std::string peg_ = folder_ / "peg.ply";
  std::string sphere_ = folder_ / "sphere.obj";
  std::string fork_ = folder_ / "fork.off";
};

const std::string turned = "0 -1 0 0.9  1 0 0 0.2  0 0 1 0.1  0 0 0 1";

TEST_F(PenetrationTool, SaysWhatTheLibrarySays) {
  const ToolRun result = run({sphere_, unit_, "--transform-b", turned, "--json", "-", "--threads", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const Json document = checked_document(result.out);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  pose.translation() << 0.9, 0.2, 0.1;
  const ClosedModel a(read_mesh(sphere_).mesh), b(read_mesh(unit_).mesh);
  const PenetrationDepth expected = penetration_depth(a, {b, pose});
  EXPECT_EQ(document["schema"], "meshbound/penetration/1");
  EXPECT_EQ(document["verdict"], "done");
  EXPECT_EQ(document["contact"], "overlapping");
  ASSERT_EQ(document["volumes"].size(), expected.volumes.size());
  const Json& volume = document["volumes"][0];
  EXPECT_EQ(volume["depth"]["lower"], expected.volumes[0].depth.lower);
  EXPECT_EQ(volume["depth"]["upper"], expected.volumes[0].depth.upper);
  EXPECT_EQ(volume["volume"]["lower"], expected.volumes[0].volume.lower);
  EXPECT_EQ(volume["faces_on_a"], expected.volumes[0].faces_on_a);
  EXPECT_EQ(volume["faces_on_b"], expected.volumes[0].faces_on_b);
  EXPECT_EQ(point_of(volume["witness"]["on_a"]), expected.volumes[0].on_a.position);
  EXPECT_EQ(point_of(volume["witness"]["on_b"]), expected.volumes[0].on_b.position);
  EXPECT_EQ(document["depth"]["upper"], expected.depth.upper);
  EXPECT_EQ(document["threads"], 1);
  EXPECT_EQ(document["provenance"]["tool"], "penetration_depth");
}

TEST_F(PenetrationTool, PrintsEachVolume) {
  const ToolRun result = run({unit_, fork_});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* text : {"\nvolume 0    depth [0.4999", "\nvolume 1    depth [0.2499", "\ncontact     overlapping\n",
                           "\nverdict     done\n", " faces on A, "})
    EXPECT_NE(result.out.find(text), std::string::npos) << text << "\n" << result.out;
  EXPECT_EQ(run({unit_, fork_, "--quiet"}).out, "");
}

TEST_F(PenetrationTool, DecidesByExitCode) {
  const ToolRun within = run({unit_, peg_, "--tolerance", "0.6", "--json", "-"});
  EXPECT_EQ(within.exit_code, 0);
  EXPECT_EQ(checked_document(within.out)["verdict"], "within");
  const ToolRun exceeds = run({unit_, peg_, "--tolerance", "0.4", "--quiet"});
  EXPECT_EQ(exceeds.exit_code, 1);
  EXPECT_EQ(exceeds.err.rfind("FAIL 0.", 0), 0U) << exceeds.err;
  EXPECT_EQ(line_count(exceeds.err), 1);
  const ToolRun deep =
      run({sphere_, sphere_, "--transform-b", "1 0 0 1.5  0 1 0 0  0 0 1 0.2  0 0 0 1", "--tolerance", "0.1"});
  EXPECT_NE(deep.out.find("% or more of the diagonal\n"), std::string::npos) << deep.out;
  EXPECT_EQ(deep.out.find("inf"), std::string::npos) << deep.out;
  const ToolRun undecided = run({unit_, peg_, "--tolerance", "0.5"});
  EXPECT_EQ(undecided.exit_code, 3) << "the depth is the tolerance, up to rounding";
  // 20% of the diagonal of A is 0.346.
  EXPECT_EQ(run({unit_, peg_, "--tolerance", "20%", "--quiet"}).exit_code, 1);
  EXPECT_EQ(run({unit_, peg_, "--tolerance", "40%", "--quiet"}).exit_code, 0);
}

TEST_F(PenetrationTool, SaysTouchingAndApart) {
  const auto contact = [&](const std::string& shift) {
    const ToolRun result =
        run({unit_, unit_, "--transform-b", "1 0 0 " + shift + " 0 1 0 0 0 0 1 0 0 0 0 1", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Json document = checked_document(result.out);
    EXPECT_EQ(document["volumes"].size(), 0U);
    EXPECT_EQ(document["depth"]["upper"], 0.0);
    return document["contact"].get<std::string>();
  };
  EXPECT_EQ(contact("1"), "touching");
  EXPECT_EQ(contact("1.0000000000000002"), "none");
}

TEST_F(PenetrationTool, MovesEitherModel) {
  const std::string there = "1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1", back = "1 0 0 -5  0 1 0 0  0 0 1 0  0 0 0 1";
  const Json still = checked_document(run({unit_, peg_, "--json"}).out);
  const Json moved_a =
      checked_document(run({unit_, peg_, "--transform-a", there, "--transform-b", there, "--json"}).out);
  EXPECT_NEAR(moved_a["depth"]["upper"], still["depth"]["upper"], 1e-6);
  EXPECT_EQ(checked_document(run({unit_, peg_, "--transform-a", back, "--json"}).out)["contact"], "none");
}

/// Maps that are no rigid motions are applied to the vertices first.
TEST_F(PenetrationTool, TakesAnyAffineMap) {
  const ToolRun scaled = run({unit_, peg_, "--transform-b", "1 0 0 0  0 1 0 0  0 0 0.5 0.5  0 0 0 1", "--json"});
  EXPECT_EQ(scaled.exit_code, 0) << scaled.err;
  const Json document = checked_document(scaled.out);
  EXPECT_NEAR(document["depth"]["upper"], 0.25, 1e-5);
  EXPECT_TRUE(document["b"].contains("transform_displacement"));
  // Mirrored, which turns the triangles over.
  const ToolRun mirrored = run({unit_, peg_, "--transform-b", "-1 0 0 1  0 1 0 0  0 0 1 0  0 0 0 1", "--json"});
  EXPECT_NEAR(checked_document(mirrored.out)["depth"]["upper"], 0.5, 1e-5) << mirrored.err;
  expect_refused(run({unit_, peg_, "--transform-b", "1 0 0 0  0 1 0 0  0 0 0 0  0 0 0 1"}), "peg.ply: ");
}

TEST_F(PenetrationTool, WritesThePartsForViewers) {
  const std::string obj = folder_ / "parts.obj", ply = folder_ / "parts.ply";
  ASSERT_EQ(run({unit_, fork_, "--output", obj, "--quiet"}).exit_code, 0);
  const std::string text = content_of(obj);
  for (const char* group :
       {"g volume_0_on_a\n", "g volume_0_on_b\n", "g volume_0_witness\n", "g volume_1_witness\n", "\nl "})
    EXPECT_NE(text.find(group), std::string::npos) << group;
  const TriangleMesh from_obj = read_mesh(obj).mesh;
  ASSERT_EQ(run({unit_, fork_, "--output", ply, "--quiet"}).exit_code, 0);
  const TriangleMesh from_ply = read_mesh(ply).mesh;
  EXPECT_NE(content_of(ply).find("element edge 2\n"), std::string::npos);
  EXPECT_EQ(from_obj.triangles, from_ply.triangles);
  EXPECT_EQ(from_obj.vertices, from_ply.vertices);
  PenetrationOptions options;
  options.keep_parts = true;
  const PenetrationDepth depth = penetration_depth(read_mesh(unit_).mesh, read_mesh(fork_).mesh, options);
  std::size_t triangles = 0;
  for (const PenetrationVolume& volume : depth.volumes)
    triangles += volume.parts->on_a.triangles.size() + volume.parts->on_b.triangles.size();
  EXPECT_EQ(from_obj.triangles.size(), triangles);
}

TEST_F(PenetrationTool, RefusesOutputsBeforeAnyWork) {
  expect_refused(run({unit_, peg_, "--output", folder_ / "parts.stl"}), "neither .obj nor .ply");
  expect_refused(run({unit_, peg_, "--output", peg_}), "peg.ply");
  expect_refused(run({unit_, peg_, "--output", folder_ / "missing" / "parts.obj"}), "missing");
  EXPECT_GT(fs::file_size(peg_), 100U);
}

TEST_F(PenetrationTool, RefusesWhatBoundsNoSolid) {
  TriangleMesh open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  const std::string path = folder_ / "bad.off";
  write_mesh(path, open);
  expect_refused(run({unit_, path}), "bad.off: the mesh is open");
  expect_refused(run({path, unit_}), "bad.off: the mesh is open");
  write_mesh(path, solids::reversed(box({0, 0, 0}, {1, 1, 1})));
  expect_refused(run({unit_, path}), "inside out");
  write_mesh(path, reference::both(box({0, 0, 0}, {1, 1, 1}), box({0.5, 0.5, 0.5}, {2, 2, 2})));
  expect_refused(run({unit_, path}), "intersects itself");
  TriangleMesh turned_one = box({0, 0, 0}, {1, 1, 1});
  std::swap(turned_one.triangles[0][0], turned_one.triangles[0][1]);
  write_mesh(path, turned_one);
  expect_refused(run({unit_, path}), "not consistently oriented");
}

TEST_F(PenetrationTool, IsUndecidedWhenTheTimeIsOver) {
  const ToolRun result = run({unit_, peg_, "--time-limit", "0", "--json", "-"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  const Json document = checked_document(result.out);
  EXPECT_EQ(document["verdict"], "undecided");
  EXPECT_EQ(document["contact"], "unknown");
  EXPECT_EQ(document["depth"]["lower"], 0);
  EXPECT_TRUE(document["depth"]["upper"].is_null());
}

TEST_F(PenetrationTool, RefusesBadUsage) {
  expect_refused(run({unit_}), "B is required");
  expect_refused(run({unit_, folder_ / "absent.off"}), "absent.off");
  expect_refused(run({unit_, peg_, "--error-bound", "-1"}), "--error-bound");
  expect_refused(run({unit_, peg_, "--transform-a", "1 2 3"}), "--transform-a");
  expect_refused(run({unit_, peg_, "--transform-c", "1"}), "did you mean --transform-a or --transform-b?");
}

}  // namespace penetration_tool_test
}  // namespace meshbound
