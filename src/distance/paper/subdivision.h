// SPDX-License-Identifier: MIT
/// Subdivision of the triangles of A that survive cross-culling. Paper, section 5. Compiled once per instruction set.
///
///     collect L, the triangles of B that can matter                                    (5.1 step 1, Lemma 3)
///     while a sub-triangle is left
///       done when its upper bound is within the target (rule 2: lower bound + epsilon),
///                 or equals its lower bound            (rule 1: one triangle of B is closest to all corners),
///                 or a translation takes it through B  (rule 3: closed models, Lemma 4 as closed_model.h has it)
///       cut each edge, at a Voronoi point where its ends are nearest to different triangles       (5.1 step 2, 5.2)
///       bound the four sub-triangles by L alone, keep what of L can matter to each      (5.1 step 3, Eq. 10-11)
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "distance/paper/candidate_set.h"
#include "distance/paper/closed_model.h"
#include "distance/paper/voronoi_subdivision.h"
#include "proof/proven_bounds.h"

namespace meshbound {

/// A Voronoi point nearer than this to an end of its edge gives way to the middle: it would leave slivers. Measured at
/// 1e-4 on bunny against its 10% decimation: 128,000 subdivisions for 1/16, 58,000 when edges are only halved.
inline constexpr double min_share = 1.0 / 4;
/// Subdivisions after which edges are only halved, so that sub-triangles shrink by half each time. The paper saw under
/// ten.
inline constexpr std::uint32_t halve_edges_from_depth = 24;
/// Candidates up to which the rule for closed models is tried: it tests each of them twice.
inline constexpr std::size_t max_candidates_to_cross = 32;

inline namespace MESHBOUND_ISA {

class Subdivision {
 public:
  explicit Subdivision(ProvenBounds& bounds)
      : b_(bounds.target()), bounds_(bounds), target_is_closed_(meshbound::is_closed(bounds.target())) {}

  /// Covers one triangle of A that is known to be within the root of `upper_squared` of B.
  void refine(const TriangleCorners& triangle, double upper_squared, std::uint64_t max_subdivisions) {
    subdivisions_left_ = max_subdivisions;
    begin({triangle, upper_squared, 0, 0, 0});
    run();
  }

  /// Covers a piece of a triangle of A that is known to be within the root of `upper_squared` of B, fanned out into
  /// triangles: its diagonals are exact. Returns the subdivisions that are left.
  std::uint64_t refine(const Piece& piece, double upper_squared, std::uint64_t max_subdivisions) {
    subdivisions_left_ = max_subdivisions;
    for (std::uint32_t i = 2; i < piece.count; ++i) {
      begin({{piece.corner(0), piece.corner(i - 1), piece.corner(i)}, upper_squared, 0, 0, piece.depth});
      offer_corners(open_.back());
      run();
    }
    return subdivisions_left_;
  }

 private:
  void run() {
    while (!open_.empty()) {
      const SubTriangle sub = open_.back();
      open_.pop_back();
      candidates_.resize(sub.last_candidate);  // what lies above belongs to sub-triangles that are done
      step(sub);
    }
  }

  /// A sub-triangle, with its L in candidates_[first, last).
  struct SubTriangle {
    TriangleCorners corners;
    double upper_squared;
    std::size_t first_candidate, last_candidate;
    std::uint32_t depth;
  };

  /// The six points of a subdivision, corners first, then one on each edge 01, 12, 20; and the
  /// sub-triangles between them, the centre last.
  using Points = std::array<Vec3, 6>;
  static constexpr std::array<std::array<std::size_t, 3>, 4> corners_of_sub_triangle = {
      {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};

  /// Squared distances of one candidate to the six points and to the centroids of the four sub-triangles.
  struct Distances {
    std::array<double, 6> to_point;
    std::array<double, 4> to_centroid;
  };

  [[nodiscard]] double slack() const { return bounds_.goal().largest_slack(); }

  /// Collects L for the first sub-triangle, which is the whole triangle.
  void begin(SubTriangle sub) {
    candidates_.clear();
    collect_candidates(b_, sub.corners, sub.upper_squared, slack(), candidates_, bounds_.counters().queries);
    sub.last_candidate = candidates_.size();
    open_.clear();
    open_.push_back(sub);
  }

  /// The corners of a whole triangle were offered before; those of a piece may not have been.
  void offer_corners(const SubTriangle& sub) {
    const std::array<std::size_t, 3> nearest = nearest_candidates(sub);
    for (std::size_t k = 0; k < 3; ++k) {
      const Candidate& candidate = candidates_[nearest[k]];
      bounds_.offer(sub.corners[k], {candidate.squared[k], candidate.slot}, sub.depth);
    }
  }

  void step(const SubTriangle& sub) {
    // A look at the clock costs as much as a sub-triangle; a thousand of these take milliseconds.
    if ((++bounds_.counters().pieces & 1023) == 0 && bounds_.goal().out_of_time()) subdivisions_left_ = 0;
    if (bounds_.done_with(sub.upper_squared)) return;
    const std::array<std::size_t, 3> nearest = nearest_candidates(sub);
    if (upper_equals_lower(sub, nearest)) return bounds_.accept(sub.upper_squared);
    if (crosses(sub, nearest)) return;
    if (subdivisions_left_ == 0 || bounds_.decided() || sub.depth >= deepest_cut)
      return bounds_.give_up(sub.upper_squared);
    subdivide(sub, nearest);
  }

  /// The closest candidate of each corner: all of B need not be asked again (Lemma 3).
  [[nodiscard]] std::array<std::size_t, 3> nearest_candidates(const SubTriangle& sub) const {
    std::array<std::size_t, 3> nearest;
    nearest.fill(sub.first_candidate);
    for (std::size_t i = sub.first_candidate; i < sub.last_candidate; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        if (candidates_[i].squared[k] < candidates_[nearest[k]].squared[k]) nearest[k] = i;
    return nearest;
  }

  /// Rule 1 of the paper. Corners often have several closest triangles, which share an edge or a vertex, so the rule is
  /// asked by its meaning: the furthest corner is as far from the triangle of the upper bound as from all of B.
  [[nodiscard]] bool upper_equals_lower(const SubTriangle& sub, const std::array<std::size_t, 3>& nearest) const {
    double lower_squared = 0;
    for (std::size_t k = 0; k < 3; ++k) lower_squared = std::max(lower_squared, candidates_[nearest[k]].squared[k]);
    return sub.upper_squared <= lower_squared;
  }

  /// Rule 3 of the paper, tried with a translation by the target towards the closest point of the worst corner.
  bool crosses(const SubTriangle& sub, const std::array<std::size_t, 3>& nearest) {
    const std::size_t count = sub.last_candidate - sub.first_candidate;
    if (!target_is_closed_ || count > max_candidates_to_cross) return false;
    std::size_t worst = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (candidates_[nearest[k]].squared[k] > candidates_[nearest[worst]].squared[worst]) worst = k;
    const Vec3& corner = sub.corners[worst];
    const Vec3 offset = closest_on_triangle(triangle_at(b_, candidates_[nearest[worst]].slot), corner).offset;
    const double distance = length(offset);
    if (!(distance > slack())) return false;
    const Vec3 shift = (-std::sqrt(bounds_.accepted_squared()) * (1 - 0x1p-30) / distance) * offset;
    TriangleCorners image;
    double longest_squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      image[k] = sub.corners[k] + shift;
      longest_squared = std::max(longest_squared, squared_length(image[k] - sub.corners[k]));
    }
    if (!bounds_.accepts(longest_squared)) return false;
    std::array<std::uint32_t, max_candidates_to_cross> slots;
    for (std::size_t i = 0; i < count; ++i) slots[i] = candidates_[sub.first_candidate + i].slot;
    if (!crosses_surface(b_, sub.corners, image, {slots.data(), count})) return false;
    ++bounds_.counters().enclosed;
    bounds_.accept(longest_squared);
    return true;
  }

  /// Where to cut the edge from corner k: at a Voronoi point, else in the middle.
  [[nodiscard]] Vec3 edge_point(const SubTriangle& sub, const std::array<std::size_t, 3>& nearest,
                                std::size_t k) const {
    const std::size_t next = (k + 1) % 3;
    double share = 0.5;
    if (nearest[k] != nearest[next] && sub.depth < halve_edges_from_depth) {
      const auto voronoi =
          equidistant_parameter(sub.corners[k], sub.corners[next], triangle_at(b_, candidates_[nearest[k]].slot),
                                triangle_at(b_, candidates_[nearest[next]].slot));
      if (voronoi && *voronoi >= min_share && *voronoi <= 1 - min_share) share = *voronoi;
    }
    return sub.corners[k] + share * (sub.corners[next] - sub.corners[k]);
  }

  void subdivide(const SubTriangle& sub, const std::array<std::size_t, 3>& nearest) {
    ++bounds_.counters().cuts;
    --subdivisions_left_;
    bounds_.counters().deepest = std::max(bounds_.counters().deepest, sub.depth + 1);
    Points points;
    for (std::size_t k = 0; k < 3; ++k) {
      points[k] = sub.corners[k];
      points[3 + k] = edge_point(sub, nearest, k);
    }
    measure(sub, points);
    offer_edge_points(sub, points);
    push_sub_triangles(sub, points);
  }

  [[nodiscard]] static TriangleCorners sub_triangle_between(const Points& points, std::size_t which) {
    const auto& c = corners_of_sub_triangle[which];
    return {points[c[0]], points[c[1]], points[c[2]]};
  }

  /// Fills `distances_`: those of the corners are known, those of the three edge points and of the centroids are
  /// computed four at a time.
  void measure(const SubTriangle& sub, const Points& points) {
    std::array<Vec3, 4> centroid;
    for (std::size_t i = 0; i < 4; ++i) centroid[i] = CentroidBall(sub_triangle_between(points, i)).centre;
    const Points& p = points;
    const auto& c = centroid;
    const Vec<Double4> edge_points{
        {p[3].x, p[4].x, p[5].x, p[5].x}, {p[3].y, p[4].y, p[5].y, p[5].y}, {p[3].z, p[4].z, p[5].z, p[5].z}};
    const Vec<Double4> centroids{
        {c[0].x, c[1].x, c[2].x, c[3].x}, {c[0].y, c[1].y, c[2].y, c[3].y}, {c[0].z, c[1].z, c[2].z, c[3].z}};
    distances_.clear();
    for (std::size_t i = sub.first_candidate; i < sub.last_candidate; ++i) {
      const Candidate& candidate = candidates_[i];
      const CornerTriangle<Double4> t = broadcast4(triangle_at(b_, candidate.slot));
      const Double4 to_edges = closest_on_triangle(t, edge_points).squared_distance;
      const Double4 to_centroids = closest_on_triangle(t, centroids).squared_distance;
      const auto& known = candidate.squared;
      distances_.push_back({{known[0], known[1], known[2], to_edges[0], to_edges[1], to_edges[2]},
                            {to_centroids[0], to_centroids[1], to_centroids[2], to_centroids[3]}});
    }
  }

  /// The distances of the new points raise the lower bound (Eq. 11).
  void offer_edge_points(const SubTriangle& sub, const Points& points) {
    for (std::size_t k = 3; k < 6; ++k) {
      Nearest nearest;
      for (std::size_t i = 0; i < distances_.size(); ++i) {
        if (distances_[i].to_point[k] < nearest.squared)
          nearest = {distances_[i].to_point[k], candidates_[sub.first_candidate + i].slot};
      }
      bounds_.offer(points[k], nearest, sub.depth + 1);
    }
  }

  /// Eq. 10 by L alone. A sub-triangle is nowhere further from B than the whole.
  [[nodiscard]] double upper_squared_of(const SubTriangle& sub, std::size_t which) const {
    const auto& c = corners_of_sub_triangle[which];
    double upper = sub.upper_squared;
    for (const Distances& d : distances_)
      upper = std::min(upper, std::max({d.to_point[c[0]], d.to_point[c[1]], d.to_point[c[2]]}));
    return upper;
  }

  struct Bounded {
    double upper_squared;
    std::size_t which;
    bool operator<(const Bounded& other) const { return upper_squared < other.upper_squared; }
  };

  /// Pushes the sub-triangles that need more work, the worst on top.
  void push_sub_triangles(const SubTriangle& sub, const Points& points) {
    std::array<Bounded, 4> order;
    for (std::size_t i = 0; i < 4; ++i) order[i] = {upper_squared_of(sub, i), i};
    std::sort(order.begin(), order.end());
    for (const auto [upper_squared, which] : order) {
      if (bounds_.done_with(upper_squared)) continue;
      const TriangleCorners corners = sub_triangle_between(points, which);
      const double reach = CentroidBall(corners).reach_squared(upper_squared, slack());
      const auto& c = corners_of_sub_triangle[which];
      const std::size_t first = candidates_.size();
      for (std::size_t i = 0; i < distances_.size(); ++i) {
        const Distances& d = distances_[i];
        if (d.to_centroid[which] <= reach)
          candidates_.push_back(
              {candidates_[sub.first_candidate + i].slot, {d.to_point[c[0]], d.to_point[c[1]], d.to_point[c[2]]}});
      }
      open_.push_back({corners, upper_squared, first, candidates_.size(), sub.depth + 1});
    }
  }

  const Bvh::Data& b_;
  ProvenBounds& bounds_;
  bool target_is_closed_;
  std::uint64_t subdivisions_left_ = 0;
  std::vector<SubTriangle> open_;
  std::vector<Candidate> candidates_;
  std::vector<Distances> distances_;  ///< of the sub-triangle at hand, by candidate
};

}  // namespace MESHBOUND_ISA
}  // namespace meshbound
