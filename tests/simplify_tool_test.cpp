// SPDX-License-Identifier: MIT
// The tool simplify_with_bound through its command line: exit codes, files, JSON, and that nothing appears under the
// name of the output unless its bound was measured.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <string>

#include "bvh/bvh_data.h"
#include "common/gated_output.h"
#include "datasets.h"
#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "mesh/stored_mesh.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "reference/small_meshes.h"
#include "run_tool.h"
#include "setting.h"

namespace meshbound {
namespace simplify_tool_test {

namespace fs = std::filesystem;
using testing_tools::checked_document;
using testing_tools::content_of;
using testing_tools::expect_nearest;
using testing_tools::Json;

struct Result {
  int exit_code = -1;
  std::string out, err;
};

class SimplifyTool : public testing::Test {
 protected:
  SimplifyTool() { write_mesh(in("sphere.off"), datasets::icosphere(1, 3)); }

  [[nodiscard]] fs::path in(const std::string& name) const { return folder_ / name; }

  /// Runs the tool inside the folder. `timeout` ends what hangs, with exit code 124.
  [[nodiscard]] Result run(const std::string& arguments, const std::string& tool = SIMPLIFY_WITH_BOUND) const {
    const std::string command =
        "cd '" + folder_.string() + "' && timeout 300 '" + tool + "' " + arguments + " >stdout.txt 2>stderr.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(in("stdout.txt")), content_of(in("stderr.txt"))};
  }

  /// Nothing but what the tests put there themselves: no half-written or temporary files.
  [[nodiscard]] bool is_clean() const {
    return std::all_of(fs::directory_iterator(folder_), fs::directory_iterator(), [](const fs::directory_entry& entry) {
      return entry.path().filename().string().find("unproven") == std::string::npos;
    });
  }

