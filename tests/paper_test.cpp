// SPDX-License-Identifier: MIT
// Each lemma and equation of Tang, Lee, Kim 2009 by itself, and the method made of them against an oracle that shares
// no code with it. The names cite the paper.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bvh/build.h"
#include "datasets/analytic_meshes.h"
#include "distance/paper/candidate_set.h"
#include "distance/paper/closed_model.h"
#include "distance/paper/group_traversal.h"
#include "distance/paper/voronoi_subdivision.h"
#include "geometry/mapping.h"
#include "meshbound/distance.h"
#include "reference/brute_force.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace paper_test {

using reference::both;
using reference::brute_force_one_sided;
using reference::brute_force_symmetric;
using reference::moved;
using reference::random_soup;
using reference::scaled;

constexpr double rounding = 1e-12;  ///< what the plain arithmetic of these tests may be off
constexpr Method methods[] = {Method::CellWalking, Method::CrossCulling};

DistanceOptions with(Method method, double error_bound) {
  DistanceOptions options;
  options.method = method;
  options.error_bound = error_bound;
  options.threads = 1;
  return options;
}

double squared_distance(const Bvh::Data& data, std::uint32_t slot, const Vec3& p) {
  return closest_on_triangle(triangle_at(data, slot), p).squared_distance;
}

double min_squared_distance(const Bvh::Data& data, const Vec3& p) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot)
    smallest = std::min(smallest, squared_distance(data, slot, p));
  return smallest;
}

/// Random triangles and points in the working cube of a tree, [-1, 1]^3.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double number() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  Vec3 point() { return {number(), number(), number()}; }
  TriangleCorners triangle(double size) {
    const Vec3 at = point();
    return {at + size * point(), at + size * point(), at + size * point()};
  }
  Vec3 point_in(const TriangleCorners& t) {
    double v = 0.5 + 0.5 * number(), w = 0.5 + 0.5 * number();
    if (v + w > 1) {
      v = 1 - v;
      w = 1 - w;
    }
    return t[0] + v * (t[1] - t[0]) + w * (t[2] - t[0]);
  }

 private:
  std::mt19937 engine_;
};

TriangleMesh mesh_of(const Bvh::Data& data, const TriangleCorners& t) {
  const auto to_model = [&data](const Vec3& w) {
    const Vec3 p = data.frame.to_model(w);
    return Eigen::Vector3d(p.x, p.y, p.z);
  };
  return reference::single_triangle(to_model(t[0]), to_model(t[1]), to_model(t[2]));
}

GroupBounds bounds_of(const Bvh::Data& data, const TriangleCorners& t) {
  GroupBounds bounds;
  QueryCounters counters;
  group_traversal(data, t, 0, bounds, counters);
  return bounds;
}

void expect_overlap(const Bounds& x, const Bounds& y) {
  EXPECT_LE(x.lower, y.upper);
  EXPECT_LE(y.lower, x.upper);
}

TEST(Paper, Lemma1_more_of_A_raises_and_more_of_B_lowers_the_distance) {
  const TriangleMesh a = random_soup(1, 15, 0.3), b = random_soup(2, 15, 0.3);
  const Bvh tree_a(a), tree_b(b), more_a(both(a, random_soup(3, 15, 0.3))), more_b(both(b, random_soup(4, 15, 0.3)));
  for (const Method method : methods) {
    const DistanceOptions options = with(method, 1e-9);
    const Bounds plain = one_sided_hausdorff_distance(tree_a, tree_b, options).bounds;
    const Bounds larger_b = one_sided_hausdorff_distance(tree_a, more_b, options).bounds;
    const Bounds larger_a = one_sided_hausdorff_distance(more_a, tree_b, options).bounds;
    EXPECT_LE(larger_b.lower, plain.upper);
    EXPECT_GE(larger_a.upper, plain.lower);
    EXPECT_LT(larger_b.upper, plain.lower) << "this pair gets nearer";
    EXPECT_GE(larger_a.lower, plain.lower - 1e-9);
  }
}

