// SPDX-License-Identifier: MIT
// What the tools have in common: how they print a distance, name themselves and their files in documents, round what
// they write, and answer mistakes on the command line.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>

#include "common/length.h"
#include "common/mesh_input.h"
#include "common/progress.h"
#include "common/sha256.h"
#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace tool_conventions_test {

using testing_tools::checked_document;
using testing_tools::content_of;
using testing_tools::Json;
using testing_tools::run_tool;
using testing_tools::ToolRun;

class ToolConventions : public testing::Test {
 protected:
  ToolConventions() { write_mesh(in("in.off"), datasets::torus(1, 0.3, 40, 16)); }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] ToolRun simplify(std::vector<std::string> options, const std::string& out = "out.ply") const {
    options.insert(options.begin(), {in("in.off"), in(out)});
    return run_tool(SIMPLIFY_WITH_BOUND, options);
  }
  static void expect_refused(const ToolRun& result, const std::string& reason) {
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(testing_tools::line_count(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
  }

  testing_tools::TemporaryFolder folder_;
};

const std::vector<std::string> all_tools = {SIMPLIFY_WITH_BOUND, LOD_CHAIN,          HAUSDORFF_DISTANCE,
                                            PENETRATION_DEPTH,   VERIFY_CERTIFICATE, GENERATE_MESH};

TEST_F(ToolConventions, HelpOfEveryToolListsItsExitCodes) {
  for (const std::string& tool : all_tools)
    EXPECT_NE(run_tool(tool, {"--help"}).out.find("Exit codes: 0 "), std::string::npos) << tool;
}

TEST_F(ToolConventions, HelpOfEveryToolListsTheCompletion) {
  for (const std::string& tool : all_tools) {
    EXPECT_NE(run_tool(tool, {"--help"}).out.find("--completion {bash,zsh,fish}"), std::string::npos) << tool;
    const ToolRun fish = run_tool(tool, {"--completion", "fish"});
    EXPECT_EQ(fish.exit_code, 0) << fish.err;
    EXPECT_NE(fish.out.find(" -l completion "), std::string::npos) << fish.out;
  }
}

/// From the line "distance" to the next one that begins with a word.
std::string distance_lines(const std::string& text) {
  const std::regex lines("(^|\n)(distance [^\n]*\n([ ][^\n]*\n)+)");
  std::smatch match;
  EXPECT_TRUE(std::regex_search(text, match, lines)) << text;
  return match[2];
}

TEST_F(ToolConventions, DistancesArePrintedInTheSameLines) {
  const ToolRun simplified = simplify({"--tolerance", "0.02", "--error-bound", "0.0002"});
  ASSERT_EQ(simplified.exit_code, 0) << simplified.err;
  const ToolRun measured =
      run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("out.ply"), "--tolerance", "0.02", "--error-bound", "0.0002"});
  std::string lines = distance_lines(simplified.out);
  lines = std::regex_replace(lines, std::regex("original to simplified"), "A to B");
  lines = std::regex_replace(lines, std::regex("simplified to original"), "B to A");
  EXPECT_EQ(lines, distance_lines(measured.out));
  for (const char* line : {"\nverdict     within\n", "\ntolerance   0.02 ("}) {
    EXPECT_NE(simplified.out.find(line), std::string::npos) << simplified.out;
    EXPECT_NE(measured.out.find(line), std::string::npos) << measured.out;
  }
}

/// Bounds are those of the document, to the bit, and no number has a digit that it does not need.
TEST_F(ToolConventions, PrintedBoundsReadBackAsTheSameDoubles) {
  const ToolRun run = simplify({"--tolerance", "0.02", "--json", in("r.json")});
  const Json distance = checked_document(content_of(in("r.json")))["distance"];
  double lower = 0, upper = 0;
  const std::string lines = distance_lines(run.out);
  ASSERT_EQ(std::sscanf(lines.c_str(), "distance [%lf, %lf]", &lower, &upper), 2) << lines;
  EXPECT_EQ(lower, distance["lower"].get<double>());
  EXPECT_EQ(upper, distance["upper"].get<double>());
  const std::regex number("-?[0-9]+[.][0-9]+(e-?[0-9]+)?");
  for (std::sregex_iterator it(lines.begin(), lines.end(), number), end; it != end; ++it) {
    const std::string text = it->str();
    EXPECT_EQ(tools::exact_number(std::strtod(text.c_str(), nullptr)), text);
  }
}

