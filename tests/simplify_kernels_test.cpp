// SPDX-License-Identifier: MIT
// What proposals and proofs are made of: vector code gives what portable code gives, to the bit; covers by candidates
// say nothing that plain arithmetic denies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <span>

#include "simplify/cover/candidate_faces.h"
#include "simplify/cover/cover_assignment.h"
#include "simplify/cover/forward_cover.h"
#include "simplify/cover/id_list.h"
#include "simplify/cover/original_clusters.h"
#include "simplify/kernel/kernels.h"

namespace meshbound {
namespace simplify_kernels_test {

using Eigen::Vector3d;

TEST(SamplePoints, ChangePlaces) {
  SamplePoints points;
  for (int i = 0; i < 20; ++i) points.add({1.0 * i, 2.0 * i, 3.0 * i});
  points.swap(3, 17);
  for (const auto& [at, number] : {std::pair<std::size_t, double>(3, 17), {17, 3}, {4, 4}, {19, 19}}) {
    EXPECT_EQ(points.at(at).x, number);
    EXPECT_EQ(points.at(at).y, 2 * number);
    EXPECT_EQ(points.at(at).z, 3 * number);
  }
}

std::vector<SampleFace> three_faces() {
  return {SampleFace({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), SampleFace({0, 0, 0}, {0, 1, 0}, {-1, -1, 0.2}),
          SampleFace({0, 0, 0}, {1, 1, 1}, {1, 1, 1})};
}

/// Every third lies in the plane of the first of `three_faces`.
SamplePoints random_points(int count) {
  SamplePoints points;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < count; ++i) points.add({unit(random), unit(random), i % 3 == 0 ? 0 : unit(random)});
  return points;
}

/// An even and an odd number of blocks, of which vectors of AVX-512 take two.
constexpr std::array points_of_test = {32, 36};

TEST(SampleKernel, IsTheSameOnEveryProcessor) {
  const std::vector<SampleFace> faces = three_faces();
  for (const int count : points_of_test) {
    const SamplePoints points = random_points(count);
    const std::size_t blocks = points.blocks.size();
    const SampleKernel portable = all_simplify_kernels().back().samples;
    std::vector<SampleOffsets> offsets(blocks);
    std::vector<SampleDistances> distances(blocks);
    DeviationSums sums;
    portable.offsets(points.blocks, faces, offsets);
    portable.distances(points.blocks, faces, distances);
    portable.add_deviations(points, faces, 2, sums);
    EXPECT_GT(sums.worst_squared, 0);
    for (const SimplifyKernels& kernels : all_simplify_kernels()) {
      std::vector<SampleOffsets> same_offsets(blocks);
      kernels.samples.offsets(points.blocks, faces, same_offsets);
      EXPECT_TRUE(same_offsets == offsets);
      std::vector<SampleDistances> same_distances(blocks);
      kernels.samples.distances(points.blocks, faces, same_distances);
      EXPECT_TRUE(same_distances == distances);
      DeviationSums same;
      kernels.samples.add_deviations(points, faces, 2, same);
      EXPECT_EQ(same.sum, sums.sum);
      EXPECT_EQ(same.worst_squared, sums.worst_squared);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(same.gradient[k], sums.gradient[k]);
      for (int k = 0; k < 6; ++k) EXPECT_EQ(same.curvature[k], sums.curvature[k]);
    }
  }
}

/// What is beyond the last block of an odd number is left as it is.
TEST(SampleKernel, WritesNothingBeyondTheLastBlock) {
  const std::vector<SampleFace> faces = three_faces();
  const SamplePoints points = random_points(20);
  ASSERT_EQ(points.blocks.size(), 3U);
  for (const SimplifyKernels& kernels : all_simplify_kernels()) {
    std::vector<SampleOffsets> offsets(4);
    std::vector<SampleDistances> distances(4);
    offsets.back().squared[0] = distances.back().squared[0] = -1;
    kernels.samples.offsets(points.blocks, faces, std::span(offsets).first(3));
    kernels.samples.distances(points.blocks, faces, std::span(distances).first(3));
    EXPECT_EQ(offsets.back().squared[0], -1);
    EXPECT_EQ(distances.back().squared[0], -1);
  }
}

/// The sums of all points, by the formula of `DeviationSums`.
TEST(SampleKernel, SumsUpDeviations) {
  const std::vector<SampleFace> faces = three_faces();
  const SamplePoints points = random_points(36);
  std::vector<SampleOffsets> offsets(points.blocks.size());
  simplify_kernels().samples.offsets(points.blocks, faces, offsets);
  DeviationSums expected;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SampleOffsets& at = offsets[i / 8];
    expected.add(2.0 * Vec3{at.x[i % 8], at.y[i % 8], at.z[i % 8]}, at.share[i % 8]);
  }
  DeviationSums sums;
  simplify_kernels().samples.add_deviations(points, faces, 2, sums);
  EXPECT_NEAR(sums.sum, expected.sum, 1e-5 * expected.sum);
  EXPECT_NEAR(sums.worst_squared, expected.worst_squared, 1e-5 * expected.worst_squared);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sums.gradient[k], expected.gradient[k], 1e-5 * expected.sum);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(sums.curvature[k], expected.curvature[k], 1e-4 * expected.sum);
}