TEST(Paper, Lemma2_Eq5_bounds_of_a_triangle_contain_its_distance) {
  const TriangleMesh b = random_soup(5, 40, 0.4);
  const Bvh tree(b);
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    const TriangleCorners t = random.triangle(0.4);
    const GroupBounds bounds = bounds_of(tree.data(), t);
    const double unit = tree.data().frame.length_up(1);
    const double lower = unit * std::sqrt(bounds.nearest[bounds.worst_corner()].squared);
    const double upper = unit * std::sqrt(bounds.upper.squared);
    const Bounds truth = brute_force_one_sided(mesh_of(tree.data(), t), b, 1e-3);
    EXPECT_LE(lower, truth.upper);
    EXPECT_GE(upper, truth.lower);
  }
}

TEST(Paper, Theorem1_the_distance_of_a_model_is_the_largest_of_its_triangles) {
  const TriangleMesh a = random_soup(7, 12, 0.4), b = random_soup(8, 12, 0.4);
  const Bvh tree_a(a), tree_b(b);
  for (const Method method : methods) {
    const DistanceOptions options = with(method, 1e-9);
    Bounds largest{0, 0};
    for (const Triangle& t : a.triangles) {
      const Bvh alone(reference::single_triangle(a.vertices[t[0]], a.vertices[t[1]], a.vertices[t[2]]));
      const Bounds one = one_sided_hausdorff_distance(alone, tree_b, options).bounds;
      largest = {std::max(largest.lower, one.lower), std::max(largest.upper, one.upper)};
    }
    expect_overlap(largest, one_sided_hausdorff_distance(tree_a, tree_b, options).bounds);
    EXPECT_LE(largest.upper - largest.lower, 1e-9);
  }
}

TEST(Paper, Theorem2_Eq6_the_largest_bounds_of_the_triangles_bound_the_model) {
  const TriangleMesh a = random_soup(9, 25, 0.3), b = random_soup(10, 25, 0.3);
  const Bvh tree_a(a), tree_b(b);
  const Mapping map = mapping_between(tree_a.data().frame, Eigen::Isometry3d::Identity(), tree_b.data().frame,
                                      Eigen::Isometry3d::Identity());
  double lower = 0, upper = 0;
  for (const Triangle& t : tree_a.data().corners) {
    const auto& v = tree_a.data().vertices;
    const GroupBounds bounds = bounds_of(tree_b.data(), {map(v[t[0]]), map(v[t[1]]), map(v[t[2]])});
    lower = std::max(lower, std::sqrt(bounds.nearest[bounds.worst_corner()].squared));
    upper = std::max(upper, std::sqrt(bounds.upper.squared));
  }
  const double unit = tree_b.data().frame.length_up(1);
  const Bounds truth = brute_force_one_sided(a, b, 1e-3);
  EXPECT_LE(unit * lower, truth.upper);
  EXPECT_GE(unit * upper, truth.lower);
}

TEST(Paper, Eq8_Eq9_the_corners_of_a_box_bound_all_that_is_inside_never_looser_than_the_paper) {
  const Bvh a(random_soup(11, 200, 0.2)), b(random_soup(12, 200, 0.2));
  const Bvh::Data &from = a.data(), &to = b.data();
  const Mapping map =
      mapping_between(from.frame, Eigen::Isometry3d::Identity(), to.frame, Eigen::Isometry3d::Identity());
  for (std::uint32_t block = 0; block < from.block_count(); ++block) {
    const Box box = node_box(from, 0, block);
    const Vec3 centre = map(0.5 * (box.lo + box.hi));
    Nearest q;
    QueryCounters counters;
    find_nearest(to, centre, 0, q, counters);
    const CornerTriangle<double> t = triangle_at(to, q.slot);
    const Vec3 point = centre - closest_on_triangle(t, centre).offset;
    Piece corners;
    double eq9 = 0;
    for (const double x : {box.lo.x, box.hi.x})
      for (const double y : {box.lo.y, box.hi.y})
        for (const double z : {box.lo.z, box.hi.z}) {
          corners.add(map({x, y, z}));
          eq9 = std::max(eq9, length(map({x, y, z}) - point));
        }
    const double bound = std::sqrt(farthest_corner(corners, t).squared);
    EXPECT_LE(bound, eq9 + rounding);
    EXPECT_LE(eq9, length(centre - point) + length(map(box.hi) - centre) + rounding) << "the ball is looser still";
    const auto [first, last] = slots_below(from, 0, block);
    for (std::uint32_t slot = first; slot < last; ++slot)
      for (const std::uint32_t v : from.corners[slot])
        EXPECT_LE(std::sqrt(min_squared_distance(to, map(from.vertices[v]))), bound + rounding);
  }
}