TEST_F(ToolConventions, UnknownOptionsNameTheNearestOnes) {
  expect_refused(simplify({"--tol", "0.1"}), "did you mean --tolerance?");
  expect_refused(simplify({"--tolerence", "0.1"}), "did you mean --tolerance?");
  expect_refused(simplify({"-e", "0.1"}), "did you mean --effort or --error-bound?");
  expect_refused(run_tool(LOD_CHAIN, {in("in.off"), in("chain"), "--level", "0.1"}), "did you mean --levels?");
  const ToolRun unlike = simplify({"--tolerance", "0.1", "--frobnicate"});
  expect_refused(unlike, "--frobnicate");
  EXPECT_EQ(unlike.err.find("did you mean"), std::string::npos) << unlike.err;
}

TEST_F(ToolConventions, LengthsWithAUnitAreRefusedWithAdvice) {
  for (const char* length : {"0.05mm", "0.05µm", "0.05px", "0.05 mm"})
    expect_refused(simplify({"--tolerance", length}),
                   "mesh files carry no unit; give the number in the unit of the file (0.05)");
  expect_refused(simplify({"--tolerance", "mm"}), "give a number in model units (0.5)");
  ASSERT_EQ(simplify({"--tolerance", "0.5%"}).exit_code, 0);
  EXPECT_EQ(simplify({"--tolerance", "0.5 %"}, "blank.ply").exit_code, 0);
  EXPECT_EQ(content_of(in("out.ply")), content_of(in("blank.ply")));
}

/// A run that ends at a target far below its tolerance is measured as closely as one that the tolerance ends.
TEST_F(ToolConventions, TargetsEndInANarrowInterval) {
  ASSERT_EQ(simplify({"--tolerance", "100%", "--target-faces", "200", "--json", in("r.json")}).exit_code, 0);
  const Json distance = checked_document(content_of(in("r.json")))["distance"];
  const double upper = distance["upper"].get<double>(), lower = distance["lower"].get<double>();
  EXPECT_LE(upper - lower, 0.01 * upper);
  EXPECT_GT(lower, 0);
}

TEST_F(ToolConventions, TargetsAreSharesOrPercentages) {
  const auto faces = [&](const std::string& ratio) {
    EXPECT_EQ(simplify({"--tolerance", "100%", "--target-ratio", ratio, "--quiet"}).exit_code, 0);
    return read_mesh(in("out.ply")).mesh.triangles.size();
  };
  EXPECT_EQ(faces("0.5"), faces("50%"));
  for (const char* ratio : {"1.5", "150%", "-1", "half"})
    expect_refused(simplify({"--tolerance", "1", "--target-ratio", ratio}),
                   "give a number from 0 to 1 or a percentage");
  expect_refused(simplify({"--target-ratio", "0.5"}), "--tolerance 100%");
}

std::string sha256sum(const std::string& path) {
  return testing_tools::run_shell("sha256sum " + testing_tools::shell_quoted(path)).out.substr(0, 64);
}

