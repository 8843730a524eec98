// SPDX-License-Identifier: MIT
// Texture deviation by the command lines: hausdorff_distance measures and decides, simplify_with_bound keeps a
// tolerance.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <regex>

#include "datasets/analytic_meshes.h"
#include "json_claims.h"
#include "meshbound/io.h"
#include "run_tool.h"

namespace meshbound {
namespace texture_tool_test {

using nlohmann::json;
using namespace testing_tools;

/// n x n squares of the unit square in the plane z = `height`, or with waves as high as `wave` on it, whose u runs
/// unevenly by `warp`; moved by `offset` along x.
void write_square(const std::string& path, int n, double warp, double height = 0, double wave = 0, double offset = 0) {
  const auto z = [&](int i, int j) {
    return height + wave * std::sin(2 * std::numbers::pi * i / n) * std::sin(2 * std::numbers::pi * j / n);
  };
  std::ofstream out(path);
  out.precision(17);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      out << "v " << offset + i / double(n) << ' ' << j / double(n) << ' ' << z(i, j) << '\n';
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      out << "vt " << i / double(n) + warp * std::sin(2 * std::numbers::pi * i / n) << ' ' << j / double(n) << '\n';
  const auto corner = [&](int i, int j) {
    const std::string index = std::to_string(j * (n + 1) + i + 1);
    return " " + index + "/" + index;
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      out << "f" << corner(i, j) << corner(i + 1, j) << corner(i + 1, j + 1) << "\nf" << corner(i, j)
          << corner(i + 1, j + 1) << corner(i, j + 1) << '\n';
}

class TextureTool : public testing::Test {
 protected:
  TextureTool() {
    write_square(even_, 4, 0);
    write_square(raised_, 3, 0, 0.25);
    write_square(warped_, 16, 0.05);
  }
  static ToolRun measure(const std::vector<std::string>& arguments) { return run_tool(HAUSDORFF_DISTANCE, arguments); }
  static ToolRun simplify(const std::vector<std::string>& arguments) {
    return run_tool(SIMPLIFY_WITH_BOUND, arguments);
  }

  TemporaryFolder folder_;
  std::string even_ = folder_ / "even.obj", raised_ = folder_ / "raised.obj", warped_ = folder_ / "warped.obj";
  std::string out_ = folder_ / "out.obj";
};

class SlowTextureTool : public TextureTool {};

TEST_F(TextureTool, TellsHowFarTheTextureMoves) {
  const ToolRun result = measure({even_, raised_, "--texture", "--texture-size", "8", "--json", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json texture = checked_document(result.out)["texture"];
  EXPECT_NEAR(texture["lower"].get<double>(), 0.25, 1e-9);
  EXPECT_GE(texture["upper"].get<double>(), 0.25);
  EXPECT_EQ(texture["a_to_b"]["uncovered"]["upper"], 0);
  EXPECT_EQ(texture["a_to_b"]["witness"]["to"][2], 0.25);
  EXPECT_EQ(texture["texel_length"], 0.125);
  EXPECT_NEAR(texture["texels"]["upper"].get<double>(), 2, 1e-6);
  const ToolRun text = measure({even_, raised_, "--texture"});
  EXPECT_NE(text.out.find("texture     [0.2"), std::string::npos) << text.out;
}

TEST_F(TextureTool, DecidesAboutATolerance) {
  EXPECT_EQ(measure({even_, raised_, "--texture", "--texture-tolerance", "0.26"}).exit_code, 0);
  const ToolRun fails = measure({even_, raised_, "--texture", "--texture-tolerance", "0.24", "--quiet"});
  EXPECT_EQ(fails.exit_code, 1);
  EXPECT_EQ(fails.err.substr(0, 18), "FAIL texture 0.25 ") << fails.err;
  EXPECT_EQ(measure({even_, raised_, "--texture", "--texture-tolerance", "1.9texels", "--texture-size", "8"}).exit_code,
            1);
  EXPECT_EQ(measure({even_, raised_, "--texture", "--texture-tolerance", "2.1texels", "--texture-size", "8"}).exit_code,
            0);
}

/// A sheet of n x m squares with a hole of a triangle where wanted. The texture coordinate runs across it alone.
void write_striped(const std::string& path, int n, int m, bool has_hole) {
  std::ofstream out(path);
  out.precision(9);
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i)
      out << "v " << i / double(n) << ' ' << j / double(m) << " 0\nvt " << i / double(n) << " 0.5\n";
  const auto corner = [&](int i, int j) {
    const std::string index = std::to_string(j * (n + 1) + i + 1);
    return " " + index + "/" + index;
  };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      out << "f" << corner(i, j) << corner(i + 1, j) << corner(i + 1, j + 1) << '\n';
      if (!has_hole || i != 1 || j != 1) out << "f" << corner(i, j) << corner(i + 1, j + 1) << corner(i, j + 1) << '\n';
    }
}

TEST_F(TextureTool, MeasuresAsNarrowlyAsAToleranceTakes) {
  const std::string holed = folder_ / "holed.obj", striped = folder_ / "striped.obj";
  write_striped(holed, 3, 4, true);
  write_striped(striped, 6, 1, false);
  constexpr double deviation = 0.125;  // the hole is 1/4 long where a coordinate is in it alone, and 1/8 from its ends
  const auto width_of = [&](double tolerance, const std::vector<std::string>& more, int exit_code) {
    std::vector<std::string> words = {holed,    striped, "--texture", "--texture-tolerance", std::to_string(tolerance),
                                      "--json", "-"};
    words.insert(words.end(), more.begin(), more.end());
    const ToolRun run = measure(words);
    EXPECT_EQ(run.exit_code, exit_code) << tolerance << ' ' << run.err;
    const json texture = checked_document(run.out)["texture"];
    const double lower = texture["lower"], upper = texture["upper"];
    EXPECT_LE(lower, deviation);
    EXPECT_GE(upper, deviation);
    return upper - lower;
  };
  EXPECT_LE(width_of(1, {}, 0), 0.01);
  EXPECT_GT(width_of(1, {}, 0), 1e-5);
  EXPECT_LE(width_of(1, {"--worst"}, 0), 1e-5);
  for (const double share : {0.99, 0.999, 1.0005, 1.001, 1.002, 1.005, 1.01})
    width_of(share * deviation, {}, share < 1 ? 1 : 0);
}

TEST_F(TextureTool, WidensByTheRoundingOfAMap) {
  const std::string shift = "1 0 0 0.1  0 1 0 0  0 0 1 0  0 0 0 1";
  const ToolRun result = measure({even_, even_, "--texture", "--transform-b", shift, "--json", "-"});
  const json document = checked_document(result.out);
  EXPECT_GE(document["texture"]["upper"].get<double>(), 0.1);
  EXPECT_LE(document["texture"]["lower"].get<double>(), 0.1);
}

TEST_F(TextureTool, RefusesWhatMakesNoSense) {
  std::ofstream(folder_ / "bare.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto refused = [](const ToolRun& run, const std::string& word) {
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  };
  refused(measure({even_, folder_ / "bare.obj", "--texture"}), "bare.obj: no texture coordinates");
  refused(measure({even_, raised_, "--texture-tolerance", "1"}), "--texture");
  refused(measure({even_, raised_, "--texture", "--one-sided"}), "--one-sided");
  refused(measure({even_, raised_, "--texture", "--texture-tolerance", "2texels"}), "--texture-size");
  std::string strip = testing_tools::content_of(even_);
  std::ofstream(folder_ / "strip.obj") << std::regex_replace(strip, std::regex("vt (\\S+) \\S+"), "vt $1 0.5");
  refused(measure({folder_ / "strip.obj", folder_ / "strip.obj", "--texture", "--texture-tolerance", "2texels",
                   "--texture-size", "8"}),
          "a texel has no size");
  refused(simplify({folder_ / "bare.obj", out_, "--tolerance", "1%", "--texture-tolerance", "1%"}),
          "texture coordinates");
  refused(simplify({even_, out_, "--tolerance", "1%", "--texture-tolerance", "1%", "--drop-attributes"}),
          "--drop-attributes");
  for (const std::string wrong : {"x", "1%x", "-1x", "1y"})
    refused(simplify({even_, out_, "--tolerance", "1%", "--texture-tolerance", wrong}), "--texture-tolerance: '");
  const auto levels = [](const std::string& in, const std::string& chain, const std::string& format) {
    return run_tool(LOD_CHAIN, {in, chain, "--levels", "1%", "--texture-tolerance", "1x", "--format", format});
  };
  refused(levels(folder_ / "bare.obj", folder_ / "chain", "obj"), "texture coordinates");
  refused(levels(even_, folder_ / "chain", "stl"), "texture coordinates");
  refused(simplify({even_, folder_ / "out.stl", "--tolerance", "1%", "--texture-tolerance", "1%"}),
          "texture coordinates");
}

/// Two squares that lie apart, of n x n squares each, whose charts meet along a line of the texture on which the
/// coordinates lie in decimals but not in floats.
void write_adjoining_charts(const std::string& path, int n) {
  std::ofstream out(path);
  out.precision(12);
  for (const int chart : {0, 1})
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double x = i / double(n), y = j / double(n), u = x + chart;
        out << "v " << x + 5 * chart << ' ' << y << ' ' << 0.01 * std::sin(6 * x + 4 * y) << "\nvt "
            << 0.1 + 0.3 * u + 0.1 * y << ' ' << 0.2 + 0.7 * y - 0.05 * u << '\n';
      }
  const auto corner = [&](int chart, int i, int j) {
    const std::string index = std::to_string((chart * (n + 1) + j) * (n + 1) + i + 1);
    return " " + index + "/" + index;
  };
  for (const int chart : {0, 1})
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        out << "f" << corner(chart, i, j) << corner(chart, i + 1, j) << corner(chart, i + 1, j + 1) << "\nf"
            << corner(chart, i, j) << corner(chart, i + 1, j + 1) << corner(chart, i, j + 1) << '\n';
}

/// What a file of floats rounds off lies beside the border of a chart, where the other chart has the coordinates.
TEST_F(TextureTool, ComparesChartsThatMeetInThePrecisionOfTheFiles) {
  const std::string in = folder_ / "charts.obj", certificate = folder_ / "out.cert";
  write_adjoining_charts(in, 10);
  for (const char* const name : {"out.glb", "out.gltf", "out.ply", "out.obj"}) {
    const std::string out = folder_ / name;
    const ToolRun run = simplify(
        {in, out, "--tolerance", "0.02", "--texture-tolerance", "0.02", "--json", "-", "--certificate", certificate});
    ASSERT_EQ(run.exit_code, 0) << name << ": " << run.err;
    EXPECT_LT(checked_document(run.out)["simplified"]["faces"], 200) << name;
    EXPECT_EQ(measure({in, out, "--texture", "--texture-tolerance", "0.02"}).exit_code, 0) << name;
    EXPECT_EQ(measure({out, in, "--texture", "--texture-tolerance", "0.02"}).exit_code, 0) << name;
    const json texture = checked_document(measure({in, out, "--texture", "--json", "-"}).out)["texture"];
    const bool has_floats = !out.ends_with(".obj");
    EXPECT_EQ(texture.contains("compares_floats"), has_floats) << name;
    const std::string text = measure({in, out, "--texture"}).out;
    EXPECT_EQ(text.find("compared as floats") != std::string::npos, has_floats) << name << ": " << text;
    const ToolRun verified = run_tool(VERIFY_CERTIFICATE, {in, out, certificate});
    EXPECT_EQ(verified.exit_code, 0) << name << ": " << verified.err;
  }
}

/// The square is flat, so that any triangulation is at distance 0: only the texture limits what may go.
TEST_F(TextureTool, KeepsTheTextureInPlace) {
  ASSERT_EQ(simplify({warped_, out_, "--tolerance", "1%"}).exit_code, 0);
  const json without = checked_document(measure({warped_, out_, "--texture", "--json", "-"}).out);
  EXPECT_GT(without["texture"]["lower"].get<double>(), 0.02);
  const ToolRun kept = simplify({warped_, out_, "--tolerance", "1%", "--texture-tolerance", "0.01", "--json", "-"});
  ASSERT_EQ(kept.exit_code, 0) << kept.err;
  const json document = checked_document(kept.out);
  EXPECT_EQ(document["verdict"], "within");
  EXPECT_LE(document["texture"]["upper"].get<double>(), 0.01);
  EXPECT_EQ(document["texture"]["tolerance"]["absolute"], 0.01);
  EXPECT_LT(document["simplified"]["faces"].get<int>(), 512);
  const json again = checked_document(measure({warped_, out_, "--texture", "--json", "-"}).out);
  EXPECT_LE(again["texture"]["upper"].get<double>(), 0.01);
  EXPECT_EQ(again["b"]["faces"], document["simplified"]["faces"]);
}

/// The texture alone limits these levels: what is undone for it may leave the coarser one with more faces.
TEST_F(TextureTool, WritesAFinerLevelThatHasFewerFaces) {
  const std::string wavy = folder_ / "wavy.obj";
  write_square(wavy, 12, 0.08, 0, 0.05);
  const ToolRun run =
      simplify({wavy, out_, "--tolerance", "2%", "--levels", "0.5%,1%", "--texture-tolerance", "0.004", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json document = checked_document(run.out);
  const json& levels = document["levels"];
  EXPECT_LE(levels[1]["faces"], levels[0]["faces"]);
  EXPECT_LE(document["simplified"]["faces"], levels[1]["faces"]);
  EXPECT_EQ(document["verdict"], "within");
  EXPECT_LE(document["texture"]["upper"].get<double>(), 0.004);
}

/// Each level may move the texture as far as its own tolerance. A level whose texture may move as little as that of the
/// finest one has more faces.
TEST_F(TextureTool, LetsTheTextureOfEachLevelMoveByItsOwnTolerance) {
  const std::string wavy = folder_ / "wavy.obj", chain = folder_ / "chain";
  write_square(wavy, 12, 0.08, 0, 0.05);
  const auto levels_of = [&](const std::string& texture_tolerance) {
    const ToolRun run = run_tool(LOD_CHAIN, {wavy, chain, "--format", "obj", "--levels", "0.004,0.01,0.03",
                                             "--texture-tolerance", texture_tolerance, "--json", "-"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return checked_document(run.out)["levels"];
  };
  const json each = levels_of("0.5x");
  ASSERT_EQ(each.size(), 3U);
  for (const json& level : each) {
    const double tolerance = level["tolerance"].get<double>() / 2;
    EXPECT_EQ(level["texture"]["tolerance"]["absolute"], tolerance);
    EXPECT_LE(level["texture"]["upper"].get<double>(), tolerance);
    const json again = checked_document(measure({wavy, level["path"], "--texture", "--json", "-"}).out)["texture"];
    EXPECT_LE(again["upper"].get<double>(), tolerance);
    EXPECT_NEAR(again["upper"].get<double>(), level["texture"]["upper"].get<double>(), 0.01 * tolerance);
  }
  const json fixed = levels_of("0.002");
  EXPECT_EQ(fixed[0]["faces"], each[0]["faces"]);
  EXPECT_GT(fixed[2]["faces"].get<int>(), 2 * each[2]["faces"].get<int>());
  EXPECT_LE(fixed[2]["texture"]["upper"].get<double>(), 0.002);
  const ToolRun text = run_tool(LOD_CHAIN, {wavy, chain, "--format", "obj", "--levels", "0.01", "--texture-tolerance",
                                            "1x", "--normal-tolerance", "20"});
  EXPECT_NE(text.out.find("original to level"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("faces turn by at most"), std::string::npos) << text.out;
}

/// The levels of simplify_with_bound, and the proofs of their textures.
TEST_F(TextureTool, CertifiesTheTextureOfEachLevel) {
  const std::string wavy = folder_ / "wavy.obj", certificate = folder_ / "out.cert";
  write_square(wavy, 12, 0.08, 0, 0.05);
  const ToolRun run = simplify({wavy, out_, "--levels", "0.004", "--tolerance", "0.02", "--texture-tolerance", "1x",
                                "--normal-tolerance", "60", "--certificate", certificate, "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json document = checked_document(run.out);
  EXPECT_EQ(document["levels"][0]["texture"]["tolerance"]["absolute"], 0.004);
  EXPECT_LE(document["levels"][0]["texture"]["upper"].get<double>(), 0.004);
  EXPECT_LE(document["levels"][0]["normals"]["max_degrees"].get<double>(), 60);
  EXPECT_EQ(document["texture"]["tolerance"]["absolute"], 0.02);
  EXPECT_GT(document["texture"]["upper"].get<double>(), 0.004);
  const auto proves = [](const ToolRun& verified, const std::string& tolerance) {
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    EXPECT_NE(verified.out.find("texture     moves by at most " + tolerance), std::string::npos) << verified.out;
  };
  proves(run_tool(VERIFY_CERTIFICATE, {wavy, folder_ / "out_level_0.obj", folder_ / "out_level_0.cert"}), "0.004 (");
  proves(run_tool(VERIFY_CERTIFICATE, {wavy, out_, certificate}), "0.02 (");
}

/// Far from the origin floats move vertices by up to 1/2, a flat square's only within its plane. What measuring refutes
/// then is the rounded original, of which nothing can be undone.
TEST_F(TextureTool, RefusesFormatsThatRoundBeyondTheTolerances) {
  const std::string far = folder_ / "far.obj", glb = folder_ / "out.glb";
  const auto refused = [&](double wave, int exit_code, const std::string& why) {
    write_square(far, 16, 0.05, 0, wave, 1e7);
    const ToolRun run = simplify({far, glb, "--tolerance", "0.1", "--texture-tolerance", "0.1"});
    EXPECT_EQ(run.exit_code, exit_code);
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find(why), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(glb));
    EXPECT_EQ(simplify({far, out_, "--tolerance", "0.1", "--texture-tolerance", "0.1"}).exit_code, 0);
  };
  refused(0.5, 1, "smaller than the rounding of the output format");
  refused(0, 2, "out.glb: rounding coordinates to this format alone");
}

TEST_F(TextureTool, WritesTheOriginalWhereNothingMayMove) {
  const ToolRun kept = simplify({warped_, out_, "--tolerance", "1%", "--texture-tolerance", "0", "--json", "-"});
  ASSERT_EQ(kept.exit_code, 0) << kept.err;
  const json document = checked_document(kept.out);
  EXPECT_EQ(document["texture"]["upper"], 0);
}

/// A triangle without area at one corner of the square has texture coordinates of the opposite corner, which no face
/// near it has: it stays, and nothing else does. One whose coordinates lie beside it goes.
TEST_F(TextureTool, KeepsTrianglesWithoutAreaThatNoFaceNearShows) {
  const std::string square = folder_ / "square.obj", certificate = folder_ / "out.cert";
  write_square(square, 16, 0);
  std::ofstream(square, std::ios::app) << "v 0.125 0.125 0\nv 0.1875 0.125 0\n"
                                          "vt 0.9 0.9\nvt 0.9 0.8\nvt 0.8 0.9\n"
                                          "vt 0.125 0.125\nvt 0.1875 0.125\nvt 0.1875 0.126\n"
                                          "f -2/-6 -1/-5 -1/-4\nf -2/-3 -1/-2 -1/-1\n";
  const ToolRun run = simplify(
      {square, out_, "--tolerance", "1%", "--texture-tolerance", "0.01", "--json", "-", "--certificate", certificate});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json document = checked_document(run.out);
  EXPECT_EQ(document["simplified"]["faces"], 3);
  EXPECT_LE(document["texture"]["upper"].get<double>(), 0.01);
  const json again = checked_document(measure({square, out_, "--texture", "--json", "-"}).out);
  EXPECT_LE(again["texture"]["upper"].get<double>(), 0.01);
  EXPECT_EQ(run_tool(VERIFY_CERTIFICATE, {square, out_, certificate}).exit_code, 0);
}

/// A face thinner than what floats round off has another normal in every file of floats, or none. The other faces
/// count.
TEST_F(TextureTool, ComparesNormalsInThePrecisionOfTheFile) {
  const std::string thin = folder_ / "thin.obj", stl = folder_ / "out.stl";
  write_square(thin, 12, 0, 0, 0.2, 10000);
  std::ofstream(thin, std::ios::app) << "v 10000.5 0.2 2\nv 10000.5 0.8 2\nv 10000.50001 0.5 2.00001\nf -3 -2 -1\n";
  for (const std::string& out : {stl, out_}) {
    const ToolRun run = simplify({thin, out, "--tolerance", "0.02", "--normal-tolerance", "10", "--json", "-"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json document = checked_document(run.out);
    EXPECT_LE(document["normals"]["max_degrees"].get<double>(), 10);
    EXPECT_GT(document["normals"]["max_degrees"].get<double>(), 2);
    EXPECT_LT(document["simplified"]["faces"].get<int>(), 250);  // of 289
  }
}

/// All folds of 45 degrees are lower than the tolerance: only the normals keep them.
TEST_F(TextureTool, KeepsFacesFromTurning) {
  constexpr int n = 16;
  const std::string folded = folder_ / "folded.off", out = folder_ / "out.off";
  {
    std::ofstream off(folded);
    off << "OFF\n" << (n + 1) * (n + 1) << ' ' << 2 * n * n << " 0\n";
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) off << i + 1 << ' ' << j + 1 << ' ' << i % 2 + 1 << '\n';
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i, c = a + n + 1;
        off << "3 " << a << ' ' << a + 1 << ' ' << c + 1 << "\n3 " << a << ' ' << c + 1 << ' ' << c << '\n';
      }
    }
  }
  const auto faces = [](const json& document) { return document["simplified"]["faces"].get<int>(); };
  const std::vector<std::string> wide = {folded, out, "--tolerance", "1.5", "--json", "-"};
  const json without = checked_document(simplify(wide).out);
  std::vector<std::string> with_normals = wide;
  with_normals.insert(with_normals.end(), {"--normal-tolerance", "20"});
  const ToolRun kept = simplify(with_normals);
  ASSERT_EQ(kept.exit_code, 0) << kept.err;
  const json document = checked_document(kept.out);
  EXPECT_LE(document["normals"]["max_degrees"].get<double>(), 20);
  EXPECT_EQ(document["normals"]["tolerance"], 20);
  EXPECT_GT(faces(document), faces(without));
  EXPECT_LE(faces(document), 2 * n);  // two for each slope
}

/// Sixty ellipsoids that cross each other.
TriangleMesh crossing_ellipsoids() {
  std::mt19937 random(1);
  const auto between = [&](double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random()) / 0x1p32; };
  TriangleMesh all;
  for (int k = 0; k < 60; ++k) {
    const TriangleMesh sphere = datasets::icosphere(1, 3);
    const Eigen::Vector3d centre{between(0, 1), between(0, 1), between(0, 1)};
    const Eigen::Vector3d radii{between(0.1, 0.2), between(0.1, 0.2), between(0.1, 0.2)};
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (const Eigen::Vector3d& p : sphere.vertices) all.vertices.emplace_back(centre + radii.cwiseProduct(p));
    for (const Triangle& t : sphere.triangles) all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

/// Where sheets cross, what is taken back on one of them may stand for the other: in 20 rounds and more.
TEST_F(SlowTextureTool, KeepsNormalsWhereManySheetsCross) {
  const std::string crossing = folder_ / "crossing.ply";
  const TriangleMesh mesh = crossing_ellipsoids();
  write_mesh(crossing, mesh);
  for (const std::string tolerance : {"1%", "2%"}) {
    const ToolRun run =
        simplify({crossing, folder_ / "out.ply", "--tolerance", tolerance, "--normal-tolerance", "45", "--json", "-"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json document = checked_document(run.out);
    EXPECT_LE(document["normals"]["max_degrees"].get<double>(), 45);
    EXPECT_LT(document["simplified"]["faces"].get<std::size_t>(), mesh.triangles.size() / 8);
  }
}

}  // namespace texture_tool_test
}  // namespace meshbound
