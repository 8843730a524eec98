// SPDX-License-Identifier: MIT
// The nearest shapes are those that measuring every candidate finds, for a fraction of its queries.
#include "meshbound/similarity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "meshbound/transform.h"
#include "random_poses.h"

namespace similarity_test {

using namespace meshbound;
using Eigen::Vector3d;

class Random : public test::RandomPoses {
 public:
  Random() : RandomPoses(5) {}
  /// Anywhere, at any scale, and turned if asked.
  Eigen::Affine3d similarity(bool turned) {
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    map.translation() = offset(100);
    if (turned) map.rotate(Eigen::AngleAxisd(uniform(-3, 3), offset(1).normalized()));
    map.scale(std::exp(uniform(-5, 5)));
    return map;
  }
};

struct Family {
  std::string name;
  std::vector<TriangleMesh> members;  ///< the same surface at three resolutions
};

std::vector<Family> families() {
  using namespace datasets;
  std::vector<Family> all;
  const auto add = [&](const std::string& name, auto&& make) { all.push_back({name, {make(1), make(2), make(3)}}); };
  const auto n = [](int fineness, int base) { return static_cast<std::uint32_t>(fineness * base); };
  add("torus", [&](int f) { return torus(1, 0.3, n(f, 20), n(f, 10)); });
  add("thin torus", [&](int f) { return torus(1, 0.1, n(f, 20), n(f, 10)); });
  add("gear", [&](int f) { return gear(1, 0.4, 12, n(f, 4), n(f, 2)); });
  add("cube", [&](int f) { return cube(1, n(f, 4)); });
  add("sheet", [&](int f) { return thin_sheet(1, 0.02, n(f, 10)); });
  add("cylinder", [&](int f) { return cylinder(1, 3, n(f, 16)); });
  add("sphere", [&](int f) { return icosphere(1, f + 1); });
  for (int x = 1; x <= 4; ++x)
    for (int y = 1; y <= x; ++y)
      add("box " + std::to_string(x) + " " + std::to_string(y), [&](int f) {
        return box(Vector3d(5, x, y), {n(f, 5), n(f, 3), n(f, 2)});
      });
  return all;
}

std::uint64_t queries(const HausdorffDistance& distance) {
  return distance.a_to_b.stats.closest_point_queries + distance.b_to_a.stats.closest_point_queries;
}

/// All members of all families, each somewhere else; `family[i]` is that of shape i.
struct Collection {
  std::vector<Shape> shapes;
  std::vector<std::size_t> family;