TEST_F(ToolConventions, DocumentsSayWhichProgramMadeThemOfWhichFiles) {
  const std::string levels = in("levels"), proof = in("out.cert");
  ASSERT_EQ(simplify({"--tolerance", "0.02", "--levels", "0.01", "--output-dir", levels, "--certificate", proof,
                      "--json", in("simplify.json")})
                .exit_code,
            0);
  ASSERT_EQ(run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("out.ply"), "--json", in("distance.json")}).exit_code, 0);
  ASSERT_EQ(run_tool(VERIFY_CERTIFICATE, {in("in.off"), in("out.ply"), proof, "--json", in("verify.json")}).exit_code,
            0);
  ASSERT_EQ(run_tool(LOD_CHAIN, {in("in.off"), in("chain"), "--levels", "0.02", "--json", in("lod.json")}).exit_code,
            0);
  const auto document = [&](const std::string& name, const std::string& tool) {
    const Json json = checked_document(content_of(in(name + ".json")));
    EXPECT_EQ(json["provenance"]["tool"], tool);
    EXPECT_EQ(
        json["provenance"]["tool"].get<std::string>() + " " + json["provenance"]["version"].get<std::string>() + "\n",
        run_tool(std::filesystem::path(SIMPLIFY_WITH_BOUND).parent_path() / tool, {"--version"}).out);
    EXPECT_TRUE(std::regex_match(json["provenance"]["date"].get<std::string>(),
                                 std::regex("20\\d\\d-\\d\\d-\\d\\dT\\d\\d:\\d\\d:\\d\\dZ")));
    EXPECT_EQ(json["provenance"]["command"][1], in("in.off"));
    return json;
  };
  const std::string original = sha256sum(in("in.off")), result = sha256sum(in("out.ply"));
  const Json simplified = document("simplify", "simplify_with_bound");
  EXPECT_EQ(simplified["original"]["sha256"], original);
  EXPECT_EQ(simplified["simplified"]["sha256"], result);
  EXPECT_EQ(simplified["levels"][0]["sha256"], sha256sum(levels + "/out_level_0.ply"));
  const Json distance = document("distance", "hausdorff_distance");
  EXPECT_EQ(distance["a"]["sha256"], original);
  EXPECT_EQ(distance["b"]["sha256"], result);
  const Json verified = document("verify", "verify_certificate");
  EXPECT_EQ(verified["original"]["sha256"], original);
  EXPECT_EQ(verified["simplified"]["sha256"], result);
  EXPECT_EQ(verified["certificate"]["sha256"], sha256sum(proof));
  const Json chain = document("lod", "lod_chain");
  EXPECT_EQ(chain["original"]["sha256"], original);
  EXPECT_EQ(chain["levels"][0]["sha256"], sha256sum(in("chain/lod_0.ply")));
}

