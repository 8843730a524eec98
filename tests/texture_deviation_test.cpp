// SPDX-License-Identifier: MIT
// Texture deviation: the answers that can be computed by hand, and intervals that contain what rational arithmetic
// finds, on charts that overlap, touch, mirror each other, are slivers or have no area at all.
#include "meshbound/texture_deviation.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "meshbound/error.h"
#include "meshbound/io.h"
#include "reference/texture_oracle.h"
#include "texture/approximate.h"
#include "texture/charts.h"
#include "texture/surface_area.h"
#include "textured_shapes.h"

namespace meshbound {
namespace texture_deviation_test {

using namespace test;
using Random = std::mt19937_64;

TEST(TextureDeviation, OfAMeshAndItselfIsZero) {
  const TexturedMesh mesh = grid(5, flat);
  const TextureDeviation found = measured(mesh, mesh);
  EXPECT_EQ(found.bounds.upper, 0);
  EXPECT_EQ(found.a_to_b.uncovered.upper, 0);
  EXPECT_EQ(found.a_to_b.outcome, Outcome::Converged);
}

TEST(TextureDeviation, IsTheHeightThatASquareIsRaisedBy) {
  const TexturedMesh raised = grid(3, [](double s, double t) { return Corner{{s, t, 0.25}, {s, t}}; });
  const TextureDeviation found = measured(grid(1, flat), raised);
  expect_value(found.bounds, 0.25);
  EXPECT_EQ(found.a_to_b.witness->distance, 0.25);
}

/// Corners in another order, at other heights: those with the same texture coordinates belong together.
TEST(TextureDeviation, OfACopyIsThatOfItsFarthestCorner) {
  const Corner p{{0, 0, 0}, {0, 0}}, q{{1, 0, 0}, {1, 0}}, r{{0, 1, 0}, {0, 1}};
  const auto raised = [](Corner corner, double z) {
    corner.at.z() = z;
    return corner;
  };
  const TexturedMesh a = numbered({{triangle(p, q, r)}, {}});
  const TexturedMesh b = numbered({{triangle(raised(q, 0.125), raised(r, 0.25), raised(p, 0.0625))}, {}});
  TextureDeviationOptions options;
  options.error_bound = tight;
  options.tolerance = 1;
  expect_value(texture_deviation(a, b, options).bounds, 0.25);
}

/// The second triangle of B has corners where the first two of A's second have theirs, but its third corner shows
/// another part of the texture; elsewhere the deviation is 0.25, so that less would not be looked at closely.
TEST(TextureDeviation, OfATriangleThatSharesTwoCornersIsNotThatOfACopy) {
  const auto shown_at = [](double z, double u, double v) {
    return triangle({{0, 0, z}, {u, 0}}, {{1, 0, z}, {u + 1, 0}}, {{0, 1, z}, {u, v}});
  };
  const TexturedMesh a = numbered({{shown_at(0, 5, 1), shown_at(0, 0, 1)}, {}});
  const TexturedMesh b = numbered({{shown_at(0.25, 5, 1), shown_at(0, 0, 2)}, {}});
  expect_value(measured(a, b).a_to_b.bounds, 0.5);  // from (0, 1, 0) to (0, 0.5, 0)
}

/// Squares of these lengths overflow. No corner of B has a texture coordinate of A.
TEST(TextureDeviation, OfWhatIsNoCopyIsFoundFarAway) {
  constexpr double far = 1e200;
  const TexturedMesh a = numbered({{triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {1, 0}}, {{0, 1, 0}, {0, 1}})}, {}});
  const TexturedMesh b =
      numbered({{triangle({{0, 0, far}, {-1, -1}}, {{4, 0, far}, {3, -1}}, {{0, 4, far}, {-1, 3}})}, {}});
  TextureDeviationOptions options;
  options.error_bound = 1e-2 * far;
  options.tolerance = 0.1 * far;
  EXPECT_GE(texture_deviation(a, b, options).a_to_b.bounds.upper, far);
}

