// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "child_process.h"
#include "measure.h"
#include "meshbound/bounds.h"
#include "meshbound/distance.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::bench {

/// One measurement of `hausdorff_distance`, of `one_sided_hausdorff_distance` from a to b or, where a tolerance is
/// given, of `check_tolerance`.
struct OurRun {
  ChildResult::Status status = ChildResult::Status::Failed;
  std::string error;
  Bounds bounds;
  Times build;  ///< both trees
  Times query;
  double peak_bytes = 0;
};

struct OurTask {
  double error_bound = 1e-6;  ///< model units
  double tolerance = -1;      ///< decides this instead of measuring, when not negative
  int threads = 1;
  double limit = 120;  ///< seconds of processor time
  bool one_sided = false;
  Method method = Method::CellWalking;
};

/// In a child process of its own.
[[nodiscard]] OurRun run_ours(const TriangleMesh& a, const TriangleMesh& b, const OurTask& task);

}  // namespace meshbound::bench
