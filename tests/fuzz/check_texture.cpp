// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "fuzz/choices.h"
#include "fuzz/claims.h"
#include "meshbound/error.h"
#include "meshbound/texture_deviation.h"
#include "reference/texture_oracle.h"
#include "texture/texture_comparison.h"

namespace meshbound::fuzz {
namespace {

using reference::RationalWeights;

/// Coordinates of the texture: multiples of 1/4 and of 1/3 are full of charts that touch and overlap.
double texture_coordinate(Source& source, unsigned kind) {
  if (kind == 0) return source.below(5) / 4.0;
  if (kind == 1) return source.below(4) / 3.0;
  return source.coordinate(kind == 2 ? 1 : 3);
}

/// Up to 8 corners and 1 to 6 triangles over them, some of another material.
TexturedMesh soup(Source& source, unsigned kind) {
  struct Corner {
    Eigen::Vector3d position;
    Eigen::Vector2d coordinate;
  };
  std::vector<Corner> corners(1 + source.below(8));
  source.set_kind(kind);
  for (Corner& corner : corners) {
    corner.position = source.point();
    const double u = texture_coordinate(source, kind / 4 % 4), v = texture_coordinate(source, kind / 4 % 4);
    corner.coordinate = {u, v};
  }
  TexturedMesh mesh;
  const std::uint32_t triangles = 1 + source.below(6), max_material = 1 + source.below(2);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    TexturedTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& corner = corners[source.take<std::uint8_t>() % corners.size()];
      t.corners[k] = corner.position, t.coordinates[k] = corner.coordinate;
    }
    t.triangle = i;
    t.material = source.below(max_material);
    mesh.triangles.push_back(t);
  }
  return mesh;
}

/// A copy, in which some corners moved in space or in the texture.
TexturedMesh moved_a_little(TexturedMesh mesh, Source& source, unsigned kind) {
  const double factor = std::ldexp(1.0, -static_cast<int>(source.below(64)));
  source.set_kind(kind);
  for (TexturedTriangle& t : mesh.triangles) {
    const unsigned moved = source.below(64);
    for (std::size_t k = 0; k < 3; ++k) {
      if ((moved >> k) % 2 != 0) t.corners[k] += factor * source.point();
      if (moved >> (3 + k) != 0 && k == 0) t.coordinates[k].x() += factor * texture_coordinate(source, kind / 4 % 4);
    }
  }
  return mesh;
}

/// Corners, middles of edges, and points inside.
std::vector<RationalWeights> sample_weights() {
  std::vector<RationalWeights> weights;
  for (const std::array<int, 3> w :
       {std::array{1, 0, 0}, std::array{0, 1, 0}, std::array{0, 0, 1}, std::array{1, 1, 0}, std::array{0, 1, 1},
        std::array{1, 0, 1}, std::array{1, 1, 1}, std::array{2, 1, 5}}) {
    const mpq_class sum = w[0] + w[1] + w[2];
    weights.push_back({w[0] / sum, w[1] / sum, w[2] / sum});
  }
  return weights;
}

bool all_have_area(const TexturedMesh& mesh) {
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), reference::has_area_in_texture);
}

/// No point is further away than `upper`, and those further away than the tolerance belong to triangles that are
/// listed.
void check_samples(const OneSidedTextureDeviation& found, const TexturedMesh& a, const TexturedMesh& b,
                   const std::optional<double>& tolerance) {
  static const std::vector<RationalWeights> samples = sample_weights();
  for (const TexturedTriangle& t : a.triangles) {
    const bool is_listed = std::any_of(found.exceeding.begin(), found.exceeding.end(),
                                       [&](const TextureWitness& w) { return w.from.triangle == t.triangle; });
    for (const RationalWeights& weights : samples) {
      const std::optional<mpq_class> squared = reference::squared_deviation_at(t, weights, b);
      if (!squared) continue;
      require(std::isinf(found.bounds.upper) || reference::compare_root(*squared, found.bounds.upper) <= 0,
              "a point is further away than upper");
      require(is_listed || !tolerance || reference::compare_root(*squared, *tolerance) <= 0,
              "a triangle beyond the tolerance is missing");
    }
  }
}

double area(const TexturedTriangle& t) {
  return (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).norm();
}