  explicit Collection(bool turned) {
    Random random;
    const std::vector<Family> all = families();
    for (std::size_t f = 0; f < all.size(); ++f) {
      for (const TriangleMesh& member : all[f].members) {
        shapes.emplace_back(transformed(member, random.similarity(turned)).mesh);
        family.push_back(f);
      }
    }
  }
};

TEST(Similarity, ShapesThatDifferInPlaceAndScaleOnlyAreAtDistanceZero) {
  Random random;
  const TriangleMesh gear = datasets::gear(1, 0.4, 12, 4, 2);
  const Shape query(gear);
  std::vector<Shape> one;
  one.emplace_back(transformed(gear, random.similarity(false)).mesh);
  const SimilarShapes found = nearest_shapes(query, one);
  ASSERT_EQ(found.nearest.size(), 1u);
  EXPECT_LE(found.nearest[0].distance.upper, 1e-3);
  EXPECT_LE(found.nearest[0].distance.lower, 1e-9);
  EXPECT_TRUE(found.complete);
}

/// A rod is turned by a right angle: without aligning, its ends are far from the other one; aligned, it is the same.
TEST(Similarity, AlignsPrincipalAxesWhenAsked) {
  const TriangleMesh rod = datasets::box(Vector3d(4, 1, 0.5), {16, 4, 2});
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  turn.rotate(Eigen::AngleAxisd(std::acos(-1) / 2, Vector3d::UnitZ()));
  const Shape query(rod);
  std::vector<Shape> turned;
  turned.emplace_back(transformed(rod, turn).mesh);
  EXPECT_GT(nearest_shapes(query, turned).nearest[0].distance.lower, 0.5);
  SimilarityOptions options;
  options.align = true;
  const SimilarShapes aligned = nearest_shapes(query, turned, options);
  EXPECT_LE(aligned.nearest[0].distance.upper, 1e-3);
  EXPECT_EQ(aligned.stats.alignments, 4u);
}

TEST(Similarity, ScaleIsThatOfTheSurfaceNotOfItsTriangles) {
  const Shape coarse(datasets::torus(1, 0.3, 40, 20)), fine(datasets::torus(1, 0.3, 160, 80));
  EXPECT_NEAR(coarse.normalisation().linear()(0, 0), fine.normalisation().linear()(0, 0), 0.01);
  EXPECT_NEAR(coarse.normalisation().linear()(0, 0), 1 / std::sqrt(1 + 2 * 0.09), 0.01);
}

double error_bound_at(double upper, const SimilarityOptions& options) {
  return std::max(options.error_bound, options.relative_error_bound * upper);
}

/// Whether shapes are aligned, and the relative error bound.
class FindsTheFamily : public testing::TestWithParam<std::tuple<bool, double>> {};

/// The two other members of the query's family come first, with the distances that measuring all finds, for a tenth of
/// the queries of measuring all.
TEST_P(FindsTheFamily, FirstAndWithATenthOfTheQueries) {
  const auto [turned, relative_error_bound] = GetParam();
  const Collection all(turned);
  SimilarityOptions options;
  options.relative_error_bound = relative_error_bound;
  options.count = 3;
  options.align = turned;
  double searched = 0, measured = 0;
  for (std::size_t q = 0; q < all.shapes.size(); q += 3) {
    SCOPED_TRACE(q);
    const Shape& query = all.shapes[q];
    const SimilarShapes found = nearest_shapes(query, all.shapes, options);
    ASSERT_EQ(found.nearest.size(), 3u);
    // Axes are well defined only where all three extents differ.
    const std::string name = families()[all.family[q]].name;
    const bool has_axes = name.find("box") == 0 && name[4] != name[6];
    for (const SimilarShape& shape : found.nearest)
      if (!turned || has_axes) {
        EXPECT_EQ(all.family[shape.index], all.family[q]) << name;
      }
    EXPECT_EQ(found.nearest[0].index, q);
    EXPECT_LE(found.nearest[0].distance.lower, 1e-9);
    for (const SimilarShape& shape : found.nearest) {
      EXPECT_TRUE(shape.converged);
      EXPECT_LE(shape.distance.upper - shape.distance.lower, error_bound_at(shape.distance.upper, options));
    }
    searched += static_cast<double>(found.stats.closest_point_queries);
    if (turned) continue;
    DistanceOptions to_the_end;
    to_the_end.error_bound = options.error_bound;
    for (std::size_t i = 0; i < all.shapes.size(); ++i) {
      const HausdorffDistance distance = hausdorff_distance(query.tree(), all.shapes[i].tree(), to_the_end);
      measured += static_cast<double>(queries(distance));
      const auto listed = std::find_if(found.nearest.begin(), found.nearest.end(),
                                       [&](const SimilarShape& shape) { return shape.index == i; });
      for (auto before = found.nearest.begin(); before != listed; ++before) {
        EXPECT_GE(distance.bounds.upper, before->distance.upper - error_bound_at(before->distance.upper, options));
      }
      if (listed == found.nearest.end()) continue;
      EXPECT_LE(listed->distance.lower, distance.bounds.upper);
      EXPECT_GE(listed->distance.upper, distance.bounds.lower);
    }
  }
  if (!turned) {
    EXPECT_LE(searched, measured / 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Similarity, FindsTheFamily, testing::Combine(testing::Bool(), testing::Values(0.0, 0.5)),
                         [](const auto& given) {
                           return std::string(std::get<0>(given.param) ? "aligned" : "as_they_lie") +
                                  (std::get<1>(given.param) > 0 ? "_by_shares" : "_by_lengths");
                         });

TEST(Similarity, IsTheSameForAnyNumberOfThreads) {
  const Collection all(true);
  SimilarityOptions one, many;
  one.align = many.align = true;
  one.count = many.count = 4;
  one.distance.threads = 1;
  many.distance.threads = 3;
  const SimilarShapes a = nearest_shapes(all.shapes[8], all.shapes, one);
  const SimilarShapes b = nearest_shapes(all.shapes[8], all.shapes, many);
  ASSERT_EQ(a.nearest.size(), b.nearest.size());
  for (std::size_t i = 0; i < a.nearest.size(); ++i) {
    EXPECT_EQ(a.nearest[i].index, b.nearest[i].index);
    EXPECT_EQ(a.nearest[i].distance.lower, b.nearest[i].distance.lower);
    EXPECT_EQ(a.nearest[i].distance.upper, b.nearest[i].distance.upper);
  }
  EXPECT_EQ(a.stats.closest_point_queries, b.stats.closest_point_queries);
}

TEST(Similarity, EveryAlignmentIsAccountedFor) {
  const Collection all(false);
  const SimilarityStats stats = nearest_shapes(all.shapes[0], all.shapes).stats;
  EXPECT_EQ(stats.alignments, all.shapes.size());
  EXPECT_EQ(stats.ended_by_extents + stats.ended_by_samples + stats.ended_by_decision + stats.measured,
            stats.alignments);
  EXPECT_GT(stats.ended_by_extents, stats.alignments / 2);
}

/// A sphere with a vertex pushed towards the centre: extents and samples do not show it.
Shape dented(std::size_t vertex, double depth) {
  TriangleMesh sphere = datasets::icosphere(1, 4);
  sphere.vertices[vertex] *= 1 - depth;
  return Shape(sphere);
}

TEST(Similarity, AVertexThatIsTooFarSparesADecision) {
  const Shape query(datasets::icosphere(1, 4));
  std::vector<Shape> candidates;
  candidates.push_back(dented(1000, 0.03));
  const SimilarityStats alone = nearest_shapes(query, candidates).stats;
  candidates.push_back(dented(2000, 0.06));
  const SimilarShapes found = nearest_shapes(query, candidates);
  EXPECT_EQ(found.nearest[0].index, 0u);
  EXPECT_EQ(found.stats.ended_by_decision, 1u);
  EXPECT_EQ(found.stats.measured, 1u);
  // 256 points of the two are for samples; a decision asks for more than 64 vertices.
  EXPECT_LT(found.stats.closest_point_queries - alone.closest_point_queries, 256u + 64u);
}

TEST(Similarity, KnowsADistanceToAFactorOfTwoUnlessToldOtherwise) {
  const Shape query(datasets::torus(1, 0.3, 40, 20));
  std::vector<Shape> candidates;
  candidates.emplace_back(datasets::torus(1, 0.3, 25, 12));
  SimilarityOptions by_length;
  by_length.relative_error_bound = 0;
  const SimilarShape narrow = nearest_shapes(query, candidates, by_length).nearest[0],
                     wide = nearest_shapes(query, candidates).nearest[0];
  EXPECT_LE(narrow.distance.upper - narrow.distance.lower, 1e-3);
  EXPECT_GT(wide.distance.upper - wide.distance.lower, 1e-3);
  EXPECT_LE(wide.distance.upper, 2 * wide.distance.lower);
}

/// A candidate that points of its own show to be too far needs no tree: this one's cannot be built.
TEST(Similarity, BuildsTreesOfThoseAloneThatAreReached) {
  const Shape query(datasets::icosphere(1, 4));
  TriangleMesh spiky = datasets::icosphere(1, 4);
  for (std::size_t v = 100; v < spiky.vertices.size(); v += 7) spiky.vertices[v] *= 0.7;
  const std::atomic<bool> cancel = true;
  std::vector<Shape> candidates;
  candidates.emplace_back(spiky, BvhOptions{.threads = 1, .stop = {.cancel = &cancel}});
  candidates.push_back(dented(1000, 0.2));
  const SimilarShapes found = nearest_shapes(query, candidates);
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.stats.ended_by_samples, 1u);
  EXPECT_EQ(found.nearest[0].index, 1u);
}

TEST(Similarity, IsIncompleteWhenTheTimeOrATreeEndsTheSearch) {
  const Shape query(datasets::icosphere(1, 3));
  std::vector<Shape> candidates;
  const std::atomic<bool> cancel = true;
  candidates.emplace_back(datasets::icosphere(1, 3), BvhOptions{.threads = 1, .stop = {.cancel = &cancel}});
  EXPECT_FALSE(nearest_shapes(query, candidates).complete) << "its tree cannot be built";
  candidates[0] = Shape(datasets::icosphere(1, 3));
  SimilarityOptions options;
  options.distance.budget.seconds = 0;
  EXPECT_FALSE(nearest_shapes(query, candidates, options).complete);
  EXPECT_TRUE(nearest_shapes(query, candidates).complete);
}

TEST(Similarity, RefusesWhatHasNoShape) {
  TriangleMesh point;
  point.vertices.assign(3, Vector3d(1, 2, 3));
  point.triangles = {{0, 1, 2}};
  EXPECT_THROW(Shape{point}, InvalidInput);
  const Shape cube(datasets::cube(1, 1));
  SimilarityOptions none;
  none.count = 0;
  EXPECT_THROW((void)nearest_shapes(cube, {}, none), InvalidInput);
  SimilarityOptions all;
  all.relative_error_bound = 1;
  EXPECT_THROW((void)nearest_shapes(cube, {}, all), InvalidInput);
  TriangleMesh segment = point;
  segment.vertices[1].x() = 4;
  segment.vertices[2].x() = 2;
  EXPECT_NO_THROW(Shape{segment});
}

}  // namespace similarity_test