/// Where a message ends relative to the blocks of 64 bytes makes the difference; and two vectors of FIPS 180-4.
TEST(Sha256, IsTheStandardOne) {
  EXPECT_EQ(tools::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(tools::sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  const testing_tools::TemporaryFolder folder;
  for (const std::size_t size : {0, 1, 55, 56, 63, 64, 65, 119, 120, 128}) {
    std::string bytes;
    for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(37 * i + 200);
    std::ofstream(folder / "bytes", std::ios::binary) << bytes;
    EXPECT_EQ(tools::sha256(bytes), sha256sum(folder / "bytes")) << size;
  }
}

TEST(Sha256, LooksEveryMebibyteWhetherItIsToEnd) {
  const std::string bytes(std::size_t{5} << 20, 'a');
  int looks = 0;
  const std::string digits = tools::sha256(bytes, [&] { ++looks; });
  EXPECT_EQ(digits, tools::sha256(bytes));
  EXPECT_EQ(looks, 5);
  EXPECT_THROW((void)tools::sha256(bytes, [] { throw Stopped("enough"); }), Stopped);
}

TEST_F(ToolConventions, ReadingEndsByTheTimeLimit) {
  MeshReport report;
  const StopToken late{.deadline = StopToken::Clock::now()};
  EXPECT_THROW((void)tools::read_input(in("in.off"), true, report, late), Stopped);
  EXPECT_EQ(tools::read_input(in("in.off"), true, report, {}).triangles.size(), 1280u);
}

bool all_floats(const TriangleMesh& mesh) {
  for (const Eigen::Vector3d& p : mesh.vertices)
    if (p.cast<float>().cast<double>() != p) return false;
  return true;
}

/// Rounding comes before the measurement: the bound is that of the file.
TEST_F(ToolConventions, CoordinatesAreFloatsWhenAskedInEveryFormat) {
  const Bvh original(read_mesh(in("in.off")).mesh);
  for (const char* name : {"out.ply", "out.off", "out.obj", "out.stl"}) {
    SCOPED_TRACE(name);
    ASSERT_EQ(simplify({"--tolerance", "0.02", "--quiet"}, name).exit_code, 0);
    EXPECT_EQ(all_floats(read_mesh(in(name)).mesh), std::string(name) == "out.stl");
    const ToolRun run = simplify({"--tolerance", "0.02", "--single-precision", "--json", "-"}, name);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const TriangleMesh written = read_mesh(in(name)).mesh;
    EXPECT_TRUE(all_floats(written));
    const Json distance = checked_document(run.out)["distance"];
    EXPECT_EQ(check_tolerance(original, Bvh(written), distance["upper"]).verdict, Verdict::Within);
    EXPECT_EQ(check_tolerance(original, Bvh(written), 0.02).verdict, Verdict::Within);
  }
  ASSERT_EQ(simplify({"--tolerance", "0.02", "--single-precision"}).exit_code, 0);
  EXPECT_NE(content_of(in("out.ply")).find("property float x\n"), std::string::npos);
}

TEST_F(ToolConventions, EveryToolThatWritesMeshesWritesText) {
  const auto head = [&](const std::string& name) { return content_of(in(name)).substr(0, 60); };
  ASSERT_EQ(simplify({"--tolerance", "0.02", "--ascii"}).exit_code, 0);
  EXPECT_NE(head("out.ply").find("format ascii 1.0\n"), std::string::npos);
  ASSERT_EQ(simplify({"--tolerance", "0.02", "--ascii"}, "out.stl").exit_code, 0);
  EXPECT_EQ(head("out.stl").rfind("solid", 0), 0u);
  const std::vector<std::string> levels = {in("in.off"), in("chain"), "--levels",
                                           "0.02",       "--ascii",   "--single-precision"};
  ASSERT_EQ(run_tool(LOD_CHAIN, levels).exit_code, 0);
  EXPECT_NE(head("chain/lod_0.ply").find("format ascii 1.0\n"), std::string::npos);
  EXPECT_TRUE(all_floats(read_mesh(in("chain/lod_0.ply")).mesh));
  ASSERT_EQ(run_tool(GENERATE_MESH, {"gear", "--size", "5000", "--ascii", "--single-precision", "-o", in("gear.ply")})
                .exit_code,
            0);
  EXPECT_NE(head("gear.ply").find("format ascii 1.0\n"), std::string::npos);
  EXPECT_TRUE(all_floats(read_mesh(in("gear.ply")).mesh));
}

/// Both ends of an edge of the cube that is sharp: 12 edges of 5 inner vertices and 8 corners.
TEST_F(ToolConventions, SayHowManyVerticesAreLocked) {
  write_mesh(in("cube.off"), datasets::cube(1, 6));
  const ToolRun run = run_tool(SIMPLIFY_WITH_BOUND, {in("cube.off"), in("out.off"), "--tolerance", "0.2",
                                                     "--feature-angle", "80", "--json", in("r.json")});
  EXPECT_NE(run.out.find("\nlocked      68 of 218 vertices: "), std::string::npos) << run.out;
  EXPECT_EQ(checked_document(content_of(in("r.json")))["locked_vertices"], 68);
  const ToolRun chain = run_tool(
      LOD_CHAIN, {in("cube.off"), in("chain"), "--levels", "0.2", "--feature-angle", "80", "--json", in("l.json")});
  EXPECT_NE(chain.out.find("\nlocked      68 of 218 vertices: "), std::string::npos) << chain.out;
  EXPECT_EQ(checked_document(content_of(in("l.json")))["locked_vertices"], 68);
  EXPECT_EQ(simplify({"--tolerance", "0.02"}).out.find("locked"), std::string::npos);
}

/// A cube without its top: its border and its edges are lines, which levels and results keep in every format.
TEST_F(ToolConventions, ToolsThatDecimateKeepAndReportLines) {
  TriangleMesh open_box = datasets::cube(1, 6);
  double top = -1;
  for (const Eigen::Vector3d& p : open_box.vertices) top = std::max(top, p.z());
  std::erase_if(open_box.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return open_box.vertices[v].z() == top; });
  });
  write_mesh(in("box.off"), open_box);
  const std::vector<std::string> options = {"--feature-angle", "80",        "--line-tolerance", "0.1%",
                                            "--json",          in("r.json")};
  for (const char* const out : {"out.ply", "out.stl"}) {
    std::vector<std::string> words = {in("box.off"), in(out), "--tolerance", "0.2"};
    words.insert(words.end(), options.begin(), options.end());
    const ToolRun run = run_tool(SIMPLIFY_WITH_BOUND, words);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("\nlines       72 -> 12 edges, tolerance "), std::string::npos) << run.out;
    const Json json = checked_document(content_of(in("r.json")));
    EXPECT_EQ(json["lines"]["original_edges"], 72);
    EXPECT_EQ(json["lines"]["edges"], 12);
    EXPECT_LE(json["lines"]["distance"]["upper"], json["lines"]["tolerance"]["absolute"]);
    EXPECT_EQ(json["locked_vertices"], 0);
    EXPECT_EQ(read_mesh(in(out)).mesh.triangles.size(), 10u);
  }
  std::vector<std::string> words = {in("box.off"), in("chain"), "--levels", "0.05,0.2"};
  words.insert(words.end(), options.begin(), options.end());
  ASSERT_EQ(run_tool(LOD_CHAIN, words).exit_code, 0);
  for (const Json& level : checked_document(content_of(in("r.json")))["levels"]) EXPECT_EQ(level["lines"]["edges"], 12);
  const ToolRun wrong =
      run_tool(SIMPLIFY_WITH_BOUND, {in("box.off"), in("none.ply"), "--tolerance", "0.2", "--line-tolerance", "-1"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(in("none.ply")));
}

