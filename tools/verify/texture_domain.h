// SPDX-License-Identifier: MIT
/// A triangle A of one mesh as a domain in barycentric weights, and what triangles B of the other mesh cover of it in
/// the texture. Points are exact; signs are decided by intervals where these tell, else by rationals.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "verify/numbers.h"
#include "verify/texture_surface.h"

namespace meshbound::verify {

/// A point of A: weights of its corners, of sum 1.
struct DomainPoint {
  std::array<Exact, 3> weights;
  std::array<Interval, 3> rough;
};

/// Convex; its corners in their order. Empty, or with corners on a line, it has no area.
using DomainPolygon = std::vector<DomainPoint>;

/// A linear function on A, by its values at the corners. Not copyable while signs are asked for in other threads.
struct DomainLine {
  std::array<Interval, 3> rough;
  /// What the exact values are made of: the area of `from`, `to` and each corner in the texture, times `sign`.
  const Eigen::Vector2d *from = nullptr, *to = nullptr;
  int sign = 1;
  std::optional<std::array<Exact, 3>> exact;
};

/// A triangle B over A.
struct CoveringTriangle {
  const TextureSurface::Triangle* triangle = nullptr;
  /// The area spanned in the texture with the edge opposite to each corner, times `turn`: not negative inside B, and in
  /// proportion to B's barycentric weights.
  std::array<DomainLine, 3> lines;
  int turn = 0;  ///< 1: the coordinates go round counter-clockwise; -1: clockwise; 0: they have no area
};

class TextureDomain {
 public:
  explicit TextureDomain(const TextureSurface::Triangle& a) : a_(a) {}

  [[nodiscard]] static DomainPolygon whole();
  [[nodiscard]] CoveringTriangle covering(const TextureSurface::Triangle& b) const;

  /// The line on which the weight of a corner is `numerator` / 2^`bits`; positive where it is larger.
  [[nodiscard]] static DomainLine level(std::size_t corner, std::int64_t numerator, int bits);

  /// What lies on a side of a line, `side` 1 or -1, the line included. `has_area` is set to whether the polygon, if it
  /// has an area, has one there: some of it lies strictly on that side. Only where A has no area in the texture can all
  /// of a polygon lie on a line; it then counts to the side 1.
  [[nodiscard]] DomainPolygon clipped(const DomainPolygon& polygon, DomainLine& line, int side, bool& has_area) const;

  /// Whether the point of B with the texture coordinate of this point, which must be covered by B, is at most the
  /// tolerance away from it.
  [[nodiscard]] bool is_near(const DomainPoint& point, CoveringTriangle& b, double tolerance) const;

  /// The number of clips so far.
  [[nodiscard]] std::uint64_t work() const { return work_; }

 private:
  [[nodiscard]] int sign_at(DomainLine& line, const DomainPoint& point) const;
  [[nodiscard]] const std::array<Exact, 3>& exact(DomainLine& line) const;

  const TextureSurface::Triangle& a_;
  mutable std::uint64_t work_ = 0;
};

}  // namespace meshbound::verify
