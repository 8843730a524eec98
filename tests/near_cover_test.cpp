// SPDX-License-Identifier: MIT
// Triangles that cover another one in the texture, and how far they are from it, as doubles know it: against integers.
#include "texture/near_cover.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "chart_cases.h"
#include "reference/point_triangle_cases.h"
#include "texture/chart_edges.h"
#include "texture/chart_sides.h"
#include "texture/covering.h"
#include "texture/pair_bound.h"

namespace meshbound {
namespace near_cover_test {

/// All coordinates here are multiples of 2^-70.
constexpr ExactUnits units{-70, -70};

const Eigen::Vector2d low(0, 0), right(1, 0), up(0, 1), inside(0.25, 0.375), far_right(2, -0.5), far_up(-0.5, 2);

/// A triangle, and others as its candidates.
struct Case {
  Case(const TexturedTriangle& of, std::vector<TexturedTriangle> by) : whole(of), triangles(std::move(by)) {
    link_across_edges(charts);
    for (const ChartTriangle& t : charts)
      if (t.chart == Chart::Area) candidates.push_back(&t);
  }
  /// Whether the first `count` candidates, or the sheets of these, are known to cover the triangle.
  [[nodiscard]] bool is_complete(std::size_t count) const {
    return NearCover().upper(a, NearCover::Candidates(candidates).first(count), 0, HUGE_VAL).has_value();
  }
  [[nodiscard]] bool is_complete() const { return is_complete(candidates.size()); }
  [[nodiscard]] std::optional<double> upper(double least = 0, double precision = 1e-9) const {
    return NearCover().upper(a, candidates, least, precision);
  }
  TexturedTriangle whole;
  ChartTriangle a = chart_triangle(whole, units);
  std::vector<TexturedTriangle> triangles;
  std::vector<ChartTriangle> charts = charts_of(triangles, units);
  std::vector<const ChartTriangle*> candidates;
};

bool is_covered(const std::vector<TexturedTriangle>& by) { return Case(in_texture(low, right, up), by).is_complete(); }

std::vector<TexturedTriangle> fan(double height = 0) {
  return {in_texture(low, right, inside, height), in_texture(right, up, inside, height),
          in_texture(up, low, inside, height)};
}

TEST(NearCover, IsThatOfATriangleByItself) { EXPECT_TRUE(is_covered({in_texture(low, right, up)})); }

TEST(NearCover, IsThatOfAPartOfOne) {
  EXPECT_TRUE(is_covered({in_texture({-1, -1}, far_right, far_up)}));
  EXPECT_FALSE(is_covered({in_texture(low, {0.5, 0}, up)}));
  EXPECT_FALSE(is_covered({in_texture(right, {2, 0}, up)}));  // beside it
  EXPECT_FALSE(is_covered({}));
}

TEST(NearCover, IsThatByAFan) {
  std::vector<TexturedTriangle> triangles = fan();
  EXPECT_TRUE(is_covered(triangles));
  triangles.push_back(in_texture({1, 1}, {2, 1}, {1, 2}));          // beside it
  triangles.push_back(in_texture({-1, 0.5}, {0.5, -1}, {-1, -1}));  // before its first corner
  EXPECT_TRUE(is_covered(triangles));
  triangles.erase(triangles.begin() + 1);
  EXPECT_FALSE(is_covered(triangles));
}

/// The triangles across edges belong to the sheet, candidates or not: rounding may have left one out.
TEST(NearCover, IsThatByASheetOfWhichSomeAreNoCandidates) {
  Case test(in_texture(low, right, up), fan());
  for (int k = 0; k < 3; ++k) {
    std::rotate(test.candidates.begin(), test.candidates.begin() + 1, test.candidates.end());
    EXPECT_TRUE(test.is_complete(1)) << k;
  }
}

/// Which way round corners go does not matter: charts may be mirrored.
TEST(NearCover, IsThatByAFanOfBothOrientations) {
  std::vector<TexturedTriangle> triangles = fan();
  std::swap(triangles[1].coordinates[0], triangles[1].coordinates[1]);
  std::swap(triangles[1].corners[0], triangles[1].corners[1]);
  EXPECT_TRUE(is_covered(triangles));
}

/// Where two triangles lie on the same side of their common edge, nothing is on the other side.
TEST(NearCover, IsNotThatOfAFold) {
  EXPECT_FALSE(is_covered({in_texture(low, {0.5, 0}, up), in_texture(low, up, {0.5, 0})}));
  EXPECT_FALSE(is_covered({in_texture({0.5, 0}, up, low), in_texture({0.5, 0}, up, {-1, 0})}));
}

/// Two sheets with the same texture: the triangle is covered as long as one of them has no hole.
TEST(NearCover, IsThatByOneOfTwoSheets) {
  for (const std::size_t hole : {0, 3}) {
    std::vector<TexturedTriangle> triangles = fan();
    for (const TexturedTriangle& t : fan(1)) triangles.push_back(t);
    EXPECT_TRUE(is_covered(triangles));
    triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(hole));
    EXPECT_TRUE(is_covered(triangles)) << hole;
    triangles.erase(triangles.begin() + (hole == 0 ? 2 : 0));  // now both have one
    EXPECT_FALSE(is_covered(triangles)) << hole;
  }
}

/// The nearer one of two sheets, or of two triangles that cover all of it.
TEST(NearCover, TakesTheNearestSheet) {
  for (const bool is_first_near : {true, false}) {
    std::vector<TexturedTriangle> triangles = fan(is_first_near ? 0.5 : 2);
    for (const TexturedTriangle& t : fan(is_first_near ? 2 : 0.5)) triangles.push_back(t);
    const std::optional<double> of_sheets = Case(in_texture(low, right, up), triangles).upper();
    ASSERT_TRUE(of_sheets);
    EXPECT_NEAR(*of_sheets, 0.5, 1e-12);
    for (const double height : {is_first_near ? 0.25 : 1.0, is_first_near ? 1.0 : 0.25})
      triangles.push_back(in_texture(low, far_right, far_up, height));
    const std::optional<double> of_triangles = Case(in_texture({0.1, 0.1}, right / 2, up / 2), triangles).upper();
    ASSERT_TRUE(of_triangles);
    EXPECT_NEAR(*of_triangles, 0.25, 1e-12);
  }
}

/// The points that are tried to see whether a sheet covers a triangle all lie on edges, but for the last one.
TEST(NearCover, IsKnownOnAGrid) {
  const auto at = [](int i, int j) { return Eigen::Vector2d(i, j); };
  std::vector<TexturedTriangle> triangles;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      triangles.push_back(in_texture(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
      triangles.push_back(in_texture(at(i, j), at(i + 1, j + 1), at(i, j + 1)));
    }
  }
  EXPECT_TRUE(Case(in_texture(at(0, 0), at(9, 0), at(0, 9)), triangles).is_complete());
}

/// The middle of the triangle lies on edges of its candidates.
TEST(NearCover, IsKnownWhereAPointLiesOnAnEdge) {
  const Eigen::Vector2d middle(1, 1), a(0, 0), b(3, 0), c(0, 3);
  const Case test(in_texture(a, b, c), {in_texture(a, b, middle), in_texture(b, c, middle), in_texture(c, a, middle)});
  EXPECT_TRUE(test.is_complete());
}

TEST(NearCover, TakesTheFarthestCandidate) {
  std::vector<TexturedTriangle> triangles = fan(0.5);
  for (TexturedTriangle& t : triangles) t.corners[2].z() = 0.75;  // the common corner of the fan
  const Case test(in_texture(low, right, up), triangles);
  ASSERT_TRUE(test.upper());
  EXPECT_NEAR(*test.upper(), 0.75, 1e-12);
  EXPECT_GE(*test.upper(), 0.75);
  EXPECT_EQ(test.upper(2), 2);
  EXPECT_EQ(test.upper(0, 0), std::nullopt);  // no distance is known to within 0
}

/// Another candidate is farther, but the first one has all of the triangle.
TEST(NearCover, TakesTheCandidateThatCoversAll) {
  const Case test(in_texture(low, right, up), {in_texture(low, {0.5, 0}, up, 5), in_texture(low, right, up, 1)});
  ASSERT_TRUE(test.upper());
  EXPECT_NEAR(*test.upper(), 1, 1e-12);
}

/// What both triangles have is the corner of one of them: the planes are much farther apart elsewhere.
TEST(PairBound, LooksNoFartherThanBothGo) {
  TexturedTriangle a = in_texture(low, right, up), b = in_texture({0.75, 0}, {3, 0}, {0.75, 3});
  b.corners[1].z() = b.corners[2].z() = 9;  // 4 a unit of length from the first corner on
  const double upper = upper_of_pair(chart_triangle(a, units), chart_triangle(b, units), 0, 1e-9);
  EXPECT_GE(upper, 1);
  EXPECT_NEAR(upper, 1, 1e-12);
}

TEST(PairBound, IsTheLeastWhereNothingIsShared) {
  const TexturedTriangle a = in_texture(low, right, up), b = in_texture({2, 0}, {3, 0}, {2, 1}, 7);
  EXPECT_EQ(upper_of_pair(chart_triangle(a, units), chart_triangle(b, units), 0.25, 1e-9), 0.25);
}

/// Kinds of coordinates that are hard on doubles.
enum class Kind { Grid, Rounded, Thin, Large };

double number(reference::Random& random, Kind kind) {
  const int x = random.below(17) - 8;
  if (kind == Kind::Grid) return x / 8.0;
  if (kind == Kind::Rounded) return x / 24.0;
  if (kind == Kind::Large) return 1000 + x / 24.0;
  return x / 24.0 + 0x1p-40 * random.below(3);
}

TexturedTriangle random_triangle(reference::Random& random, Kind kind) {
  TexturedTriangle t;
  for (std::size_t k = 0; k < 3; ++k) {
    t.coordinates[k] = {number(random, kind), number(random, kind)};
    if (kind == Kind::Thin) t.coordinates[k].y() = t.coordinates[k].x() / 3 + 0x1p-20 * random.below(9);
    t.corners[k] = {t.coordinates[k].x(), t.coordinates[k].y(), random.below(9) / 8.0};
  }
  return t;
}

/// The largest exact distance over what both triangles cover; -1 where that is empty.
double largest_distance(const ChartTriangle& a, const ChartTriangle& b) {
  Overlay overlay(units);
  overlay.begin(a);
  overlay.add(b);
  if (overlay.candidates() == 0) return -1;
  Overlay::Polygon covered;
  overlay.clip(overlay.whole(), 0, covered);
  double largest = -1;
  for (const auto& corner : covered) largest = std::max(largest, overlay.distance(0, corner.node, 0).lower);
  return largest;
}

/// Twice the area of a point with an edge, positive on the inner side.
mpq_class exact_area(const ChartTriangle& t, std::size_t edge, const Eigen::Vector2d& p) {
  const Eigen::Vector2d &from = t.source->coordinates[(edge + 1) % 3], &to = t.source->coordinates[(edge + 2) % 3];
  const auto difference = [](double x, double y) { return mpq_class(mpq_class(x) - mpq_class(y)); };
  const mpq_class area = difference(to.x(), from.x()) * difference(p.y(), from.y()) -
                         difference(to.y(), from.y()) * difference(p.x(), from.x());
  return t.turned ? mpq_class(-area) : area;
}

/// For points so near the edges that doubles cannot tell their sides.
TEST(ChartSides, TellNothingThatIsNotSo) {
  reference::Random random(12);
  int told = 0, untold = 0;
  for (int run = 0; run < 3000; ++run) {
    TexturedTriangle source = random_triangle(random, Kind::Rounded), other = source;
    const auto near_edge = [&](std::size_t k) {
      const Eigen::Vector2d &p = source.coordinates[k % 3], &q = source.coordinates[(k + 1) % 3];
      return Eigen::Vector2d(p + random.below(7) / 7.0 * (q - p));
    };
    for (std::size_t k = 0; k < 3; ++k) other.coordinates[k] = near_edge(k);
    const ChartTriangle t = chart_triangle(source, units), part = chart_triangle(other, units);
    if (t.chart != Chart::Area || part.chart != Chart::Area) continue;
    bool is_part = true;
    for (const Eigen::Vector2d& p : other.coordinates) {
      bool is_within = true, is_strictly_within = true;
      for (std::size_t edge = 0; edge < 3; ++edge) {
        is_within = is_within && sgn(exact_area(t, edge, p)) >= 0;
        is_strictly_within = is_strictly_within && sgn(exact_area(t, edge, p)) > 0;
      }
      is_part = is_part && is_within;
      ASSERT_LE(is_inside(t, p), is_strictly_within) << run;
      told += is_inside(t, p) ? 1 : 0;
    }
    ASSERT_LE(is_part_of(part, t), is_part) << run;
    untold += is_part && !is_part_of(part, t) ? 1 : 0;
    const Eigen::Vector2d from = near_edge(0), to = near_edge(0);
    bool is_beyond = false;
    for (std::size_t edge = 0; edge < 3; ++edge)
      is_beyond = is_beyond || (sgn(exact_area(t, edge, from)) <= 0 && sgn(exact_area(t, edge, to)) <= 0);
    ASSERT_LE(is_outside(t, from, to), is_beyond) << run;
    told += is_outside(t, from, to) ? 1 : 0;
  }
  EXPECT_GT(told, 100);
  EXPECT_GT(untold, 10);
}

TEST(PairBound, IsNeverBelowTheTruth) {
  reference::Random random(5);
  int known = 0, tight = 0, shared = 0;
  for (int run = 0; run < 8000; ++run) {
    const Kind kind = static_cast<Kind>(run % 4);
    TexturedTriangle a = random_triangle(random, kind), b = random_triangle(random, kind);
    if (random.below(3) == 0) b.coordinates[0] = a.coordinates[1];
    if (random.below(6) == 0) b.coordinates[1] = a.coordinates[2];
    const ChartTriangle of_a = chart_triangle(a, units), of_b = chart_triangle(b, units);
    if (of_a.chart != Chart::Area || of_b.chart != Chart::Area) continue;
    const double precision = kind == Kind::Thin ? 2 : 1e-6;
    const double truth = largest_distance(of_a, of_b), upper = upper_of_pair(of_a, of_b, 0, precision);
    ASSERT_GE(upper, truth) << run;
    if (truth > 0) {
      ++shared;
      ASSERT_GE(upper_of_pair(of_a, of_b, 0.75 * truth, precision), truth) << run;
      if (kind != Kind::Thin) {
        EXPECT_EQ(upper_of_pair(of_a, of_b, 3 * upper, precision), 3 * upper) << run;
      }
    }
    if (upper < HUGE_VAL) ++known;
    if (upper <= std::max(truth, 0.0) + 1e-6) ++tight;
  }
  EXPECT_GT(shared, 3000);
  EXPECT_GT(known, 5000);
  EXPECT_GT(tight, 5000);
}

/// Triangles of a grid with moved vertices: they cover what lies inside.
std::vector<TexturedTriangle> random_grid(reference::Random& random) {
  constexpr int size = 4;
  Eigen::Vector2d uv[size + 1][size + 1];
  double height[size + 1][size + 1];
  for (int i = 0; i <= size; ++i)
    for (int j = 0; j <= size; ++j) {
      uv[i][j] = {i + random.below(7) / 20.0, j + random.below(7) / 20.0};
      height[i][j] = random.below(9) / 8.0;
    }
  std::vector<TexturedTriangle> triangles;
  const auto add = [&](std::array<std::pair<int, int>, 3> at) {
    TexturedTriangle& t = triangles.emplace_back();
    if (random.below(2) == 0) std::swap(at[0], at[1]);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [i, j] = at[k];
      t.coordinates[k] = uv[i][j];
      t.corners[k] = {uv[i][j].x(), uv[i][j].y(), height[i][j]};
    }
  };
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      if (random.below(40) == 0) continue;  // a hole
      add({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
      add({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
    }
  return triangles;
}

/// Against the exact covering, and the largest of the exact distances.
TEST(NearCover, AgreesWithIntegers) {
  reference::Random random(9);
  int complete = 0, missed = 0, open = 0;
  for (int run = 0; run < 600; ++run) {
    const auto point = [&] { return Eigen::Vector2d(0.4 + random.below(14) / 4.0, 0.4 + random.below(14) / 4.0); };
    const Case test(in_texture(point(), point(), point()), random_grid(random));
    if (test.a.chart != Chart::Area) continue;
    Overlay overlay(units);
    overlay.begin(test.a);
    for (const ChartTriangle* b : test.candidates) overlay.add(*b);
    const auto left = Covering().uncovered(overlay, overlay.spanning());
    const bool is_covered = left && left->empty();
    if (!is_covered) {
      ++open;
      ASSERT_FALSE(test.is_complete()) << run;
      continue;
    }
    const auto upper = test.upper();
    if (!upper) {
      ++missed;
      continue;
    }
    ++complete;
    double truth = 0;
    for (const ChartTriangle* b : test.candidates) truth = std::max(truth, largest_distance(test.a, *b));
    ASSERT_GE(*upper, truth) << run;
    EXPECT_LE(*upper, truth + 1e-9) << run;
  }
  EXPECT_GT(complete, 200);
  EXPECT_GT(open, 50);
  EXPECT_LT(missed, 10);
}

}  // namespace near_cover_test
}  // namespace meshbound