TEST(Paper, Eq10_to_Eq13_group_traversal_equals_separate_queries) {
  const Bvh b(random_soup(13, 300, 0.2));
  Random random(14);
  for (int i = 0; i < 200; ++i) {
    const TriangleCorners t = random.triangle(i % 2 == 0 ? 0.05 : 0.8);
    const GroupBounds bounds = bounds_of(b.data(), t);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(bounds.nearest[k].squared, min_squared_distance(b.data(), t[k]));
    double upper = std::numeric_limits<double>::infinity();
    for (std::uint32_t slot = 0; slot < b.triangle_count(); ++slot) {
      double farthest = 0;
      for (const Vec3& corner : t) farthest = std::max(farthest, squared_distance(b.data(), slot, corner));
      upper = std::min(upper, farthest);
    }
    EXPECT_EQ(bounds.upper.squared, upper);
  }
}

TEST(Paper, Section4_2_culling_on_B_opens_a_small_part_of_the_tree) {
  const Bvh b(datasets::icosphere(1, 5));
  Random random(15);
  QueryCounters counters;
  for (int i = 0; i < 100; ++i) {
    GroupBounds bounds;
    group_traversal(b.data(), random.triangle(0.01), 0, bounds, counters);
  }
  EXPECT_LT(static_cast<double>(counters.triangles), 0.05 * 100 * static_cast<double>(b.triangle_count()));
}

TriangleCorners in_frame(const Bvh& b, const std::array<Eigen::Vector3d, 3>& t) {
  TriangleCorners corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = b.data().frame.to_working({t[k].x(), t[k].y(), t[k].z()});
  return corners;
}

/// The closest triangles of points all over T are in L. Returns its size.
std::size_t expect_complete_candidates(const Bvh& b, const TriangleCorners& t, Random& random) {
  std::vector<Candidate> candidates;
  QueryCounters counters;
  collect_candidates(b.data(), t, bounds_of(b.data(), t).upper.squared, 1e-13, candidates, counters);
  for (int j = 0; j < 50; ++j) {
    const Vec3 p = random.point_in(t);
    double smallest = std::numeric_limits<double>::infinity();
    for (const Candidate& c : candidates) smallest = std::min(smallest, squared_distance(b.data(), c.slot, p));
    EXPECT_EQ(smallest, min_squared_distance(b.data(), p));
  }
  for (const Candidate& c : candidates)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(c.squared[k], squared_distance(b.data(), c.slot, t[k]));
  return candidates.size();
}

TEST(Paper, Lemma3_the_candidate_set_holds_the_closest_triangle_of_every_point) {
  const Bvh b(random_soup(16, 300, 0.2));
  Random random(17);
  std::size_t largest = 0;
  for (int i = 0; i < 100; ++i)
    largest = std::max(largest, expect_complete_candidates(b, random.triangle(0.2), random));
  EXPECT_LT(largest, b.triangle_count()) << "a set that holds everything proves nothing";
}

