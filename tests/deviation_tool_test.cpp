// SPDX-License-Identifier: MIT
// What --heatmap, --report and --image write: values against exact arithmetic, the scale of colours, files that other
// programs can read, and the same bytes for any number of threads.
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "datasets/analytic_meshes.h"
#include "deviation/checkerboard.h"
#include "deviation/colour_map.h"
#include "deviation/deviation_outputs.h"
#include "deviation/deviation_request.h"
#include "deviation/display_mesh.h"
#include "json_claims.h"
#include "meshbound/io.h"
#include "reference/brute_force.h"
#include "reference/exact_distance.h"
#include "reference/small_meshes.h"
#include "run_tool.h"

namespace meshbound {
namespace deviation_tool_test {

namespace fs = std::filesystem;
using namespace testing_tools;
using tools::Colour;

struct HeatmapVertex {
  Eigen::Vector3d position;
  double quality = 0;
  Colour colour{};
};

struct Heatmap {
  std::string header;
  std::vector<HeatmapVertex> vertices;
  std::vector<Triangle> triangles;
};

template <class T>
T take(const std::string& bytes, std::size_t& at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  at += sizeof(T);
  return value;
}

std::size_t count_after(const std::string& header, const std::string& words) {
  return std::stoul(header.substr(header.find(words) + words.size()));
}

/// A reader of its own for the very layout that the documents promise.
Heatmap read_heatmap(const std::string& path) {
  const std::string bytes = content_of(path);
  Heatmap heatmap;
  const std::string end = "end_header\n";
  std::size_t at = bytes.find(end) + end.size();
  heatmap.header = bytes.substr(0, at);
  EXPECT_NE(heatmap.header.find("format binary_little_endian 1.0\n"), std::string::npos) << heatmap.header;
  EXPECT_NE(heatmap.header.find("property double x\nproperty double y\nproperty double z\nproperty double quality\n"
                                "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face "),
            std::string::npos)
      << heatmap.header;
  heatmap.vertices.resize(count_after(heatmap.header, "element vertex "));
  for (HeatmapVertex& v : heatmap.vertices) {
    for (int k = 0; k < 3; ++k) v.position[k] = take<double>(bytes, at);
    v.quality = take<double>(bytes, at);
    for (std::uint8_t& value : v.colour) value = take<std::uint8_t>(bytes, at);
  }
  heatmap.triangles.resize(count_after(heatmap.header, "element face "));
  for (Triangle& t : heatmap.triangles) {
    EXPECT_EQ(take<std::uint8_t>(bytes, at), 3);
    for (std::uint32_t& v : t) v = take<std::uint32_t>(bytes, at);
  }
  EXPECT_EQ(at, bytes.size());
  return heatmap;
}

class DeviationTool : public testing::Test {
 protected:
  DeviationTool() { write_mesh(in("in.off"), datasets::torus(1, 0.3, 40, 16)); }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] TriangleMesh mesh(const std::string& name) const { return read_mesh(in(name)).mesh; }
  [[nodiscard]] ToolRun simplify(std::vector<std::string> options) const {
    options.insert(options.begin(), {in("in.off"), in("out.ply"), "--tolerance", "0.02"});
    return run_tool(SIMPLIFY_WITH_BOUND, options);
  }
  /// The file holds `mesh`, and for each vertex its distance to `other`: never below, no more than a rounding above.
  static void expect_heatmap(const Heatmap& heatmap, const TriangleMesh& mesh, const TriangleMesh& other,
                             double scale) {
    ASSERT_EQ(heatmap.vertices.size(), mesh.vertices.size());
    EXPECT_EQ(heatmap.triangles, mesh.triangles);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      EXPECT_EQ(heatmap.vertices[v].position, mesh.vertices[v]);
      const reference::ExactLength exact = reference::exact_distance(mesh.vertices[v], other);
      const double quality = heatmap.vertices[v].quality;
      EXPECT_LE(exact.compare(quality), 0) << v;
      EXPECT_NEAR(quality, exact.approximate(), 1e-12) << v;
      const bool is_beyond = quality > scale + 1e-12;
      EXPECT_EQ(heatmap.vertices[v].colour,
                is_beyond ? tools::colour_beyond : tools::colour_of(std::min(1.0, quality / scale)))
          << v;
    }
  }
  [[nodiscard]] bool has_report_page() const {
    return run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("in.off"), "--report", in("probe.html")}).exit_code == 0;
  }

  test::TemporaryFolder folder_;
};

