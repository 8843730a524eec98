// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "meshes.h"

namespace meshbound::bench {

/// One line of the table.
struct PairSpec {
  std::string name;
  /// "decimation" (50% and 10%), "coarse" (1%), "subdivision", "near-zero", "identical", "real", "given" or "apart".
  std::string kind;
  Recipe a, b;
  double reach_seconds = std::numeric_limits<double>::quiet_NaN();  ///< to reach on the machine of the benchmarks
  double tolerance = -1;                                            ///< a decision, when not negative
};

/// The pairs of the first table, and more near-zero ones. What is not on this machine is left out and named on
/// stderr.
[[nodiscard]] std::vector<PairSpec> table_pairs();

/// Every mesh of cad, organic, scan and game, and of the fetcher's folders, with its decimations to 50% and 10%.
[[nodiscard]] std::vector<PairSpec> decimation_pairs();

/// The pair of `--pair A B`, scaled to a diagonal of 1 of A.
[[nodiscard]] PairSpec file_pair(const std::filesystem::path& a, const std::filesystem::path& b);

/// Every two meshes of a family of pairs/, and `decimation_pairs`.
[[nodiscard]] std::vector<PairSpec> dataset_pairs();

}  // namespace meshbound::bench