/// The geometry is the same; only where the texture lies on it is not.
TEST(TextureDeviation, SeesATextureThatSlidesOnTheSurface) {
  const auto fan = [](double x) {  // a square around a vertex at x whose coordinate is that of the centre
    const Corner middle{{x, 0.5, 0}, {0.5, 0.5}};
    const Corner c[] = {flat(0, 0), flat(1, 0), flat(1, 1), flat(0, 1)};
    TexturedMesh mesh;
    for (std::size_t k = 0; k < 4; ++k) mesh.triangles.push_back(triangle(c[k], c[(k + 1) % 4], middle));
    return numbered(mesh);
  };
  const TextureDeviation found = measured(fan(0.5), fan(0.75));
  expect_value(found.a_to_b.bounds, 0.25);
  expect_value(found.b_to_a.bounds, 0.25);
  EXPECT_EQ(found.a_to_b.witness->coordinate, Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(found.a_to_b.witness->nearest.position, Eigen::Vector3d(0.75, 0.5, 0));
}

/// Two squares share one part of the texture, the second one mirrored.
TEST(TextureDeviation, TakesTheNearestOfOverlappingCharts) {
  const TexturedMesh first = grid(4, flat);
  const TexturedMesh second = grid(3, [](double s, double t) { return Corner{{11 - s, t, 0}, {s, t}}; });
  const TexturedMesh both = joined(first, second);
  const TexturedMesh moved = joined(grid(5, [](double s, double t) { return Corner{{s, t, 0.5}, {s, t}}; }), second);
  expect_value(measured(both, moved).bounds, 0.5, 1e-6);
  const TextureDeviation one = measured(both, first);
  expect_value(one.a_to_b.bounds, 11, 1e-6);  // from (11, t) of the second square to (0, t)
  EXPECT_EQ(one.b_to_a.bounds.upper, 0);
}

/// Between two candidates the largest distance is inside a piece, at equal distance from both.
TEST(TextureDeviation, FindsTheMiddleBetweenTwoCandidates) {
  const auto slope = [](double z) { return [z](double s, double t) { return Corner{{0, 0, z * s + t}, {s, t}}; }; };
  // At s the candidates are s above and 1 - s below: at most 1/2.
  const TexturedMesh a = grid(1, slope(0));
  const TexturedMesh above = grid(1, slope(1));
  const TexturedMesh below = grid(1, [](double s, double t) { return Corner{{0, 0, t - (1 - s)}, {s, t}}; });
  expect_value(measured(a, joined(above, below), 1e-6).a_to_b.bounds, 0.5, 1e-6);
}

/// The middles are nothing beside a square that has moved by 10, which comes last.
TEST(TextureDeviation, LooksRoughlyAtFirst) {
  const auto slope = [](double z) { return [z](double s, double t) { return Corner{{0, 0, z * s + t}, {s, t}}; }; };
  const TexturedMesh below = grid(1, [](double s, double t) { return Corner{{0, 0, t - (0.9 - s)}, {s, t}}; });
  const auto apart = [](double z) { return [z](double s, double t) { return Corner{{s, t, z}, {s + 3, t}}; }; };
  const TexturedMesh a = joined(grid(3, slope(0)), grid(1, apart(0)));
  const TexturedMesh b = joined(joined(grid(1, slope(1)), below), grid(1, apart(10)));
  const OneSidedTextureDeviation found = measured(a, b, 1e-6).a_to_b;
  expect_value(found.bounds, 10, 1e-6);
  EXPECT_LT(found.pieces, 1000U);
}

TEST(TextureDeviation, MeasuresWhatIsCoveredAndSaysWhatIsNot) {
  const TexturedMesh half = grid(2, [](double s, double t) { return Corner{{s / 2, t, 0.125}, {s / 2, t}}; });
  const TextureDeviation found = measured(grid(3, flat), half);
  expect_value(found.a_to_b.bounds, 0.125);
  expect_value(found.a_to_b.uncovered, 0.5);
  EXPECT_EQ(found.b_to_a.uncovered.upper, 0);
}

TEST(TextureDeviation, SaysThatNothingIsCovered) {
  const TexturedMesh away = grid(2, [](double s, double t) { return Corner{{s, t, 0}, {s + 2, t}}; });
  const TextureDeviation found = measured(grid(2, flat), away);
  EXPECT_EQ(found.bounds.upper, 0);
  EXPECT_FALSE(found.a_to_b.witness);
  EXPECT_EQ(found.a_to_b.uncovered.upper, 1);
  EXPECT_GT(found.a_to_b.uncovered.lower, 1 - 1e-12);
}

TEST(TextureDeviation, CountsTrianglesWithoutCoordinatesAsUncovered) {
  TexturedMesh a = grid(1, flat);
  a.bare.push_back({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(0, 1, 0)});
  expect_value(measured(a, grid(1, flat)).a_to_b.uncovered, 0.5);
}

/// Charts that lie beside one another in the texture and far apart in space: on the border both count.
TEST(TextureDeviation, TellsApartChartsThatTouch) {
  const TexturedMesh left = grid(3, [](double s, double t) { return Corner{{s, t, 0}, {s / 3, t}}; });
  const TexturedMesh right = grid(4, [](double s, double t) { return Corner{{s, t, 50}, {(1 + 2 * s) / 3, t}}; });
  const TexturedMesh atlas = joined(left, right);
  expect_value(measured(atlas, atlas).bounds, 0);
  const TexturedMesh moved = joined(left, grid(4, [](double s, double t) {
                                      return Corner{{s, t, 50.5}, {(1 + 2 * s) / 3, t}};
                                    }));
  expect_value(measured(atlas, moved).bounds, 0.5);
}

/// A corner of the texture that touches another chart belongs to what that covers.
TEST(TextureDeviation, CountsPointsThatAreCoveredOnABorder) {
  const TexturedMesh right = grid(1, [](double s, double t) { return Corner{{s, t, 7}, {s + 1, t}}; });
  const TextureDeviation found = measured(grid(1, flat), right);
  expect_value(found.a_to_b.bounds, std::sqrt(1 + 49.0));  // from (1, t, 0) to (0, t, 7)
  EXPECT_GT(found.a_to_b.uncovered.lower, 1 - 1e-12);
}

/// Two charts that cover the same border, and no more of the texture: the nearer one counts.
TEST(TextureDeviation, CountsPointsThatTwoCoverOnABorder) {
  const auto right = [](double height) {
    return grid(1, [height](double s, double t) { return Corner{{s, t, height}, {s + 1, t}}; });
  };
  expect_value(measured(grid(1, flat), joined(right(9), right(7))).a_to_b.bounds, std::sqrt(1 + 49.0));
}

/// A chart inside of a triangle, far below the error bound: no corner of the triangle tells where it is.
TEST(TextureDeviation, NamesAPointOfATriangleBeyondTheTolerance) {
  const TexturedMesh inside = grid(1, [](double s, double t) { return Corner{{s, t, 5}, {(1 + s) / 3, (1 + t) / 8}}; });
  TextureDeviationOptions options;
  options.threads = 1;
  options.error_bound = 100;
  options.tolerance = 1;
  const OneSidedTextureDeviation found = texture_deviation(grid(1, flat), inside, options).a_to_b;
  ASSERT_TRUE(found.witness);
  EXPECT_GE(found.witness->distance, 5);
  EXPECT_NEAR(found.bounds.lower, found.witness->distance, tight);
  ASSERT_EQ(found.exceeding.size(), 1U);
  EXPECT_EQ(found.exceeding[0].from.triangle, 0U);
}

/// Where one of two sheets that cross gets nearer than the other changes along a curve, which takes many pieces to
/// follow; that both are too far takes few.
TEST(TextureDeviation, BoundsTrianglesBeyondTheToleranceRoughly) {
  const TexturedMesh around = joined(grid(1,
                                          [](double s, double t) {
                                            return Corner{{s + 1, t + s, 0}, {s, t}};
                                          }),
                                     grid(1, [](double s, double t) {
                                       return Corner{{s - t, t, 1.2 - s * 0.3}, {s, t}};
                                     }));
  TextureDeviationOptions options;
  options.threads = 1;
  options.error_bound = tight;
  const OneSidedTextureDeviation exact = texture_deviation(grid(1, flat), around, options).a_to_b;
  options.tolerance = 0.1;
  const OneSidedTextureDeviation found = texture_deviation(grid(1, flat), around, options).a_to_b;
  EXPECT_EQ(found.outcome, Outcome::ExceedsTolerance);
  EXPECT_EQ(found.exceeding.size(), 2U);
  EXPECT_GT(found.bounds.lower, *options.tolerance);
  EXPECT_LE(found.bounds.lower, exact.bounds.upper);
  EXPECT_GE(found.bounds.upper, exact.bounds.lower);
  EXPECT_LT(found.bounds.upper, 4);  // no point of either sheet is farther
  EXPECT_LT(found.pieces, exact.pieces / 4);
}

TEST(TextureDeviation, KeepsMaterialsApart) {
  TexturedMesh a = grid(1, flat), b = grid(1, flat);
  for (TexturedTriangle& t : b.triangles) t.material = 1;
  EXPECT_EQ(measured(a, b).a_to_b.uncovered.upper, 1);
}

/// All of a triangle has one coordinate: the nearest point of the other one counts, as in a plain distance.
TEST(TextureDeviation, OfTrianglesAtOnePointOfTheTexture) {
  const Eigen::Vector2d u(0.5, 0.25);
  TexturedMesh a, b;
  a.triangles.push_back(triangle({{0, 0, 0}, u}, {{2, 0, 0}, u}, {{0, 2, 0}, u}));
  b.triangles.push_back(triangle({{0, 0, 1}, u}, {{1, 0, 1}, u}, {{0, 1, 1}, u}));
  const TextureDeviation found = measured(a, b);
  expect_value(found.a_to_b.bounds, std::sqrt(2.0));  // from (2, 0, 0) to (1, 0, 1)
  expect_value(found.b_to_a.bounds, 1);
  EXPECT_EQ(found.a_to_b.uncovered.upper, 0);
}

/// The coordinates of a triangle lie on a segment: each belongs to a segment in space.
TEST(TextureDeviation, OfTrianglesOnASegmentOfTheTexture) {
  TexturedMesh a, b;
  a.triangles.push_back(triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {1, 0}}, {{0, 1, 0}, {0, 0}}));
  b.triangles.push_back(triangle({{0, 0, 1}, {0, 0}}, {{1, 0, 1}, {1, 0}}, {{0, 3, 1}, {0, 0}}));
  const TextureDeviation found = measured(a, b);
  expect_value(found.a_to_b.bounds, 1);               // straight up: the fibre above is longer
  expect_value(found.b_to_a.bounds, std::sqrt(5.0));  // from (0, 3, 1) to (0, 1, 0)
}