TEST(SampleKernel, GivesTheDistancesOfOffsets) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  SamplePoints points;
  for (int i = 0; i < 80; ++i) points.add(point());
  std::vector<SampleFace> faces;
  for (int i = 0; i < 6; ++i) faces.emplace_back(point(), point(), point());
  std::vector<SampleOffsets> offsets(10);
  std::vector<SampleDistances> distances(10);
  simplify_kernels().samples.offsets(points.blocks, faces, offsets);
  simplify_kernels().samples.distances(points.blocks, faces, distances);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(distances[i / 8].squared[i % 8], offsets[i / 8].squared[i % 8]);
    EXPECT_EQ(distances[i / 8].face[i % 8], offsets[i / 8].face[i % 8]);
  }
}

/// A shared side is looked at once, and no distance is lost by that.
TEST(SampleKernel, LooksAtSharedSidesOfAFanOnce) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  SamplePoints points;
  for (int i = 0; i < 400; ++i) points.add({1.5 * unit(random), 1.5 * unit(random), 0.5 * unit(random)});
  constexpr int spokes = 7;
  std::vector<Vec3> rim;
  for (int i = 0; i < spokes; ++i)
    rim.push_back({std::cos(2 * M_PI * i / spokes), std::sin(2 * M_PI * i / spokes), 0.3 * unit(random)});
  for (const int count : {spokes, spokes - 1}) {  // closed, and with a border
    std::vector<SampleFace> faces;
    for (int i = 0; i < count; ++i)
      faces.emplace_back(Vec3{0.1, 0, 0.2}, rim[static_cast<std::size_t>(i)],
                         rim[static_cast<std::size_t>((i + 1) % spokes)]);
    std::vector<SampleOffsets> before(points.blocks.size()), after(points.blocks.size());
    simplify_kernels().samples.offsets(points.blocks, faces, before);
    note_shared_sides(faces);
    simplify_kernels().samples.offsets(points.blocks, faces, after);
    const auto shared = std::count_if(faces.begin(), faces.end(), [](const SampleFace& f) { return f.shares_ac; });
    EXPECT_EQ(shared, count == spokes ? spokes : count - 1);
    for (std::size_t i = 0; i < before.size(); ++i)
      for (int k = 0; k < 8; ++k) EXPECT_NEAR(after[i].squared[k], before[i].squared[k], 1e-6);
  }
}

