// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

#include "fuzz/claims.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "reference/exact_distance.h"
#include "reference/hard_meshes.h"

namespace meshbound::fuzz {
namespace {

using reference::exact_distance;
using reference::ExactLength;

void require(bool holds, const char* claim) {
  if (!holds) throw std::logic_error(claim);
}

/// Takes values off the front; zeros once the bytes have run out.
class Source final : public reference::Choices {
 public:
  explicit Source(Bytes bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof value, bytes_.size());
    std::memcpy(&value, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
    return value;
  }

  Eigen::Vector3d point() override {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    return {x, y, z};
  }
  unsigned below(unsigned n) override { return take<std::uint8_t>() % n; }

  /// A mesh with coordinates of this kind. A first byte below 144 gives a soup; any other a shape of `hard_mesh`,
  /// chosen by the next byte, or a variant of `other`, where there is one.
  TriangleMesh mesh(unsigned kind, const TriangleMesh* other = nullptr) {
    constexpr unsigned soups = 144, max_hard_triangles = 12, variants = 2;
    kind_ = kind;
    const unsigned shape = take<std::uint8_t>();
    if (shape < soups) return small_soup(shape);
    const unsigned chosen = below(other != nullptr ? reference::hard_shapes + variants : reference::hard_shapes);
    if (chosen == reference::hard_shapes) return with_seams(*other, *this);
    if (chosen > reference::hard_shapes) return moved_a_little(*other);
    return hard_mesh(static_cast<reference::HardShape>(chosen), *this, 1 + shape % max_hard_triangles);
  }

 private:
  /// Any double there is, a float, a small multiple of 1/8 (ties), or that at an exponent from 2^-1016 to 2^1016.
  double coordinate() {
    switch (kind_ % 4) {
      case 0:
        return take<double>();
      case 1:
        return static_cast<double>(take<float>());
      case 2:
        return take<std::int8_t>() / 8.0;
      default:
        const int mantissa = take<std::int8_t>();
        return std::ldexp(mantissa, 8 * take<std::int8_t>());
    }
  }

  /// Up to 8 vertices and 1 to 6 triangles over them, so that neighbours, duplicates and degenerate ones are common.
  TriangleMesh small_soup(unsigned shape) {
    TriangleMesh mesh;
    const unsigned vertices = 1 + shape % 8, triangles = 1 + shape / 8 % 6;
    for (unsigned i = 0; i < vertices; ++i) mesh.vertices.push_back(point());
    for (unsigned i = 0; i < triangles; ++i) {
      const std::uint32_t a = take<std::uint8_t>(), b = take<std::uint8_t>(), c = take<std::uint8_t>();
      mesh.triangles.push_back({a % vertices, b % vertices, c % vertices});
    }
    return mesh;
  }

  TriangleMesh moved_a_little(TriangleMesh mesh) {
    const double factor = std::ldexp(1.0, -static_cast<int>(below(64)));
    for (Eigen::Vector3d& vertex : mesh.vertices)
      if (below(2) == 0) vertex += factor * point();
    return mesh;
  }

  Bytes bytes_;
  unsigned kind_ = 0;
};

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

/// Where it is a point of doubles.
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

/// Exact lengths with `lower <= h(A,B) <= upper`. A corner or the middle of an edge of A is a point of A. The distance
/// to one triangle is convex, so that on a triangle of A, or on each of the four that the middles of its edges make of
/// it, it is largest at a corner.
struct Enclosure {
  ExactLength lower{0, 1, 0}, upper{0, 1, 0};

