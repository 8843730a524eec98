// SPDX-License-Identifier: MIT
// Distances in an overlay: what doubles say of them encloses what integers say.
#include "texture/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "reference/point_triangle_cases.h"
#include "texture/overlay_numbers.h"

namespace meshbound {
namespace overlay_test {

/// Coordinates here are multiples of 1/64.
constexpr ExactUnits units{-6, -6};

double random_number(reference::Random& random) { return (random.below(257) - 128) / 64.0; }

TexturedTriangle random_triangle(reference::Random& random) {
  TexturedTriangle t;
  for (std::size_t k = 0; k < 3; ++k) {
    t.corners[k] = {random_number(random), random_number(random), random_number(random)};
    t.coordinates[k] = {random_number(random), random_number(random)};
  }
  return t;
}

/// All its texture coordinates on one line.
TexturedTriangle random_segment(reference::Random& random) {
  TexturedTriangle t = random_triangle(random);
  for (std::size_t k = 0; k < 3; ++k) t.coordinates[k] = Eigen::Vector2d(random.below(9) - 4, 0) / 4;
  return t;
}

/// Compares the distances of points of `a` that the candidate has. Returns their number.
int compare(const TexturedTriangle& a, const TexturedTriangle& b, reference::Random& random) {
  const ChartTriangle of_a = chart_triangle(a, units), of_b = chart_triangle(b, units);
  Overlay overlay(units);
  overlay.begin(of_a);
  overlay.add(of_b);
  if (overlay.candidates() == 0 || of_b.chart == Chart::Point) return 0;
  std::vector<Overlay::Node> points;
  Overlay::Polygon covered;
  overlay.clip(overlay.whole(), 0, covered);
  for (const auto& corner : covered) points.push_back(corner.node);
  for (int k = 0; k < 4; ++k)
    points.push_back(Overlay::given({random.below(5) / 4.0 + 0x1p-4, random.below(5) / 4.0, random.below(5) / 4.0}));
  int compared = 0;
  for (const Overlay::Node& point : points) {
    if (!overlay.covers(0, point)) continue;
    const Bounds rough = overlay.rough_distance(0, point), exact = overlay.distance(0, point, 0);
    EXPECT_LE(rough.lower, exact.upper);
    EXPECT_GE(rough.upper, exact.lower);
    if (rough.upper - rough.lower < 1e-9) ++compared;
  }
  return compared;
}

TEST(OverlayDistance, ByDoublesEnclosesThatToATriangle) {
  reference::Random random(1);
  int compared = 0;
  for (int run = 0; run < 3000; ++run) compared += compare(random_triangle(random), random_triangle(random), random);
  EXPECT_GT(compared, 3000);
}

/// Where the texture coordinates of a candidate lie on a line, those of one point belong to a whole segment.
TEST(OverlayDistance, ByDoublesEnclosesThatToASegment) {
  reference::Random random(2);
  int compared = 0;
  for (int run = 0; run < 3000; ++run) compared += compare(random_segment(random), random_segment(random), random);
  EXPECT_GT(compared, 3000);
}

/// A segment in the texture is halved again and again by its coordinates, far beyond what doubles tell apart.
TEST(Overlay, PartsPiecesHoweverThin) {
  reference::Random random(7);
  for (int run = 0; run < 100; ++run) {
    const TexturedTriangle segment = random_segment(random);
    const ChartTriangle of_segment = chart_triangle(segment, units);
    if (of_segment.chart != Chart::Segment) continue;
    Overlay overlay(units);
    overlay.begin(of_segment);
    Overlay::Polygon piece = overlay.whole(), half;
    for (int k = 0; k < 200; ++k) {
      const auto line = overlay.add_middle_coordinate(piece);
      ASSERT_TRUE(line);
      EXPECT_FALSE(overlay.is_on_one_side(*line, piece));
      const Overlay::Node inside = overlay.inside(piece, piece.front().node, 10);
      for (const auto& corner : piece) {
        const bool is_edge = overlay.is_on_one_side(corner.to_next, piece);
        EXPECT_TRUE(!is_edge || overlay.side(corner.to_next, inside) != 0);
      }
      overlay.clip(piece, *line, random.below(2) == 0, half);
      std::swap(piece, half);
    }
  }
}

/// What the planes of two triangles say of a limit, against exact distances. Counts the pairs that they tell are near.
int compare_planes(const TexturedTriangle& a, const TexturedTriangle& b, const ExactUnits& of_both) {
  const ChartTriangle of_a = chart_triangle(a, of_both), of_b = chart_triangle(b, of_both);
  Overlay overlay(of_both);
  overlay.begin(of_a);
  overlay.add(of_b);
  if (overlay.candidates() == 0 || of_a.chart != Chart::Area || of_b.chart != Chart::Area) return 0;
  double at_corners = 0;  // of A, from the plane of B
  for (const auto& corner : overlay.whole())
    at_corners = std::max(at_corners, overlay.rough_distance(0, corner.node).upper);
  const auto is_within = [&](double limit) { return of_a.plane.is_within(b, limit) || of_b.plane.is_within(a, limit); };
  Overlay::Polygon covered;
  overlay.clip(overlay.whole(), 0, covered);
  for (const auto& corner : covered) {
    const double exact = overlay.distance(0, corner.node, 0).lower;
    EXPECT_FALSE(is_within(std::nextafter(exact, 0)));
  }
  return is_within(at_corners + 1e-9) ? 1 : 0;
}

TEST(LiftedPlane, NeverTellsThatAPointIsNearerThanItIs) {
  reference::Random random(4);
  int near = 0;
  for (int run = 0; run < 3000; ++run) near += compare_planes(random_triangle(random), random_triangle(random), units);
  EXPECT_GT(near, 1000);
}

/// Nearly no area in the texture: what a step in the texture leads to in space is hardly known. Thirds are rounded.
TEST(LiftedPlane, HoldsWhereATriangleIsNearlyASegment) {
  reference::Random random(5);
  int near = 0;
  for (int run = 0; run < 3000; ++run) {
    TexturedTriangle a = random_segment(random), b = random_segment(random);
    for (TexturedTriangle* t : {&a, &b})
      for (Eigen::Vector2d& uv : t->coordinates) uv = {uv.x() / 3, 0x1p-30 * random.below(9) / 3};
    near += compare_planes(a, b, {-90, -6});
  }
  EXPECT_GT(near, 0);
}

/// One triangle in the plane of the other, so that all that there is are errors.
TEST(LiftedPlane, HoldsForOffsetsOfTheSizeOfRounding) {
  reference::Random random(6);
  for (int run = 0; run < 3000; ++run) {
    TexturedTriangle a = random_triangle(random), b = random_triangle(random);
    for (TexturedTriangle* t : {&a, &b})
      for (std::size_t k = 0; k < 3; ++k) {
        t->coordinates[k] /= 3;
        t->corners[k] = {t->coordinates[k].x(), t->coordinates[k].y(), 1};
      }
    (void)compare_planes(a, b, {-70, -70});
  }
}

/// Squares of such lengths underflow or overflow.
TEST(LiftedPlane, HoldsForAnyUnitOfLength) {
  const std::array<Eigen::Vector2d, 3> uv = {{{0, 0}, {1, 0}, {0, 1}}};
  for (const double unit : {0x1p-1000, 0x1p-500, 0x1p-280, 1.0, 0x1p400, 0x1p600}) {
    TexturedTriangle a{{{{0, 0, 0}, {unit, 0, 0}, {0, unit, 0}}}, uv, 0, 0}, b = a;
    for (Eigen::Vector3d& p : b.corners) p.z() += 3 * unit;
    EXPECT_FALSE(LiftedPlane(a).is_within(b, 2.9999 * unit)) << unit;
    EXPECT_EQ(LiftedPlane(a).is_within(b, 3.0001 * unit), unit > 0x1p-300 && unit < 0x1p500) << unit;
  }
}

/// Doubles cannot tell whether there is an area in the texture, so they know nothing of the plane, not even where all
/// differences come out as 0, as they do for some of these lengths.
TEST(LiftedPlane, TellsNothingWhereDoublesDoNotKnowTheArea) {
  for (int k = 1; k < 100; ++k) {
    const double r = k / 3.0;
    const TexturedTriangle t{
        {{{0, 0, 0}, {r, 0, 0}, {2 * r, 0, 0}}}, {{{0, 0}, {0.1, 0.3}, {0.2, std::nextafter(0.6, 1)}}}, 0, 0};
    EXPECT_FALSE(LiftedPlane(t).is_within(t, 1e100));
  }
}

TEST(DoubledArea, EnclosesTheTruth) {
  reference::Random random(3);
  const double steps[] = {0, 0x1p-52, 0x1p-30, 1, 3};
  for (int run = 0; run < 20000; ++run) {
    const auto number = [&] { return random.below(3) / 2.0 + steps[random.below(5)] * random.below(4); };
    const Eigen::Vector2d a(number(), number()), b(number(), number()), p(number(), number());
    const mpq_class truth = (mpq_class(b.x()) - mpq_class(a.x())) * (mpq_class(p.y()) - mpq_class(a.y())) -
                            (mpq_class(b.y()) - mpq_class(a.y())) * (mpq_class(p.x()) - mpq_class(a.x()));
    const Approximate area = doubled_area(a, b, p);
    EXPECT_LE(abs(truth - mpq_class(area.value)), mpq_class(area.error));
    if (area.is_zero()) {
      EXPECT_EQ(sgn(truth), 0);
    }
  }
}

}  // namespace overlay_test
}  // namespace meshbound