TEST(DeviationKernel, IsTheSameOnEveryProcessor) {
  const std::vector<SampleFace> faces = three_faces();
  const DeviationKernel::Move move = {0.1F, 0.2F, -0.1F}, step = {0.3F, -0.1F, 0.2F};
  const std::array<float, DeviationKernel::shares> shares = {0, 0.2F, 0.5F, 1};
  for (const int count : points_of_test) {
    const SamplePoints points = random_points(count);
    const SimplifyKernels portable = all_simplify_kernels().back();
    std::vector<SampleOffsets> offsets(points.blocks.size());
    portable.samples.offsets(points.blocks, faces, offsets);
    LinearDeviations deviations;
    portable.deviations.linearise(points, faces, offsets, 2, deviations);
    const WeightedSums sums = portable.deviations.weighted_sums(deviations, move, 0.3F, 3);
    EXPECT_GT(sums.square, 0);
    const auto largest = portable.deviations.largest_along(deviations, move, step, shares);
    for (const SimplifyKernels& kernels : all_simplify_kernels()) {
      LinearDeviations same_deviations;
      kernels.deviations.linearise(points, faces, offsets, 2, same_deviations);
      EXPECT_TRUE(same_deviations.blocks == deviations.blocks);
      const WeightedSums same = kernels.deviations.weighted_sums(deviations, move, 0.3F, 3);
      EXPECT_EQ(same.weight, sums.weight);
      EXPECT_EQ(same.square, sums.square);
      EXPECT_EQ(same.right, sums.right);
      EXPECT_EQ(same.matrix, sums.matrix);
      EXPECT_EQ(kernels.deviations.largest_along(deviations, move, step, shares), largest);
    }
  }
}

/// Deviations of points and what they become by moves, in plain arithmetic.
TEST(DeviationKernel, SumsUpAndFindsTheLargest) {
  const DeviationKernel kernel = simplify_kernels().deviations;
  const DeviationKernel::Move move = {0.1F, 0.2F, -0.1F}, step = {0.3F, -0.1F, 0.2F};
  const std::array<float, DeviationKernel::shares> shares = {0, 0.2F, 0.5F, 1};
  LinearDeviations deviations;
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int i = 0; i < 5; ++i) deviations.add(unit(random), unit(random), unit(random), unit(random));
  const auto after = [&](const LinearDeviations::Block& block, float share) {
    return block.deviation[0] - block.x[0] * (move[0] + share * step[0]) - block.y[0] * (move[1] + share * step[1]) -
           block.z[0] * (move[2] + share * step[2]);
  };
  const auto largest = kernel.largest_along(deviations, move, step, shares);
  for (std::size_t k = 0; k < shares.size(); ++k) {
    float expected = 0;
    for (const LinearDeviations::Block& block : deviations.blocks)
      expected = std::max(expected, std::abs(after(block, shares[k])));
    EXPECT_NEAR(largest[k], expected, 1e-5);
  }
  const WeightedSums sums = kernel.weighted_sums(deviations, move, 0.5F, 2);  // weights of (h / 2)^6
  double weight = 0, right = 0, mixed = 0;
  for (const LinearDeviations::Block& block : deviations.blocks) {
    const double h = after(block, 0), w = std::pow(h / 2, 6);
    weight += w, right += w * h * block.y[0], mixed += w * block.x[0] * block.z[0];
  }
  EXPECT_NEAR(sums.weight, weight, 1e-5 * weight);
  EXPECT_NEAR(sums.right[1], right, 1e-5 * weight);
  EXPECT_NEAR(sums.matrix[5], mixed, 1e-5 * weight);
}

/// Numbers below the smallest normal one make every later operation slow.
TEST(DeviationKernel, LeavesOutWeightsThatNoSumWouldShow) {
  for (const SimplifyKernels& kernels : all_simplify_kernels()) {
    for (int doublings = 1; doublings <= 5; ++doublings) {
      const double exponent = (2 << doublings) - 2;  // of the weight |h|^(p - 2)
      for (const double weight : {-59.9, -60.1}) {
        LinearDeviations deviations;
        deviations.add(1, 1, 0, 0);
        deviations.add(static_cast<float>(std::exp2(weight / exponent)), 0, 1, 0);
        const WeightedSums sums = kernels.deviations.weighted_sums(deviations, {}, 1, doublings);
        EXPECT_EQ(sums.matrix[0], 1);
        if (weight > -60)
          EXPECT_NEAR(std::log2(sums.matrix[1]), weight, 0.01) << doublings;
        else
          EXPECT_EQ(sums.matrix[1], 0) << doublings;
      }
    }
  }
}

