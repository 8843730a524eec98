// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>

#include "numeric/marked_ids.h"
#include "texture/overlay.h"

namespace meshbound {

/// Bounds the texture deviation of a triangle A by candidates that are known to cover all of it, in doubles and pair by
/// pair, without an overlay. What it cannot decide it leaves open. Not thread-safe: each thread has its own.
class NearCover {
 public:
  using Candidates = std::span<const ChartTriangle* const>;

  /// An upper bound over all of A: that of the candidate that covers all of it, else that of the farthest one; not
  /// below `min_upper`. Absent where the candidates are not known to cover A, or a distance is not known to within
  /// `precision`. A and all candidates must have an area in the texture. Lengths in model units. O(candidates).
  [[nodiscard]] std::optional<double> upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                            double precision);

  /// True only if the candidates cover all of A: as `Covering` tells it, where no open edge runs through the inside of
  /// A. False also where doubles do not know.
  [[nodiscard]] bool is_complete(const ChartTriangle& a, Candidates candidates);

 private:
  MarkedIds candidates_;  ///< their numbers
};

}  // namespace meshbound