/// The coordinates of a triangle on a segment, so far apart that their squares overflow.
TEST(TextureDeviation, OfTrianglesOnALongSegmentOfTheTexture) {
  const double far = 0x1p600;
  TexturedMesh a, b;
  a.triangles.push_back(triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {far, 0}}, {{0, 1, 0}, {far / 2, 0}}));
  b.triangles.push_back(triangle({{0, 0, 1}, {0, 0}}, {{1, 0, 1}, {far, 0}}, {{0, 3, 1}, {far / 2, 0}}));
  const TextureDeviation found = measured(a, b);
  expect_value(found.a_to_b.bounds,
               std::sqrt(1 + 1 / 9.25));              // from (0, 1, 0) to the line from (1/2, 0, 1) to (0, 3, 1)
  expect_value(found.b_to_a.bounds, std::sqrt(5.0));  // from (0, 3, 1) to (0, 1, 0)
}

TEST(TextureDeviation, OfASegmentAcrossAChart) {
  TexturedMesh line;
  line.triangles.push_back(triangle({{0, 0, 2}, {0.25, 0.5}}, {{1, 0, 2}, {0.75, 0.5}}, {{1, 0, 2}, {0.75, 0.5}}));
  const TextureDeviation found = measured(line, grid(3, flat));
  // From (s, 0, 2) to (1/4 + s/2, 1/2, 0).
  expect_value(found.a_to_b.bounds, std::sqrt(0.0625 + 0.25 + 4));
  EXPECT_EQ(found.a_to_b.uncovered.upper, 0);
  expect_value(found.b_to_a.bounds, std::sqrt(0.0625 + 0.25 + 4));
  EXPECT_GT(found.b_to_a.uncovered.lower, 1 - 1e-12);
}