/// Sizes around 2 and the powers of two, where memory is taken and given back.
TEST(IdList, IsAListOfAnySize) {
  std::mt19937 random(8);
  IdList list;
  std::vector<std::uint32_t> expected;
  for (int step = 0; step < 3000; ++step) {
    const auto size = static_cast<std::uint32_t>(random() % 40);
    switch (random() % 4) {
      case 0:
        expected.clear();
        for (std::uint32_t i = 0; i < size; ++i) expected.push_back(static_cast<std::uint32_t>(random() & 0x7fffffff));
        list.assign(expected);
        break;
      case 1: {
        const auto is_wanted = [k = random() % 5](std::uint32_t id) { return id % 5 >= k; };
        std::erase_if(expected, [&](std::uint32_t id) { return !is_wanted(id); });
        list.keep_if(is_wanted);
        break;
      }
      case 2: {
        IdList moved = std::move(list);
        list = {};
        list = std::move(moved);
        break;
      }
      default:
        expected.push_back(size);
        list.add(size);
    }
    ASSERT_TRUE(std::ranges::equal(list.ids(), expected)) << "step " << step;
    ASSERT_EQ(list.empty(), expected.empty());
  }
}

TEST(CoverAssignment, KeepsBothSidesOfTheRelationThroughCoversOfAnySize) {
  constexpr std::uint32_t originals = 20, faces = 12;
  CoverAssignment cover(originals);
  std::vector<std::set<std::uint32_t>> expected(originals);
  std::mt19937 random(3);
  for (int step = 0; step < 2000; ++step) {
    std::set<std::uint32_t> chosen;
    for (auto k = random() % 5; k > 0; --k) chosen.insert(static_cast<std::uint32_t>(random() % originals));
    const std::vector<std::uint32_t> together(chosen.begin(), chosen.end());
    std::vector<std::vector<std::uint32_t>> covers;
    for (const std::uint32_t t : together) {
      expected[t].clear();
      for (auto k = random() % 7; k > 0; --k) expected[t].insert(static_cast<std::uint32_t>(random() % faces));
      covers.emplace_back(expected[t].begin(), expected[t].end());
    }
    cover.assign(together, [&](std::size_t i) { return std::span<const std::uint32_t>(covers[i]); });
  }
  for (std::uint32_t t = 0; t < originals; ++t) {
    const auto ids = cover.faces_of(t);
    EXPECT_EQ(std::set<std::uint32_t>(ids.begin(), ids.end()), expected[t]);
    for (std::uint32_t f = 0; f < faces; ++f) {
      const auto of_face = cover.originals_of(f);
      EXPECT_EQ(std::count(of_face.begin(), of_face.end(), t), static_cast<std::ptrdiff_t>(expected[t].count(f)));
    }
  }
}

/// The slab test must not depend on the machine: the chosen one against plain arithmetic.
TEST(CandidateFaces, HoldExactlyThoseThatAreNear) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&] { return Vec3{coordinate(random), coordinate(random), coordinate(random)}; };
  constexpr double tolerance = 0.3;
  for (int round = 0; round < 200; ++round) {
    CandidateFaces candidates;
    candidates.clear(tolerance);
    std::vector<std::array<Vec3, 3>> faces;
    for (int k = 0; k < CandidateFaces::capacity; ++k) {
      const Vec3 a = point(), b = point();
      faces.push_back({a, b, k % 9 == 0 ? b : point()});  // some without area
      candidates.add(faces.back());
    }
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = point();
      const FaceMask among = (FaceMask{random()} << 32) | random();
      const FaceMask mask = candidates.holding(p, among);
      EXPECT_EQ(mask & ~among, 0u);
      for (int k = 0; k < CandidateFaces::capacity; ++k) {
        const auto& f = faces[static_cast<std::size_t>(k)];
        const double squared =
            closest_on_triangle(CornerTriangle<double>{f[0], f[1] - f[0], f[2] - f[0]}, p).squared_distance;
        if (std::abs(std::sqrt(squared) - tolerance) < 1e-6 || ((among >> k) & 1) == 0) continue;
        EXPECT_EQ((mask >> k) & 1, squared < tolerance * tolerance ? 1u : 0u);
      }
    }
  }
}

