// SPDX-License-Identifier: MIT
/// A triangle A of one mesh as a domain in barycentric weights, and what triangles B of the other mesh cover of it in
/// the texture. Points are where two lines cross, so they are exact; signs are decided by intervals where these tell,
/// else by what the lines are made of, else by rationals.
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "verify/numbers.h"
#include "verify/texture_surface.h"
#include "verify/work.h"

namespace meshbound::verify {

/// A linear function on A, by its values at the corners; not 0 everywhere where points are made of it.
struct DomainLine {
  std::array<Interval, 3> rough;
  /// The ends in the texture of an edge of B, where the line is one: the function is then twice the signed area of the
  /// triangle that both ends and the point span in the texture, times `sign`.
  const Eigen::Vector2d *from = nullptr, *to = nullptr;
  int sign = 1;
  std::optional<std::array<Exact, 3>> exact;  ///< once asked for; given where there are no ends
};

/// The point of A where two different lines are 0.
struct DomainPoint {
  std::array<DomainLine*, 2> lines{};
  std::array<Interval, 3> rough;  ///< weights of A's corners, times one positive number
};

/// Convex; its corners in their order. Empty, or with corners on a line, it has no area.
struct DomainCorner {
  DomainPoint point;
  DomainLine* to_next = nullptr;  ///< 0 on the edge to the next corner
};
using DomainPolygon = std::vector<DomainCorner>;

/// A triangle B over A.
struct CoveringTriangle {
  const TextureSurface::Triangle* triangle = nullptr;
  /// The area spanned in the texture with the edge opposite to each corner, times `turn`: not negative inside B, and in
  /// proportion to B's barycentric weights.
  std::array<DomainLine*, 3> lines{};
  int turn = 0;  ///< 1: the coordinates go round counter-clockwise; -1: clockwise; 0: they have no area
};

/// Lines, and what is made of them, are valid until they are forgotten.
class TextureDomain {
 public:
  /// `a` and `work`, which counts what is done here, must outlive this.
  TextureDomain(const TextureSurface::Triangle& a, Work& work);
  TextureDomain(const TextureDomain&) = delete;
  TextureDomain& operator=(const TextureDomain&) = delete;

  [[nodiscard]] const DomainPolygon& whole() const { return whole_; }
  [[nodiscard]] CoveringTriangle covering(const TextureSurface::Triangle& b);

  [[nodiscard]] std::size_t line_count() const { return lines_.size(); }
  /// Forgets all lines but the first ones: proofs may ask for more than memory holds.
  void forget_lines_from(std::size_t count) { lines_.resize(count); }

  /// The line on which the weight of a corner is `numerator` / 2^`bits`; positive where it is larger.
  [[nodiscard]] DomainLine* level(std::size_t corner, std::int64_t numerator, int bits);

  /// What lies on a side of a line, `side` 1 or -1, the line included. `has_area` is set to whether the polygon, if it
  /// has an area, has one there: some of it lies strictly on that side. Only where A has no area in the texture can all
  /// of a polygon lie on a line; it then counts to the side 1.
  [[nodiscard]] DomainPolygon clipped(const DomainPolygon& polygon, DomainLine* line, int side, bool& has_area);

  /// Whether the point of B with the texture coordinate of this point, which must be covered by B, is at most the
  /// tolerance away from it.
  [[nodiscard]] bool is_near(const DomainPoint& point, const CoveringTriangle& b, double tolerance) const;

 private:
  /// The bits of the rationals that these are made of.
  [[nodiscard]] std::uint64_t bits_of_line(DomainLine& line) const;
  [[nodiscard]] std::uint64_t bits_of_point(const DomainPoint& point) const;
  /// `CoveringTriangle::turn` of texture coordinates.
  [[nodiscard]] int turn_of(const std::array<Eigen::Vector2d, 3>& uv) const;
  [[nodiscard]] DomainPoint crossing(DomainLine* line, DomainLine* other) const;
  [[nodiscard]] std::array<Exact, 3> exact_weights(const DomainPoint& point) const;
  [[nodiscard]] const std::array<Exact, 3>& exact(DomainLine& line) const;
  [[nodiscard]] int sign_at(DomainLine& line, const DomainPoint& point) const;

  const TextureSurface::Triangle& a_;
  std::deque<DomainLine> lines_;
  DomainPolygon whole_;
  Work& work_;
};

}  // namespace meshbound::verify
