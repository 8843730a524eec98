// SPDX-License-Identifier: MIT
// What is true of every pair of triangle soups, tried on thousands of random ones: soups, lattices full of ties,
// slivers, neighbours that share vertices, the shapes of `hard_mesh`, copies that moved a little or lost their welding.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fuzz/claims.h"
#include "meshbound/distance.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/transform.h"
#include "reference/claims.h"
#include "reference/hard_meshes.h"
#include "reference/point_triangle_cases.h"
#include "reference/small_meshes.h"

namespace meshbound {
namespace property_test {

using namespace reference;
using Eigen::Vector3d;

constexpr std::uint32_t cases = 1000;

TriangleMesh lattice_soup(Random& random, int count) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const int x = random.below(4), y = random.below(4), z = random.below(3);
    mesh.vertices.emplace_back(x / 4.0, y / 4.0, z / 4.0);
  }
  for (int i = 0; i < count; ++i) {
    const int a = random.below(8), b = random.below(8), c = random.below(8);
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  }
  return mesh;
}

TriangleMesh thin_soup(Random& random, int count) {
  const auto& families = case_families();
  std::vector<std::array<Vector3d, 3>> triangles;
  for (int i = 0; i < count; ++i)
    triangles.push_back(families[static_cast<std::size_t>(1 + i % 6)].make(random).triangle);
  return soup(triangles);
}

/// Points of the unit cube, or of a lattice in it, full of ties.
class RandomChoices final : public Choices {
 public:
  explicit RandomChoices(Random& random) : random_(random), on_lattice_(random.below(2) == 0) {}
  Vector3d point() override {
    const Vector3d anywhere = random_.in_cube();
    return on_lattice_ ? Vector3d((4 * anywhere).array().round() / 4) : anywhere;
  }
  unsigned below(unsigned n) override { return static_cast<unsigned>(random_.below(static_cast<int>(n))); }

 private:
  Random& random_;
  bool on_lattice_;
};

TriangleMesh random_hard_mesh(Random& random) {
  RandomChoices choices(random);
  const auto shape = static_cast<HardShape>(random.below(static_cast<int>(hard_shapes)));
  return hard_mesh(shape, choices, 1 + choices.below(40));
}

TriangleMesh random_mesh(Random& random) {
  const int count = 1 + random.below(20);
  switch (random.below(5)) {
    case 0:
      return lattice_soup(random, count);
    case 1:
      return thin_soup(random, count);
    case 2:
      return random.below(2) == 0 ? icosphere(random.below(2)) : unit_square(1 + random.below(4));
    case 3:
      return random_hard_mesh(random);
    default:
      return random_soup(static_cast<std::uint32_t>(random.below(1 << 20)), count, random.power_of_ten(-2, 0));
  }
}

struct Pair {
  TriangleMesh a, b;
};

/// Two meshes that have nothing in common, or one and a copy of it whose vertices moved a little, welded or not.
Pair random_pair(std::uint32_t seed) {
  Random random(seed);
  TriangleMesh a = random_mesh(random);
  if (random.below(3) != 0) return {std::move(a), random_mesh(random)};
  TriangleMesh b = random.below(2) == 0 ? a : unwelded(a);
  const double by = random.power_of_ten(-12, -1);
  for (Vector3d& v : b.vertices)
    if (random.below(2) == 0) v += by * random.in_cube();
  return {std::move(a), std::move(b)};
}

DistanceOptions quick() {
  DistanceOptions options;
  options.threads = 1;
  options.budget.subdivisions = 20000;
  return options;
}

Bounds symmetric(const TriangleMesh& a, const TriangleMesh& b) {
  return hausdorff_distance(Bvh(a, {1}), Bvh(b, {1}), quick()).bounds;
}
Bounds one_sided(const TriangleMesh& a, const TriangleMesh& b) {
  return one_sided_hausdorff_distance(Bvh(a, {1}), Bvh(b, {1}), quick()).bounds;
}

/// A random part of the triangles, at least one.
TriangleMesh part_of(const TriangleMesh& mesh, Random& random) {
  TriangleMesh part = mesh;
  std::erase_if(part.triangles, [&](const Triangle&) { return random.below(2) == 0; });
  if (part.triangles.empty()) part.triangles.push_back(mesh.triangles[0]);
  return part;
}

/// Runs the claim for every seed, until it fails.
template <class Claim>
void for_all(std::uint32_t count, Claim&& claim) {
  for (std::uint32_t seed = 0; seed < count && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    claim(seed);
  }
}

TEST(Property, TheDistanceIsSymmetric) {
  for_all(cases, [](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    expect_meets(symmetric(a, b), symmetric(b, a));
  });
}

