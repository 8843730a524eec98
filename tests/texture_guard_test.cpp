// SPDX-License-Identifier: MIT
// Collapses that would move the texture are refused one by one: what comes out is measured by `texture_deviation`.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "meshbound/lod_chain.h"
#include "meshbound/simplify.h"
#include "meshbound/texture_deviation.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace texture_guard_test {

using Coordinates = std::array<Eigen::Vector2d, 3>;

/// A mesh with texture coordinates at the corners of its triangles.
struct Textured {
  TriangleMesh mesh;
  std::vector<Coordinates> coordinates;
  std::vector<std::uint32_t> materials;
};

using Height = std::function<double(double x, double y)>;
using Map = std::function<Eigen::Vector2d(double x, double y, bool is_right)>;

/// n x n squares of the unit square at a height; `map` also says what the half right of x = 1/2 has.
Textured sheet(std::uint32_t n, const Height& height, const Map& map) {
  Textured result;
  const auto at = [&](std::uint32_t i) { return i / static_cast<double>(n); };
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) result.mesh.vertices.emplace_back(at(x), at(y), height(at(x), at(y)));
  const auto add = [&](const Triangle& t) {
    double middle = 0;
    for (const std::uint32_t v : t) middle += result.mesh.vertices[v].x() / 3;
    Coordinates& corners = result.coordinates.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = map(result.mesh.vertices[t[k]].x(), result.mesh.vertices[t[k]].y(), middle > 0.5);
    result.mesh.triangles.push_back(t);
  };
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      add({a, b, d});
      add({a, d, c});
    }
  }
  return result;
}

double flat(double /*x*/, double /*y*/) { return 0; }
Eigen::Vector2d even(double x, double y, bool /*is_right*/) { return {x, y}; }
Eigen::Vector2d warped(double x, double y, bool /*is_right*/) {
  return {x + 0.05 * std::sin(2 * std::numbers::pi * x), y + 0.05 * std::sin(2 * std::numbers::pi * (x + y))};
}

SimplifyOptions options_of(const Textured& sheet, double tolerance, double texture_tolerance) {
  SimplifyOptions options;
  options.tolerance = tolerance;
  options.texture_coordinates = sheet.coordinates;
  options.materials = sheet.materials;
  options.texture_tolerance = texture_tolerance;
  return options;
}

TexturedMesh textured(const TriangleMesh& mesh, const std::vector<Coordinates>& coordinates) {
  TexturedMesh result;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    TexturedTriangle& added = result.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) added.corners[k] = mesh.vertices[mesh.triangles[t][k]];
    added.coordinates = coordinates[t];
    added.triangle = t;
  }
  return result;
}

TextureDeviation deviation_of(const Textured& original, const SimplifiedLevel& level) {
  TextureDeviationOptions options;
  options.error_bound = 1e-4;
  return texture_deviation(textured(original.mesh, original.coordinates),
                           textured(level.mesh, level.texture_coordinates), options);
}

SimplifiedLevel simplified(const Textured& sheet, double tolerance, double texture_tolerance) {
  return simplify_with_bound(sheet.mesh, options_of(sheet, tolerance, texture_tolerance)).last();
}

/// Where the texture is even, it asks for no faces of its own.
TEST(TextureGuard, LeavesTwoFacesOfAnEvenSquare) {
  const Textured square = sheet(16, flat, even);
  const SimplifiedLevel level = simplified(square, 0.01, 0.01);
  EXPECT_EQ(level.faces(), 2U);
  EXPECT_LE(deviation_of(square, level).bounds.upper, 1e-4);
}

/// On a plane every collapse keeps the surface: only the texture limits what may go. Without its tolerance the map of
/// the two faces that remain is the even one, off by up to 0.05 along u and v.
TEST(TextureGuard, KeepsFacesWhereTheTextureIsUneven) {
  const Textured square = sheet(16, flat, warped);
  EXPECT_GT(deviation_of(square, simplified(square, 0.01, HUGE_VAL)).bounds.lower, 0.04);
  const SimplifiedLevel level = simplified(square, 0.01, 0.01);
  EXPECT_LE(deviation_of(square, level).bounds.upper, 0.01);
  EXPECT_LT(level.faces(), 200U);  // of 512
  EXPECT_LT(simplified(square, 0.01, 0.02).faces(), level.faces());
}