/// Asked for all points at once, a face gives the answers that it gives for each.
TEST(CandidateFaces, HoldAllPointsWhereTheyHoldEach) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&](double size) {
    return Vec3{size * coordinate(random), size * coordinate(random), size * coordinate(random)};
  };
  CandidateFaces candidates;
  int held = 0, lost = 0;
  for (int round = 0; round < 500; ++round) {
    candidates.clear(0.3);
    for (int k = 0; k < 7; ++k) {
      const Vec3 a = point(1), b = point(1);
      candidates.add({a, b, k == 3 ? b : point(1)});  // one without area
    }
    const Vec3 centre = point(0.5);
    std::vector<Vec3> points;
    for (int i = 0; i < 3; ++i) points.push_back(centre + point(0.2));
    for (int k = 0; k < candidates.size(); ++k) {
      const FaceMask one = FaceMask{1} << k;
      const bool each =
          std::all_of(points.begin(), points.end(), [&](Vec3 p) { return candidates.holding(p, one) == one; });
      EXPECT_EQ(candidates.holds_all(k, points.size(), [&](std::size_t i) { return points[i]; }), each);
      ++(each ? held : lost);
    }
  }
  EXPECT_GT(held, 300);
  EXPECT_GT(lost, 300);
}

/// A strip of squares along x, two triangles each, below two faces that meet at x = 10.
TEST(ForwardCover, HoldsAClusterByOneFaceOrNot) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i <= 20; ++i) {
    vertices.push_back({static_cast<double>(i), 0, 0}), vertices.push_back({static_cast<double>(i), 1, 0});
    if (i > 0) triangles.push_back({2 * i - 2, 2 * i, 2 * i - 1}), triangles.push_back({2 * i - 1, 2 * i, 2 * i + 1});
  }
  const OriginalClusters clusters(triangles, vertices.size());
  ASSERT_EQ(clusters.count(), 3U);  // 16, 16 and 8 triangles
  EXPECT_EQ(clusters.vertices(0).size(), 18U);
  EXPECT_EQ(clusters.vertices(2).size(), 10U);
  const auto ids = clusters.vertices(2);
  EXPECT_EQ(std::set<std::uint32_t>(ids.begin(), ids.end()).size(), 10U);
  EXPECT_EQ(OriginalClusters::cluster_of(39), 2U);
  EXPECT_EQ(OriginalClusters::member(39), 1U << 7);

  ForwardCover cover(vertices, triangles);
  cover.begin(0.1);
  cover.add({Vec3{-9, -9, 0.05}, Vec3{10, -9, 0.05}, Vec3{10, 29, 0.05}}, 5);
  cover.add({Vec3{10, -9, 0.05}, Vec3{29, -9, 0.05}, Vec3{10, 29, 0.05}}, 6);
  const FaceMask both = ForwardCover::first(2);
  EXPECT_EQ(cover.hold_all(clusters.vertices(0), both), 1U);
  EXPECT_EQ(cover.hold_all(clusters.vertices(0), 2), 0U) << "the other one is not near";
  EXPECT_EQ(cover.hold_all(clusters.vertices(1), both), 0U) << "the two meet there";
  EXPECT_EQ(cover.hold_all(clusters.vertices(2), both), 2U);
}

