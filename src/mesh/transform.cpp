// SPDX-License-Identifier: MIT
// Dot products in twice the working precision: T. Ogita, S. M. Rump, S. Oishi, "Accurate Sum and Dot Product", SIAM J.
// Sci. Comput. 26(6), 2005, with the remainder kept as an error bound.
#include "meshbound/transform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/affine.h"
#include "geometry/safe_length.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "meshbound/pose.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

/// Below this a product may lose part of its remainder to underflow, at most half of the smallest subnormal.
constexpr double product_is_exact_above = 0x1p-960;

struct Rounded {
  double value;
  double error;
};

/// Knuth's two-sum: a + b = value + error exactly.
Rounded two_sum(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// A coordinate of the image, and an upper bound of its distance from sum_j row[j] * x[j] + row[3].
Rounded image_coordinate(const Eigen::RowVector4d& row, const Eigen::Vector3d& x) {
  Rounded sum = {row[3], 0};
  double lost = 0;  // what did not fit into sum.value; rounded itself, at most 6 additions
  double lost_magnitude = 0;
  double underflow = 0;
  for (int j = 0; j < 3; ++j) {
    const double product = row[j] * x[j];
    const double product_error = std::fma(row[j], x[j], -product);
    if (std::abs(product) < product_is_exact_above && row[j] != 0 && x[j] != 0) underflow += smallest;
    sum = two_sum(sum.value, product);
    lost += product_error + sum.error;
    lost_magnitude += std::abs(product_error) + std::abs(sum.error);
  }
  const Rounded result = two_sum(sum.value, lost);
  // gamma_6 < 7u for the additions into `lost`, one more u for the sum of magnitudes itself; the factor of 2 covers the
  // roundings of this line, and products below the subnormals only make the bound larger.
  const double error = std::abs(result.error) + 16 * unit_roundoff * lost_magnitude + underflow;
  const bool exact = lost_magnitude == 0 && underflow == 0;
  return {result.value, exact ? 0 : std::nextafter(error, infinity)};
}

/// Length of a vector of non-negative errors, rounded up.
double length_rounded_up(const Eigen::Vector3d& v) {
  const double length = safe_length(v);
  return length == 0 ? 0 : std::nextafter(length * (1 + 16 * unit_roundoff), infinity);
}

}  // namespace

TransformedMesh transformed(const MeshView& mesh, const AffineMap& map) {
  require_affine(map.matrix(), "transform: the matrix");
  validate(mesh);
  TransformedMesh result{to_triangle_mesh(mesh), 0};
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  for (std::size_t i = 0; i < used.size(); ++i) {
    Eigen::Vector3d image;
    Eigen::Vector3d error;
    for (int k = 0; k < 3; ++k) {
      const Rounded coordinate = image_coordinate(map.matrix().row(k), result.mesh.vertices[i]);
      image[k] = coordinate.value;
      error[k] = coordinate.error;
    }
    result.mesh.vertices[i] = image;
    if (used[i] == 0) continue;
    if (!(image.cwiseAbs().maxCoeff() <= largest_coordinate) || !error.allFinite())
      throw InvalidInput("transform: vertex " + std::to_string(i) +
                         " leaves the range of coordinates (2^1000); scale the map down");
    result.displacement_bound = std::max(result.displacement_bound, length_rounded_up(error));
  }
  return result;
}

Bounds widened(const Bounds& bounds, double displacement) {
  if (!(displacement >= 0)) throw InvalidInput("a displacement must be a length of 0 or more");
  if (displacement == 0) return bounds;
  return {std::max(0.0, std::nextafter(bounds.lower - displacement, -infinity)),
          std::nextafter(bounds.upper + displacement, infinity)};
}

}  // namespace meshbound
