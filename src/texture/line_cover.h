// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "texture/near_cover.h"
#include "texture/overlay.h"

namespace meshbound {

/// Bounds the texture deviation of a triangle A whose texture coordinates lie on a line, as on walls under a texture
/// projected from above, or where a height is shown by a strip of colours.
///
/// A point of A is compared with a point of another triangle that has the same texture coordinate and the same place in
/// the direction in which that stays the same on A. So both triangles have an area in the chart of these two
/// (`LineChart`). `NearCover` bounds the deviation in these charts. It is an upper bound however the place is rounded
/// or changed, as points with the same texture coordinate are compared. Not thread-safe: each thread has its own.
class LineCover {
 public:
  using Candidates = std::span<const ChartTriangle* const>;

  explicit LineCover(const ExactUnits& units) : units_(units) {}

  /// An upper bound over all of A, not below `min_upper`. Absent where the candidates with coordinates on the same line
  /// are not known to cover A in those charts, or a distance is not known to within `precision`. Lengths in model
  /// units. O(k log k) for k candidates.
  [[nodiscard]] std::optional<double> upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                            double precision);

 private:
  ExactUnits units_;
  std::vector<TexturedTriangle> unfolded_;  ///< A first, with coordinates in these charts
  std::vector<ChartTriangle> charts_;
  std::vector<const ChartTriangle*> candidates_;
  NearCover near_cover_;
};

}  // namespace meshbound
