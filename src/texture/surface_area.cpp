// SPDX-License-Identifier: MIT
#include "texture/surface_area.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "meshbound/error.h"

namespace meshbound {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// The exponent of the largest coordinate, so that areas neither overflow nor underflow in units of its power of two;
/// no further from 0 than that this power and its reciprocal are normal numbers.
int exponent_of(const TexturedMesh& mesh) {
  double largest = 0;
  const auto look_at = [&](const Corners& corners) {
    for (const Eigen::Vector3d& p : corners) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  };
  for (const TexturedTriangle& t : mesh.triangles) look_at(t.corners);
  for (const Corners& corners : mesh.bare) look_at(corners);
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::clamp(exponent, -1000, 1000);
}

/// x in a unit that is a power of two; a value that underflows has an error.
Approximate in_unit(double x, double by_unit) {
  const double value = x * by_unit;
  return {value, std::fabs(value) < Approximate::small && x != 0 ? Approximate::tiny : 0};
}

/// Twice the area of a triangle in squares of the unit.
Approximate area(const Corners& corners, double by_unit) {
  std::array<Approximate, 3> ab, ac;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const Approximate from = in_unit(corners[0][axis], by_unit);
    ab[i] = in_unit(corners[1][axis], by_unit) - from;
    ac[i] = in_unit(corners[2][axis], by_unit) - from;
  }
  double squares = 0, error = 0;
  bool is_zero = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const Approximate component = ab[j] * ac[k] - ab[k] * ac[j];
    is_zero = is_zero && component.is_zero();
    squares += component.value * component.value;
    error += component.error;
  }
  if (is_zero) return {};
  const double root = std::sqrt(squares);
  return {root, (error + root * (8 * unit_roundoff)) * Approximate::grown + 0x1p-500};  // 2^-500: squares underflow
}

}  // namespace

Bounds uncovered_share_of(const TexturedMesh& mesh, std::span<const Approximate> shares) {
  const auto is_covered = [](const Approximate& share) { return share.is_zero(); };
  if (mesh.bare.empty() && std::ranges::all_of(shares, is_covered)) return {0, 0};
  const double by_unit = std::ldexp(1.0, -exponent_of(mesh));
  Approximate all, uncovered;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Approximate of_triangle = area(mesh.triangles[i].corners, by_unit);
    all = all + of_triangle;
    uncovered = uncovered + of_triangle * shares[i];
  }
  for (const Corners& corners : mesh.bare) {
    const Approximate of_triangle = area(corners, by_unit);
    all = all + of_triangle;
    uncovered = uncovered + of_triangle;
  }
  if (uncovered.is_zero()) return {0, 0};
  const Approximate share = uncovered / all;
  const Bounds bounds{std::max(0.0, next_down(share.value - share.error)),
                      std::min(1.0, next_up(share.value + share.error))};
  return bounds.lower <= bounds.upper ? bounds : Bounds{0, 1};
}

double texel_length(const TexturedMesh& mesh, double texture_size) {
  if (!(texture_size > 0)) throw InvalidInput("the texture size must be a number of texels, above 0");
  double in_space = 0, in_texture = 0;
  for (const TexturedTriangle& t : mesh.triangles) {
    const Eigen::Vector3d ab = t.corners[1] - t.corners[0], ac = t.corners[2] - t.corners[0];
    const Eigen::Vector2d p = t.coordinates[1] - t.coordinates[0], q = t.coordinates[2] - t.coordinates[0];
    in_space += ab.cross(ac).norm();
    in_texture += std::fabs(p.x() * q.y() - p.y() * q.x());
  }
  return std::sqrt(in_space) / std::sqrt(in_texture) / texture_size;
}

}  // namespace meshbound
