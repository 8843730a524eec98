// SPDX-License-Identifier: GPL-3.0-or-later
/// The tables of the `simplify_all` benchmark. `--only` selects by "<part>/<mesh>".
#pragma once
#include "report.h"

namespace meshbound::bench {

struct SimplifyBench {
  const Options& options;
  const std::vector<double>& percents;  ///< tolerances of `all_meshes`
  Report& report;
};

/// "all-meshes/<percent>/...": every shared mesh at `percents`, beside CGAL without a bound.
void all_meshes(const SimplifyBench& bench);

/// "named": faces and time of `normal` and `high` at 0.1%, the sphere of 81,920 included.
void named(const SimplifyBench& bench);

/// "blade": the engine blade of engeom at absolute tolerances, beside the figures that engeom 0.5 publishes.
void blade(const SimplifyBench& bench);

/// "threads": two threads against one, by the clock; both must leave the same bits.
void threads(const SimplifyBench& bench);

/// "levels": T/8, T/4, T/2 and T in one run against T alone.
void levels(const SimplifyBench& bench);

/// "target": a number of faces that a loose tolerance allows, beside CGAL to the same number.
void target(const SimplifyBench& bench);

/// "degenerate": one degenerate or duplicate triangle more, and levels with several, against the mesh without.
void degenerate(const SimplifyBench& bench);

/// "scale": time and memory of large meshes, and how they grow with a torus.
void scale(const SimplifyBench& bench);

}  // namespace meshbound::bench