TEST(TextureDeviation, HoldsForTheSmallestAndLargestCoordinates) {
  for (const double scale : {1e-300, 1e-160, 1e-30, 1e30, 1e150}) {
    const auto at = [&](double z) {
      return [z, scale](double s, double t) { return Corner{{s * scale, t * scale, z * scale}, {s, t}}; };
    };
    const TextureDeviation found = measured(grid(2, at(0)), grid(3, at(0.5)), tight * scale);
    expect_value(found.bounds, 0.5 * scale, tight * scale);
    const auto far = [&](double z) {
      return [z, scale](double s, double t) { return Corner{{s, t, z}, {s * scale, t * scale}}; };
    };
    const TextureDeviation in_texture = measured(grid(2, far(0)), grid(2, far(0.5)));
    expect_value(in_texture.bounds, 0.5);
    EXPECT_EQ(in_texture.a_to_b.uncovered.upper, 0);
  }
}

/// Areas of such triangles overflow or underflow.
/// Twice the areas are 1 and 7, the length of (2, 3, 6).
TEST(TextureDeviation, SaysWhatIsUncoveredByAreasInSpace) {
  TexturedMesh mesh;
  mesh.triangles.push_back(triangle({{0, 0, 0}, {0, 0}}, {{1, 0, 0}, {1, 0}}, {{0, 1, 0}, {0, 1}}));
  mesh.triangles.push_back(triangle({{5, 5, 5}, {0, 0}}, {{5, 7, 4}, {1, 0}}, {{2, 5, 6}, {0, 1}}));
  expect_value(uncovered_share_of(mesh, std::vector<Approximate>{{0, 0}, {1, 0}}), 7.0 / 8);
}