TEST(Paper, Lemma3_holds_for_a_large_triangle_over_a_plane_with_crumbs) {
  // The plane makes the upper bound small against T, the crumbs are closest near its corners.
  TriangleMesh b = random_soup(27, 200, 0.05);
  for (Eigen::Vector3d& v : b.vertices) v.z() *= 0.05;
  const Bvh tree(both(b, moved(scaled(reference::unit_square(1), 3), {-1, -1, -0.02})));
  Random random(28);
  for (int i = 0; i < 30; ++i) {
    std::array<Eigen::Vector3d, 3> corners;
    for (Eigen::Vector3d& c : corners) c = {0.5 + 0.5 * random.number(), 0.5 + 0.5 * random.number(), 0.08};
    expect_complete_candidates(tree, in_frame(tree, corners), random);
  }
}

std::vector<std::uint32_t> all_slots(const Bvh& b) {
  std::vector<std::uint32_t> slots(b.triangle_count());
  for (std::uint32_t i = 0; i < slots.size(); ++i) slots[i] = i;
  return slots;
}

TEST(Paper, Lemma4_a_triangle_that_a_translation_takes_through_a_closed_model_is_that_near) {
  const Bvh cube(reference::cube(1));
  const TriangleCorners above = in_frame(cube, {{{-0.5, -0.4, 1.2}, {0.5, -0.3, 1.3}, {0.1, 0.6, 1.1}}});
  const TriangleCorners inside = in_frame(cube, {{{-0.5, -0.4, 0.8}, {0.5, -0.3, 0.9}, {0.1, 0.6, 0.7}}});
  const TriangleCorners through = in_frame(cube, {{{-0.5, -0.4, 0.9}, {0.5, -0.3, 1.1}, {0.1, 0.6, 1.1}}});
  const TriangleCorners beyond = in_frame(cube, {{{-0.5, -0.4, -2}, {0.5, -0.3, -1.9}, {0.1, 0.6, -2.1}}});
  EXPECT_TRUE(is_closed(cube.data()));
  EXPECT_TRUE(crosses_surface(cube.data(), above, inside, all_slots(cube)));
  EXPECT_TRUE(crosses_surface(cube.data(), inside, above, all_slots(cube))) << "from inside as well";
  EXPECT_FALSE(crosses_surface(cube.data(), above, through, all_slots(cube))) << "not enclosed";
  EXPECT_FALSE(crosses_surface(cube.data(), through, inside, all_slots(cube))) << "inside to begin with";
  EXPECT_FALSE(crosses_surface(cube.data(), above, beyond, all_slots(cube))) << "in and out again";
}

TEST(Paper, Lemma4_as_printed_fails_for_a_triangle_that_is_partly_inside) {
  // A cube with three bubbles; the triangle has a corner in each, 0.1 above the floor, and runs through the solid.
  TriangleMesh b = reference::cube(10);
  const std::array<Eigen::Vector3d, 3> bubbles = {Eigen::Vector3d(-3, -2, 0), Eigen::Vector3d(3, -2, 0),
                                                  Eigen::Vector3d(0, 3, 0)};
  std::array<Eigen::Vector3d, 3> triangle, image;
  for (std::size_t k = 0; k < 3; ++k) {
    b = both(b, moved(reference::cube(0.2), bubbles[k]));
    triangle[k] = bubbles[k] + Eigen::Vector3d(0, 0, -0.1);
    image[k] =
        triangle[k] - Eigen::Vector3d(0, 0, 0.1 + 0.01);  // lower bound 0.1, epsilon 0.01: all of it in the solid
  }
  const Bvh tree(b);
  const TriangleCorners t = in_frame(tree, triangle);
  const GroupBounds bounds = bounds_of(tree.data(), t);
  const double lower = tree.data().frame.length_up(std::sqrt(bounds.nearest[bounds.worst_corner()].squared));
  EXPECT_NEAR(lower, 0.1, 1e-9) << "the premise of the lemma";
  const Eigen::Vector3d centroid = (triangle[0] + triangle[1] + triangle[2]) / 3;
  EXPECT_GT(closest_point(tree, centroid).distance.lower, 2) << "yet its centroid is not within 0.11";
  EXPECT_TRUE(is_closed(tree.data()));
  EXPECT_FALSE(crosses_surface(tree.data(), t, in_frame(tree, image), all_slots(tree)));
  const TriangleMesh a = reference::single_triangle(triangle[0], triangle[1], triangle[2]);
  const Bounds truth = brute_force_one_sided(a, b, 0.05);
  const Bounds ours = one_sided_hausdorff_distance(Bvh(a), tree, with(Method::CrossCulling, 0.01)).bounds;
  expect_overlap(ours, truth);
  EXPECT_GT(ours.lower, 2);
}

