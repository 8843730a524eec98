// SPDX-License-Identifier: GPL-3.0-or-later
/// Simplifiers that take turns on one mesh, each run in a child process, and the checks of what they leave.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench_main.h"
#include "child_process.h"
#include "simplifiers.h"

namespace meshbound::bench {

/// What one simplifier left and the seconds that it took, one entry for each turn.
struct Turns {
  ChildResult::Status status = ChildResult::Status::Failed;
  std::string error;
  TriangleMesh mesh;
  std::vector<double> cpus, walls;
  /// Bytes by which a process that holds the original grew at most while the mesh was made, the result included.
  double peak_growth = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] bool done() const { return status == ChildResult::Status::Done; }
  [[nodiscard]] std::size_t faces() const { return mesh.triangles.size(); }
  /// Medians; not a number where no turn came to its end.
  [[nodiscard]] double cpu() const;
  [[nodiscard]] double wall() const;
  /// The number of faces, or why there is none.
  [[nodiscard]] std::string faces_or_reason() const;
};

struct Contender {
  std::function<Simplified()> simplify;  ///< called in a child process, after `after` has come to its end
  Turns* into;
  const Turns* after = nullptr;  ///< it has no turn where this did not come to its end
};

/// Gives the contenders their turns until each has had `rounds` of them or has used its seconds (`--quick`: 1). Within
/// a turn, what takes less than a tenth of a second is repeated, and the median counts.
void contest(const Options& options, const std::vector<Contender>& contenders);

/// One contender alone, one turn.
[[nodiscard]] Turns run_once(const Options& options, const std::function<Simplified()>& simplify);

/// Both distances of a result over the tolerance, not a number where the measurement failed or took too long.
struct Check {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double share = none;       ///< our upper bound of the symmetric distance
  double cgal_share = none;  ///< CGAL's `bounded_error_symmetric_Hausdorff_distance`, to a thousandth of the tolerance
  double seconds = none;     ///< processor time of our measurement as `simplify_with_bound` makes it

  /// False when one of the two has measured more than the tolerance.
  [[nodiscard]] bool holds() const;
};

[[nodiscard]] Check check(const Options& options, const TriangleMesh& original, const TriangleMesh& simplified,
                          double tolerance);

/// What CGAL decimates: the mesh itself, or the manifold that `manifold_copy` makes of it.
struct CgalInput {
  std::optional<cgal::SurfaceMesh> mesh;
  std::string how;  ///< "as it is", "manifold copy", or why there is none
};

[[nodiscard]] CgalInput cgal_input(const TriangleMesh& mesh);

}  // namespace meshbound::bench