/// The share of A that is not covered, from that of each pair: at least what is left when all pairs are disjoint, and
/// at most what is left by the largest.
void check_uncovered(const Bounds& uncovered, const TexturedMesh& a, const TexturedMesh& b) {
  require(0 <= uncovered.lower && uncovered.lower <= uncovered.upper && uncovered.upper <= 1, "a share is 0 to 1");
  double all = 0, least = 0, most = 0;
  for (const TexturedTriangle& t : a.triangles) {
    all += area(t);
    if (!reference::has_area_in_texture(t)) {
      most += area(t);
      continue;
    }
    mpq_class sum = 0, largest = 0;
    for (const TexturedTriangle& other : b.triangles) {
      const mpq_class covered = 1 - reference::uncovered_share(t, TexturedMesh{{other}, {}});
      sum += covered;
      largest = std::max(largest, covered);
    }
    least += area(t) * std::max(0.0, 1 - sum.get_d());
    most += area(t) * (1 - largest.get_d());
  }
  constexpr double margin = 1e-9;
  if (!std::isnormal(all)) return;
  require(uncovered.upper >= least / all - margin, "more is uncovered than upper");
  require(uncovered.lower <= most / all + margin, "less is uncovered than lower");
}

void check_direction(const OneSidedTextureDeviation& found, const TexturedMesh& a, const TexturedMesh& b,
                     double error_bound, const std::optional<double>& tolerance) {
  require(found.bounds.lower >= 0 && found.bounds.lower <= found.bounds.upper, "0 <= lower <= upper");
  require(found.outcome != Outcome::Converged || found.bounds.upper - found.bounds.lower <= error_bound,
          "converged, but the interval is wider than the error bound");
  require(found.witness || found.bounds.lower == 0, "a lower bound without a witness");
  check_samples(found, a, b, tolerance);
  if (all_have_area(a) && all_have_area(b))
    require(reference::compare_root(reference::squared_deviation_of_charts(a, b, true), found.bounds.lower) >= 0,
            "no point is as far away as lower");
}

/// Areas of these do not overflow.
bool is_moderate(const TexturedMesh& mesh) {
  constexpr double largest = 1e30, smallest = 1e-30;
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const TexturedTriangle& t) {
    return std::all_of(t.corners.begin(), t.corners.end(), [&](const Eigen::Vector3d& p) {
      return (p.array() == 0 || (p.array().abs() <= largest && p.array().abs() >= smallest)).all();
    });
  });
}

void check_both(const TextureDeviation& found, const TexturedMesh& a, const TexturedMesh& b,
                const TextureDeviationOptions& options) {
  check_direction(found.a_to_b, a, b, *options.error_bound, options.tolerance);
  check_direction(found.b_to_a, b, a, *options.error_bound, options.tolerance);
  if (!is_moderate(a) || !is_moderate(b)) return;
  check_uncovered(found.a_to_b.uncovered, a, b);
  check_uncovered(found.b_to_a.uncovered, b, a);
}

}  // namespace

void check_texture(Bytes content) {
  Source source(content);
  const unsigned kind = source.take<std::uint8_t>(), how = source.take<std::uint8_t>();
  const TexturedMesh a = soup(source, kind);
  const TexturedMesh b = how >= 192 ? moved_a_little(a, source, kind) : soup(source, kind);
  double size = 0;
  for (const TexturedMesh* mesh : {&a, &b})
    for (const TexturedTriangle& t : mesh->triangles)
      for (const Eigen::Vector3d& p : t.corners) size = std::max(size, p.cwiseAbs().maxCoeff());
  TextureDeviationOptions options;
  options.threads = 1;
  options.max_pieces = 200;
  options.error_bound = std::ldexp(size, -(static_cast<int>(how) % 48));
  if (const auto halvings = static_cast<int>(source.below(24)); halvings < 16)
    options.tolerance = std::ldexp(size, -halvings);
  const TexturedMesh before = moved_a_little(b, source, kind);
  try {
    check_both(texture_deviation(a, b, options), a, b, options);
    TextureComparison comparison;
    (void)comparison.measure({a, before}, options);
    check_both(comparison.measure({a, b}, options), a, b, options);
  } catch (const InvalidInput&) {  // a coordinate is not finite
  }
}

}  // namespace meshbound::fuzz
