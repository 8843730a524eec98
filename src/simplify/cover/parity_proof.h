// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "geometry/triangle_corners.h"
#include "proof/parity_view.h"

namespace meshbound {

/// Proves that a triangle T lies within a tolerance of a triangle soup by a parity (proof/parity_patch.h) over T',
/// which is T a little shrunk (`ParityView`). The set P of that proof grows from one triangle over those next to it.
///
/// A soup tells `corners(t)` of triangle t, and `neighbour(t, k)`: the triangle across its edge from corner k, or
/// `no_index` where there is none, or none that the proof may use. Not thread-safe.
class ParityProof {
 public:
  ParityProof();

  /// True proves that `triangle` lies within `tolerance` of the soup (but for CandidateFaces::rounding_slack of the
  /// largest coordinate); false says nothing. P grows from `seed` over the edges that project onto the triangle.
  template <class Soup>
  [[nodiscard]] bool covers(const Soup& soup, const TriangleCorners& triangle, double tolerance, double magnitude,
                            std::uint32_t seed) {
    return covers_from(soup, triangle, tolerance, magnitude, [seed](const Sight<Soup>&) { return seed; });
  }
  /// As `covers`; P grows from the first of `likely` that lies above or below a point in the middle of the triangle,
  /// within the tolerance where it does.
  template <class Soup>
  [[nodiscard]] bool covers_from_first(const Soup& soup, const TriangleCorners& triangle, double tolerance,
                                       double magnitude, std::span<const std::uint32_t> likely) {
    return covers_from(soup, triangle, tolerance, magnitude, [likely](Sight<Soup>& sight) {
      const auto seed = std::find_if(likely.begin(), likely.end(), [&](std::uint32_t t) {
        sight.project(t);
        return sight.has_middle() && sight.look_at(t);
      });
      return seed == likely.end() ? no_index : *seed;
    });
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
  template <class Soup, class Seed>
  [[nodiscard]] bool covers_from(const Soup& soup, const TriangleCorners& triangle, double tolerance, double magnitude,
                                 const Seed& find_seed) {
    obstacle_ = {};
    const std::optional<ParityView> view = ParityView::of(triangle, tolerance, magnitude);
    if (!view) return false;
    Sight<Soup> sight{*view, soup};
    const std::uint32_t seed = find_seed(sight);
    if (seed == no_index) return false;
    const auto neighbour = [&](std::uint32_t t, std::size_t k) { return soup.neighbour(t, k); };
    if (patch_.covers(neighbour, seed, sight)) return true;
    note_obstacle(view->window, view->window.clipped(sight.seen_last(), view->rim));
    return false;
  }
  void note_obstacle(const Window<3>& window, const Window<3>::Clipped& seen);

  ParityPatch patch_;
  Obstacle obstacle_;
};

}  // namespace meshbound