/// What the texture has refused is tried again where it may move further. What one decimation of its own leaves for the
/// last tolerance is a little less: it need not come by the finer levels.
TEST(TextureGuard, LetsTheTextureOfLaterLevelsMoveFurther) {
  const Textured square = sheet(16, flat, warped);
  LodOptions options = options_of(square, 0, 0.005);
  options.tolerance = std::numeric_limits<double>::quiet_NaN();
  LodChain chain(square.mesh, options);
  const LodLevel first = chain.next(0.01);
  EXPECT_LE(deviation_of(square, first).bounds.upper, 0.005);
  chain.set_texture_tolerance(0.02);
  const LodLevel second = chain.next(0.02);
  EXPECT_GT(deviation_of(square, second).bounds.lower, 0.005);
  EXPECT_LE(deviation_of(square, second).bounds.upper, 0.02);
  EXPECT_LT(second.faces(), first.faces() / 2);
  EXPECT_LE(second.faces(), simplified(square, 0.02, 0.02).faces() * 3 / 2);
  EXPECT_THROW(chain.set_texture_tolerance(0.01), InvalidInput);
  EXPECT_THROW(chain.set_texture_tolerance(std::numeric_limits<double>::quiet_NaN()), InvalidInput);
  EXPECT_THROW(LodChain(square.mesh).set_texture_tolerance(1), InvalidInput);
}

/// A collapse that moves the texture much too far is tried at one placement, and again only once its ends have moved:
/// 2,930 refusals, of 3,451 where it is tried again after each change nearby.
TEST(TextureGuard, TriesCollapsesFarBeyondTheToleranceOnce) {
  const Textured square = sheet(32, flat, warped);
  const SimplifiedLevel level = simplified(square, 0.01, 0.002);
  EXPECT_LE(deviation_of(square, level).bounds.upper, 0.002 * 1.2);  // guard and measurement look elsewhere
  EXPECT_LT(level.collapses_refused, 3200U);
}

/// A surface that so many samples miss that proofs fail and collapses are taken back.
double hilly(double x, double y) { return 0.04 * std::sin(17 * x) * std::cos(13 * y) + 0.01 * std::sin(61 * x * y); }

/// Edges whose middle moves by more than half the tolerance are looked at closely: else 608 triangles exceed it.
TEST(TextureGuard, HoldsNearlyEverywhereWithoutAMeasurement) {
  const Textured hills = sheet(48, hilly, [](double x, double y, bool /*is_right*/) {
    return Eigen::Vector2d(x + 0.02 * std::sin(17 * x), y + 0.02 * std::sin(17 * (x + y)));
  });
  std::size_t exceeding = 0;
  for (const double tolerance : {0.002, 0.003, 0.004, 0.005}) {
    const SimplifiedLevel level = simplified(hills, 0.05, tolerance);
    TextureDeviationOptions options;
    options.tolerance = tolerance;
    const TextureDeviation deviation = texture_deviation(textured(hills.mesh, hills.coordinates),
                                                         textured(level.mesh, level.texture_coordinates), options);
    exceeding += deviation.a_to_b.exceeding.size() + deviation.b_to_a.exceeding.size();
  }
  EXPECT_LT(exceeding, 100U);
}

/// Proofs fail here, and what is taken back gets its texture coordinates and samples back. A coordinate that stayed
/// behind would be off by the length of an edge, which is many tolerances.
TEST(TextureGuard, GivesCoordinatesBackWithWhatIsTakenBack) {
  const Textured hills = sheet(48, hilly, warped);
  const SimplifyResult result = simplify_with_bound(hills.mesh, options_of(hills, 0.004, 0.006));
  EXPECT_GT(result.counts.taken_back + result.counts.unproven, 0U);
  EXPECT_LE(deviation_of(hills, result.last()).bounds.upper, 0.006 * 1.2);  // guard and measurement look elsewhere
  EXPECT_LT(result.last().faces(), hills.mesh.triangles.size() / 2);
}

/// Squares of distances between such coordinates overflow; the samples of what is taken back go to faces all the same.
TEST(TextureGuard, GivesSamplesBackWhateverTheScaleOfTheTexture) {
  const Textured hills = sheet(48, hilly, [](double x, double y, bool is_right) {
    return Eigen::Vector2d(warped(x, y, is_right).cwiseProduct(Eigen::Vector2d(1e160, 1e-160)));
  });
  const SimplifyResult result = simplify_with_bound(hills.mesh, options_of(hills, 0.004, 0.006));
  EXPECT_GT(result.counts.taken_back + result.counts.unproven, 0U);
  EXPECT_EQ(result.last().verdict, Verdict::Within);
}

