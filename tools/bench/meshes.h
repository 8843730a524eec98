// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "meshbound/triangle_mesh.h"

namespace meshbound::bench {

/// Where real meshes are looked for: $MESHBOUND_DATASETS, shared/datasets beside the source tree, the fetcher's cache.
[[nodiscard]] std::vector<std::filesystem::path> dataset_folders();

/// The first of `candidates`, paths such as "scan/igl_bunny.off", that exists in one of the folders.
[[nodiscard]] std::optional<std::filesystem::path> find_dataset(const std::vector<std::string>& candidates);

/// Files of one folder of the data sets, in order of their names; each mesh once.
[[nodiscard]] std::vector<std::filesystem::path> list_dataset(const std::string& folder);

/// A mesh that is nearly or exactly the same surface, met with other bits.
enum class Variation {
  None,
  OtherOrder,  ///< triangles and vertices shuffled
  Jittered,    ///< every coordinate moved by up to 1e-9
  Float        ///< coordinates rounded to single precision
};

/// How a mesh of the benchmark is made from a file, in this order.
struct Recipe {
  std::filesystem::path file{};
  std::filesystem::path frame{};  ///< the file whose box is mapped to a diagonal of 1; `file` itself when empty
  int subdivisions = 0;           ///< midpoint subdivisions: the same surface, four times the triangles each
  double ratio = 1;               ///< kept by decimation
  Variation variation = Variation::None;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

/// Makes the mesh. Decimations are done once and kept in `cache`; that runs in a child process, so that a failure of
/// CGAL is an exception here. Throws `Error`, or `std::runtime_error` when decimation fails or takes more than 600 s.
[[nodiscard]] TriangleMesh make(const Recipe& recipe, const std::filesystem::path& cache);

/// Every triangle cut into four by the midpoints of its edges, `times` times.
[[nodiscard]] TriangleMesh midpoint_subdivision(TriangleMesh mesh, int times);

/// Length of the longest side of the bounding box of the vertices that faces use.
[[nodiscard]] double longest_dimension(const TriangleMesh& mesh);

}  // namespace meshbound::bench