/// What floats round off is said to be that, whether a line, the tolerance or the time brings it up.
TEST_F(ToolConventions, ToolsThatDecimateTellRoundingFromWrongProofs) {
  TriangleMesh moved = datasets::cube(1, 6);
  for (Eigen::Vector3d& p : moved.vertices) p.x() += 1000.3;
  write_mesh(in("moved.off"), moved);
  const auto refused = [](const ToolRun& run, const std::string& why) {
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_EQ(testing_tools::line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find(why), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  const auto lines = [&](const std::string& tolerance) {
    return run_tool(SIMPLIFY_WITH_BOUND, {in("moved.off"), in("out.stl"), "--tolerance", "0.2", "--feature-angle", "80",
                                          "--line-tolerance", tolerance});
  };
  const std::string why = "--line-tolerance is smaller than the rounding of the output format; raise it to ";
  std::string enough = refused(lines("0"), why);
  EXPECT_FALSE(std::filesystem::exists(in("out.stl")));
  enough = enough.substr(enough.find(why) + why.size());
  EXPECT_EQ(lines(enough.substr(0, enough.find(','))).exit_code, 0) << enough;
  refused(run_tool(LOD_CHAIN, {in("moved.off"), in("chain"), "--levels", "0.2", "--feature-angle", "80",
                               "--line-tolerance", "0", "--format", "stl"}),
          why);
  for (Eigen::Vector3d& p : moved.vertices) p.x() += 1e7;
  write_mesh(in("moved.off"), moved);
  for (const char* const seconds : {"100", "1e-9"})
    refused(
        run_tool(SIMPLIFY_WITH_BOUND, {in("moved.off"), in("none.stl"), "--tolerance", "0.1", "--time-limit", seconds}),
        "the tolerance is smaller than the rounding of the output format");
  EXPECT_FALSE(std::filesystem::exists(in("none.stl")));
}

/// Where nothing collapses because floats are too coarse, the summary says what to do; doubles go on.
TEST_F(ToolConventions, TellWhenFloatsLeaveNoRoomForCollapses) {
  TriangleMesh far = datasets::cube(64, 8);
  for (Eigen::Vector3d& p : far.vertices) p += Eigen::Vector3d(500000, 5400000, 460);
  write_mesh(in("far.ply"), far);
  const std::string remedy = "nothing collapsed; use PLY, OFF or OBJ, or move the mesh to the origin";
  for (const char* const out : {"out.glb", "out.stl"}) {
    const ToolRun run = run_tool(SIMPLIFY_WITH_BOUND, {in("far.ply"), in(out), "--tolerance", "0.1"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find(remedy), std::string::npos) << run.out;
  }
  EXPECT_NE(run_tool(LOD_CHAIN, {in("far.ply"), in("chain"), "--levels", "0.1", "--format", "glb"}).out.find(remedy),
            std::string::npos);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{in("far.ply"), in("out.ply"), "--tolerance", "0.1"},
        {in("far.ply"), in("out.glb"), "--tolerance", "0.3"},
        {in("far.ply"), in("out.glb"), "--tolerance", "0"}}) {
    const ToolRun run = run_tool(SIMPLIFY_WITH_BOUND, words);
    EXPECT_EQ(run.out.find("use PLY"), std::string::npos) << run.out;
  }
}

/// Rounding to floats may move a seam where the surface stays as it is: here only its vertices are none of floats.
TEST_F(ToolConventions, ToolsThatDecimateTellRoundingOfSeamsFromWrongProofs) {
  std::ofstream(in("seam.obj")) << "v 1000 0 0\nv 1000.3 0 0\nv 1001 0 0\nv 1000 1 0\nv 1000.3 1 0\nv 1001 1 0\n"
                                   "usemtl red\nf 1 2 5 4\nusemtl blue\nf 2 3 6 5\n";
  const std::vector<std::string> words = {in("seam.obj"), in("out.obj"), "--tolerance", "1e-6"};
  ASSERT_EQ(run_tool(SIMPLIFY_WITH_BOUND, words).exit_code, 0);
  std::vector<std::string> in_floats = words;
  in_floats.emplace_back("--single-precision");
  const ToolRun run = run_tool(SIMPLIFY_WITH_BOUND, in_floats);
  EXPECT_EQ(run.exit_code, 1);
  const std::string why = "the tolerance is smaller than the rounding of the output format; raise it to ";
  ASSERT_NE(run.err.find(why), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(", or use PLY, OFF or OBJ, without --single-precision"), std::string::npos) << run.err;
  const std::string enough = run.err.substr(run.err.find(why) + why.size());
  in_floats[3] = enough.substr(0, enough.find(','));
  EXPECT_EQ(run_tool(SIMPLIFY_WITH_BOUND, in_floats).exit_code, 0) << enough;
}

/// A sheet of two materials: both tools that decimate carry them to OBJ, and say what other formats lose.
TEST_F(ToolConventions, AttributesComeAlongBetweenObjFiles) {
  std::string text = "mtllib sheet.mtl\n";
  constexpr int n = 16;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x)
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\nvt " + std::to_string(x / 16.0) + " " +
              std::to_string(y / 16.0) + "\n";
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const auto corner = [&](int i, int j) {
        const std::string index = std::to_string((y + j) * (n + 1) + x + i + 1);
        return " " + index + "/" + index;
      };
      text += (x < n / 2 ? "usemtl red\nf" : "usemtl blue\nf") + corner(0, 0) + corner(1, 0) + corner(1, 1) +
              corner(0, 1) + "\n";
    }
  }
  std::ofstream(in("sheet.obj")) << text;
  const auto run = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words = {in("sheet.obj"), in(out), "--tolerance", "0.5", "--json", in("r.json")};
    words.insert(words.end(), more.begin(), more.end());
    return run_tool(SIMPLIFY_WITH_BOUND, words);
  };
  const ToolRun carried = run("out.obj", {});
  ASSERT_EQ(carried.exit_code, 0) << carried.err;
  EXPECT_EQ(carried.out.find("dropped:"), std::string::npos) << carried.out;
  const Json json = checked_document(content_of(in("r.json")));
  EXPECT_EQ(json["original"]["dropped"]["texture_coordinates"], 0);
  EXPECT_EQ(json["lines"]["tolerance"]["absolute"], 0.5);
  EXPECT_LE(json["simplified"]["faces"], 8);
  ReadOptions options;
  options.attributes = true;
  const MeshFile result = read_mesh(in("out.obj"), options);
  EXPECT_EQ(result.attributes.material_libraries, std::vector<std::string>{"sheet.mtl"});
  ASSERT_EQ(result.attributes.materials.index.size(), result.mesh.triangles.size());
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
    double x = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = result.mesh.vertices[result.mesh.triangles[t][k]];
      x += p.x() / 3;
      const Eigen::Vector3d& uv =
          result.attributes.texture_coordinates.values[result.attributes.texture_coordinates.index[t][k]];
      EXPECT_NEAR(uv.x(), p.x() / n, 1e-6);
      EXPECT_NEAR(uv.y(), p.y() / n, 1e-6);
    }
    EXPECT_EQ(result.attributes.materials.names[result.attributes.materials.index[t]], x < n / 2 ? "red" : "blue");
  }
  const ToolRun bare = run("bare.obj", {"--drop-attributes"});
  EXPECT_NE(bare.out.find("dropped: 289 texture coordinates, 2 materials"), std::string::npos) << bare.out;
  EXPECT_EQ(content_of(in("bare.obj")).find("vt "), std::string::npos);
  EXPECT_EQ(checked_document(content_of(in("r.json")))["simplified"]["faces"], 2);
  EXPECT_NE(run("out.ply", {}).out.find("dropped: 2 materials\n"), std::string::npos);
  ASSERT_EQ(run_tool(LOD_CHAIN, {in("sheet.obj"), in("chain"), "--levels", "0.5", "--format", "obj"}).exit_code, 0);
  EXPECT_NE(content_of(in("chain/lod_0.obj")).find("usemtl blue"), std::string::npos);
}

