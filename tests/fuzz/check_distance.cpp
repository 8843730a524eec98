// SPDX-License-Identifier: MIT
#include <cmath>
#include <optional>
#include <vector>

#include "fuzz/choices.h"
#include "fuzz/claims.h"
#include "fuzz/enclosure.h"
#include "meshbound/distance.h"
#include "meshbound/error.h"
#include "reference/exact_distance.h"

namespace meshbound::fuzz {
namespace {

using reference::exact_distance;
using reference::ExactLength;

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
  require(one.lower == many.lower && one.upper == many.upper,
          "several threads, or queries together, find other bounds than one");
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

/// Queries answered together have the answers of one by one, to the bit: corners and middles, neighbours or not.
void check_closest_points(const Bvh& tree, const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> queries;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) queries.push_back(mesh.vertices[v]);
    queries.push_back(mesh.vertices[t[0]] + 0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]));
    if (!queries.back().allFinite()) queries.pop_back();
  }
  const std::vector<ClosestPoint> answers = closest_points(tree, queries, {1});
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const ClosestPoint one = closest_point(tree, queries[i]);
    check_same(one.distance, answers[i].distance);
    require(one.point.triangle == answers[i].point.triangle && one.point.position == answers[i].point.position,
            "queries answered together find another point than one by one");
  }
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
  check_closest_points(*tree_b, a);
  // Chosen by bits that choose nothing else, and seldom: it takes as long as a thousand of the others, longest with
  // cross-culling, which compares all of these triangles with each other.
  if (how < 128 || kind < 192) return;
  const int threads = options.method == Method::CellWalking ? 2 + static_cast<int>(kind / 16 % 2) : 2;
  check_threads(a, b, options, threads, forward, backward);
}

}  // namespace meshbound::fuzz