  void expect_refused(const Result& result, const std::string& output) const {
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(in(output)));
    EXPECT_TRUE(is_clean());
  }

  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

Verdict check(const fs::path& original, const fs::path& simplified, double tolerance) {
  return check_tolerance(Bvh(read_mesh(original).mesh), Bvh(read_mesh(simplified).mesh), tolerance).verdict;
}

TEST_F(SimplifyTool, WritesAMeshWithinTheToleranceInEveryFormat) {
  for (const char* name : {"out.off", "out.obj", "out.ply", "out.stl"}) {
    SCOPED_TRACE(name);
    const Result result = run(std::string("sphere.off ") + name + " --tolerance 0.02");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(check(in("sphere.off"), in(name), 0.02), Verdict::Within);
    EXPECT_LT(read_mesh(in(name)).mesh.triangles.size(), 600u);
    EXPECT_NE(result.out.find(name), std::string::npos);
  }
  EXPECT_TRUE(is_clean());
}

TEST_F(SimplifyTool, TakesTolerancesInPercentOfTheDiagonal) {
  ASSERT_EQ(run("sphere.off out.off --tolerance 1% --json -").exit_code, 0);
  const Json json = checked_document(content_of(in("stdout.txt")));
  EXPECT_NEAR(json["tolerance"]["absolute"].get<double>(), 0.01 * json["original"]["bbox_diagonal"].get<double>(),
              1e-15);
  EXPECT_NEAR(json["tolerance"]["percent_of_diagonal"].get<double>(), 1, 1e-12);
}

TEST_F(SimplifyTool, ReportsEveryKeyOfTheSchema) {
  const Result result =
      run("sphere.off out.ply --tolerance 0.02 --levels 0.005,0.01 --output-dir levels --json r.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = checked_document(content_of(in("r.json")));
  EXPECT_EQ(json["schema"], "meshbound/simplify/1");
  EXPECT_LE(json["collapses"]["estimated"].get<int>(), json["collapses"]["performed"].get<int>());
  EXPECT_EQ(json["collapses"]["estimated"].get<int>() + json["collapses"]["proven_alone"].get<int>(),
            json["collapses"]["performed"].get<int>());
  EXPECT_EQ(json["collapses"]["restarts"], 0);
  EXPECT_TRUE(json["collapses"]["taken_back"].is_number());
  EXPECT_EQ(json["verdict"], "within");
  EXPECT_EQ(json["original"]["faces"], 1280);
  EXPECT_EQ(json["original"]["closed"], true);
  EXPECT_EQ(json["simplified"]["path"], "out.ply");
  EXPECT_EQ(json["simplified"]["faces"], read_mesh(in("out.ply")).mesh.triangles.size());
  for (const char* side : {"original_to_simplified", "simplified_to_original"}) {
    EXPECT_LE(json["distance"][side]["lower"], json["distance"][side]["upper"]);
    EXPECT_EQ(json["distance"][side]["witness"]["from"].size(), 3u);
    EXPECT_EQ(json["distance"][side]["witness"]["to"].size(), 3u);
  }
  const std::string worse = json["worst"]["direction"];
  EXPECT_EQ(json["worst"]["distance"],
            Json({{"lower", json["distance"]["lower"]}, {"upper", json["distance"]["upper"]}}));
  EXPECT_EQ(json["worst"]["point"], json["distance"][worse]["witness"]["from"]);
  EXPECT_EQ(json["worst"]["triangle"], json["distance"][worse]["witness"]["from_triangle"]);
  expect_nearest(json["distance"]["original_to_simplified"], read_mesh(in("out.ply")).mesh);
  expect_nearest(json["distance"]["simplified_to_original"], read_mesh(in("sphere.off")).mesh);
  EXPECT_LE(json["distance"]["upper"].get<double>(), 0.02);
  for (const char* key : {"performed", "refused"}) EXPECT_TRUE(json["collapses"][key].is_number());
  for (const char* key : {"read", "simplify", "certify", "write", "total"})
    EXPECT_TRUE(json["seconds"][key].is_number());
  EXPECT_TRUE(json.contains("stats") && json.contains("threads"));
  ASSERT_EQ(json["levels"].size(), 2u);
  for (const Json& level : json["levels"]) {
    const double tolerance = level["tolerance"];
    EXPECT_LE(level["distance"]["upper"].get<double>(), tolerance);
    EXPECT_EQ(check(in("sphere.off"), in(level["path"]), tolerance), Verdict::Within);
    EXPECT_EQ(level["faces"], read_mesh(in(level["path"])).mesh.triangles.size());
  }
}

/// Directions that the lower bound of the other one cuts short have a witness that is a closest pair, too.
TEST_F(SimplifyTool, PrintsClosestPairsOfRealMeshes) {
  for (const char* name : {"cad/c3d_fandisk.obj", "game/gltf_Duck.obj"}) {
    SCOPED_TRACE(name);
    const auto path = test::dataset(name);
    if (!path) GTEST_SKIP() << name << " is not on this machine (MESHBOUND_DATASETS)";
    const Result result = run("'" + path->string() + "' out.ply --tolerance 0.5% --threads 1 --json -");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json distance = checked_document(result.out)["distance"];
    expect_nearest(distance["original_to_simplified"], read_mesh(in("out.ply")).mesh);
    expect_nearest(distance["simplified_to_original"], read_mesh(*path).mesh);
  }
}

TEST_F(SimplifyTool, StopsAtTheFirstCollapseThatWouldExceedWhenAsked) {
  write_mesh(in("terrain.off"), datasets::terrain(1, 30, 5));
  ASSERT_EQ(run("terrain.off skip.off --tolerance 0.01").exit_code, 0);
  const Result stop = run("terrain.off stop.off --tolerance 0.01 --on-exceed stop");
  ASSERT_EQ(stop.exit_code, 0) << stop.err;
  EXPECT_NE(stop.out.find("next collapse would exceed"), std::string::npos);
  EXPECT_LT(read_mesh(in("skip.off")).mesh.triangles.size(), read_mesh(in("stop.off")).mesh.triangles.size());
  EXPECT_EQ(check(in("terrain.off"), in("stop.off"), 0.01), Verdict::Within);
}

TEST_F(SimplifyTool, SaysWhetherTheTargetOrTheToleranceCameFirst) {
  const Result target = run("sphere.off out.off --tolerance 0.05 --target-faces 900 --json r.json");
  EXPECT_EQ(target.exit_code, 0);
  EXPECT_NE(target.out.find("target was reached first"), std::string::npos);
  EXPECT_EQ(checked_document(content_of(in("r.json")))["stopped_by"], "target");
  EXPECT_NEAR(static_cast<double>(read_mesh(in("out.off")).mesh.triangles.size()), 900, 2);
  const Result tolerance = run("sphere.off out.off --tolerance 0.001 --target-ratio 0.01 --json r.json");
  EXPECT_EQ(tolerance.exit_code, 0);
  EXPECT_NE(tolerance.out.find("it came before the target"), std::string::npos);
  EXPECT_EQ(checked_document(content_of(in("r.json")))["stopped_by"], "tolerance");
}

TEST_F(SimplifyTool, KeepsSharpEdgesWhenAsked) {
  write_mesh(in("cube.off"), datasets::cube(1, 6));
  ASSERT_EQ(run("cube.off out.off --tolerance 0.2 --feature-angle 80").exit_code, 0);
  const std::size_t kept = read_mesh(in("out.off")).mesh.vertices.size();
  EXPECT_GE(kept, 12u * 5 + 8);
  ASSERT_EQ(run("cube.off out.off --tolerance 0.2 --feature-angle 100").exit_code, 0);
  EXPECT_LT(read_mesh(in("out.off")).mesh.vertices.size(), kept);
  expect_refused(run("cube.off none.off --tolerance 0.2 --feature-angle 200"), "none.off");
}

/// A flat square: without the line across it the four corners would be left.
TEST_F(SimplifyTool, KeepsGivenEdgesAsLines) {
  constexpr int n = 4;
  TriangleMesh square;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) square.vertices.emplace_back(i, j, 0);
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
      square.triangles.insert(square.triangles.end(), {{a, a + 1, b + 1}, {a, b + 1, b}});
    }
  }
  write_mesh(in("square.off"), square);
  std::ofstream(in("edges")) << "# across the square\n2 7\n12 7\n\n12 17 # inside\n17 22\n0 24\n";
  ASSERT_EQ(run("square.off out.off --tolerance 0.01 --line-tolerance 0.01").exit_code, 0);
  EXPECT_EQ(read_mesh(in("out.off")).mesh.vertices.size(), 4U);
  ASSERT_EQ(run("square.off out.off --tolerance 0.01 --feature-edges edges --json r.json").exit_code, 0);
  EXPECT_EQ(read_mesh(in("out.off")).mesh.vertices.size(), 6U);
  EXPECT_EQ(checked_document(content_of(in("r.json")))["lines"]["edges"], 7);
  for (const char* const wrong : {"1", "1 2 3", "1 25", "-1 2", "1 x"}) {
    std::ofstream(in("wrong")) << "0 1\n" << wrong << "\n";
    const Result refused = run("square.off none.off --tolerance 0.01 --feature-edges wrong");
    expect_refused(refused, "none.off");
    EXPECT_NE(refused.err.find("wrong: line 2"), std::string::npos) << refused.err;
  }
  expect_refused(run("square.off none.off --tolerance 0.01 --feature-edges missing"), "none.off");
  EXPECT_EQ(run("square.off edges --output-format off --tolerance 0.01 --feature-edges edges").exit_code, 2);
  EXPECT_EQ(run("square.off out.off --tolerance 0.01 --feature-edges out.off").exit_code, 2);
}