TEST(TextureDeviation, SaysWhatIsUncoveredOfTheSmallestAndLargestTriangles) {
  for (const double scale : {0x1p-1070, 0x1p-1010, 0x1p-600, 0x1p600, 0x1p1000}) {
    const TexturedMesh mesh = grid(2, [&](double s, double t) { return Corner{{s * scale, t * scale, 0}, {s, t}}; });
    const Bounds uncovered = uncovered_share_of(mesh, std::vector<Approximate>(8, {0.5, 0}));
    expect_value(uncovered, 0.5);
  }
}

/// Charts of the unit square with random vertices: neither mesh overlaps itself.
TexturedMesh random_chart(int n, Random& random, bool with_slivers) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Corner> corners;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double ds = i % n == 0 ? 0 : unit(random) * 0.3, dt = j % n == 0 ? 0 : unit(random) * 0.3;
      double s = (i + ds) / n;
      const double t = (j + dt) / n;
      if (with_slivers && i == 1) s = 1e-13 * (1 + j);
      corners.push_back({{s + 0.1 * unit(random), t + 0.1 * unit(random), 0.3 * unit(random)}, {s, t}});
    }
  }
  TexturedMesh mesh;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int x, int y) { return corners[static_cast<std::size_t>((j + y) * (n + 1) + i + x)]; };
      mesh.triangles.push_back(triangle(at(0, 0), at(1, 0), at(1, 1)));
      mesh.triangles.push_back(triangle(at(0, 0), at(1, 1), at(0, 1)));
    }
  }
  return numbered(mesh);
}

mpq_class uncovered_of(const TexturedMesh& a, const TexturedMesh& b) {
  mpq_class worst = 0;
  for (const TexturedTriangle& t : a.triangles)
    worst = std::max<mpq_class>(worst, abs(mpq_class(reference::uncovered_share(t, b))));
  return worst;
}

TEST(TextureDeviation, ContainsWhatRationalArithmeticFinds) {
  Random random(1);
  for (int trial = 0; trial < 24; ++trial) {
    const bool with_slivers = trial % 3 == 2;
    const TexturedMesh a = random_chart(2 + trial % 3, random, with_slivers),
                       b = random_chart(3, random, trial % 2 == 1);
    const TextureDeviation found = measured(a, b, 1e-7);
    const auto contains = [](const Bounds& bounds, const mpq_class& squared) {
      EXPECT_GE(reference::compare_root(squared, bounds.lower), 0);
      EXPECT_LE(reference::compare_root(squared, bounds.upper), 0);
      EXPECT_LE(bounds.upper - bounds.lower, 1e-7);
    };
    contains(found.a_to_b.bounds, reference::squared_deviation_of_charts(a, b));
    contains(found.b_to_a.bounds, reference::squared_deviation_of_charts(b, a));
    if (uncovered_of(a, b) == 0) {
      EXPECT_LE(found.a_to_b.uncovered.upper, 1e-12);
    }
  }
}