TEST(Property, TheTriangleInequalityHolds) {
  for_all(cases, [](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    const TriangleMesh c = random_pair(seed + 7777).b;
    const Bounds ab = symmetric(a, b), bc = symmetric(b, c), ac = symmetric(a, c);
    EXPECT_LE(ac.lower, (ab.upper + bc.upper) * (1 + 1e-15));
    const Bounds one_ab = one_sided(a, b), one_bc = one_sided(b, c), one_ac = one_sided(a, c);
    EXPECT_LE(one_ac.lower, (one_ab.upper + one_bc.upper) * (1 + 1e-15));
  });
}

TEST(Property, AMeshHasDistanceZeroFromItselfInAnyOrder) {
  for_all(cases, [](std::uint32_t seed) {
    const TriangleMesh a = random_pair(seed).a;
    TriangleMesh shuffled = a;
    std::reverse(shuffled.triangles.begin(), shuffled.triangles.end());
    for (Triangle& t : shuffled.triangles) std::rotate(t.begin(), t.begin() + seed % 3, t.end());
    const Bounds bounds = symmetric(a, shuffled);
    EXPECT_EQ(bounds.lower, 0);
    EXPECT_EQ(bounds.upper, 0);
  });
}

TEST(Property, RigidMotionOfBothChangesNothingButRounding) {
  for_all(cases, [](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    Random random(seed + 1);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.rotate(Eigen::AngleAxisd(random.uniform(-3, 3), random.in_cube().normalized()));
    pose.pretranslate(random.power_of_ten(-3, 6) * random.in_cube());
    const TransformedMesh moved_a = transformed(a, Eigen::Affine3d(pose)),
                          moved_b = transformed(b, Eigen::Affine3d(pose));
    // The matrix is a rotation up to rounding, which the larger coordinates feel.
    const double rounding = moved_a.displacement_bound + moved_b.displacement_bound + 1e-14 * 4;
    expect_meets(widened(symmetric(moved_a.mesh, moved_b.mesh), rounding), symmetric(a, b));
    expect_meets(widened(hausdorff_distance({Bvh(a, {1}), pose}, {Bvh(b, {1}), pose}, quick()).bounds, rounding),
                 symmetric(a, b));
  });
}

TEST(Property, ScalingByAPowerOfTwoScalesTheBoundsExactly) {
  for_all(cases, [](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    Random random(seed + 2);
    const double factor = std::ldexp(1.0, random.below(400) - 200);
    DistanceOptions options = quick();
    options.error_bound = 1e-6 * bounding_box_diagonal(a);
    const Bounds plain = hausdorff_distance(Bvh(a, {1}), Bvh(b, {1}), options).bounds;
    *options.error_bound *= factor;
    const Bounds large = hausdorff_distance(Bvh(scaled(a, factor), {1}), Bvh(scaled(b, factor), {1}), options).bounds;
    EXPECT_EQ(large.lower, plain.lower * factor);
    EXPECT_EQ(large.upper, plain.upper * factor);
  });
}

/// Lemma 1 of the paper, in both arguments: fewer points to start from bring the meshes no further apart, fewer to
/// arrive at no nearer.
TEST(Property, APartIsNoFurtherAndNoNearerThanTheWhole) {
  for_all(cases, [](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    Random random(seed + 3);
    const Bounds whole = one_sided(a, b);
    EXPECT_LE(one_sided(part_of(a, random), b).lower, whole.upper);
    EXPECT_GE(one_sided(a, part_of(b, random)).upper, whole.lower);
  });
}

TEST(Property, BothMethodsProveTheSameDistance) {
  for_all(cases, [](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    DistanceOptions paper = quick();
    paper.method = Method::CrossCulling;
    expect_meets(one_sided(a, b), one_sided_hausdorff_distance(Bvh(a, {1}), Bvh(b, {1}), paper).bounds);
  });
}

/// Also when it runs out at the last piece of all: doubles are not to blame then.
TEST(Property, ABudgetThatRanOutIsSaid) {
  int cut_short = 0;
  for_all(cases, [&](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    DistanceOptions options = quick();
    options.error_bound = 1e-9 * bounding_box_diagonal(a);
    const Bvh tree_a(a, {1}), tree_b(b, {1});
    if (one_sided_hausdorff_distance(tree_a, tree_b, options).outcome != Outcome::Converged) return;
    for (const Method method : {Method::CellWalking, Method::CrossCulling}) {
      options.method = method;
      for (const std::uint64_t subdivisions : {0, 1, 5}) {
        options.budget.subdivisions = subdivisions;
        const OneSidedDistance early = one_sided_hausdorff_distance(tree_a, tree_b, options);
        const bool narrow = early.bounds.upper - early.bounds.lower <= *options.error_bound;
        EXPECT_EQ(early.outcome, narrow ? Outcome::Converged : Outcome::BudgetExhausted) << subdivisions;
        cut_short += narrow ? 0 : 1;
      }
    }
  });
  EXPECT_GT(cut_short, 100) << "no budget was short";
}