/// Triangles at the places of others are no repetitions where their texture coordinates differ.
TEST(TextureGuard, KeepsADecalThatLiesOnItsSurface) {
  Textured square = sheet(8, flat, even);
  const Textured decal = sheet(8, flat, [](double x, double y, bool) { return Eigen::Vector2d(5 + x, y); });
  for (std::size_t t = 20; t < 60; ++t) {
    square.mesh.triangles.push_back(decal.mesh.triangles[t]);
    square.coordinates.push_back(decal.coordinates[t]);
  }
  const TextureDeviation deviation = deviation_of(square, simplified(square, 0.01, 0.01));
  EXPECT_LE(deviation.bounds.upper, 0.01);
  EXPECT_LE(deviation.a_to_b.uncovered.upper, 1e-9);
}

/// Renderers that draw the front of triangles only would show holes.
TEST(TextureGuard, LeavesTrianglesFacingTheWayTheyDid) {
  Textured square = sheet(16, flat, even);
  for (std::size_t t = 0; t < square.mesh.triangles.size(); ++t) {
    if (square.coordinates[t][0].x() + square.coordinates[t][1].x() + square.coordinates[t][2].x() < 1.5) continue;
    std::swap(square.mesh.triangles[t][0], square.mesh.triangles[t][1]);
    std::swap(square.coordinates[t][0], square.coordinates[t][1]);
  }
  const SimplifiedLevel level = simplified(square, 0.01, 0.01);
  EXPECT_LT(level.faces(), square.mesh.triangles.size() / 4);
  double front = 0, back = 0;  // twice the areas
  for (const Triangle& t : level.mesh.triangles) {
    const auto& v = level.mesh.vertices;
    const double z = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).z();
    (z > 0 ? front : back) += std::abs(z);
  }
  EXPECT_NEAR(front, 1, 1e-9);
  EXPECT_NEAR(back, 1, 1e-9);
  EXPECT_LE(deviation_of(square, level).bounds.upper, 0.01);
}

/// The two halves have charts that do not touch. At the line between them each side keeps its own coordinates.
TEST(TextureGuard, KeepsTheSidesOfASeamApart) {
  const Textured halves = sheet(16, flat, [](double x, double y, bool is_right) {
    return is_right ? Eigen::Vector2d(5 - x, y) : Eigen::Vector2d(x, y);
  });
  const SimplifiedLevel level = simplified(halves, 0.01, 0.01);
  EXPECT_EQ(level.faces(), 4U);
  for (std::size_t t = 0; t < level.faces(); ++t) {
    const bool is_right = level.texture_coordinates[t][0].x() > 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = level.mesh.vertices[level.mesh.triangles[t][k]];
      EXPECT_NEAR(level.texture_coordinates[t][k].x(), is_right ? 5 - p.x() : p.x(), 1e-9);
      EXPECT_NEAR(level.texture_coordinates[t][k].y(), p.y(), 1e-9);
    }
  }
}

/// In the texture the border of the right half lies along the seam of the left one, in a bow. Cutting one of them short
/// would show the texture of the other, which is half a unit away.
TEST(TextureGuard, KeepsALineThatAnotherChartLiesAlong) {
  const auto bow = [](double y) { return 0.03 * std::sin(std::numbers::pi * y); };
  const auto beside = [&](double x, double y, bool is_right) {
    return Eigen::Vector2d(is_right ? 1.5 - x + bow(y) : x + bow(y), y);
  };
  const auto apart = [&](double x, double y, bool is_right) {
    return Eigen::Vector2d(beside(x, y, is_right) + Eigen::Vector2d(is_right ? 3 : 0, 0));
  };
  const Textured touching = sheet(16, flat, beside), alone = sheet(16, flat, apart);
  const SimplifiedLevel kept = simplified(touching, 0.2, 0.2), cut = simplified(alone, 0.2, 0.2);
  EXPECT_LT(cut.lines.size() + 8, kept.lines.size());
  EXPECT_LE(deviation_of(touching, kept).bounds.upper, 0.2);
}