/// A corner on a coarse lattice, so that coordinates coincide, edges are shared, and triangles have no area.
TexturedMesh lattice_soup(std::size_t count, Random& random) {
  std::uniform_int_distribution<int> place(0, 4), uv(0, 3);
  TexturedMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    const auto corner = [&] {
      return Corner{{0.25 * place(random), 0.25 * place(random), 0.25 * place(random)},
                    {uv(random) / 3.0, 0.5 * uv(random)}};
    };
    mesh.triangles.push_back(triangle(corner(), corner(), corner()));
  }
  return numbered(mesh);
}

/// No point of a triangle, taken at random or at its corners and edges, is further than the upper bound: whether all
/// triangles of the other mesh count as near, or few.
TEST(TextureDeviation, IsNeverExceededByAPoint) {
  Random random(2);
  std::uniform_int_distribution<int> share(0, 6);
  for (int trial = 0; trial < 40; ++trial) {
    const TexturedMesh a = lattice_soup(6, random), b = lattice_soup(8, random);
    mpq_class furthest = 0;
    for (const TexturedTriangle& t : a.triangles) {
      for (int k = 0; k < 40; ++k) {
        const int p = share(random), q = share(random), r = p + q == 0 ? 1 : share(random);
        const mpq_class all = p + q + r;
        const auto squared = reference::squared_deviation_at(t, {p / all, q / all, r / all}, b);
        if (squared) furthest = std::max(furthest, *squared);
      }
    }
    TextureDeviationOptions options;
    options.threads = 1;
    options.error_bound = 1e-4;
    for (const double tolerance : {0.25, 2.0}) {
      options.tolerance = tolerance;
      const Bounds found = texture_deviation(a, b, options).a_to_b.bounds;
      EXPECT_LE(found.lower, found.upper);
      EXPECT_LE(reference::compare_root(furthest, found.upper), 0) << trial << ", " << tolerance;
    }
  }
}

TEST(TextureDeviation, IsTheSameForAnyNumberOfThreads) {
  Random random(3);
  const TexturedMesh a = random_chart(12, random, true), b = random_chart(9, random, false);
  const TextureDeviation one = measured(a, b, 1e-7, 1), four = measured(a, b, 1e-7, 4);
  EXPECT_EQ(one.bounds.lower, four.bounds.lower);
  EXPECT_EQ(one.bounds.upper, four.bounds.upper);
  EXPECT_EQ(one.a_to_b.uncovered.upper, four.a_to_b.uncovered.upper);
  EXPECT_EQ(one.a_to_b.witness->from.position, four.a_to_b.witness->from.position);
  EXPECT_EQ(one.a_to_b.pieces, four.a_to_b.pieces);
}

/// A flat square with two holes, and triangles with lines of coordinates: one runs high through the first hole, another
/// one rises through both.
TEST(TextureDeviation, SeesLinesThroughHoles) {
  constexpr int n = 8;
  const TexturedMesh around = numbered({{triangle(flat(-1, -1), flat(3, -1), flat(-1, 3))}, {}});
  for (const bool is_mirrored : {false, true}) {  // the holes are looked at in some order
    const auto across = [&](double s) { return is_mirrored ? 1 - s : s; };
    TexturedMesh with_lines = grid(n, flat);
    std::erase_if(with_lines.triangles, [&](const TexturedTriangle& t) {
      const Eigen::Vector2d middle = (t.coordinates[0] + t.coordinates[1] + t.coordinates[2]) / 3;
      const int column = static_cast<int>(n * middle.x());
      return static_cast<int>(n * middle.y()) == n / 2 && (column == 1 || column == 6);
    });
    const auto on_line = [&](double s, double z) { return Corner{{across(s), 0.5625, z}, {across(s), 0.5625}}; };
    with_lines.triangles.push_back(triangle(on_line(0.15625, 1), on_line(0.25, 1), on_line(0.375, 1)));
    with_lines.triangles.push_back(triangle(on_line(0.15625, 0), on_line(0.5, 0.25), on_line(0.84375, 0.5)));
    for (const TexturedMesh& a : {around, grid(3, flat)})
      expect_value(measured(a, numbered(with_lines)).a_to_b.bounds, 0.5);
  }
}