TEST(Paper, Lemma4_is_off_where_the_model_is_not_closed) {
  EXPECT_FALSE(is_closed(Bvh(random_soup(18, 20, 0.3)).data()));
  TriangleMesh open = reference::cube(1);
  open.triangles.pop_back();
  EXPECT_FALSE(is_closed(Bvh(open).data()));
  TriangleMesh fan = reference::cube(1);  // a third triangle at an edge
  fan.vertices.emplace_back(5, 5, 5);
  fan.triangles.push_back({fan.triangles[0][0], fan.triangles[0][1], 8});
  EXPECT_FALSE(is_closed(Bvh(fan).data()));
  const Bvh sphere(datasets::icosphere(1, 4)), open_box(open);
  EXPECT_EQ(one_sided_hausdorff_distance(sphere, open_box, with(Method::CrossCulling, 1e-4)).stats.enclosed, 0U);
}

TEST(Paper, Lemma4_ends_subdivision_on_closed_models_and_keeps_the_truth) {
  const TriangleMesh a = scaled(reference::icosphere(1), 1.02), b = reference::icosphere(2);
  const OneSidedDistance ours = one_sided_hausdorff_distance(Bvh(a), Bvh(b), with(Method::CrossCulling, 1e-4));
  EXPECT_GT(ours.stats.enclosed, 0U);
  expect_overlap(ours.bounds, brute_force_one_sided(a, b, 1e-2));
  EXPECT_LE(ours.bounds.upper - ours.bounds.lower, 1e-4);
  expect_overlap(ours.bounds, one_sided_hausdorff_distance(Bvh(a), Bvh(b), with(Method::CellWalking, 1e-6)).bounds);
}

TEST(Paper, Section5_2_the_Voronoi_point_is_equidistant_from_the_supporting_planes) {
  Random random(19);
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    const TriangleCorners x = random.triangle(0.5), y = random.triangle(0.5);
    const CornerTriangle<double> t1{x[0], x[1] - x[0], x[2] - x[0]}, t2{y[0], y[1] - y[0], y[2] - y[0]};
    const Vec3 v1 = random.point(), v2 = random.point();
    const auto share = equidistant_parameter(v1, v2, t1, t2);
    const SupportingPlane p1(t1), p2(t2);
    if (!share) {  // the nearer plane is the same at both ends and no bisector passes between
      EXPECT_GT((std::fabs(p1.distance(v1)) - std::fabs(p2.distance(v1))) *
                    (std::fabs(p1.distance(v2)) - std::fabs(p2.distance(v2))),
                0);
      continue;
    }
    ++found;
    EXPECT_TRUE(*share > 0 && *share < 1);
    const Vec3 point = v1 + *share * (v2 - v1);
    EXPECT_NEAR(std::fabs(p1.distance(point)), std::fabs(p2.distance(point)), rounding);
  }
  EXPECT_GT(found, 100);
}

