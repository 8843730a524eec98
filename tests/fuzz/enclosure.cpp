// SPDX-License-Identifier: MIT
#include "fuzz/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "fuzz/claims.h"

namespace meshbound::fuzz {
namespace {

using reference::exact_distance;
using reference::ExactLength;

/// Exact distances of points to each triangle of one mesh, computed once for each point.
class ExactDistances {
 public:
  explicit ExactDistances(const TriangleMesh& to) {
    for (std::size_t i = 0; i < to.triangles.size(); ++i) triangles_.push_back(reference::corners(to, i));
  }

  const std::vector<ExactLength>& from(const Eigen::Vector3d& point) {
    std::vector<ExactLength>& lengths = known_[{point.x(), point.y(), point.z()}];
    if (lengths.empty())
      for (const reference::Corners& triangle : triangles_) lengths.push_back(exact_distance(point, triangle));
    return lengths;
  }

 private:
  std::vector<reference::Corners> triangles_;
  std::map<std::array<double, 3>, std::vector<ExactLength>> known_;
};

/// The middle between two points; absent where its coordinates are no doubles.
std::optional<Eigen::Vector3d> exact_midpoint(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  Eigen::Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = a[axis] / 2, y = b[axis] / 2, sum = x + y;
    const double y_part = sum - x, rounding = (x - (sum - y_part)) + (y - y_part);
    if (2 * x != a[axis] || 2 * y != b[axis] || rounding != 0) return std::nullopt;
    middle[axis] = sum;
  }
  return middle;
}

void include(Enclosure& enclosure, const reference::Corners& corners, ExactDistances& distances) {
  std::vector<ExactLength> furthest = distances.from(corners[0]);
  for (const Eigen::Vector3d& corner : corners) {
    const std::vector<ExactLength>& lengths = distances.from(corner);
    enclosure.lower = std::max(enclosure.lower, *std::min_element(lengths.begin(), lengths.end()));
    for (std::size_t j = 0; j < lengths.size(); ++j) furthest[j] = std::max(furthest[j], lengths[j]);
  }
  enclosure.upper = std::max(enclosure.upper, *std::min_element(furthest.begin(), furthest.end()));
}

}  // namespace

Enclosure enclosure(const TriangleMesh& a, const TriangleMesh& b) {
  Enclosure result;
  ExactDistances distances(b);
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    const auto [p, q, r] = reference::corners(a, i);
    const auto pq = exact_midpoint(p, q), qr = exact_midpoint(q, r), rp = exact_midpoint(r, p);
    if (pq && qr && rp) {
      for (const reference::Corners& quarter : {reference::Corners{p, *pq, *rp}, reference::Corners{*pq, q, *qr},
                                                reference::Corners{*rp, *qr, r}, reference::Corners{*pq, *qr, *rp}})
        include(result, quarter, distances);
    } else {
      include(result, {p, q, r}, distances);
    }
  }
  return result;
}

void check_bounds(const Bounds& bounds, const Enclosure& exact) {
  require(bounds.lower >= 0 && bounds.lower <= bounds.upper, "0 <= lower <= upper");
  require(std::isinf(bounds.upper) || exact.lower.compare(bounds.upper) <= 0, "a corner is further away than upper");
  require(exact.upper.compare(bounds.lower) >= 0, "no point is as far away as lower");
}

}  // namespace meshbound::fuzz