TEST_F(SimplifyTool, GivesTheSameFileForEveryNumberOfThreads) {
  ASSERT_EQ(run("sphere.off one.ply --tolerance 0.02 --threads 1").exit_code, 0);
  ASSERT_EQ(run("sphere.off two.ply --tolerance 0.02 --threads 2").exit_code, 0);
  EXPECT_EQ(content_of(in("one.ply")), content_of(in("two.ply")));
}

TEST_F(SimplifyTool, ChangesNothingAtToleranceZero) {
  ASSERT_EQ(run("sphere.off out.off --tolerance 0 --json -").exit_code, 0);
  const Json json = checked_document(content_of(in("stdout.txt")));
  EXPECT_EQ(json["distance"]["upper"], 0.0);
  EXPECT_EQ(json["stopped_by"], "rounding");
}

TEST_F(SimplifyTool, PrintsNothingWhenQuietAndOnlyJsonWhenAskedFor) {
  EXPECT_EQ(run("sphere.off out.off --tolerance 0.02 --quiet").out, "");
  EXPECT_TRUE(Json::accept(run("sphere.off out.off --tolerance 0.02 --json").out));
}

TEST_F(SimplifyTool, AnswersHelpAndVersion) {
  EXPECT_EQ(run("--version").exit_code, 0);
  const Result help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* option :
       {"--tolerance", "--target-faces", "--target-ratio", "--on-exceed", "--levels", "--output-dir", "--cost",
        "--preserve-boundary", "--feature-angle", "--time-limit", "--json", "--quiet", "--threads", "Exit codes: 0 "})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
}