TEST_F(DeviationTool, HeatmapsHoldTheDistanceOfEveryVertex) {
  const ToolRun run = simplify({"--heatmap", in("result.ply"), "--heatmap-original", in("original.ply")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Heatmap result = read_heatmap(in("result.ply"));
  expect_heatmap(result, mesh("out.ply"), mesh("in.off"), 0.02);
  EXPECT_NE(result.header.find("comment colours: viridis from 0 to 0.02, the tolerance; 255 0 144 beyond it\n"),
            std::string::npos)
      << result.header;
  expect_heatmap(read_heatmap(in("original.ply")), mesh("in.off"), mesh("out.ply"), 0.02);
  EXPECT_EQ(mesh("result.ply").triangles, mesh("out.ply").triangles) << "our own reader takes it, too";
}

/// It lies where the bound of the surface says nothing.
TEST_F(DeviationTool, AVertexThatNoTriangleHasKeepsItsOwnDistance) {
  TriangleMesh with_unused = datasets::torus(1, 0.3, 40, 16);
  with_unused.vertices.emplace_back(0, 0, 5);
  write_mesh(in("unused.off"), with_unused);
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in("unused.off"), in("in.off"), "--heatmap-original", in("h.ply")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(read_heatmap(in("h.ply")).vertices.back().quality, 4);
}

TEST_F(DeviationTool, WhatIsBeyondTheToleranceHasAColourOfItsOwn) {
  ASSERT_EQ(simplify({"--quiet"}).exit_code, 0);
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("out.ply"), "--tolerance", "0.005", "--heatmap",
                                                    in("b.ply"), "--heatmap-original", in("a.ply")});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  const Heatmap a = read_heatmap(in("a.ply"));
  expect_heatmap(a, mesh("in.off"), mesh("out.ply"), 0.005);
  expect_heatmap(read_heatmap(in("b.ply")), mesh("out.ply"), mesh("in.off"), 0.005);
  const auto beyond = std::count_if(a.vertices.begin(), a.vertices.end(),
                                    [](const HeatmapVertex& v) { return v.colour == tools::colour_beyond; });
  EXPECT_GT(beyond, 0);
  EXPECT_LT(beyond, static_cast<std::ptrdiff_t>(a.vertices.size()));
}

