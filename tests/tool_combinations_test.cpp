// SPDX-License-Identifier: MIT
// Combinations of options of simplify_with_bound on meshes that are drawn at random, with defects and textures of
// several kinds. Whatever comes out is measured, its certificate is checked, and two threads must write the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "run_tool.h"

namespace meshbound {
namespace tool_combinations_test {

using testing_tools::content_of;
using testing_tools::run_tool;
using testing_tools::ToolRun;
using Words = std::vector<std::string>;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  int number(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double p) { return real(0, 1) < p; }
  std::string one_of(const Words& words) {
    return words[static_cast<std::size_t>(number(0, static_cast<int>(words.size()) - 1))];
  }

 private:
  std::mt19937_64 random_;
};

struct Point {
  double x, y, z;
};

/// A point of a surface by its parameters, each from 0 to 1.
Point point_of(const std::string& surface, double s, double t) {
  const double a = 2 * std::numbers::pi * s, b = 2 * std::numbers::pi * t;
  if (surface == "cylinder") return {std::cos(a), std::sin(a), 2 * t};
  if (surface == "torus")
    return {(1 + 0.3 * std::cos(b)) * std::cos(a), (1 + 0.3 * std::cos(b)) * std::sin(a), 0.3 * std::sin(b)};
  return {s, t, 0};
}

/// Writes a surface in n x m squares, some of which may be gone, turned over or there twice. Returns whether it has
/// texture coordinates.
bool write_surface(Draw& draw, const std::string& path) {
  const std::string surface = draw.one_of({"sheet", "cylinder", "torus"}),
                    texture = draw.one_of({"", "along", "above", "line", "one"});
  const int n = draw.number(3, 16), m = draw.number(3, 16);
  const double noise = draw.chance(0.5) ? 0 : std::pow(10, draw.real(-4, -1)), scale = std::pow(10, draw.real(-9, 9)),
               offset = draw.chance(0.6) ? 0 : std::pow(10, draw.real(0, 4)), gone = draw.chance(0.3) ? 0.1 : 0,
               turned = draw.chance(0.15) ? 0.1 : 0, twice = draw.chance(0.2) ? 0.05 : 0;
  std::ofstream out(path);
  out.precision(17);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      const bool closes = surface != "sheet" && i == n;
      const Point p = point_of(surface, closes ? 0 : i / double(n), surface == "torus" && j == m ? 0 : j / double(m));
      const Point q{scale * (p.x + offset + noise * draw.real(-1, 1)), scale * (p.y + noise * draw.real(-1, 1)),
                    scale * (p.z + noise * draw.real(-1, 1))};
      out << "v " << q.x << ' ' << q.y << ' ' << q.z << '\n';
      if (texture == "along") out << "vt " << i / double(n) << ' ' << j / double(m) << '\n';
      if (texture == "above") out << "vt " << p.x << ' ' << p.y << '\n';
      if (texture == "line") out << "vt " << i / double(n) << " 0.5\n";
      if (texture == "one") out << "vt 0.25 0.25\n";
    }
  const auto write_face = [&](int a, int b, int c) {
    out << 'f';
    for (const int v : {a, b, c}) out << ' ' << v << (texture.empty() ? "" : '/' + std::to_string(v));
    out << '\n';
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * (m + 1) + j + 1, b = a + 1, c = a + m + 1, d = c + 1;
      if (!draw.chance(gone)) write_face(a, c, d);
      draw.chance(turned) ? write_face(a, b, d) : write_face(a, d, b);
      if (draw.chance(twice)) write_face(a, d, b);
    }
  return !texture.empty();
}

/// Options of a run beside its tolerances.
Words drawn_options(Draw& draw, const std::string& tolerance) {
  Words options;
  const auto add = [&](double p, const Words& words) {
    if (draw.chance(p)) options.insert(options.end(), words.begin(), words.end());
  };
  add(0.2, {"--normal-tolerance", draw.one_of({"0", "5", "30", "180"})});
  add(0.2, {"--line-tolerance", draw.one_of({tolerance, "0.01%"})});
  add(0.2, {"--feature-angle", draw.one_of({"0", "30", "120"})});
  add(0.1, {"--preserve-boundary"});
  add(0.15, {"--prune"});
  add(0.2, {"--effort", "high"});
  add(0.3, {"--driver", "core"});
  add(0.1, {"--placement", "subset"});
  const bool is_high = std::find(options.begin(), options.end(), "high") != options.end();
  if (!is_high) add(0.1, {"--on-exceed", "stop"});  // the two exclude each other
  add(0.15, {"--target-ratio", draw.one_of({"50%", "10%", "0"})});
  add(0.2, {"--single-precision"});
  return options;
}

class ToolCombinations : public testing::Test {
 protected:
  void expect_proven_results(std::uint64_t first_seed, std::uint64_t count) {
    for (std::uint64_t seed = first_seed; seed < first_seed + count; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      expect_proven_result(seed);
    }
  }

  testing_tools::TemporaryFolder folder_;

 private:
  void expect_proven_result(std::uint64_t seed) {
    Draw draw(seed);
    const std::string in = folder_ / "in.obj", certificate = folder_ / "c.cert";
    const bool has_texture = write_surface(draw, in);
    const std::string tolerance = draw.one_of({"5%", "1%", "0.3%", "0.1%", "0.01%"}),
                      format =
                          draw.one_of(has_texture ? Words{"obj", "ply", "glb"} : Words{"obj", "ply", "off", "stl"}),
                      out = folder_ / ("out." + format), out_of_two = folder_ / ("two." + format);
    const bool bounds_texture = has_texture && draw.chance(0.8);
    Words options = drawn_options(draw, tolerance);
    options.insert(options.end(), {"--tolerance", tolerance, "--quiet"});
    if (bounds_texture) options.insert(options.end(), {"--texture-tolerance", tolerance});
    const auto simplify = [&](const std::string& to, const Words& more) {
      Words words = {in, to};
      words.insert(words.end(), options.begin(), options.end());
      words.insert(words.end(), more.begin(), more.end());
      return run_tool(SIMPLIFY_WITH_BOUND, words);
    };
    const ToolRun run = simplify(out, {"--threads", "1", "--certificate", certificate});
    if (run.exit_code != 0) {  // what floats round may be too much
      EXPECT_NE(run.err.find("rounding"), std::string::npos) << run.err;
      return;
    }
    EXPECT_EQ(simplify(out_of_two, {"--threads", "2"}).exit_code, 0);
    EXPECT_EQ(content_of(out), content_of(out_of_two));
    const ToolRun proof = run_tool(VERIFY_CERTIFICATE, {in, out, certificate});
    EXPECT_EQ(proof.exit_code, 0) << proof.err;
    EXPECT_EQ(run_tool(HAUSDORFF_DISTANCE, {in, out, "--tolerance", tolerance, "--quiet"}).exit_code, 0);
    if (!bounds_texture) return;
    const ToolRun texture =
        run_tool(HAUSDORFF_DISTANCE, {in, out, "--texture", "--texture-tolerance", tolerance, "--quiet"});
    EXPECT_NE(texture.exit_code, 1) << texture.err;
  }
};

class SlowToolCombinations : public ToolCombinations {};

TEST_F(ToolCombinations, GiveProvenResults) { expect_proven_results(0, 60); }
TEST_F(SlowToolCombinations, GiveProvenResults) { expect_proven_results(1000, 1000); }

}  // namespace tool_combinations_test
}  // namespace meshbound