TEST_F(SimplifyTool, RefusesBadUsageInOneLine) {
  for (const char* arguments :
       {"sphere.off out.off", "sphere.off", "", "sphere.off out.off --tolerance -1",
        "sphere.off out.off --tolerance 1x", "sphere.off out.off --tolerance nan", "sphere.off out.off --tolerance inf",
        "sphere.off out.xyz --tolerance 1", "absent.off out.off --tolerance 1",
        "sphere.off out.off --tolerance 1 --on-exceed maybe", "sphere.off out.off --tolerance 1 --cost least",
        "sphere.off out.off --tolerance 1 --target-ratio 2",
        "sphere.off out.off --tolerance 1 --target-faces 5 --target-ratio 0.5",
        "sphere.off out.off --tolerance 1 --wrong", "sphere.off out.off --tolerance 1 --levels 2",
        "sphere.off out.off --tolerance 1 --levels x", "sphere.off out.off --tolerance 1 --target-faces -3",
        "sphere.off out.off --tolerance 1 --output-dir levels",
        "sphere.off out.off --tolerance 1 --texture-size 512"}) {
    SCOPED_TRACE(arguments);
    expect_refused(run(arguments), "out.off");
  }
  expect_refused(run("sphere.off nowhere/out.off --tolerance 1"), "nowhere/out.off");
}

/// The best mesh that was proven in time, at worst the original itself.
TEST_F(SimplifyTool, WritesWhatIsProvenWhenItIsOutOfTime) {
  write_mesh(in("terrain.off"), datasets::terrain(1, 100, 5));
  for (const char* limit : {"0", "0.01", "0.1", "0.5"}) {
    SCOPED_TRACE(limit);
    const Result result = run(std::string("terrain.off out.off --tolerance 0.01 --json r.json --time-limit ") + limit);
    const Json json = checked_document(content_of(in("r.json")));
    const bool was_late = json["stopped_by"] == "time_limit";
    EXPECT_EQ(result.exit_code, was_late ? 3 : 0);
    EXPECT_EQ(testing_tools::line_count(result.err), was_late ? 1 : 0) << result.err;
    EXPECT_TRUE(was_late || limit != std::string("0"));
    EXPECT_EQ(json["verdict"], "within");
    EXPECT_EQ(check(in("terrain.off"), in("out.off"), 0.01), Verdict::Within);
    EXPECT_EQ(json["simplified"]["faces"], read_mesh(in("out.off")).mesh.triangles.size());
    EXPECT_TRUE(is_clean());
  }
}

TEST_F(SimplifyTool, WritesTheOriginalInEveryFormatAndLevelWhenThereIsNoTimeAtAll) {
  for (const char* name : {"out.off", "out.obj", "out.ply", "out.stl"}) {
    SCOPED_TRACE(name);
    const Result result = run(std::string("sphere.off ") + name +
                              " --tolerance 0.02 --levels 0.005,0.01 --certificate proof --json r.json --time-limit 0");
    ASSERT_EQ(result.exit_code, 3) << result.err;
    EXPECT_NE(result.out.find("time limit came"), std::string::npos) << result.out;
    const Json json = checked_document(content_of(in("r.json")));
    EXPECT_EQ(json["stopped_by"], "time_limit");
    EXPECT_EQ(json["verdict"], "within");
    EXPECT_EQ(json["collapses"]["performed"], 0);
    EXPECT_EQ(json["simplified"]["faces"], 1280);
    ASSERT_EQ(json["levels"].size(), 2u);
    for (const Json& level : json["levels"])
      EXPECT_EQ(check(in("sphere.off"), in(level["path"]), level["tolerance"]), Verdict::Within);
    EXPECT_EQ(check(in("sphere.off"), in(name), 0.02), Verdict::Within);
  }
}