/// Twice as many triangles, no more pieces: charts that overlap everywhere do not multiply.
TEST(TextureDeviation, LooksAtFewPiecesOfMirroredCharts) {
  const auto mirrored = [](int n) {
    const auto height = [](double s, double t) { return 0.01 * std::sin(9 * s) * std::cos(7 * t); };
    return joined(grid(n,
                       [&](double s, double t) {
                         return Corner{{s, t, height(s, t)}, {s, t}};
                       }),
                  grid(n, [&](double s, double t) {
                    return Corner{{11 - s, t, height(t, s)}, {s, t}};
                  }));
  };
  const std::uint64_t few = measured(mirrored(16), mirrored(14)).a_to_b.pieces;
  const std::uint64_t many = measured(mirrored(32), mirrored(28)).a_to_b.pieces;
  EXPECT_GT(many, 0U);
  EXPECT_LT(many, 2 * few);
}

/// Two rough sheets with one texture, askew so that the box of a large triangle holds much of both.
TEST(Charts, FindNoCandidatesInTheSheetBeside) {
  const auto sheet = [](int n, double above) {
    return grid(n, [=](double s, double t) {
      const double rough = 0.04 * std::cos(std::numbers::pi * n * s) * std::cos(std::numbers::pi * n * t);
      return Corner{{s, t, s + t + above + rough}, {s, t}};
    });
  };
  const TexturedMesh large = grid(1, [](double s, double t) { return Corner{{s, t, s + t}, {s, t}}; });
  const TexturedMesh small = joined(sheet(8, 0), sheet(8, 0.5));
  const Charts of_large(large), of_small(small);
  ChartCandidates found;
  of_small.find_candidates(of_large.triangles()[0], 0.01, found);
  EXPECT_EQ(found.near.size(), 64U);
  of_large.find_candidates(of_small.triangles()[0], 0.01, found);
  EXPECT_EQ(found.near.size(), 1U);
  for (const ChartTriangle& beside : std::span(of_small.triangles()).last(128)) {
    of_large.find_candidates(beside, 0.01, found);
    EXPECT_TRUE(found.near.empty());
  }
}

/// Two large triangles on 20,000 small ones. Across these the second kind shares slivers with many, by rounding alone.
TEST(TextureDeviation, LooksAtFewPiecesOfLargeTriangles) {
  const TexturedMesh wavy = grid(100, [](double s, double t) {
    return Corner{{s, t, 0.002 * std::sin(30 * s) * std::sin(20 * t)}, {s, t}};
  });
  const TexturedMesh mirrored = grid(1, [](double s, double t) { return flat(1 - s, t); });
  for (const TexturedMesh& large : {grid(1, flat), mirrored}) {
    const TextureDeviation found = measured(large, wavy, 1e-6);
    EXPECT_LT(found.a_to_b.pieces, 200U);
    EXPECT_LE(found.a_to_b.bounds.upper - found.a_to_b.bounds.lower, 1e-6);
    EXPECT_LE(found.a_to_b.bounds.lower, found.b_to_a.bounds.upper);
    EXPECT_GE(found.a_to_b.bounds.upper, found.b_to_a.bounds.lower);
  }
}

/// Twice as many copies that all show the same texture, each near its own counterpart: twice as many pairs.
TEST(TextureDeviation, LooksAtNearCopiesOfAChartFirst) {
  const auto copies = [](int count, int n) {
    TexturedMesh mesh;
    for (int k = 0; k < count; ++k)
      mesh = joined(mesh, grid(n, [&](double s, double t) { return Corner{{s + 3 * k, t, 0.01 * s * t}, {s, t}}; }));
    return mesh;
  };
  const auto pairs = [&](int count) { return measured(copies(count, 4), copies(count, 3)).a_to_b.pairs; };
  EXPECT_LT(pairs(40), 3 * pairs(20));
}

TEST(TextureDeviation, RefusesWhatIsNoNumber) {
  TexturedMesh broken = grid(1, flat);
  broken.triangles[0].coordinates[1].x() = std::nan("");
  EXPECT_THROW(measured(broken, grid(1, flat)), InvalidInput);
  EXPECT_THROW(measured(grid(1, flat), grid(1, flat), -1), InvalidInput);
}

TEST(TextureDeviation, EndsWhenItIsStopped) {
  const std::atomic<bool> stop = true;
  TextureDeviationOptions options;
  options.stop.cancel = &stop;
  EXPECT_THROW(texture_deviation(grid(2, flat), grid(2, flat), options), Stopped);
}