TEST(Paper, Section6_seeding_and_cached_pairs_leave_the_two_sided_distance_as_it_is) {
  for (std::uint32_t seed = 20; seed < 26; ++seed) {
    const Bvh a(random_soup(seed, 60, 0.3)), b(random_soup(seed + 100, 60, 0.3));
    for (const Method method : methods) {
      const DistanceOptions options = with(method, 1e-7);
      const Bounds ab = one_sided_hausdorff_distance(a, b, options).bounds,
                   ba = one_sided_hausdorff_distance(b, a, options).bounds;
      const Bounds both_ways = hausdorff_distance(a, b, options).bounds;
      expect_overlap(both_ways, {std::max(ab.lower, ba.lower), std::max(ab.upper, ba.upper)});
      EXPECT_LE(both_ways.upper - both_ways.lower, 1e-7);
    }
  }
}

struct Pair {
  const char* name;
  TriangleMesh a, b;
  double width;  ///< of the oracle
};

std::vector<Pair> pairs() {
  std::vector<Pair> all;
  for (std::uint32_t seed = 30; seed < 34; ++seed)
    all.push_back({"soups", random_soup(seed, 25, 0.4), random_soup(seed + 100, 25, 0.4), 5e-3});
  all.push_back(
      {"touching soups", random_soup(40, 20, 0.4), both(random_soup(40, 20, 0.4), random_soup(41, 5, 0.1)), 5e-3});
  all.push_back({"spheres", reference::icosphere(1), moved(reference::icosphere(2), {0.1, 0.05, 0}), 1e-2});
  all.push_back({"nested", scaled(reference::icosphere(1), 0.7), reference::cube(1), 1e-2});
  all.push_back({"coplanar", reference::unit_square(3), moved(reference::unit_square(4), {0.3, 0.1, 0}), 1e-2});
  all.push_back({"gear and torus", datasets::gear(1, 0.3, 5, 4, 1), datasets::torus(0.8, 0.2, 12, 6), 2e-2});
  all.push_back({"terrain and spikes", datasets::terrain(1, 6, 7), datasets::spiked_plane(1, 0.2, 8, 4), 1e-2});
  return all;
}

TEST(Paper, BothMethods_contain_the_distance_and_each_other) {
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const Bvh a(pair.a), b(pair.b);
    const Bounds truth = brute_force_symmetric(pair.a, pair.b, pair.width);
    const HausdorffDistance walked = hausdorff_distance(a, b, with(Method::CellWalking, 1e-5));
    const HausdorffDistance culled = hausdorff_distance(a, b, with(Method::CrossCulling, 1e-5));
    for (const HausdorffDistance* ours : {&walked, &culled}) {
      expect_overlap(ours->bounds, truth);
      EXPECT_LE(ours->bounds.upper - ours->bounds.lower, 1e-5);
      for (const OneSidedDistance* way : {&ours->a_to_b, &ours->b_to_a}) EXPECT_EQ(way->outcome, Outcome::Converged);
    }
    expect_overlap(walked.bounds, culled.bounds);
  }
}

TEST(Paper, BothMethods_give_for_rigid_poses_what_moved_vertices_give) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()))
      .pretranslate(Eigen::Vector3d(0.3, -0.2, 0.1));
  const auto applied = [&pose](TriangleMesh mesh) {
    for (Eigen::Vector3d& v : mesh.vertices) v = pose * v;
    return mesh;
  };
  for (const Pair& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    const Bvh a(pair.a), b(pair.b), moved_a(applied(pair.a)), moved_b(applied(pair.b));
    for (const Method method : methods) {
      const DistanceOptions options = with(method, 1e-5);
      const Bounds of_a = hausdorff_distance({a, pose}, b, options).bounds;
      const Bounds of_b = hausdorff_distance(a, {b, pose}, options).bounds;
      expect_overlap(of_a, hausdorff_distance(moved_a, b, options).bounds);
      expect_overlap(of_b, hausdorff_distance(a, moved_b, options).bounds);
      EXPECT_LE(of_a.upper - of_a.lower, 1e-5);
      EXPECT_LE(of_b.upper - of_b.lower, 1e-5);
      expect_overlap(hausdorff_distance({a, pose}, {b, pose}, options).bounds,
                     hausdorff_distance(a, b, options).bounds);
    }
  }
}

