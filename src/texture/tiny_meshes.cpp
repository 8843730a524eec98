// SPDX-License-Identifier: MIT
#include "texture/tiny_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace meshbound {
namespace {

constexpr double largest_of_tiny = 0x1p-1000;
constexpr double enlargement = 0x1p990;  ///< coordinates are below 2^-10 then, and multiples of 2^-84

/// A share of the largest coordinate: the smallest error bound. What is a share of the diagonal may have been rounded
/// to 0.
constexpr double share_of_error_bound = 1e-9;

double farthest_coordinate(const TexturedMesh& mesh) {
  double largest = 0;
  const auto include = [&](const std::array<Eigen::Vector3d, 3>& corners) {
    for (const Eigen::Vector3d& p : corners) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  };
  for (const TexturedTriangle& t : mesh.triangles) include(t.corners);
  for (const auto& corners : mesh.bare) include(corners);
  return largest;
}

TexturedMesh enlarged(TexturedMesh mesh) {
  for (TexturedTriangle& t : mesh.triangles)
    for (Eigen::Vector3d& p : t.corners) p *= enlargement;
  for (auto& corners : mesh.bare)
    for (Eigen::Vector3d& p : corners) p *= enlargement;
  return mesh;
}

/// Lengths that are no tiny ones become the largest double.
double enlarged(double length) { return std::min(length * enlargement, std::numeric_limits<double>::max()); }

/// The product is rounded to a multiple of the smallest double, which the enlargement takes back without rounding.
double reduced(double length) { return length / enlargement; }

Bounds reduced(const Bounds& bounds) {
  double lower = reduced(bounds.lower), upper = reduced(bounds.upper);
  if (lower * enlargement > bounds.lower) lower = std::nextafter(lower, 0.0);
  if (upper * enlargement < bounds.upper) upper = std::nextafter(upper, HUGE_VAL);
  return {lower, upper};
}

void reduce(TextureWitness& witness) {
  witness.from.position /= enlargement;
  witness.nearest.position /= enlargement;
  witness.distance = reduced(witness.distance);
}

void reduce(OneSidedTextureDeviation& deviation) {
  deviation.bounds = reduced(deviation.bounds);
  if (deviation.witness) reduce(*deviation.witness);
  for (TextureWitness& witness : deviation.exceeding) reduce(witness);
}

}  // namespace

bool are_tiny(const TexturedMesh& a, const TexturedMesh& b) {
  const double largest = std::max(farthest_coordinate(a), farthest_coordinate(b));
  return largest > 0 && largest < largest_of_tiny;
}

TextureDeviation deviation_of_tiny(const TexturedMesh& a, const TexturedMesh& b,
                                   const TextureDeviationOptions& options) {
  const TexturedMesh large_a = enlarged(a), large_b = enlarged(b);
  TextureDeviationOptions of_large = options;
  if (options.tolerance) of_large.tolerance = enlarged(*options.tolerance);
  if (options.error_bound) {
    const double error_bound = enlarged(*options.error_bound),
                 smallest = share_of_error_bound * std::max(farthest_coordinate(large_a), farthest_coordinate(large_b));
    of_large.error_bound = error_bound >= 0 && error_bound < smallest ? smallest : error_bound;
  }
  TextureDeviation deviation = texture_deviation(large_a, large_b, of_large);
  deviation.bounds = reduced(deviation.bounds);
  reduce(deviation.a_to_b);
  reduce(deviation.b_to_a);
  return deviation;
}

}  // namespace meshbound