/// The texture is folded along a bow: u grows up to it and falls beyond. Where that fold moves, coordinates beside it
/// are covered no more, and only another sheet far away has them.
TEST(TextureGuard, KeepsAFoldOfTheTexture) {
  const auto folded = [](double x, double y, bool /*is_right*/) {
    return Eigen::Vector2d(0.5 - std::abs(x - 0.5) + 0.03 * std::sin(std::numbers::pi * y), y);
  };
  Textured sheets = sheet(16, flat, folded);
  const Textured far = sheet(
      1, [](double, double) { return 9.0; }, [](double x, double y, bool) { return Eigen::Vector2d(2 * x - 0.5, y); });
  const auto first = static_cast<std::uint32_t>(sheets.mesh.vertices.size());
  sheets.mesh.vertices.insert(sheets.mesh.vertices.end(), far.mesh.vertices.begin(), far.mesh.vertices.end());
  for (const Triangle& t : far.mesh.triangles)
    sheets.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  sheets.coordinates.insert(sheets.coordinates.end(), far.coordinates.begin(), far.coordinates.end());
  const SimplifiedLevel level = simplified(sheets, 0.1, 0.1);
  EXPECT_LT(level.faces(), sheets.mesh.triangles.size() / 4);
  EXPECT_LE(deviation_of(sheets, level).bounds.upper, 0.1);
  EXPECT_TRUE(std::any_of(level.lines.begin(), level.lines.end(), [&](const Edge& line) {
    return level.mesh.vertices[line[0]].x() == 0.5 && level.mesh.vertices[line[1]].x() == 0.5;
  }));
}

/// Equal coordinates of different materials are different: the line between them is kept though the map is even.
TEST(TextureGuard, KeepsMaterialsApart) {
  Textured square = sheet(16, flat, even);
  for (std::uint32_t t = 0; t < square.mesh.triangles.size(); ++t)
    square.materials.push_back(square.mesh.vertices[square.mesh.triangles[t][1]].x() > 0.5 ? 1 : 0);
  EXPECT_GE(simplified(square, 0.01, 0.01).faces(), 4U);
}

/// Each colour of a palette is one point of the texture.
TEST(TextureGuard, KeepsTheColoursOfAPaletteApart) {
  const auto colour = [](double /*x*/, double /*y*/, bool is_right) -> Eigen::Vector2d {
    return {is_right ? 0.75 : 0.25, 0.5};
  };
  const auto wavy = [](double x, double y) { return 0.05 * std::sin(7 * x) * std::cos(5 * y); };
  const Textured square = sheet(32, wavy, colour);
  const SimplifiedLevel level = simplified(square, 0.01, 0.01);
  EXPECT_LE(deviation_of(square, level).bounds.upper, 0.01);
  EXPECT_LT(level.faces(), 2 * simplified(square, 0.01, HUGE_VAL).faces());
}

std::size_t exceeding(const Textured& original, const SimplifiedLevel& level, double tolerance) {
  TextureDeviationOptions options;
  options.tolerance = tolerance;
  options.error_bound = 0.1 * tolerance;
  const TextureDeviation deviation = texture_deviation(textured(original.mesh, original.coordinates),
                                                       textured(level.mesh, level.texture_coordinates), options);
  return deviation.a_to_b.exceeding.size() + deviation.b_to_a.exceeding.size();
}

/// Coordinates on a line, as with a palette of gradients: each belongs to a segment in space. Here they run along a
/// side of a wavy square, across it, and with its height, so that hills have a coordinate in common.
TEST(TextureGuard, KeepsGradients) {
  const auto wavy = [](double x, double y) { return 0.05 * std::sin(11 * x) * std::cos(9 * y); };
  struct Case {
    Height gradient;
    std::size_t max_exceeding, max_faces;
  };
  const Case cases[] = {
      {[](double x, double y) { return x + 0.05 * std::sin(9 * y); }, 2, 220},
      {[](double x, double y) { return 0.3 * x + y; }, 2, 79},
      {wavy, 20, 650},
  };
  for (const auto& [gradient, max_exceeding, max_faces] : cases) {
    const Textured square = sheet(32, wavy, [&along = gradient](double x, double y, bool /*is_right*/) {
      return Eigen::Vector2d(along(x, y), 0.5);
    });
    const SimplifiedLevel level = simplified(square, 0.01, 0.01);
    EXPECT_LE(exceeding(square, level, 0.01), max_exceeding);  // samples miss a little
    EXPECT_LE(level.faces(), max_faces);                       // of 2,048
  }
}