/// Where a measurement cannot tell, the tool tries harder; at the end the original is left, which is always decided.
TEST_F(SimplifyTool, WritesTheBestMeshThatIsDecided) {
  const std::string arguments = "sphere.off out.ply --tolerance 0.02 --threads 1 --json r.json";
  std::size_t faces_before = 0;
  for (const auto& [undecided, decided_by] : {std::pair{0, "measurement"}, std::pair{1, "second_method"},
                                              std::pair{2, "smaller_tolerance"}, std::pair{3, "original"}}) {
    SCOPED_TRACE(decided_by);
    const test::EnvironmentSetting fault("UNDECIDED_MEASUREMENTS", std::to_string(undecided));
    const Result result = run(arguments, SIMPLIFY_WITH_UNDECIDED_MEASUREMENTS);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out.find("decided     ") != std::string::npos, undecided > 0) << result.out;
    const Json json = checked_document(content_of(in("r.json")));
    EXPECT_EQ(json["decided_by"], decided_by);
    EXPECT_EQ(json["verdict"], "within");
    EXPECT_EQ(check(in("sphere.off"), in("out.ply"), 0.02), Verdict::Within);
    const std::size_t faces = json["simplified"]["faces"];
    EXPECT_GE(1.05 * static_cast<double>(faces), static_cast<double>(faces_before));
    faces_before = faces;
  }
  EXPECT_EQ(faces_before, 1280u);
}

/// The original, which is left in the end, has other coordinates in a file of floats, and so have its lines.
TEST_F(SimplifyTool, LinesOfTheOriginalAreFoundInAFileOfFloats) {
  write_mesh(in("terrain.off"), datasets::terrain(1, 12, 1));
  const test::EnvironmentSetting fault("UNDECIDED_MEASUREMENTS", "3");
  const Result result = run("terrain.off terrain.stl --tolerance 0.02 --line-tolerance 0.01 --json r.json",
                            SIMPLIFY_WITH_UNDECIDED_MEASUREMENTS);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = checked_document(content_of(in("r.json")));
  EXPECT_EQ(json["decided_by"], "original");
  EXPECT_EQ(json["lines"]["edges"], 48);
}

