// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// How the distance of a report was found, for a browser that repeats it. Lengths in model units.
struct RepeatedMeasurement {
  bool decides = false;  ///< first whether it is at most `tolerance`, as `check_tolerance` does
  std::optional<double>
      error_bound;  ///< then its value, as `hausdorff_distance` does; absent: no more than the decision
  std::optional<double> tolerance;
  bool one_sided = false;  ///< only from the first mesh to the second
  std::string obstacle;    ///< why a browser cannot repeat it, a sentence; empty where it can
};

/// What a report holds so that the browser of its reader can repeat the measurement.
struct MeasureHere {
  std::string options;        ///< JSON; or the reason why nothing can be measured
  std::string first, second;  ///< JSON: the meshes whole; null where the reader is to choose their files
  std::string engine;         ///< the script with the engine in WebAssembly; empty where there is a reason

  /// All of it as one JSON document.
  [[nodiscard]] std::string measurement() const;
  /// Meshes are left out where they and the engine would take more than `max_bytes`.
  [[nodiscard]] MeasureHere within(std::size_t max_bytes) const;
};

/// The engine is the file share/meshbound/report_engine.js beside the folder of this program. Where it was not built or
/// not installed there is a reason instead. Throws `IoError` where it cannot be read. O(n).
[[nodiscard]] MeasureHere measure_here(const RepeatedMeasurement& measurement, const TriangleMesh& first,
                                       const TriangleMesh& second);

}  // namespace meshbound::tools