  void include(const reference::Corners& corners, ExactDistances& distances) {
    std::vector<ExactLength> furthest = distances.from(corners[0]);
    for (const Eigen::Vector3d& corner : corners) {
      const std::vector<ExactLength>& lengths = distances.from(corner);
      lower = std::max(lower, *std::min_element(lengths.begin(), lengths.end()));
      for (std::size_t j = 0; j < lengths.size(); ++j) furthest[j] = std::max(furthest[j], lengths[j]);
    }
    upper = std::max(upper, *std::min_element(furthest.begin(), furthest.end()));
  }
};

Enclosure enclosure(const TriangleMesh& a, const TriangleMesh& b) {
  Enclosure result;
  ExactDistances distances(b);
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    const auto [p, q, r] = reference::corners(a, i);
    const auto pq = exact_midpoint(p, q), qr = exact_midpoint(q, r), rp = exact_midpoint(r, p);
    if (pq && qr && rp) {
      for (const reference::Corners& quarter : {reference::Corners{p, *pq, *rp}, reference::Corners{*pq, q, *qr},
                                                reference::Corners{*rp, *qr, r}, reference::Corners{*pq, *qr, *rp}})
        result.include(quarter, distances);
    } else {
      result.include({p, q, r}, distances);
    }
  }
  return result;
}

void check_bounds(const Bounds& bounds, const Enclosure& exact) {
  require(bounds.lower >= 0 && bounds.lower <= bounds.upper, "0 <= lower <= upper");
  require(std::isinf(bounds.upper) || exact.lower.compare(bounds.upper) <= 0, "a corner is further away than upper");
  require(exact.upper.compare(bounds.lower) >= 0, "no point is as far away as lower");
}

/// Two intervals that hold the same number.
void check_meet(const Bounds& one, const Bounds& other) {
  require(one.lower <= other.upper && other.lower <= one.upper, "the two methods prove different distances");
}

void check_verdict(const ToleranceCheck& check, const Enclosure& forward, const Enclosure& backward) {
  const double tolerance = check.tolerance;
  if (check.verdict == Verdict::Within)
    require(forward.lower.compare(tolerance) <= 0 && backward.lower.compare(tolerance) <= 0, "within, but it exceeds");
  if (check.verdict == Verdict::Exceeds)
    require(forward.upper.compare(tolerance) > 0 || backward.upper.compare(tolerance) > 0, "exceeds, but it is within");
}

/// The surface made of triangles that are repeated until a search shares its work among so many threads.
TriangleMesh repeated(TriangleMesh mesh, int threads) {
  constexpr std::size_t triangles_per_thread = 1050;
  const std::size_t distinct = mesh.triangles.size();
  while (mesh.triangles.size() < static_cast<std::size_t>(threads - 1) * triangles_per_thread)
    mesh.triangles.push_back(mesh.triangles[mesh.triangles.size() - distinct]);
  return mesh;
}

void check_same(const Bounds& one, const Bounds& many) {
  require(one.lower == many.lower && one.upper == many.upper, "several threads find other bounds than one");
}

/// Several threads find what one finds, and the exact distance agrees.
void check_threads(const TriangleMesh& a, const TriangleMesh& b, DistanceOptions options, int threads,
                   const Enclosure& forward, const Enclosure& backward) {
  const auto [tree_a, tree_b] = build_trees(repeated(a, threads), repeated(b, threads), {threads});
  const HausdorffDistance one = hausdorff_distance(tree_a, tree_b, options);
  options.threads = threads;
  const HausdorffDistance many = hausdorff_distance(tree_a, tree_b, options);
  check_same(one.a_to_b.bounds, many.a_to_b.bounds);
  check_same(one.b_to_a.bounds, many.b_to_a.bounds);
  check_bounds(many.a_to_b.bounds, forward);
  check_bounds(many.b_to_a.bounds, backward);
}

void check_closest_point(const Bvh& tree, const TriangleMesh& mesh, const Eigen::Vector3d& query) {
  const ClosestPoint closest = closest_point(tree, query);
  const ExactLength exact = exact_distance(query, mesh);
  require(closest.point.triangle < mesh.triangles.size(), "the closest point names no triangle");
  require(exact.compare(closest.distance.lower) >= 0, "closest point: lower is above the distance");
  require(std::isinf(closest.distance.upper) || exact.compare(closest.distance.upper) <= 0,
          "closest point: upper is below the distance");
}

}  // namespace

void check_distance(Bytes content) {
  Source source(content);
  const unsigned kind = source.take<std::uint8_t>(), how = source.take<std::uint8_t>();
  const TriangleMesh a = source.mesh(kind), b = source.mesh(kind / 4, &a);
  std::optional<Bvh> tree_a, tree_b;
  try {
    tree_a.emplace(a, BvhOptions{1});
    tree_b.emplace(b, BvhOptions{1});
  } catch (const InvalidInput&) {
    return;  // a coordinate that is not finite or too large
  }
  DistanceOptions options;
  options.threads = 1;
  options.budget.subdivisions = 500;
  options.method = how % 2 == 0 ? Method::CellWalking : Method::CrossCulling;
  options.error_bound = std::ldexp(tree_a->bounding_box_diagonal(), -(static_cast<int>(how) / 2 % 64));
  const Enclosure forward = enclosure(a, b), backward = enclosure(b, a);
  const HausdorffDistance distance = hausdorff_distance(*tree_a, *tree_b, options);
  check_bounds(distance.a_to_b.bounds, forward);
  check_bounds(distance.b_to_a.bounds, backward);
  check_bounds(one_sided_hausdorff_distance(*tree_b, *tree_a, options).bounds, backward);
  for (const double tolerance : {distance.bounds.upper, distance.bounds.lower, 0.5 * distance.bounds.lower}) {
    if (!std::isfinite(tolerance)) continue;
    check_verdict(check_tolerance(*tree_a, *tree_b, tolerance, options), forward, backward);
  }
  DistanceOptions other_options = options;
  other_options.method = options.method == Method::CellWalking ? Method::CrossCulling : Method::CellWalking;
  const HausdorffDistance other = hausdorff_distance(*tree_a, *tree_b, other_options);
  check_bounds(other.a_to_b.bounds, forward);
  check_bounds(other.b_to_a.bounds, backward);
  check_meet(distance.a_to_b.bounds, other.a_to_b.bounds);
  check_meet(distance.b_to_a.bounds, other.b_to_a.bounds);
  check_closest_point(*tree_b, b, a.vertices[a.triangles[0][0]]);
  // Chosen by bits that choose nothing else, and seldom: it takes as long as a thousand of the others, longest with
  // cross-culling, which compares all of these triangles with each other.
  if (how < 128 || kind < 192) return;
  const int threads = options.method == Method::CellWalking ? 2 + static_cast<int>(kind / 16 % 2) : 2;
  check_threads(a, b, options, threads, forward, backward);
}

}  // namespace meshbound::fuzz
