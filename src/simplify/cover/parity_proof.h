// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/triangle_mesh.h"
#include "proof/edge_neighbours.h"
#include "proof/parity_patch.h"

namespace meshbound {

/// The triangles of an original as a parity proof asks for them. `neighbours` are its `edge_neighbours`.
struct OriginalSoup {
  const std::vector<Vec3>& vertices;
  const std::vector<Triangle>& triangles;
  const std::vector<TriangleNeighbours>& neighbours;

  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t t) const {
    return {vertices[triangles[t][0]], vertices[triangles[t][1]], vertices[triangles[t][2]]};
  }
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t t, std::size_t k) const { return neighbours[t][k]; }
};

/// Proves that a triangle T lies within a tolerance of a triangle soup by a parity (proof/parity_patch.h) over T',
/// which is T a little shrunk.
///
/// A soup tells `corners(t)` of triangle t, and `neighbour(t, k)`: the triangle across its edge from corner k, or
/// `no_index` where there is none, or none that the proof may use.
///
/// Rounding. It is the heights that carry the error of the projection, and tests against T' keep a rim that is wider
/// than theirs (`covers`). Not thread-safe.
class ParityProof {
 public:
  /// Shrinking the triangle costs this share of the tolerance. It keeps walls that stand on an edge of it, as at the
  /// creases of machined parts, out of the prism.
  static constexpr double shrink_share = 1e-3;

  /// For soups of up to `triangle_count` triangles. O(triangle_count).
  explicit ParityProof(std::size_t triangle_count);

  /// True proves that `triangle` lies within `tolerance` of the soup (but for CandidateFaces::rounding_slack of the
  /// largest coordinate); false says nothing. P grows from `seed` over the edges that project onto the triangle.
  template <class Soup>
  [[nodiscard]] bool covers(const Soup& soup, const std::array<Vec3, 3>& triangle, double tolerance, double magnitude,
                            std::uint32_t seed) {
    obstacle_ = {};
    return set_view(triangle, tolerance, magnitude) && grow(soup, seed);
  }
  /// As `covers`; P grows from the first of `likely` that lies above or below a point in the middle of the triangle,
  /// within the tolerance where it does.
  template <class Soup>
  [[nodiscard]] bool covers_from(const Soup& soup, const std::array<Vec3, 3>& triangle, double tolerance,
                                 double magnitude, std::span<const std::uint32_t> likely) {
    obstacle_ = {};
    if (!set_view(triangle, tolerance, magnitude)) return false;
    Sight<Soup> sight{*this, soup};
    const auto seed =
        std::find_if(likely.begin(), likely.end(), [&](std::uint32_t t) { return sight.is_over_centre(t); });
    return seed != likely.end() && grow(soup, *seed);
  }
  /// What stood in the way of a proof that failed: a triangle that is too high, or an edge at which the soup ends.
  struct Obstacle {
    std::size_t side = 0;  ///< the edge of T from this corner is the nearest one
    /// How far from that edge it reaches, and how far away the corner across is. Both are 0 where no triangle was found
    /// to begin with.
    double depth = 0, height = 0;
  };
  [[nodiscard]] const Obstacle& obstacle() const { return obstacle_; }
  /// P of the last proof: the triangle is near these together.
  [[nodiscard]] std::span<const std::uint32_t> patch() const { return patch_.triangles(); }

 private:
  template <class Soup>
  struct Sight;
  [[nodiscard]] bool set_view(const std::array<Vec3, 3>& triangle, double tolerance, double magnitude);
  template <class Soup>
  [[nodiscard]] bool grow(const Soup& soup, std::uint32_t seed) {
    Sight<Soup> sight{*this, soup};
    const auto neighbour = [&](std::uint32_t t, std::size_t k) { return soup.neighbour(t, k); };
    if (patch_.covers(neighbour, seed, sight)) return true;
    note_obstacle(window_.clipped(sight.seen_last(), rim_));
    return false;
  }
  void note_obstacle(const Window<3>::Clipped& seen);

  ParityPatch patch_;
  FaceView view_;
  Window<3> window_;                    ///< T'
  double centre_x_ = 0, centre_y_ = 0;  ///< of it
  double height_limit_ = 0, rim_ = 0;
  Obstacle obstacle_;
};

/// What is seen of one triangle.
template <class Soup>
struct ParityProof::Sight {
  const ParityProof& proof;
  const Soup& soup;
  ProjectedTriangle corners = {};
  /// How far each corner is beyond each side of T', by side and corner.
  std::array<std::array<double, 3>, 3> outside = {};
  mutable std::size_t edge_seen = 3;  ///< the edge whose passage was asked for last; 3: none since `look_at`

  void project(std::uint32_t t) {
    const std::array<Vec3, 3> at = soup.corners(t);
    for (std::size_t k = 0; k < 3; ++k) corners[k] = proof.view_.project(at[k]);
  }
  bool look_at(std::uint32_t t) {
    project(t);
    edge_seen = 3;
    for (std::size_t side = 0; side < 3; ++side)
      for (std::size_t k = 0; k < 3; ++k) outside[side][k] = proof.window_.outside(side, corners[k]);
    const double limit = proof.height_limit_;
    if (std::abs(corners[0].h) <= limit && std::abs(corners[1].h) <= limit && std::abs(corners[2].h) <= limit)
      return true;
    for (const auto& of_side : outside)
      if (std::min({of_side[0], of_side[1], of_side[2]}) > proof.rim_) return true;
    return proof.window_.heights_within(corners, proof.rim_, proof.height_limit_);
  }
  [[nodiscard]] bool crosses_ray(std::size_t k) const {
    return meshbound::crosses_ray(corners[k], corners[(k + 1) % 3], proof.centre_x_, proof.centre_y_);
  }
  /// Whether the triangle has a point over the middle of T', and no part over T' that is too high.
  [[nodiscard]] bool is_over_centre(std::uint32_t t) {
    project(t);
    return (crosses_ray(0) ^ crosses_ray(1) ^ crosses_ray(2)) && look_at(t);
  }
  /// The triangle or the edge that was looked at last; an edge is a triangle without area.
  [[nodiscard]] ProjectedTriangle seen_last() const {
    if (edge_seen == 3) return corners;
    const Projected &p = corners[edge_seen], &q = corners[(edge_seen + 1) % 3];
    return {p, q, q};
  }
  /// Clear when a line separates the projected edge from T' by more than the rim.
  [[nodiscard]] Passage passage(std::size_t k) const {
    const std::size_t j = (k + 1) % 3;
    edge_seen = k;
    for (const auto& of_side : outside)
      if (of_side[k] > proof.rim_ && of_side[j] > proof.rim_) return Passage::Clear;
    return proof.window_.is_beside_line(corners[k], corners[j], proof.rim_) ? Passage::Clear : Passage::Across;
  }
};

}  // namespace meshbound