TEST(TexelLength, IsTheSideOfATexelOnTheSurface) {
  const TexturedMesh stretched = grid(2, [](double s, double t) { return Corner{{4 * s, 9 * t, 0}, {s, t}}; });
  EXPECT_DOUBLE_EQ(texel_length(stretched, 512), 6.0 / 512);
  EXPECT_THROW((void)texel_length(stretched, 0), InvalidInput);
}

TEST(TexturedMeshes, TellMaterialsApartByName) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}}};
  MeshAttributes a;
  a.texture_coordinates.values = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  a.texture_coordinates.index = {{0, 1, 2}, {0, 1, CornerAttribute::none}};
  MeshAttributes b = a;
  a.materials = {{"wood", "stone"}, {0, 1}};
  b.materials = {{"stone", "wood"}, {1, 0}};
  const auto [first, second] = textured_meshes(mesh, a, mesh, b);
  ASSERT_EQ(first.triangles.size(), 1U);
  EXPECT_EQ(first.bare.size(), 1U);
  EXPECT_EQ(first.triangles[0].material, second.triangles[0].material);
  EXPECT_THROW((void)textured_meshes(mesh, a, mesh, {}), InvalidInput);
}

/// A mesh, and what a file of floats keeps of it.
TEST(TexturedMeshes, AreComparedInThePrecisionOfBoth) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  MeshAttributes exact;
  exact.texture_coordinates.values = {{0.1, 0.1, 0}, {0.7, 0.2, 0}, {0.3, 0.9, 0}};
  exact.texture_coordinates.index = {{0, 1, 2}};
  for (const FileFormat format : {FileFormat::Ply, FileFormat::Glb}) {
    DroppedAttributes lost;
    const MeshAttributes held = carried_by(format, exact, lost);
    for (const bool exact_first : {true, false}) {
      const auto [a, b] =
          exact_first ? textured_meshes(mesh, exact, mesh, held) : textured_meshes(mesh, held, mesh, exact);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(a.triangles[0].coordinates[k], b.triangles[0].coordinates[k]);
        EXPECT_EQ(a.triangles[0].coordinates[k], held.texture_coordinates.values[k].head<2>());
      }
    }
  }
  EXPECT_EQ(textured_meshes(mesh, exact, mesh, exact)[0].triangles[0].coordinates[0], Eigen::Vector2d(0.1, 0.1));
}

/// Sums of products that cancel, underflow, overflow and are exactly zero lie in their intervals.
TEST(Approximate, EnclosesSumsOfProducts) {
  Random random(1);
  std::uniform_int_distribution<int> exponent(-560, 200), spread(-60, 60), kind(0, 5);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  for (int run = 0; run < 20000; ++run) {
    const int scale = exponent(random);
    std::array<Approximate, 3> a, b;
    mpq_class exact = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto number = [&] {
        return kind(random) == 0 ? 0.0 : std::ldexp(mantissa(random), scale + spread(random));
      };
      a[i] = {number(), 0};
      b[i] = {number(), 0};
      if (i == 2 && kind(random) == 0 && b[1].value != 0) a[2] = {-a[1].value, 0}, b[2] = b[1];
      exact += mpq_class(a[i].value) * mpq_class(b[i].value);
    }
    const Approximate sum = sum_of_products(a, b);
    if (sum.is_zero()) {
      EXPECT_EQ(exact, 0);
    }
    if (!std::isfinite(sum.error)) continue;
    EXPECT_LE(abs(mpq_class(sum.value) - exact), mpq_class(sum.error));
  }
}

/// A corner of a triangle that runs far beyond a small candidate in the texture says nothing of what both cover:
/// neither of the two looks at corners may drop a candidate that is far away only where they overlap.
TEST(TextureDeviation, FindsTheFarCornerOfASmallTriangleInALargeOne) {
  const auto lifted = [](double height) {
    TexturedMesh mesh = grid(8, [&](double s, double t) {
      return Corner{{s, t, s == 0.5 && t == 0.5 ? height : 0.0}, {s, t}};
    });
    return mesh;
  };
  const TexturedMesh large = grid(1, [](double s, double t) { return Corner{{s, t, 0}, {s, t}}; });
  for (const double height : {1e-3, 0.25, 4.0}) {
    const TextureDeviation found = measured(large, lifted(height));
    expect_value(found.a_to_b.bounds, height);
    expect_value(found.b_to_a.bounds, height);
  }
}

}  // namespace texture_deviation_test
}  // namespace meshbound