TEST(Paper, BothMethods_give_the_same_bits_for_any_number_of_threads) {
  const Bvh a(datasets::icosphere(1, 3)), b(datasets::torus(0.9, 0.3, 20, 10));
  for (const Method method : methods) {
    DistanceOptions options = with(method, 1e-6);
    const HausdorffDistance one = hausdorff_distance(a, b, options);
    for (const int threads : {2, 3}) {
      options.threads = threads;
      const HausdorffDistance more = hausdorff_distance(a, b, options);
      EXPECT_EQ(one.bounds.lower, more.bounds.lower);
      EXPECT_EQ(one.bounds.upper, more.bounds.upper);
      EXPECT_EQ(one.a_to_b.stats.subdivisions, more.a_to_b.stats.subdivisions);
      EXPECT_EQ(one.b_to_a.witness.from.position, more.b_to_a.witness.from.position);
    }
  }
}

TEST(Paper, CrossCulling_keeps_its_promise_when_a_budget_ends_it) {
  const TriangleMesh mesh_a = random_soup(50, 25, 0.4), mesh_b = random_soup(51, 25, 0.4);
  const Bvh a(mesh_a), b(mesh_b);
  const Bounds truth = brute_force_one_sided(mesh_a, mesh_b, 5e-3);
  DistanceOptions options = with(Method::CrossCulling, 1e-9);
  for (const std::uint64_t subdivisions : {0, 1, 2}) {
    options.budget.subdivisions = subdivisions;
    const OneSidedDistance early = one_sided_hausdorff_distance(a, b, options);
    expect_overlap(early.bounds, truth);
    EXPECT_TRUE(std::isfinite(early.bounds.upper));
    EXPECT_EQ(early.outcome, Outcome::BudgetExhausted);
  }
  const std::atomic<bool> cancelled{true};
  options.budget = {};
  options.cancel = &cancelled;
  const OneSidedDistance at_once = one_sided_hausdorff_distance(a, b, options);
  expect_overlap(at_once.bounds, truth);
  EXPECT_EQ(at_once.outcome, Outcome::BudgetExhausted);
}

TEST(Paper, CrossCulling_decides_a_tolerance_as_cell_walking_does) {
  const Bvh a(datasets::icosphere(1, 3)), b(datasets::icosphere(1, 2));
  const double distance = hausdorff_distance(a, b, with(Method::CellWalking, 1e-9)).bounds.upper;
  for (const Method method : methods) {
    EXPECT_EQ(check_tolerance(a, b, 1.01 * distance, with(method, 0)).verdict, Verdict::Within);
    const ToleranceCheck above = check_tolerance(a, b, 0.99 * distance, with(method, 0));
    EXPECT_EQ(above.verdict, Verdict::Exceeds);
    EXPECT_GT(above.bounds.lower, 0.99 * distance);
  }
}

TEST(Paper, Table2_culling_rates_and_Fig9_phases_are_reported) {
  const Bvh a(datasets::icosphere(1, 5));
  const Bvh b(moved(reference::icosphere(4), {3, 0, 0}));
  for (const Method method : methods) {
    const DistanceStats stats = one_sided_hausdorff_distance(a, b, with(method, 1e-4)).stats;
    EXPECT_GT(stats.culled_on_a_percent, 97);
    EXPECT_GT(stats.culled_on_b_percent, 97);
    const PhaseSeconds& phases = stats.phases;
    for (const double seconds : {phases.matching, phases.culling_on_a, phases.culling_on_b, phases.subdivision})
      EXPECT_GE(seconds, 0);
    EXPECT_GT(phases.culling_on_a, 0);
    EXPECT_LE(phases.matching + phases.culling_on_a + phases.culling_on_b + phases.subdivision, stats.seconds);
  }
}

}  // namespace paper_test
}  // namespace meshbound