/// The interval is as narrow as 1% of the tolerance, or as narrow as asked.
TEST_F(SimplifyTool, MeasuresToOnePercentOfTheToleranceOrTheErrorBound) {
  const auto width = [&](const std::string& more) {
    const Result result = run("sphere.off out.ply --tolerance 0.02 --json r.json" + more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Json distance = checked_document(content_of(in("r.json")))["distance"];
    return distance["upper"].get<double>() - distance["lower"].get<double>();
  };
  EXPECT_LE(width(""), 0.0002);
  EXPECT_LE(width(" --error-bound 1e-9"), 1e-9);
}

/// A level that was proven serves the next one when its own proof was not finished.
TEST_F(SimplifyTool, FallsBackToTheBestProvenMesh) {
  const TriangleMesh sphere = datasets::icosphere(1, 5);
  const Bvh tree(sphere);
  TriangleMesh near = sphere;
  near.vertices[17] *= 1.001;
  DistanceOptions options;
  options.tolerance = 0.002;
  tools::MeshWithTree original(sphere, 1);
  tools::GatedOutput proven(in("proven.off"), {}), late(in("late.off"), {}), first(in("first.off"), {});
  proven.write(near);
  proven.measure(original, options);
  ASSERT_EQ(proven.verdict(), Verdict::Within);
  const TriangleMesh coarse = datasets::icosphere(1, 2);
  options.tolerance = hausdorff_distance(tree, Bvh(coarse)).bounds.upper;
  options.budget.seconds = 0;
  late.write(coarse);
  late.measure(original, options);
  ASSERT_EQ(late.verdict(), Verdict::Undecided);
  late.fall_back(&proven, original, {}, {}, options);
  ASSERT_EQ(late.verdict(), Verdict::Within);
  EXPECT_EQ(late.distance().bounds.upper, proven.distance().bounds.upper);
  late.publish();
  EXPECT_EQ(read_mesh(in("late.off")).mesh.vertices[17], near.vertices[17]);
  first.write(coarse);
  first.measure(original, options);
  first.fall_back(nullptr, original, {}, {}, options);
  first.publish();
  EXPECT_EQ(read_mesh(in("first.off")).mesh.vertices, sphere.vertices);
}

/// After the time limit nothing is measured and no tree is built any more: the original is written, read back and found
/// to be itself. Trees are numbered, so the number of those that were built is known.
TEST_F(SimplifyTool, FallsBackToTheOriginalWithoutATree) {
  const TriangleMesh sphere = datasets::icosphere(1, 5), coarse = datasets::icosphere(1, 2);
  tools::MeshWithTree original(sphere, 1);
  EXPECT_THROW((void)original.tree({.deadline = StopToken::Clock::now()}), Stopped);
  DistanceOptions options;
  options.tolerance = 0.01;
  for (const char* name : {"out.off", "out.stl"}) {
    const std::uint64_t before = Bvh(coarse).data().serial;
    tools::GatedOutput output(in(name), StopToken{.deadline = StopToken::Clock::now()});
    EXPECT_THROW(output.write(coarse), Stopped) << name;
    output.fall_back(nullptr, original, {}, {}, options);
    EXPECT_EQ(output.verdict(), Verdict::Within) << name;
    EXPECT_EQ(output.checksum().size(), 64u) << name;
    output.publish();
    EXPECT_EQ(read_mesh(in(name)).mesh.triangles.size(), sphere.triangles.size()) << name;
    const std::uint64_t small_trees = std::string(name) == "out.off" ? 0 : 4;  // around the furthest corners
    EXPECT_EQ(Bvh(coarse).data().serial, before + small_trees + 1) << name;
  }
}

/// Coordinates with 17 digits cannot be held by floats: the file would be further away than the tolerance.
TEST_F(SimplifyTool, WritesNoStlWhoseRoundingExceedsTheTolerance) {
  const Result result = run("sphere.off out.stl --tolerance 1e-12");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_FALSE(fs::exists(in("out.stl")));
  EXPECT_TRUE(is_clean());
}

/// What stands between a wrong simplifier and the user: a mesh with one vertex out of place is measured, found too far,
/// and not published.
TEST_F(SimplifyTool, CatchesASabotagedResultAtTheGate) {
  const TriangleMesh sphere = datasets::icosphere(1, 3);
  TriangleMesh sabotaged = sphere;
  sabotaged.vertices[17] *= 1.021;
  DistanceOptions options;
  options.tolerance = 0.02;
  tools::MeshWithTree original(sphere, 1);
  tools::GatedOutput output(in("out.off"), {});
  output.write(sabotaged);
  output.measure(original, options);
  EXPECT_EQ(output.verdict(), Verdict::Exceeds);
  EXPECT_THROW(output.publish(), Error);
  EXPECT_FALSE(fs::exists(in("out.off")));
}

/// A mesh that is too large to be read into memory.
class UnreadMesh : public MeshInMemory {
 public:
  using MeshInMemory::MeshInMemory;
  void read_vertices(std::size_t, std::span<Vec3>) const override { throw IoError("the vertices were read"); }
  void read_triangles(std::size_t, std::span<Triangle>) const override { throw IoError("the triangles were read"); }
};

/// Finds that every mesh is as near as it should be.
class TrustfulWorkers : public tools::LocalTileWorkers {
 public:
  using LocalTileWorkers::LocalTileWorkers;
  [[nodiscard]] HausdorffDistance measure(const StoredMesh&, const StoredMesh&,
                                          const DistanceOptions& options) override {
    HausdorffDistance distance;
    distance.bounds = {0, *options.tolerance};
    return distance;
  }
};

/// --memory bounds the whole process: what is measured tile by tile is not read as a whole behind that.
TEST_F(SimplifyTool, LeavesAStoredOriginalWhereItIs) {
  const TriangleMesh sphere = datasets::icosphere(1, 3), nothing;
  DistanceOptions options;
  options.tolerance = 0.02;
  const UnreadMesh stored(sphere);
  TrustfulWorkers workers(tools::TileSetting{});
  tools::MeshWithTree original(nothing, 1);
  original.measure_in_tiles(stored, workers);
  tools::GatedOutput output(in("out.off"), {});
  output.write(datasets::icosphere(1, 2));
  EXPECT_NO_THROW(output.measure(original, options));
  EXPECT_EQ(output.verdict(), Verdict::Within);
}

/// The tool itself with proofs that admit too much: nothing appears under the name of the output, and what is needed to
/// find the fault is kept.
TEST_F(SimplifyTool, CatchesAFaultyProofAndSavesAReproducer) {
  const std::string arguments = "sphere.off out.ply --tolerance 0.02 --threads 1 --driver core";
  const test::EnvironmentSetting fault("PROOF_FAULT", "1.5");
  const Result faulty = run(arguments, SIMPLIFY_WITH_FAULTY_DECIMATION);
  EXPECT_EQ(faulty.exit_code, 2);
  EXPECT_EQ(faulty.out, "");
  EXPECT_EQ(std::count(faulty.err.begin(), faulty.err.end(), '\n'), 1) << faulty.err;
  EXPECT_NE(faulty.err.find("out.ply.reproducer"), std::string::npos) << faulty.err;
  EXPECT_FALSE(fs::exists(in("out.ply")));
  const fs::path folder = in("out.ply.reproducer");
  EXPECT_EQ(content_of(folder / "original.off"), content_of(in("sphere.off")));
  const Json options = checked_document(content_of(folder / "options.json"));
  EXPECT_EQ(options.at("tolerances"), Json({0.02}));
  EXPECT_EQ(options.at("effort"), "normal");
  EXPECT_EQ(options.at("driver"), "core");
  const TriangleMesh rejected = read_mesh(folder / "rejected.ply").mesh;
  EXPECT_EQ(check_tolerance(Bvh(read_mesh(in("sphere.off")).mesh), Bvh(rejected), 0.02).verdict, Verdict::Exceeds);

  EXPECT_EQ(run(arguments).exit_code, 0);
  EXPECT_TRUE(fs::exists(in("out.ply")));
}

/// Samples that admit thirty times too much cost collapses that are taken back, and nothing else.
TEST_F(SimplifyTool, RepairsWhatFaultySamplesAdmit) {
  write_mesh(in("terrain.off"), datasets::terrain(1, 40, 3));
  const test::EnvironmentSetting fault("SAMPLE_FAULT", "30");
  const Result faulty = run("terrain.off out.ply --tolerance 0.01 --json -", SIMPLIFY_WITH_FAULTY_DECIMATION);
  ASSERT_EQ(faulty.exit_code, 0) << faulty.err;
  EXPECT_EQ(check(in("terrain.off"), in("out.ply"), 0.01), Verdict::Within);
  EXPECT_GT(checked_document(faulty.out)["collapses"]["taken_back"], 0);
}

TEST_F(SimplifyTool, HoldsItsToleranceWithEveryDriver) {
  write_mesh(in("terrain.off"), datasets::terrain(1, 30, 5));
  std::vector<std::string> arguments = {"--driver core"};
#if defined(MESHBOUND_WITH_CGAL)
  arguments = {"--driver core", "--driver cgal", "--driver cgal --cost lindstrom-turk"};
#endif
  for (const std::string& driver : arguments) {
    SCOPED_TRACE(driver);
    const Result result = run("terrain.off out.ply --tolerance 0.01 --json - " + driver);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(checked_document(result.out).at("driver"), driver.substr(9, 4));
    EXPECT_EQ(check(in("terrain.off"), in("out.ply"), 0.01), Verdict::Within);
  }
}

/// Our own queue knows the cost of Garland and Heckbert only.
TEST_F(SimplifyTool, RefusesADriverThatIsNotThereOrDoesNotKnowTheCost) {
  expect_refused(run("sphere.off out.off --tolerance 0.02 --driver core --cost lindstrom-turk"), "out.off");
  expect_refused(run("sphere.off out.off --tolerance 0.02 --driver other"), "out.off");
  const Result cgal = run("sphere.off cgal.off --tolerance 0.02 --driver cgal");
#if defined(MESHBOUND_WITH_CGAL)
  EXPECT_EQ(cgal.exit_code, 0) << cgal.err;
#else
  expect_refused(cgal, "cgal.off");
#endif
}

TEST_F(SimplifyTool, DropsComponentsAndCountsThemWhenAsked) {
  const TriangleMesh speck = reference::moved(datasets::icosphere(0.004, 1), {0, 0, 1});
  write_mesh(in("two.off"), reference::both(datasets::icosphere(1, 3), speck));
  const Result kept = run("two.off out.off --tolerance 0.02 --json -");
  EXPECT_EQ(checked_document(kept.out).at("pruned"), Json({{"components", 0}, {"faces", 0}}));
  const Result pruned = run("two.off out.off --tolerance 0.02 --prune --json -");
  ASSERT_EQ(pruned.exit_code, 0) << pruned.err;
  EXPECT_EQ(checked_document(pruned.out).at("pruned"), Json({{"components", 1}, {"faces", 80}}));
  EXPECT_EQ(check(in("two.off"), in("out.off"), 0.02), Verdict::Within);
  EXPECT_NE(run("two.off out.off --tolerance 0.02 --prune").out.find("pruned      1 components of 80"),
            std::string::npos);
}

TEST_F(SimplifyTool, FindsFewerFacesWithMoreEffort) {
  write_mesh(in("torus.off"), datasets::torus(1, 0.3, 90, 36));
  std::vector<std::size_t> faces;
  for (const std::string effort : {"normal", "high"}) {
    const Result result = run("torus.off out.off --tolerance 0.01 --threads 1 --json - --effort " + effort);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json json = checked_document(result.out);
    EXPECT_EQ(json.at("effort"), effort);
    faces.push_back(json.at("simplified").at("faces"));
  }
  EXPECT_GT(static_cast<double>(faces[0]), 1.05 * static_cast<double>(faces[1]));
  EXPECT_EQ(run("torus.off out.off --tolerance 0.01 --effort extreme").exit_code, 2);
  const Result fast = run("torus.off fast.off --tolerance 0.01 --effort fast");
  expect_refused(fast, "fast.off");
  EXPECT_NE(fast.err.find("use normal"), std::string::npos) << fast.err;
}

/// Where attributes are not carried: what is lost is said, in the text and in the JSON, and nothing where there is
/// nothing.
TEST_F(SimplifyTool, SaysWhatItDrops) {
  write_mesh(in("plain.obj"), datasets::icosphere(1, 2));
  std::ofstream(in("painted.obj")) << content_of(in("plain.obj"))
                                   << "mtllib m.mtl\nusemtl paint\nvt 0 0\nvt 1 0\nl 1 2\n";
  const Result painted = run("painted.obj out.stl --tolerance 0.02 --json r.json");
  EXPECT_EQ(painted.exit_code, 0) << painted.err;
  EXPECT_EQ(painted.err, "");
  EXPECT_NE(painted.out.find("\ndropped: 2 texture coordinates, 1 material, 1 line, point or empty face\n"),
            std::string::npos)
      << painted.out;
  const Json original = checked_document(content_of(in("r.json")))["original"];
  EXPECT_EQ(original["dropped"]["texture_coordinates"], 2);
  EXPECT_EQ(original["dropped"]["materials"], 1);
  EXPECT_EQ(original["dropped"]["normals"], 0);
  EXPECT_EQ(original["dropped"]["other_elements"], 1);
  EXPECT_EQ(run("plain.obj out.ply --tolerance 0.02").out.find("dropped"), std::string::npos);
  EXPECT_EQ(run("painted.obj out.ply --tolerance 0.02 --quiet").out, "");
  const Result strict = run("painted.obj strict.ply --tolerance 0.02 --strict");
  expect_refused(strict, "strict.ply");
  EXPECT_NE(strict.err.find("strict.ply would not carry 1 material, 1 line, point or empty face"), std::string::npos)
      << strict.err;
  EXPECT_EQ(run("plain.obj strict.ply --tolerance 0.02 --strict").exit_code, 0);
}

/// Files of the wild and of malice: either a proven result, or one line and no file.
TEST_F(SimplifyTool, SurvivesBrokenFiles) {
  const auto broken = test::dataset("broken");
  if (!broken) GTEST_SKIP() << "the folder of broken files is not on this machine (MESHBOUND_DATASETS)";
  for (const fs::directory_entry& entry : fs::directory_iterator(*broken)) {
    SCOPED_TRACE(entry.path().filename().string());
    const Result result = run("'" + entry.path().string() + "' out.ply --tolerance 1% --quiet");
    if (result.exit_code == 0) {
      EXPECT_EQ(result.err, "");
      EXPECT_FALSE(read_mesh(in("out.ply")).mesh.triangles.empty());
    } else {
      expect_refused(result, "out.ply");
    }
    fs::remove(in("out.ply"));
  }
}

}  // namespace simplify_tool_test
}  // namespace meshbound
