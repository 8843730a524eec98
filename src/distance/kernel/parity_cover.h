// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bvh/bvh_data.h"
#include "geometry/triangle_corners.h"
#include "geometry/vec3.h"

namespace meshbound {

/// A half-space {x : normal . x <= offset}.
struct HalfSpace {
  Vec3 normal;
  double offset = 0;
};

/// The halves of a triangle, across its longest edge. One cut for the rounding of both.
[[nodiscard]] std::array<TriangleCorners, 2> halves(const TriangleCorners& triangle);

/// Bounds a large triangle T of A by the many triangles of B that it lies on, without cutting it
/// (proof/parity_patch.h): P, grown over all that is straight above or below T, covers T when nothing of its boundary
/// does and an odd number of its triangles lies over one point. Where few of P are too high, what they lie over is left
/// to a walk, the rest of T is covered by the others all the same. A proof costs a twentieth of a walk across the cells
/// of P.
///
/// Rounding. A point q of T lies within `ParityView::shrink_share` limits of a point q' of the window T', and q' is
/// over the same triangles of P as its rounded coordinates, which the rim of the view allows for. `half_spaces_over`
/// leave room for both. Nothing is assumed of B: neighbours that do not share an edge to the bit count as none.
///
/// Not inline, as a walk is compiled once per instruction set (numeric/isa.h). Not thread-safe.
class ParityCover {
 public:
  /// `magnitude` bounds the coordinates of both models in the working frame of `target`, which must outlive this.
  ParityCover(const Bvh::Data& target, double magnitude);
  ~ParityCover();
  ParityCover(const ParityCover&) = delete;
  ParityCover& operator=(const ParityCover&) = delete;

  /// Whether so many triangles of B of the size of the one at `seed` fit into T, and they are so large beside the
  /// limit, that a proof is worth a try: where the limit is many of them wide, a walk cuts T into fewer pieces.
  [[nodiscard]] bool spans_many(const TriangleCorners& triangle, double limit, std::uint32_t seed) const;

  /// To be called for each triangle of A: what was spent on the one before is forgotten.
  void begin();

  /// No point of T is further from P than this, at most `limit`, but for those over `too_high()`. P grows from the
  /// triangle of B at `seed`. Nothing: not proven. O(size of P).
  [[nodiscard]] std::optional<double> distance(const TriangleCorners& triangle, double limit, std::uint32_t seed);

  /// Whether a T that failed is worth halving: it reaches beyond a border of B, and enough of B is left on each side.
  [[nodiscard]] bool is_worth_halving() const;

  // After a proof.

  [[nodiscard]] std::span<const std::uint32_t> patch() const;
  /// Triangles of P that are higher than the limit somewhere over T.
  [[nodiscard]] std::span<const std::uint32_t> too_high() const;
  /// What of T is over or under a triangle of B lies in these half-spaces; those that lines of no accurate direction
  /// bound are all of space.
  [[nodiscard]] std::array<HalfSpace, 3> half_spaces_over(std::uint32_t slot) const;

 private:
  struct TreeSoup;
  struct TreeSight;
  struct Search;

  const Bvh::Data& target_;
  double magnitude_;
  std::unique_ptr<Search> search_;  ///< made at the first try
  std::vector<std::uint32_t> too_high_;
  Vec3 normal_;        ///< of T
  double margin_ = 0;  ///< of `half_spaces_over`
  bool met_border_ = false;
  double expected_ = 0;                  ///< triangles of P over a T that failed, by the areas of those that were seen
  std::size_t spent_ = 0, largest_ = 0;  ///< triangles of P: of all tries since `begin`, of the largest one
};

}  // namespace meshbound