/// A rough surface in the colours of its height. What has the height of a peak is far away once the peak is cut off,
/// and the samples of what proofs take back belong to the face where they are, not to another one of their height.
TEST(TextureGuard, KeepsTheHeightsOfARoughSurface) {
  const auto rough = [](double x, double y) {
    return 0.05 * std::sin(11 * x) * std::cos(9 * y) + 0.006 * std::sin(97 * x + 41 * y) * std::cos(83 * y - 29 * x);
  };
  const Textured square =
      sheet(64, rough, [&](double x, double y, bool /*is_right*/) { return Eigen::Vector2d(rough(x, y), 0.5); });
  const SimplifyResult result = simplify_with_bound(square.mesh, options_of(square, 0.006, 0.03));
  EXPECT_GT(result.counts.taken_back, 0U);
  EXPECT_LE(exceeding(square, result.last(), 0.03), 20U);
  EXPECT_LE(result.last().faces(), 550U);  // of 8,192
}

/// Cubes askew in the colours of their heights. The vertex at a corner misses it by what rounding makes of its
/// placement, but its colour must not: the height of the lower cube's highest corner would be found at the other cube
/// only.
TEST(TextureGuard, KeepsTheHeightOfACorner) {
  TriangleMesh cubes;
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5, 0, 0.3)}) {
    TriangleMesh cube = datasets::cube(1, 5);
    for (Eigen::Vector3d& p : cube.vertices) p = turn * p + at;
    cubes = reference::both(cubes, cube);
  }
  Textured coloured{cubes, {}, {}};
  for (const Triangle& t : cubes.triangles) {
    Coordinates& corners = coloured.coordinates.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = {cubes.vertices[t[k]].z(), 0.5};
  }
  const SimplifiedLevel level = simplified(coloured, 0.02, 0.02);
  EXPECT_EQ(exceeding(coloured, level, 0.02), 0U);
  EXPECT_EQ(level.faces(), 24U);
}

TEST(TextureGuard, CarriesTrianglesWithoutCoordinates) {
  Textured square = sheet(8, flat, even);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (std::uint32_t t = 0; t < square.mesh.triangles.size(); ++t)
    if (square.mesh.vertices[square.mesh.triangles[t][1]].x() > 0.5) square.coordinates[t].fill({none, none});
  const SimplifiedLevel level = simplified(square, 0.01, 0.01);
  EXPECT_LE(level.faces(), 8U);
  const auto bare = std::count_if(level.texture_coordinates.begin(), level.texture_coordinates.end(),
                                  [](const Coordinates& c) { return std::isnan(c[0].x()); });
  EXPECT_GT(bare, 0);
  EXPECT_LT(static_cast<std::size_t>(bare), level.faces());
}

TEST(TextureGuard, IsTheSameForAnyNumberOfThreads) {
  const Textured hills = sheet(
      64, [](double x, double y) { return 0.04 * std::sin(17 * x) * std::cos(13 * y); }, warped);
  SimplifyOptions options = options_of(hills, 0.004, 0.006);
  options.threads = 1;
  const SimplifiedLevel one = simplify_with_bound(hills.mesh, options).last();
  options.threads = 3;
  const SimplifiedLevel three = simplify_with_bound(hills.mesh, options).last();
  EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
  EXPECT_EQ(one.texture_coordinates, three.texture_coordinates);
}

TEST(TextureGuard, RefusesWhatDoesNotFitTheMesh) {
  const Textured square = sheet(4, flat, even);
  SimplifyOptions options = options_of(square, 0.01, 0.01);
  options.materials.resize(1);
  EXPECT_THROW((void)simplify_with_bound(square.mesh, options), InvalidInput);
  options = options_of(square, 0.01, -1);
  EXPECT_THROW((void)simplify_with_bound(square.mesh, options), InvalidInput);
  options = options_of(square, 0.01, 0.01);
  options.texture_coordinates.pop_back();
  EXPECT_THROW((void)simplify_with_bound(square.mesh, options), InvalidInput);
}

}  // namespace texture_guard_test
}  // namespace meshbound