TEST_F(ToolConventions, VerticesOfASubsetAreThoseOfTheOriginal) {
  ASSERT_EQ(simplify({"--tolerance", "0.02", "--placement", "subset"}).exit_code, 0);
  const TriangleMesh original = read_mesh(in("in.off")).mesh, result = read_mesh(in("out.ply")).mesh;
  EXPECT_LT(result.vertices.size(), original.vertices.size() / 2);
  for (const Eigen::Vector3d& p : result.vertices)
    EXPECT_NE(std::find(original.vertices.begin(), original.vertices.end(), p), original.vertices.end());
}

TEST_F(ToolConventions, ADryRunSaysWhatARunWouldTakeAndWritesNothing) {
  const ToolRun dry = simplify({"--tolerance", "1%", "--dry-run"});
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_NE(dry.out.find("faces       1280\n"), std::string::npos) << dry.out;
  EXPECT_NE(dry.out.find("memory      about 1 MiB\n"), std::string::npos) << dry.out;
  EXPECT_FALSE(std::filesystem::exists(in("out.ply")));
  expect_refused(run_tool(SIMPLIFY_WITH_BOUND, {in("in.off"), in("in.off"), "--tolerance", "1%", "--dry-run"}), "IN");
}

/// What bash offers for the last of some words.
std::string bash_offers(const std::string& words, int last) {
  const std::string tool = SIMPLIFY_WITH_BOUND;
  return testing_tools::run_shell(
             "bash -c " + testing_tools::shell_quoted("source <('" + tool + "' --completion bash); COMP_WORDS=(" +
                                                      words + "); COMP_CWORD=" + std::to_string(last) +
                                                      "; _simplify_with_bound; echo ${COMPREPLY[@]}"))
      .out;
}

