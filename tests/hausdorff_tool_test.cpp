// SPDX-License-Identifier: MIT
// hausdorff_distance by its command line: exit codes, JSON against the library and the schema, bad input.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "datasets.h"
#include "json_claims.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "reference/small_meshes.h"
#include "run_tool.h"

namespace meshbound {
namespace hausdorff_tool_test {

using nlohmann::json;
using namespace testing_tools;
namespace fs = std::filesystem;

const std::string shifted = "1 0 0 0.25  0 1 0 0  0 0 1 0  0 0 0 1";

class HausdorffTool : public testing::Test {
 protected:
  HausdorffTool() {
    write_mesh(cube_, reference::cube(1));
    write_mesh(large_, reference::cube(2));
    write_mesh(sphere_, reference::icosphere(3));
    write_mesh(soup_, reference::random_soup(1, 100, 0.4));
  }
  static ToolRun run(const std::vector<std::string>& arguments) { return run_tool(HAUSDORFF_DISTANCE, arguments); }
  static void expect_one_line_and_exit_2(const ToolRun& result) {
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    EXPECT_EQ(result.out, "");
  }

  TemporaryFolder folder_;
  std::string cube_ = folder_ / "cube.off";
  std::string large_ = folder_ / "large.ply";
  std::string sphere_ = folder_ / "sphere.obj";
  std::string soup_ = folder_ / "soup.off";
};

json parsed(const ToolRun& result) { return checked_document(result.out); }

TEST_F(HausdorffTool, SaysWhatTheLibrarySays) {
  const ToolRun result = run({sphere_, soup_, "--json", "-", "--threads", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const json document = parsed(result);
  const TriangleMesh a = read_mesh(sphere_).mesh, b = read_mesh(soup_).mesh;
  const HausdorffDistance expected = hausdorff_distance(Bvh(a), Bvh(b));
  EXPECT_EQ(document["schema"], "meshbound/distance/1");
  EXPECT_EQ(document["verdict"], "done");
  EXPECT_EQ(document["distance"]["lower"], expected.bounds.lower);
  EXPECT_EQ(document["distance"]["upper"], expected.bounds.upper);
  EXPECT_EQ(document["distance"]["a_to_b"]["upper"], expected.a_to_b.bounds.upper);
  EXPECT_EQ(document["distance"]["b_to_a"]["witness"]["from"][0], expected.b_to_a.witness.from.position.x());
  EXPECT_EQ(document["a"]["faces"], a.triangles.size());
  EXPECT_EQ(document["a"]["closed"], true);
  EXPECT_EQ(document["b"]["components"], 100);
  EXPECT_EQ(document["a"]["bbox_diagonal"], bounding_box_diagonal(a));
  EXPECT_EQ(document["error_bound"], 1e-6 * bounding_box_diagonal(a));
  EXPECT_EQ(document["threads"], 1);
}

TEST_F(HausdorffTool, DecidesByExitCode) {
  const ToolRun within = run({cube_, large_, "--tolerance", "1.8", "--json", "-"});
  EXPECT_EQ(within.exit_code, 0);
  EXPECT_EQ(parsed(within)["verdict"], "within");
  EXPECT_EQ(parsed(within)["tolerance"]["absolute"], 1.8);
  const ToolRun exceeds = run({cube_, large_, "--tolerance", "1.7", "--json", "-"});
  EXPECT_EQ(exceeds.exit_code, 1);
  EXPECT_EQ(parsed(exceeds)["verdict"], "exceeds");
  EXPECT_EQ(run({cube_, large_, "--tolerance", "1.1", "--one-sided"}).exit_code, 0);
  EXPECT_EQ(run({cube_, large_, "--tolerance", "0.9", "--one-sided"}).exit_code, 1);
  const ToolRun out_of_time = run({sphere_, soup_, "--time-limit", "0", "--error-bound", "1e-9", "--json", "-"});
  EXPECT_EQ(out_of_time.exit_code, 3);
  EXPECT_EQ(parsed(out_of_time)["verdict"], "undecided");
}

TEST_F(HausdorffTool, MeasuresAndDecidesAtOnce) {
  const ToolRun result = run({cube_, large_, "--tolerance", "1.8", "--error-bound", "1e-7", "--json", "-"});
  EXPECT_EQ(result.exit_code, 0);
  const json distance = parsed(result)["distance"];
  EXPECT_LE(distance["upper"].get<double>() - distance["lower"].get<double>(), 1e-7);
  EXPECT_EQ(run({cube_, large_, "--tolerance", "1.7", "--error-bound", "1e-7"}).exit_code, 1);
}

TEST_F(HausdorffTool, TakesPercentagesOfTheDiagonalOfA) {
  const double diagonal = 2 * std::sqrt(3.0);
  const json document = parsed(run({cube_, large_, "--tolerance", "60%", "--error-bound", "1%", "--json", "-"}));
  EXPECT_NEAR(document["tolerance"]["absolute"].get<double>(), 0.6 * diagonal, 1e-14);
  EXPECT_NEAR(document["tolerance"]["percent_of_diagonal"].get<double>(), 60, 1e-12);
  EXPECT_NEAR(document["error_bound"].get<double>(), 0.01 * diagonal, 1e-14);
  EXPECT_NE(run({cube_, large_, "--tolerance", "60%"}).out.find("60% of the diagonal"), std::string::npos);
}

TEST_F(HausdorffTool, TransformsB) {
  std::ofstream(folder_ / "matrix.txt") << "1 0 0 0.25\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  for (const std::string& matrix : {shifted, std::string(folder_ / "matrix.txt")}) {
    const json document = parsed(run({cube_, cube_, "--transform-b", matrix, "--json", "-"}));
    EXPECT_LE(document["distance"]["lower"], 0.25);
    EXPECT_GE(document["distance"]["upper"], 0.25);
    EXPECT_EQ(document["b"]["transform_displacement"], 0);
  }
  // Not rigid: the cube of half 1 becomes the one of half 2. A rounded map widens the interval by what it may move.
  EXPECT_EQ(run({large_, cube_, "--transform-b", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1", "--tolerance", "0"}).exit_code, 0);
  const json rounded =
      parsed(run({sphere_, sphere_, "--transform-b", "0.1 0 0 0.3 0 0.1 0 0 0 0 0.1 0 0 0 0 1", "--json", "-"}));
  EXPECT_GT(rounded["b"]["transform_displacement"], 0);
}

TEST_F(HausdorffTool, BuildsNoTreesForACopyThatHasHardlyMoved) {
  TriangleMesh copy = read_mesh(sphere_).mesh;
  for (Eigen::Vector3d& p : copy.vertices) p = p.cast<float>().cast<double>();
  const std::string rounded = folder_ / "rounded.off";
  write_mesh(rounded, copy);
  for (const std::vector<std::string>& asked : {std::vector<std::string>{}, {"--one-sided"}, {"--tolerance", "1e-6"}}) {
    std::vector<std::string> arguments{sphere_, rounded, "--json", "-"};
    arguments.insert(arguments.end(), asked.begin(), asked.end());
    const ToolRun result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json document = parsed(result);
    EXPECT_EQ(document["seconds"]["build"], 0.0);
    EXPECT_LE(document["distance"]["upper"], 2e-7);
    EXPECT_GT(document["distance"]["upper"], 1e-9);
  }
  EXPECT_EQ(run({sphere_, rounded, "--tolerance", "1e-10"}).exit_code, 1);
  EXPECT_GT(parsed(run({sphere_, cube_, "--json", "-"}))["seconds"]["build"], 0.0);
}

/// The second direction is cut short by the first one's lower bound, and has a witness of its own nevertheless.
TEST_F(HausdorffTool, BothWitnessesEndAtTheClosestPoint) {
  const TriangleMesh sphere = read_mesh(sphere_).mesh, soup = read_mesh(soup_).mesh, cube = read_mesh(cube_).mesh;
  const auto expect_both = [&](const std::vector<std::string>& arguments, const TriangleMesh& a,
                               const TriangleMesh& b) {
    const json distance = parsed(run(arguments))["distance"];
    expect_nearest(distance["a_to_b"], b);
    if (distance["b_to_a"]["searched"]) expect_nearest(distance["b_to_a"], a);
  };
  for (const std::string method : {"cell-walking", "cross-culling"}) {
    SCOPED_TRACE(method);
    expect_both({sphere_, soup_, "--json", "-", "--method", method}, sphere, soup);
    expect_both({soup_, sphere_, "--json", "-", "--method", method}, soup, sphere);
    expect_both({soup_, sphere_, "--json", "-", "--method", method, "--tolerance", "5"}, soup, sphere);
    expect_both({soup_, sphere_, "--json", "-", "--method", method, "--tolerance", "0.01"}, soup, sphere);
    expect_both({cube_, sphere_, "--json", "-", "--method", method}, cube, sphere);
    expect_both({cube_, cube_, "--json", "-", "--method", method}, cube, cube);
  }
}

TEST_F(HausdorffTool, LeavesOutWhatWasNotAskedFor) {
  const json document = parsed(run({cube_, large_, "--one-sided", "--json", "-"}));
  expect_nearest(document["distance"]["a_to_b"], read_mesh(large_).mesh);
  EXPECT_FALSE(document["distance"].contains("b_to_a"));
  EXPECT_LE(document["distance"]["lower"], 1);
  EXPECT_GE(document["distance"]["upper"], 1);
}

TEST_F(HausdorffTool, WritesJsonToAFileAndASummaryToStdout) {
  const ToolRun result = run({cube_, large_, "--json", folder_ / "out.json"});
  EXPECT_NE(result.out.find("distance    ["), std::string::npos);
  EXPECT_EQ(json::parse(content_of(folder_ / "out.json"))["schema"], "meshbound/distance/1");
  const ToolRun quiet = run({cube_, large_, "--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_EQ(quiet.exit_code, 0);
}

TEST_F(HausdorffTool, PrintsAProfileWhenAsked) {
  const ToolRun plain = run({sphere_, soup_});
  EXPECT_EQ(plain.out.find("culled on A"), std::string::npos);
  const ToolRun profiled = run({sphere_, soup_, "--profile"});
  EXPECT_EQ(profiled.exit_code, 0) << profiled.err;
  for (const char* part : {"profile A to B", "profile B to A", "culled on B", "subdivisions into", "culling on A"})
    EXPECT_NE(profiled.out.find(part), std::string::npos) << part;
  const json stats = parsed(run({sphere_, soup_, "--json", "-", "--threads", "1"}))["stats"];
  EXPECT_GT(stats["pieces"], 0);
  EXPECT_GT(stats["phase_seconds"]["subdivision"], 0.0);
}

TEST_F(HausdorffTool, MeasuresByThePapersMethodToo) {
  const json walked = parsed(run({cube_, soup_, "--json", "-", "--error-bound", "1e-3"}))["distance"];
  const json paper =
      parsed(run({cube_, soup_, "--json", "-", "--error-bound", "1e-3", "--method", "cross-culling"}))["distance"];
  EXPECT_LE(walked["lower"], paper["upper"]);
  EXPECT_LE(paper["lower"], walked["upper"]);
  EXPECT_NE(walked["a_to_b"]["upper"], paper["a_to_b"]["upper"]) << "the method made no difference at all";
  const ToolRun unknown = run({cube_, soup_, "--method", "guessing"});
  expect_one_line_and_exit_2(unknown);
  EXPECT_NE(unknown.err.find("guessing not in {cell-walking,cross-culling}"), std::string::npos) << unknown.err;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n') + 1;
  return text.substr(text.rfind('\n', end - 1) + 1, end - text.rfind('\n', end - 1) - 1);
}

/// The corners of the large cube are sqrt(3) from the small one, and no point of the small one is further than 1 from
/// the large one.
TEST_F(HausdorffTool, NamesTheWorstSpotItKnowsOfAFailedGateInItsLastLine) {
  const std::vector<std::string> gate = {large_, cube_, "--tolerance", "1.5"};
  const ToolRun failed = run(gate);
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "");
  const std::regex form("FAIL 1\\.\\d+ > 1\\.5 at \\(\\S+ \\S+ \\S+\\), triangle \\d+");
  EXPECT_TRUE(std::regex_match(last_line(failed.out), form)) << failed.out;
  EXPECT_NE(failed.out.find("  B to A not searched\n"), std::string::npos) << failed.out;
  EXPECT_NE(failed.out.find("distance    at least 1."), std::string::npos) << failed.out;
  EXPECT_EQ(failed.out.find("inf"), std::string::npos) << failed.out;

  const ToolRun quiet = run({large_, cube_, "--tolerance", "1.5", "--quiet"});
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, last_line(failed.out) + "\n");
  const json document = parsed(run({large_, cube_, "--tolerance", "1.5", "--json", "-"}));
  EXPECT_EQ(document["outcome"], "exceeds");
  EXPECT_EQ(document["distance"]["a_to_b"]["outcome"], "exceeds");
  EXPECT_EQ(document["distance"]["b_to_a"], json({{"lower", 0.0}, {"upper", nullptr}, {"searched", false}}));
  EXPECT_EQ(document["worst"]["direction"], "a_to_b");
  EXPECT_EQ(document["worst"]["point"], document["distance"]["a_to_b"]["witness"]["from"]);
  EXPECT_EQ(document["worst"]["triangle"], document["distance"]["a_to_b"]["witness"]["from_triangle"]);
  EXPECT_EQ(document["worst"]["distance"], json({{"lower", document["distance"]["lower"]}, {"upper", nullptr}}));
}

/// However close the distance is to the tolerance, the line shows which of them is larger.
TEST_F(HausdorffTool, ShowsTheDigitsThatMakeAGateFail) {
  const std::string line = last_line(run({cube_, large_, "--one-sided", "--tolerance", "0.999999999"}).out);
  double distance = 0, tolerance = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "FAIL %lf > %lf at", &distance, &tolerance), 2) << line;
  EXPECT_GT(distance, tolerance) << line;
}

TEST_F(HausdorffTool, FindsTheWorstSpotAfterTheDecisionWhenAsked) {
  const double truth = std::sqrt(3.0), error_bound = 2e-6 * truth;
  for (const std::string tolerance : {"0.9", "1.8"}) {
    SCOPED_TRACE(tolerance);
    const ToolRun result = run({cube_, large_, "--tolerance", tolerance, "--worst", "--json", folder_ / "worst.json"});
    EXPECT_EQ(result.exit_code, tolerance == "0.9" ? 1 : 0);
    EXPECT_NE(result.out.find("worst spot  ("), std::string::npos) << result.out;
    const json document = checked_document(content_of(folder_ / "worst.json"));
    EXPECT_EQ(document["verdict"], tolerance == "0.9" ? "exceeds" : "within");
    EXPECT_EQ(document["outcome"], "converged");
    EXPECT_EQ(document["worst"]["direction"], "b_to_a");
    EXPECT_EQ(document["worst"]["distance"]["upper"], document["distance"]["upper"]);
    EXPECT_NEAR(document["worst"]["distance"]["lower"].get<double>(), truth, error_bound);
    EXPECT_LE(document["distance"]["upper"].get<double>() - document["distance"]["lower"].get<double>(),
              document["error_bound"].get<double>());
    for (const json& coordinate : document["worst"]["point"]) EXPECT_NEAR(std::abs(coordinate.get<double>()), 2, 1e-5);
  }
  const std::string line = last_line(run({cube_, large_, "--tolerance", "0.9", "--worst"}).out);
  EXPECT_EQ(line.rfind("FAIL 1.73205 > 0.9 at (", 0), 0u) << line;
  EXPECT_EQ(line.substr(line.size() - 5), " of B") << line;
  EXPECT_NE(run({cube_, large_, "--worst"}).out.find("worst spot  ("), std::string::npos);
  EXPECT_EQ(run({cube_, large_, "--tolerance", "1.8", "--worst", "--quiet"}).err, "");
}

/// Doubles near 1 are 2e-16 apart: no interval can be as narrow as the second of these.
TEST_F(HausdorffTool, SaysDoneOnlyWhenTheIntervalIsAsNarrowAsAsked) {
  const json done = parsed(run({sphere_, soup_, "--error-bound", "1e-9", "--json", "-"}));
  EXPECT_EQ(done["verdict"], "done");
  EXPECT_EQ(done["outcome"], "converged");
  EXPECT_FALSE(done.contains("reason"));
  EXPECT_LE(done["distance"]["upper"].get<double>() - done["distance"]["lower"].get<double>(), 1e-9);
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--one-sided"}}) {
    std::vector<std::string> arguments{sphere_, soup_, "--error-bound", "1e-18"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ToolRun text = run(arguments);
    EXPECT_EQ(text.exit_code, 3);
    EXPECT_TRUE(std::regex_match(last_line(text.out), std::regex("UNDECIDED width \\S+ > 1e-18: .+"))) << text.out;
    arguments.insert(arguments.end(), {"--json", "-"});
    const json precise = parsed(run(arguments));
    EXPECT_EQ(precise["verdict"], "undecided");
    EXPECT_EQ(precise["outcome"], "precision");
    EXPECT_NE(precise["reason"], "");
  }
}

/// The default error bound is no exception: two specks far apart differ by less than doubles of that size tell.
TEST_F(HausdorffTool, TheDefaultErrorBoundMustBeReachedToo) {
  TriangleMesh speck = reference::cube(1e-9);
  write_mesh(folder_ / "speck.off", speck);
  for (Eigen::Vector3d& p : speck.vertices) p.x() += 1000;
  write_mesh(folder_ / "far.off", speck);
  const ToolRun result = run({folder_ / "speck.off", folder_ / "far.off", "--json", "-"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(parsed(result)["outcome"], "precision");
}

TEST_F(HausdorffTool, SaysThatTheTimeLimitEndedIt) {
  for (const std::vector<std::string>& asked :
       {std::vector<std::string>{"--error-bound", "1e-9"}, {}, {"--tolerance", "1"}}) {
    std::vector<std::string> arguments{sphere_, soup_, "--time-limit", "0"};
    arguments.insert(arguments.end(), asked.begin(), asked.end());
    const ToolRun text = run(arguments);
    EXPECT_EQ(text.exit_code, 3);
    EXPECT_NE(last_line(text.out).find("the time limit came first"), std::string::npos) << text.out;
    arguments.insert(arguments.end(), {"--json", "-"});
    EXPECT_EQ(parsed(run(arguments))["outcome"], "budget");
    arguments.insert(arguments.end(), {"--quiet"});
    EXPECT_EQ(run(arguments).err, last_line(text.out) + "\n");
  }
}

/// The matrix comes late, through a FIFO: no trees are built for an answer that nobody waits for any more.
TEST_F(HausdorffTool, SearchesNothingWhenTheTimeIsLongOver) {
  const std::string late = folder_ / "late.txt";
  ASSERT_EQ(mkfifo(late.c_str(), 0600), 0);
  const std::string writer = "(sleep 0.5; echo " + shell_quoted(shifted) + " > " + shell_quoted(late) + ") & ";
  const ToolRun result =
      run_shell(writer + command_line(HAUSDORFF_DISTANCE, {cube_, large_, "--time-limit", "0.1", "--transform-b", late,
                                                           "--json", folder_ / "late.json"}));
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_EQ(last_line(result.out), "UNDECIDED no upper bound yet: the time limit came first");
  const json document = checked_document(content_of(folder_ / "late.json"));
  EXPECT_EQ(document["outcome"], "budget");
  EXPECT_EQ(document["distance"]["a_to_b"]["searched"], false);
  EXPECT_EQ(document["seconds"]["build"], 0.0);
  EXPECT_FALSE(document.contains("worst"));
}

/// The decision stands; what came after it is said to be incomplete.
TEST_F(HausdorffTool, SaysThatTheTimeLimitLeftTheWorstSpotOpen) {
  const std::vector<std::string> arguments{sphere_, soup_, "--tolerance", "9", "--worst", "--time-limit", "0"};
  const ToolRun text = run(arguments);
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.out.find("not reached: the time limit came first"), std::string::npos) << text.out;
}

/// A mesh that is a point beside the other one.
TEST_F(HausdorffTool, ShowsTheWitnessOfAPointLikeDirection) {
  const Eigen::Vector3d p(0.8061316566424304, -0.8019195186906112, 0.757698417477433);
  const TriangleMesh point{{p, p, p, {1e30, 0, 0}}, {{0, 1, 2}}};
  const TriangleMesh mesh{{{-0.5, 0.4, -0.7}, {0.6, -0.3, 0.1}, {1.7, -1, 0.8}}, {{0, 1, 2}}};
  write_mesh(folder_ / "point.off", point);
  write_mesh(folder_ / "mesh.off", mesh);
  const std::string text = run({folder_ / "mesh.off", folder_ / "point.off"}).out;
  EXPECT_NE(text.find("witness (-0.5 0.4 -0.7) to (0.8061316566424304 -0.8019195186906112"), std::string::npos) << text;
  const json distance = parsed(run({folder_ / "mesh.off", folder_ / "point.off", "--json", "-"}))["distance"];
  expect_nearest(distance["a_to_b"], point);
  expect_nearest(distance["b_to_a"], mesh);
}

/// The first vertex of such a mesh is not the nearest one.
TEST(PointLike, HasItsNearestVertexAsWitness) {
  const TriangleMesh near{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const TriangleMesh far{{{0x1p42, 0, 0}, {0x1p42 + 9, 0, 0}, {0x1p42, 1, 0}}, {{0, 1, 2}}};
  const HausdorffDistance found = hausdorff_distance(far, near);
  EXPECT_EQ(found.a_to_b.witness.from.position, far.vertices[1]);
  EXPECT_EQ(found.a_to_b.witness.nearest.position, near.vertices[1]);
  EXPECT_LE(found.a_to_b.witness.distance, found.bounds.upper);
  EXPECT_EQ(found.a_to_b.witness.distance, 0x1p42 + 8);
}

TEST_F(HausdorffTool, PrintsTheFewestDigitsThatReadBack) {
  const std::string text = run({sphere_, soup_}).out;
  const std::regex line("(distance +|[AB] to [AB] |witness )[\\[(].*"), number("-?\\d[0-9.e+-]*");
  std::size_t found = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it) {
    const std::string numbers = it->str();
    for (std::sregex_iterator n(numbers.begin(), numbers.end(), number); n != end; ++n, ++found) {
      char shortest[32];
      *std::to_chars(shortest, shortest + sizeof shortest, std::stod(n->str())).ptr = '\0';
      EXPECT_EQ(n->str(), shortest);
    }
  }
  EXPECT_EQ(found, 18u) << text;
}

TEST_F(HausdorffTool, GivesTheSameForAnyNumberOfThreads) {
  const json one = parsed(run({sphere_, soup_, "--threads", "1", "--json", "-"}));
  const json two = parsed(run({sphere_, soup_, "--threads", "2", "--json", "-"}));
  EXPECT_EQ(one["distance"], two["distance"]);
}

/// GNU's OpenMP says at its start how it will wait.
TEST_F(HausdorffTool, ItsThreadsWaitBrieflyUnlessToldOtherwise) {
  const std::string tool = shell_quoted(HAUSDORFF_DISTANCE) + " --version";
  const std::string clean = "env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT OMP_DISPLAY_ENV=verbose ";
  const ToolRun alone = run_shell(clean + tool);
  if (alone.err.find("GOMP_SPINCOUNT") == std::string::npos) GTEST_SKIP() << "not GNU's OpenMP";
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_NE(alone.err.find("GOMP_SPINCOUNT = '3000'"), std::string::npos) << alone.err;
  const ToolRun told = run_shell(clean + "GOMP_SPINCOUNT=77 " + tool);
  EXPECT_NE(told.err.find("GOMP_SPINCOUNT = '77'"), std::string::npos) << told.err;
  EXPECT_EQ(told.err.find("GOMP_SPINCOUNT = '3000'"), std::string::npos) << told.err;
}

TEST_F(HausdorffTool, RefusesBadUsageInOneLine) {
  const std::vector<std::vector<std::string>> bad = {
      {},
      {cube_},
      {cube_, large_, "third"},
      {cube_, large_, "--tolerance", "-1"},
      {cube_, large_, "--tolerance", "nan"},
      {cube_, large_, "--tolerance", "1e999"},
      {cube_, large_, "--tolerance", "0.1%%"},
      {cube_, large_, "--error-bound", "small"},
      {cube_, large_, "--threads", "0"},
      {cube_, large_, "--time-limit", "-3"},
      {cube_, large_, "--no-such-option"},
      {cube_, large_, "--transform-b", "1 2 3"},
      {cube_, large_, "--transform-b", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"},
      {cube_, large_, "--transform-b", "1 0 0 inf 0 1 0 0 0 0 1 0 0 0 0 1"},
      {cube_, large_, "--transform-b", folder_ / "no_such_file"},
      {cube_, folder_ / "missing.off"},
      {folder_.path().string(), cube_},
      {cube_, large_, "--json", folder_ / "no/such/folder/out.json"},
  };
  for (const auto& arguments : bad) {
    SCOPED_TRACE(arguments.empty() ? "no arguments" : arguments.back());
    expect_one_line_and_exit_2(run(arguments));
  }
}

TEST_F(HausdorffTool, ExplainsItself) {
  const ToolRun help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* option : {"--error-bound", "--tolerance", "--one-sided", "--transform-b", "--json", "--time-limit"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
  EXPECT_NE(help.out.find("Exit codes: 0 "), std::string::npos);
  EXPECT_LT(run({cube_, large_, "--time-limit", "-1"}).err.size(), 120u);
  EXPECT_EQ(run({"--version"}).exit_code, 0);
}

TEST_F(HausdorffTool, AcceptsOrRefusesEveryBrokenFile) {
  const auto folder = test::dataset("broken");
  if (!folder) GTEST_SKIP() << "the folder of broken files is not on this machine (set MESHBOUND_DATASETS)";
  for (const auto& entry : fs::directory_iterator(*folder)) {
    SCOPED_TRACE(entry.path().filename().string());
    const std::string file = entry.path().string();
    const ToolRun itself = run({file, file, "--time-limit", "20", "--json", "-"});
    const ToolRun decision = run({cube_, file, "--tolerance", "10%", "--time-limit", "20"});
    if (itself.exit_code == 2) {
      expect_one_line_and_exit_2(itself);
      expect_one_line_and_exit_2(decision);
      continue;
    }
    EXPECT_EQ(itself.exit_code, 0) << itself.err;
    EXPECT_EQ(itself.err, "");
    EXPECT_EQ(parsed(itself)["distance"]["lower"], 0);
    EXPECT_TRUE(decision.exit_code == 0 || decision.exit_code == 1) << decision.out << decision.err;
    EXPECT_EQ(decision.err, "");
  }
}

}  // namespace hausdorff_tool_test
}  // namespace meshbound