TEST_F(DeviationTool, WithoutAToleranceTheScaleEndsAtTheProvenMaximum) {
  ASSERT_EQ(simplify({"--quiet"}).exit_code, 0);
  const ToolRun run =
      run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("out.ply"), "--heatmap", in("b.ply"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = checked_document(content_of(in("r.json")));
  EXPECT_EQ(json["deviation"]["scale"], json["distance"]["upper"]);
  EXPECT_EQ(json["deviation"]["scale_meaning"], "proven maximum");
  const Heatmap heatmap = read_heatmap(in("b.ply"));
  expect_heatmap(heatmap, mesh("out.ply"), mesh("in.off"), json["distance"]["upper"]);
  EXPECT_NE(heatmap.header.find(", the proven maximum;"), std::string::npos) << heatmap.header;
}

TEST_F(DeviationTool, IdenticalMeshesHaveNoDeviation) {
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("in.off"), "--heatmap", in("b.ply"), "--image",
                                                    in("i.png"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const HeatmapVertex& v : read_heatmap(in("b.ply")).vertices) {
    EXPECT_LT(v.quality, 1e-12);
    EXPECT_EQ(v.colour, tools::colour_of(0));
  }
  EXPECT_EQ(checked_document(content_of(in("r.json")))["deviation"]["scale_meaning"], "1e-9 of the diagonal");
}

/// The middles of many small parts, weighted by their areas.
TEST_F(DeviationTool, StatisticsOfTheDocumentAreThoseOfADenseCut) {
  ASSERT_EQ(simplify({"--heatmap", in("h.ply"), "--json", in("r.json")}).exit_code, 0);
  const Json json = checked_document(content_of(in("r.json")));
  const TriangleMesh original = mesh("in.off"), result = mesh("out.ply");
  const auto expect_statistics = [](const Json& found, TriangleMesh from, const Bvh& to) {
    while (from.triangles.size() < 300'000) from = reference::subdivided(from);
    double area = 0, sum = 0, squares = 0;
    for (const Triangle& t : from.triangles) {
      const Eigen::Vector3d a = from.vertices[t[0]], b = from.vertices[t[1]], c = from.vertices[t[2]];
      const double weight = (b - a).cross(c - a).norm();
      const double distance = closest_point(to, (a + b + c) / 3).distance.upper;
      area += weight;
      sum += weight * distance;
      squares += weight * distance * distance;
    }
    EXPECT_NEAR(found["mean"].get<double>(), sum / area, 1e-5);
    EXPECT_NEAR(found["root_mean_square"].get<double>(), std::sqrt(squares / area), 1e-5);
    std::size_t samples = found["beyond_scale"];
    for (const Json& bin : found["histogram"]) samples += bin.get<std::size_t>();
    EXPECT_EQ(samples, found["samples"]);
    EXPECT_EQ(found["beyond_scale"], 0);
  };
  expect_statistics(json["deviation"]["original_to_simplified"], original, Bvh(result));
  expect_statistics(json["deviation"]["simplified_to_original"], result, Bvh(original));
}

TEST_F(DeviationTool, TheTextNamesTheStatisticsWithTheirUnit) {
  const ToolRun run = simplify({"--heatmap", in("h.ply"), "--units", "mm"});
  EXPECT_NE(run.out.find("\ndeviation   original to simplified: mean 0.00"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find(" mm, RMS 0.00"), std::string::npos) << run.out;
  EXPECT_EQ(simplify({}).out.find("deviation"), std::string::npos);
}

struct Pixels {
  png_image image{};
  std::vector<std::uint8_t> rgb;
};

Pixels decoded_png(const std::string& bytes) {
  Pixels pixels;
  pixels.image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&pixels.image, bytes.data(), bytes.size()), 0) << pixels.image.message;
  pixels.image.format = PNG_FORMAT_RGB;
  pixels.rgb.resize(PNG_IMAGE_SIZE(pixels.image));
  EXPECT_NE(png_image_finish_read(&pixels.image, nullptr, pixels.rgb.data(), 0, nullptr), 0) << pixels.image.message;
  return pixels;
}

/// A square of triangles at z = 0 with x and y as texture coordinates, of which v is shifted.
void write_textured_square(const std::string& path, double shift) {
  std::ofstream file(path);
  constexpr int n = 8;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) file << "v " << double(i) / n << ' ' << double(j) / n << " 0\n";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) file << "vt " << double(i) / n << ' ' << double(j) / n + shift << '\n';
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1, b = a + 1, c = a + n + 1, d = c + 1;
      for (const std::array<int, 3>& t : {std::array{a, b, d}, std::array{a, d, c}})
        file << "f " << t[0] << '/' << t[0] << ' ' << t[1] << '/' << t[1] << ' ' << t[2] << '/' << t[2] << '\n';
    }
}

/// Share of the pixels of panel 0, 1 or 2 whose channels differ by more than a few grey levels.
double coloured_share(const Pixels& pixels, std::size_t panel) {
  const std::size_t width = pixels.image.width, panel_width = width / 3;
  std::size_t coloured = 0, all = 0;
  for (std::size_t y = 40; y + 40 < pixels.image.height; ++y) {
    for (std::size_t x = panel * panel_width; x < (panel + 1) * panel_width; ++x, ++all) {
      const std::uint8_t* const p = &pixels.rgb[3 * (y * width + x)];
      const auto [low, high] = std::minmax({p[0], p[1], p[2]});
      if (high - low > 40) ++coloured;
    }
  }
  return static_cast<double>(coloured) / static_cast<double>(all);
}