TEST_F(ToolConventions, ShellsCompleteOptionsAndTheirValues) {
  EXPECT_EQ(bash_offers("simplify_with_bound --on-exceed s", 2), "skip stop\n");
  EXPECT_EQ(bash_offers("simplify_with_bound --up ''", 2), "x y z\n");
  EXPECT_EQ(bash_offers("simplify_with_bound --target-f", 1), "--target-faces\n");
  EXPECT_EQ(bash_offers("simplify_with_bound '" + in("in.o") + "'", 1), in("in.off") + "\n");
  const std::string zsh = run_tool(HAUSDORFF_DISTANCE, {"--completion", "zsh"}).out,
                    fish = run_tool(HAUSDORFF_DISTANCE, {"--completion", "fish"}).out;
  EXPECT_NE(zsh.find("\n  '--method["), std::string::npos) << zsh;
  EXPECT_NE(zsh.find("]:value:(cell-walking cross-culling)' \\\n"), std::string::npos) << zsh;
  EXPECT_NE(fish.find("complete -c hausdorff_distance -l method -d '"), std::string::npos) << fish;
  EXPECT_NE(fish.find("-x -a 'cell-walking cross-culling'\n"), std::string::npos) << fish;
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {"--completion", "tcsh"}), "bash, zsh and fish");
}

TEST(Progress, TellsTheTimeThatIsLeftOnceItCanBeKnown) {
  EXPECT_EQ(tools::progress_text(50, 1.9), "50%");
  EXPECT_EQ(tools::progress_text(0, 60), "0%");
  EXPECT_EQ(tools::progress_text(40, 60), "40%, 60 s so far, 90 s left");
}

TEST(Progress, FitsTheTerminal) {
  EXPECT_EQ(tools::progress_line("proving", 50, 1, 120),
            "proving [" + std::string(20, '#') + std::string(20, ' ') + "] 50%");
  EXPECT_EQ(tools::progress_line("proving", 50, 9, 54), "proving [#####     ] 50%, 9 s so far, 9 s left");
  EXPECT_EQ(tools::progress_line("proving", 50, 9, 40), "proving 50%, 9 s so far, 9 s left");
  EXPECT_EQ(tools::progress_line("proving", 50, 9, 12), "proving 50%");
  for (int columns = 0; columns < 130; ++columns)
    EXPECT_LE(tools::progress_line("measuring deviations", 100, 12345, columns).size(),
              static_cast<std::size_t>(std::max(columns - 1, 0)));
}

