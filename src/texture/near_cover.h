// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "numeric/marked_ids.h"
#include "texture/overlay.h"

namespace meshbound {

/// Bounds the texture deviation of a triangle A by candidates that are known to cover all of it, in doubles and pair by
/// pair, without an overlay. What it cannot decide it leaves open. Not thread-safe: each thread has its own.
///
/// Triangles that hang together across edges which may run through the inside of A are a *sheet*: the candidates are
/// where it is entered. Several layers of a mesh may have the same texture. Each is a sheet by itself.
class NearCover {
 public:
  using Candidates = std::span<const ChartTriangle* const>;

  /// An upper bound over all of A: the least of those of single candidates that cover all of it, else of sheets that
  /// do, whose bound is that of their farthest triangle; not below `min_upper`. Absent where none is known to cover A,
  /// or a distance is not known to within `precision`. A and all candidates must have an area in the texture. Lengths
  /// in model units. O(k) for k triangles of sheets.
  [[nodiscard]] std::optional<double> upper(const ChartTriangle& a, Candidates candidates, double min_upper,
                                            double precision);

 private:
  [[nodiscard]] bool gather_closed_sheet(const ChartTriangle& a, const ChartTriangle& first);

  MarkedIds candidates_, gathered_;  ///< numbers of triangles: the candidates, and those of sheets so far
  std::vector<const ChartTriangle*> sheet_;
};

}  // namespace meshbound
