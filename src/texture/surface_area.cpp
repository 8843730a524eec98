// SPDX-License-Identifier: MIT
#include "texture/surface_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "meshbound/error.h"
#include "texture/overlay_numbers.h"

namespace meshbound {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

/// The exponent of a number, no further from 0 than that its power of two and the reciprocal are normal numbers.
int clamped_exponent(double number) {
  int exponent = 0;
  std::frexp(number, &exponent);
  return std::clamp(exponent, -1000, 1000);
}

/// That of the largest coordinate, so that areas neither overflow nor underflow in units of its power of two.
int exponent_of(const TexturedMesh& mesh) {
  double largest = 0;
  const auto look_at = [&](const Corners& corners) {
    for (const Eigen::Vector3d& p : corners) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  };
  for (const TexturedTriangle& t : mesh.triangles) look_at(t.corners);
  for (const Corners& corners : mesh.bare) look_at(corners);
  return clamped_exponent(largest);
}

int exponent_of_coordinates(const TexturedMesh& mesh) {
  double largest = 0;
  for (const TexturedTriangle& t : mesh.triangles)
    for (const Eigen::Vector2d& uv : t.coordinates) largest = std::max(largest, uv.cwiseAbs().maxCoeff());
  return clamped_exponent(largest);
}

/// Twice the area of a triangle in squares of the unit, a power of two: the length of the vector of the areas that it
/// has when seen along the axes. Coordinates that underflow in the unit are off by less than `tiny`, like its areas.
Approximate area(const Corners& corners, double by_unit) {
  Corners in_unit;
  bool is_exact = true;
  for (std::size_t k = 0; k < 3; ++k) {
    in_unit[k] = by_unit * corners[k];
    is_exact = is_exact && 1 / by_unit * in_unit[k] == corners[k];
  }
  double squares = 0, error = is_exact ? 0 : Approximate::tiny;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto along_axis = [&](const Eigen::Vector3d& p) { return Eigen::Vector2d(p[(i + 1) % 3], p[(i + 2) % 3]); };
    const Approximate seen = doubled_area(along_axis(in_unit[0]), along_axis(in_unit[1]), along_axis(in_unit[2]));
    squares += seen.value * seen.value;
    error += seen.error;
  }
  if (squares == 0 && error == 0) return {};
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
  const int unit = exponent_of(mesh), unit_of_texture = exponent_of_coordinates(mesh);
  const double by_unit = std::ldexp(1.0, -unit), by_unit_of_texture = std::ldexp(1.0, -unit_of_texture);
  double in_space = 0, in_texture = 0;
  for (const TexturedTriangle& t : mesh.triangles) {
    const auto edge = [&](std::size_t k) -> Eigen::Vector3d { return by_unit * t.corners[k] - by_unit * t.corners[0]; };
    const auto edge_in_texture = [&](std::size_t k) -> Eigen::Vector2d {
      return by_unit_of_texture * t.coordinates[k] - by_unit_of_texture * t.coordinates[0];
    };
    const Eigen::Vector2d p = edge_in_texture(1), q = edge_in_texture(2);
    in_space += edge(1).cross(edge(2)).norm();
    in_texture += std::fabs(p.x() * q.y() - p.y() * q.x());
  }
  if (in_texture == 0) return std::numeric_limits<double>::infinity();
  return std::ldexp(std::sqrt(in_space) / std::sqrt(in_texture) / texture_size, unit - unit_of_texture);
}

}  // namespace meshbound