TEST(Progress, IsALineEveryTenSecondsWherePlainTextIsWanted) {
  tools::set_progress_style(tools::ProgressStyle::Plain);
  testing::internal::CaptureStderr();
  {
    double now = 0;
    tools::ProgressBar bar("measuring", false, [&now] { return now; });
    for (; now < 25; now += 2.5) bar.show(now / 50);
    tools::ProgressBar("quiet", true, [] { return 100.0; }).show(0.5);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "measuring: 20%, 10 s so far, 40 s left\nmeasuring: 40%, 20 s so far, 30 s left\n");
  tools::set_progress_style(tools::ProgressStyle::Automatic);
}

TEST_F(ToolConventions, ProgressOfAPipeIsThatWhichIsAskedFor) {
  EXPECT_EQ(simplify({"--tolerance", "1%", "--progress", "plain"}).err, "") << "too short for a line";
  expect_refused(simplify({"--tolerance", "1%", "--progress", "loud"}), "--progress");
}

/// Neither in a pipe nor in a file, whatever NO_COLOR says.
TEST_F(ToolConventions, NothingIsEscapedOutsideATerminal) {
  for (const char* variable : {"", "NO_COLOR=1 ", "FORCE_COLOR=1 CLICOLOR_FORCE=1 "}) {
    for (const std::string& tool : all_tools) {
      for (const char* arguments : {" --help", " --nosuch"}) {
        const ToolRun run = testing_tools::run_shell(variable + testing_tools::shell_quoted(tool) + arguments);
        EXPECT_EQ((run.out + run.err).find('\033'), std::string::npos) << variable << tool << arguments;
      }
    }
    const ToolRun run = testing_tools::run_shell(variable + testing_tools::shell_quoted(SIMPLIFY_WITH_BOUND) + " " +
                                                 in("in.off") + " " + in("out.ply") + " --tolerance 1%");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ((run.out + run.err).find('\033'), std::string::npos) << run.out << run.err;
  }
}

/// The bar moves the cursor and clears its line; it never sets a colour or a style, which codes that end in "m" do.
TEST_F(ToolConventions, NothingIsColouredOnATerminal) {
  for (const char* variable : {"", "NO_COLOR=1 "}) {
    const std::string command =
        testing_tools::shell_quoted(SIMPLIFY_WITH_BOUND) + " " + in("in.off") + " " + in("out.ply") + " --tolerance 1%";
    const ToolRun run =
        testing_tools::run_shell(variable + std::string("script --quiet --return --command ") +
                                 testing_tools::shell_quoted(command) + " " + in("terminal") + " </dev/null");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string shown = content_of(in("terminal"));
    EXPECT_NE(shown.find("simplifying ["), std::string::npos) << "no bar:\n" << shown;
    EXPECT_FALSE(std::regex_search(shown, std::regex("\033\\[[0-9;]*[^K0-9;]"))) << shown;
  }
}

/// What a terminal would show of a run whose second direction begins at the beginning again.
TEST(Progress, NeverGoesBack) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(::grantpt(terminal) | ::unlockpt(terminal), 0);
  const int screen = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY);
  ASSERT_GE(screen, 0);
  const int before = ::dup(STDERR_FILENO);
  ::dup2(screen, STDERR_FILENO);
  {
    tools::ProgressBar bar("measuring", false);
    for (const double fraction : {0.1, 0.46, 0.1, 0.3, 0.46, 0.7}) bar.show(fraction);
  }
  ::dup2(before, STDERR_FILENO);
  // What is written to a terminal arrives piece by piece; the bar wipes its line last.
  std::string shown;
  pollfd arrival{terminal, POLLIN, 0};
  while (!shown.ends_with("70%\033[K\r\033[K") && ::poll(&arrival, 1, 10000) == 1) {
    char piece[256];
    const ssize_t size = ::read(terminal, piece, sizeof piece);
    if (size <= 0) break;
    shown.append(piece, static_cast<std::size_t>(size));
  }
  for (const int file : {before, screen, terminal}) ::close(file);
  std::vector<int> percents;
  const std::regex percent(" +(\\d+)%");
  for (std::sregex_iterator it(shown.begin(), shown.end(), percent), end; it != end; ++it)
    percents.push_back(std::stoi((*it)[1]));
  EXPECT_EQ(percents, (std::vector<int>{10, 46, 70})) << shown;
}

}  // namespace tool_conventions_test
}  // namespace meshbound