TEST(Property, WeldingChangesNothing) {
  for_all(cases / 2, [](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    Random random(seed + 5);
    RandomChoices choices(random);
    const TriangleMesh cut = with_seams(b, choices), soup = unwelded(b);
    EXPECT_EQ(symmetric(b, soup).upper, 0);
    expect_meets(symmetric(a, b), symmetric(a, soup));
    expect_meets(symmetric(a, soup), symmetric(a, cut));
    expect_meets(symmetric(a, cut), symmetric(a, b));
  });
}

TEST(Property, ThreadsDoNotMatter) {
  for_all(cases / 10, [](std::uint32_t seed) {
    const auto [a, b] = random_pair(seed);
    DistanceOptions two = quick();
    two.threads = 2;
    const Bounds one = symmetric(a, b), both_threads = hausdorff_distance(Bvh(a, {2}), Bvh(b, {2}), two).bounds;
    EXPECT_EQ(one.lower, both_threads.lower);
    EXPECT_EQ(one.upper, both_threads.upper);
  });
}

/// Corners at multiples of 2^-24, so that the points at eighths of a triangle are doubles without rounding.
TriangleMesh rounded_to_grid(TriangleMesh mesh) {
  for (Vector3d& v : mesh.vertices) v = (v * 0x1p24).array().round() * 0x1p-24;
  return mesh;
}

TEST(Property, TheOneSidedDistanceLiesInItsExactEnclosure) {
  for_all(60, [](std::uint32_t seed) {
    Random random(seed + 4);
    const TriangleMesh a = rounded_to_grid(random_soup(seed, 1 + random.below(2), 0.5));
    const TriangleMesh b = rounded_to_grid(random_soup(seed + 900, 1 + random.below(4), 0.5));
    const Bounds bounds = one_sided(a, b);
    constexpr int n = 8;
    ExactLength largest{0, 1, 0};
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
      const Corners t = corners(a, i);
      const auto at = [&](int u, int v) { return Vector3d(((n - u - v) * t[0] + u * t[1] + v * t[2]) / n); };
      const auto covered = [&](const std::array<Vector3d, 3>& piece) {
        std::optional<ExactLength> smallest;
        for (std::size_t j = 0; j < b.triangles.size(); ++j) {
          ExactLength furthest{0, 1, 0};
          for (const Vector3d& p : piece) furthest = std::max(furthest, exact_distance(p, corners(b, j)));
          if (!smallest || furthest < *smallest) smallest = furthest;
        }
        largest = std::max(largest, *smallest);
      };
      for (int u = 0; u < n; ++u) {
        for (int v = 0; u + v < n; ++v) {
          EXPECT_LE(exact_distance(at(u, v), b).compare(bounds.upper), 0) << "a point is further than upper";
          covered({at(u, v), at(u + 1, v), at(u, v + 1)});
          if (u + v + 1 < n) covered({at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)});
        }
      }
    }
    EXPECT_GE(largest.compare(bounds.lower), 0) << "no point is as far as lower";
  });
}

/// Bytes without any sense.
std::vector<std::uint8_t> random_bytes(std::uint32_t seed, int count) {
  Random random(seed);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
  return bytes;
}

TEST(Property, RandomBytesHoldWhatTheFuzzersCheck) {
  for_all(2000, [](std::uint32_t seed) {
    EXPECT_NO_THROW(fuzz::check_distance(random_bytes(seed, 2 + static_cast<int>(seed % 300))));
  });
}

TEST(Property, RandomPolyhedraPenetrateAsInRationalArithmetic) {
  for_all(300, [](std::uint32_t seed) { EXPECT_NO_THROW(fuzz::check_penetration(random_bytes(seed, 64))); });
}

TEST(Property, RandomTexturesDeviateAsInRationalArithmetic) {
  for_all(300, [](std::uint32_t seed) { EXPECT_NO_THROW(fuzz::check_texture(random_bytes(seed, 300))); });
}

TEST(Property, RandomSoupsKeepTheirBoundsWhenTheyAreSimplified) {
  for_all(1000, [](std::uint32_t seed) { EXPECT_NO_THROW(fuzz::check_simplify(random_bytes(seed, 300))); });
}

}  // namespace property_test
}  // namespace meshbound