TEST(PlaneKernel, IsTheSameOnEveryProcessor) {
  const PlaneKernel portable = all_simplify_kernels().back().planes, fastest = simplify_kernels().planes;
  if (portable.test == fastest.test) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  unsigned accurate = 0, held = 0;
  for (int round = 0; round < 1000; ++round) {
    std::array<TriangleCorners, 4> faces;
    for (auto& corners : faces) {
      corners = {point(), point(), point()};
      if (random() % 4 == 0) corners[2] = 0.5 * (corners[0] + corners[1]);
    }
    PlaneBlock ours, theirs;
    const unsigned flat = portable.set(ours, faces.data(), 0.3, 3e-7);
    ASSERT_EQ(fastest.set(theirs, faces.data(), 0.3, 3e-7), flat);
    ASSERT_EQ(std::memcmp(&ours, &theirs, sizeof(PlaneBlock)), 0);
    const Vec3 p = point(), q = point();
    const SlabBits here = portable.test(ours, p, 0.3, 0.09), there = fastest.test(theirs, p, 0.3, 0.09);
    ASSERT_EQ(here.inside, there.inside);
    ASSERT_EQ(here.outside, there.outside);
    const unsigned forth = static_cast<unsigned>(random()) & flat, back = flat & ~forth;
    const Reach one = portable.reach(ours, forth, back, p, q, 0.3, 0.09);
    const Reach other = fastest.reach(theirs, forth, back, p, q, 0.3, 0.09);
    ASSERT_EQ(one.forth, other.forth);
    ASSERT_EQ(one.back, other.back);
    EXPECT_EQ(one.back, portable.reach(ours, back, forth, q, p, 0.3, 0.09).forth) << "the way back is the way from q";
    accurate |= flat;
    held |= here.inside;
  }
  EXPECT_EQ(accurate, 15u);
  EXPECT_EQ(held, 15u);
}

TEST(SlabKernel, IsTheSameOnEveryProcessor) {
  const SlabKernel portable = all_simplify_kernels().back().slabs, fastest = simplify_kernels().slabs;
  if (portable.look == fastest.look) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  unsigned met = 0, within = 0;
  for (int round = 0; round < 2000; ++round) {
    SlabView view;
    view.middle = {unit(random), unit(random), 0};
    view.up = {0, 0, 1};
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = 2 * static_cast<double>(k) + 0.3 * unit(random);
      view.side[k] = {std::cos(angle), std::sin(angle), 0};
      view.side_offset[k] = 0.5;
    }
    view.height_limit = 0.3, view.rim = 1e-6;
    SlabBlock block{};
    for (int k = 0; k < SlabBlock::lanes; ++k) {
      const double lean = 0.2 * unit(random);
      block.x[k] = 2 * unit(random), block.y[k] = 2 * unit(random), block.z[k] = 0.5 * unit(random);
      block.normal_x[k] = std::sin(lean), block.normal_z[k] = std::cos(lean);
      block.radius[k] = k == 5 ? -HUGE_VAL : 0.2, block.half_thickness[k] = 0.01;
    }
    const SlabsSeen one = portable.look(block, view), two = fastest.look(block, view);
    ASSERT_EQ(one.meets, two.meets);
    ASSERT_EQ(one.within, two.within);
    EXPECT_EQ(one.within & ~one.meets, 0U);
    met |= one.meets, within |= one.within;
    std::vector<Vec3> points;
    for (int i = 0; i < 6; ++i) points.push_back({2 * unit(random), 2 * unit(random), 0.5 * unit(random)});
    const std::vector<std::uint32_t> indices{5, 1, 2, 0, 4, 3};
    alignas(32) std::array<std::uint64_t, 8> ours{}, theirs{};
    portable.look_at_vertices(points.data(), indices, view, ours.data());
    fastest.look_at_vertices(points.data(), indices, view, theirs.data());
    ASSERT_EQ(ours, theirs);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const Vec3 p = points[indices[i]];
      EXPECT_EQ((ours[i] & VertexSeen::too_high) != 0, std::abs(p.z) > view.height_limit);
      EXPECT_EQ((ours[i] & 1) != 0, dot(p - view.middle, view.side[0]) > view.side_offset[0] + view.rim);
    }
  }
  EXPECT_EQ(met, 0xdfU) << "all but the lane without a node";
  EXPECT_EQ(within, 0xdfU);
}

}  // namespace simplify_kernels_test
}  // namespace meshbound