TEST(Checkerboard, AlternatesAlongUAndV) {
  CornerAttribute texture;
  texture.values = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  texture.index = {{0, 1, 2}, {0, 1, CornerAttribute::none}};
  const Colour otherwise = {1, 2, 3};
  const auto at = [&](double u, double v) { return tools::checkerboard_at(texture, 0, {1 - u - v, u, v}, otherwise); };
  constexpr double square = 1.0 / tools::squares_per_unit;
  const auto is_dark = [&](double u, double v) { return at(u * square, v * square)[1] < 140; };
  EXPECT_FALSE(is_dark(0.5, 0.5));
  EXPECT_TRUE(is_dark(1.5, 0.5));
  EXPECT_TRUE(is_dark(0.5, 1.5));
  EXPECT_FALSE(is_dark(1.5, 1.5));
  EXPECT_LT(at(0.5 * square, 0.5 * square)[2], at(0.5 * square, 10.5 * square)[2]);
  EXPECT_EQ(tools::checkerboard_at(texture, 1, {1, 0, 0}, otherwise), otherwise);
  EXPECT_EQ(tools::checkerboard_at(texture, 2, {1, 0, 0}, otherwise), otherwise);
}

TEST_F(DeviationTool, PictureShowsACheckerboardInTheTexture) {
  std::vector<Pixels> pictures;
  for (const double shift : {0.0, 0.5 / tools::squares_per_unit}) {
    write_textured_square(in("square.obj"), shift);
    const ToolRun run = run_tool(SIMPLIFY_WITH_BOUND, {in("square.obj"), in("out.obj"), "--tolerance", "0.1%",
                                                       "--texture-tolerance", "0.1%", "--image", in("i.png")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    pictures.push_back(decoded_png(content_of(in("i.png"))));
    EXPECT_GT(coloured_share(pictures.back(), 0), 0.2);
    EXPECT_GT(coloured_share(pictures.back(), 1), 0.2);
    // The texture has hardly moved, so both panels show the same but for the edges of triangles.
    EXPECT_NEAR(coloured_share(pictures.back(), 0), coloured_share(pictures.back(), 1), 0.05);
  }
  EXPECT_NE(pictures[0].rgb, pictures[1].rgb);
}

TEST_F(DeviationTool, PictureHasThreePanelsOfWhichTheLastIsInColours) {
  for (const char* const up : {"x", "y", "z"}) {
    ASSERT_EQ(simplify({"--image", in("i.png"), "--up", up}).exit_code, 0);
    const Pixels pixels = decoded_png(content_of(in("i.png")));
    EXPECT_EQ(pixels.image.width, 1200u);
    EXPECT_LT(coloured_share(pixels, 0), 0.001);
    EXPECT_LT(coloured_share(pixels, 1), 0.001);
    EXPECT_GT(coloured_share(pixels, 2), 0.1);
  }
}

/// Pixels in the shades of the colour for what is beyond the scale, but for those of the legend.
std::size_t pixels_beyond(const Pixels& pixels) {
  constexpr std::size_t footer = 40;  // rows
  std::size_t beyond = 0;
  for (std::size_t i = 0; i + 2 < pixels.rgb.size() - 3 * footer * pixels.image.width; i += 3)
    if (pixels.rgb[i] > 130 && pixels.rgb[i + 1] < 10 && pixels.rgb[i + 2] > 70) ++beyond;
  return beyond;
}

/// A needle of the original that the result has lost is seen only where the original is in colours.
TEST_F(DeviationTool, PictureColoursTheMeshThatIsFurtherAway) {
  write_mesh(in("spikes.off"), datasets::spiked_plane(1, 0.2, 20, 5));
  write_mesh(in("flat.off"), reference::unit_square(2));
  ASSERT_EQ(
      run_tool(HAUSDORFF_DISTANCE, {in("spikes.off"), in("flat.off"), "--tolerance", "0.1", "--image", in("i.png")})
          .exit_code,
      1);
  EXPECT_GT(pixels_beyond(decoded_png(content_of(in("i.png")))), 100u);
}

/// A copy of a mesh whose coordinates are multiples of 0.125, so that points inside of triangles are rounded to places
/// beside them: the picture, the statistics and the view of the report showed these roundings.
TEST_F(DeviationTool, NothingIsShownBeyondTheProvenDistanceOfAMeshFarAway) {
  write_mesh(in("far.off"), reference::moved(datasets::torus(1, 0.3, 40, 16), {1e15, 1e15, 1e15}));
  const ToolRun run = run_tool(HAUSDORFF_DISTANCE, {in("far.off"), in("far.off"), "--tolerance", "0.01", "--image",
                                                    in("i.png"), "--heatmap", in("h.ply"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = checked_document(content_of(in("r.json")));
  ASSERT_EQ(json["distance"]["upper"], 0);
  for (const char* const direction : {"a_to_b", "b_to_a"}) {
    const Json& found = json["deviation"][direction];
    EXPECT_EQ(found["beyond_scale"], 0) << direction;
    for (const char* const value : {"mean", "root_mean_square", "percentile_95", "largest_sample"})
      EXPECT_EQ(found[value], 0) << direction << ' ' << value;
  }
  for (const HeatmapVertex& v : read_heatmap(in("h.ply")).vertices) EXPECT_EQ(v.quality, 0);
  EXPECT_EQ(pixels_beyond(decoded_png(content_of(in("i.png")))), 0u);
}

TEST_F(DeviationTool, OutputsAreTheSameForAnyNumberOfThreads) {
  for (const char* const threads : {"1", "3"})
    ASSERT_EQ(simplify({"--threads", threads, "--heatmap", in(std::string("h") + threads + ".ply"), "--image",
                        in(std::string("i") + threads + ".png")})
                  .exit_code,
              0);
  EXPECT_EQ(content_of(in("h1.ply")), content_of(in("h3.ply")));
  EXPECT_EQ(content_of(in("i1.png")), content_of(in("i3.png")));
}

TEST_F(DeviationTool, RefusesBeforeAnyWorkWhatItCannotWrite) {
  const auto expect_refused = [&](const ToolRun& run, const std::string& reason) {
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(line_count(run.err), 1) << run.err;
    EXPECT_NE(run.err.find(reason), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(in("out.ply")));
  };
  expect_refused(simplify({"--heatmap", in("h.obj")}), "must be a .ply file");
  expect_refused(simplify({"--heatmap", in("absent/h.ply")}), "absent/h.ply");
  expect_refused(simplify({"--heatmap", in("out.ply")}), "is the file that is written");
  expect_refused(simplify({"--image", in("in.off")}), "is the file that is read as IN");
  expect_refused(simplify({"--up", "w"}), "--up");
  expect_refused(simplify({"--image", in("i.jpg")}), "must be a .png file");
  expect_refused(simplify({"--json", in("precious.ply")}), "has the name of a mesh");
  expect_refused(simplify({"--certificate", in("precious.ply")}), "has the name of a mesh");
  expect_refused(simplify({"--units", "mm"}), "--units names the unit of deviations");
  expect_refused(simplify({"--up", "y", "--heatmap", in("h.ply")}), "--up is for reports and pictures");
  std::ofstream(in("poses")) << "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
  expect_refused(
      run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("in.off"), "--poses", in("poses"), "--image", in("i.png")}),
      "leave out --poses");
  expect_refused(run_tool(HAUSDORFF_DISTANCE, {in("in.off"), "--nearest", folder_.path(), "--image", in("i.png")}),
                 "leave out --nearest");
}

TEST_F(DeviationTool, WithoutTimeTheResultIsThereButNoDeviation) {
  const ToolRun run =
      run_tool(HAUSDORFF_DISTANCE, {in("in.off"), in("in.off"), "--time-limit", "0", "--heatmap", in("h.ply")});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("no time was left to measure deviations"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(in("h.ply")));
}

/// Triangles in a square that share no vertices, of which a report holds 2.5 times as much.
TriangleMesh scattered_triangles(std::uint32_t count) {
  TriangleMesh mesh;
  const auto row = static_cast<std::uint32_t>(std::sqrt(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = i % row + 0.4 * std::sin(i), y = i / row + 0.4 * std::sin(3 * i);
    mesh.vertices.insert(mesh.vertices.end(), {{x, y, 0}, {x + 0.9, y, 0}, {x, y + 0.9, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

/// What stands between the tags of a block of the page.
Json block(const std::string& page, const std::string& id) {
  const std::string begin = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t at = page.find(begin) + begin.size();
  return Json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST_F(DeviationTool, ReportIsOneFileThatHoldsTheDocument) {
  if (!has_report_page()) GTEST_SKIP() << "this build has no report page: npm was missing";
  ASSERT_EQ(run_shell("cp " + shell_quoted(in("in.off")) + " " + shell_quoted(in("in <b>.off"))).exit_code, 0);
  const ToolRun run =
      run_tool(SIMPLIFY_WITH_BOUND, {in("in <b>.off"), in("out.ply"), "--tolerance", "0.02", "--levels", "0.005,0.01",
                                     "--units", "</script>", "--report", in("r.html"), "--json", in("r.json")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string page = content_of(in("r.html"));
  EXPECT_EQ(block(page, "document"), checked_document(content_of(in("r.json"))));
  const Json scene = block(page, "scene");
  EXPECT_EQ(scene["unit"], "</script>");
  EXPECT_EQ(scene["meshes"].size(), 4u);
  for (const char* const outside : {"src=\"http", "href=\"http", "src=http", "@import", "@@"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_EQ(page.find("<b>"), std::string::npos) << "the name of a file became a part of the page";
  EXPECT_LT(page.size(), 20u << 20);
}

/// As many levels as the view shows, of an original whose triangles share no vertices: the deviations of its vertices
/// from each level alone would take 12 MB.
TEST_F(DeviationTool, ReportOfManyLevelsStaysBelow20MB) {
  if (!has_report_page()) GTEST_SKIP() << "this build has no report page: npm was missing";
  const TriangleMesh original = scattered_triangles(60'000), result = reference::unit_square(1);
  tools::DeviationRequest request;
  request.report = in("r.html");
  tools::DeviationSubject subject(original, result, 1000, {}, {}, nullptr);
  subject.levels.resize(24, {reference::unit_square(1), {}});
  subject.measurement.obstacle = "of a test";
  tools::DeviationOutputs outputs(request);
  outputs.measure(subject, {});
  outputs.stage("{}");
  outputs.publish();
  EXPECT_EQ(block(content_of(in("r.html")), "scene")["meshes"].size(), 26u);
  EXPECT_LT(fs::file_size(in("r.html")), 15'000'000u) << "of 20, with room for the engine and the document";
}

TEST_F(DeviationTool, BuildsWithoutThePageSaySo) {
  const ToolRun run = run_tool(HAUSDORFF_WITHOUT_REPORT_PAGE, {in("in.off"), in("in.off"), "--report", in("r.html")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("install Node.js and npm"), std::string::npos) << run.err;
  EXPECT_EQ(line_count(run.err), 1) << run.err;
  EXPECT_FALSE(fs::exists(in("r.html")));
  EXPECT_EQ(run_tool(HAUSDORFF_WITHOUT_REPORT_PAGE, {in("in.off"), in("in.off"), "--heatmap", in("h.ply")}).exit_code,
            0);
}

TEST(DisplayMesh, OfALargeMeshIsSmallAndKeepsItsPeak) {
  const TriangleMesh large = datasets::spiked_plane(1, 0.2, 200, 40), flat = reference::unit_square(1);
  const Bvh other(flat);
  const std::vector<Bounds> vertices = vertex_deviations(large, other);
  const tools::DisplayMesh display = tools::display_mesh(large, vertices, other, {2000}, {});
  EXPECT_TRUE(display.is_reduced);
  EXPECT_EQ(display.faces, large.triangles.size());
  EXPECT_LE(display.mesh.triangles.size(), 2000u);
  EXPECT_GT(display.mesh.triangles.size(), 1000u);
  ASSERT_EQ(display.deviations.size(), display.mesh.vertices.size());
  double highest = 0;
  for (std::size_t v = 0; v < display.deviations.size(); ++v) {
    highest = std::max(highest, display.deviations[v].upper);
    EXPECT_NEAR(display.deviations[v].upper, display.mesh.vertices[v].z(), 1e-12);
  }
  EXPECT_NEAR(highest, 0.2, 1e-9);
}

TEST(DisplayMesh, OfASmallMeshShowsTheInsideOfItsTriangles) {
  TriangleMesh tent = reference::unit_square(2);
  for (Eigen::Vector3d& p : tent.vertices)
    if (p.x() == 0.5 && p.y() == 0.5) p.z() = 0.3;
  const TriangleMesh square = reference::unit_square(1);
  const Bvh other(tent);
  const tools::DisplayMesh display = tools::display_mesh(square, vertex_deviations(square, other), other, {1000}, {});
  EXPECT_FALSE(display.is_reduced);
  EXPECT_LE(display.mesh.triangles.size(), 1000u);
  EXPECT_GT(display.mesh.triangles.size(), 500u);
  EXPECT_EQ(display.edges.size(), 5u);
  double area = 0, highest = 0;
  for (const Triangle& t : display.mesh.triangles) {
    const Eigen::Vector3d a = display.mesh.vertices[t[0]], b = display.mesh.vertices[t[1]],
                          c = display.mesh.vertices[t[2]];
    area += (b - a).cross(c - a).norm() / 2;
  }
  for (const Bounds& deviation : display.deviations) highest = std::max(highest, deviation.upper);
  EXPECT_NEAR(area, 1, 1e-12);
  EXPECT_GT(highest, 0.15);
}

TEST(DisplayMesh, OfTrianglesThatShareNoVerticesStaysWithinItsBytes) {
  const TriangleMesh mesh = scattered_triangles(6'000), flat = reference::unit_square(1);
  const Bvh other(flat);
  const std::vector<Bounds> vertices = vertex_deviations(mesh, other);
  const tools::DisplayMesh large = tools::display_mesh(mesh, vertices, other, {6'000}, {});
  EXPECT_FALSE(large.is_reduced);
  tools::DisplayLimits limits{6'000, tools::packed_size(large, 1) / 3};
  limits.deviation_sets = 26;
  const tools::DisplayMesh small = tools::display_mesh(mesh, vertices, other, limits, {});
  EXPECT_TRUE(small.is_reduced);
  EXPECT_LE(tools::packed_size(small, 26), limits.max_size);
  EXPECT_GT(tools::packed_size(small, 26), limits.max_size / 3);
}

/// Points inside of triangles are rounded, and the view must not show by how much.
TEST(DisplayMesh, TakesNoRoundingOfItsPointsForDeviations) {
  const TriangleMesh mesh = reference::moved(datasets::torus(1, 0.3, 20, 8), {1e15, 1e15, 1e15});
  const Bvh same(mesh);
  const tools::DisplayMesh display = tools::display_mesh(mesh, vertex_deviations(mesh, same), same, {5000}, {});
  ASSERT_GT(display.mesh.vertices.size(), mesh.vertices.size());
  for (const Bounds& deviation : display.deviations) EXPECT_EQ(deviation.lower, 0);
  for (const Bounds& deviation : tools::display_deviations(display, same, {})) EXPECT_EQ(deviation.lower, 0);
}

TEST(ColourMap, RunsFromVioletToYellow) {
  EXPECT_EQ(tools::colour_of(0), (Colour{68, 1, 84}));
  EXPECT_EQ(tools::colour_of(1), (Colour{253, 231, 37}));
  EXPECT_EQ(tools::colour_of(0.5), (Colour{35, 144, 140}));
  EXPECT_EQ(tools::colour_of(1.0001), tools::colour_beyond);
  EXPECT_EQ(tools::colour_of(std::nan("")), tools::colour_beyond);
  EXPECT_EQ(tools::colour_of(-1), tools::colour_of(0));
}

}  // namespace deviation_tool_test
}  // namespace meshbound
