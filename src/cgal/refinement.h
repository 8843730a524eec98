// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <random>

#include "meshbound/cgal/deviation_monitor.h"

namespace meshbound::cgal {

/// Makes room for further collapses where decimation has come to its end: shakes the mesh a little, turns some edges,
/// then moves vertices and flips edges to where the deviation is lower. Each edit is proven by the monitor.
class Refinement {
 public:
  using Monitor = DeviationMonitor<SurfaceMesh>;

  /// All must outlive this. `stop` is asked now and then; the rest is skipped once it returns true.
  Refinement(SurfaceMesh& mesh, Monitor& monitor, std::function<bool()> stop)
      : mesh_(mesh), monitor_(monitor), stop_(std::move(stop)) {}

  /// One time over all vertices and edges. O(faces + size of the original).
  void round();

 private:
  void relocate();
  void flip();
  void turn();
  void shake();
  void shake(SurfaceMesh::Vertex_index v);
  [[nodiscard]] double mean_edge(SurfaceMesh::Vertex_index v) const;
  [[nodiscard]] double uniform();  ///< in -1 to 1

  SurfaceMesh& mesh_;
  Monitor& monitor_;
  std::function<bool()> stop_;
  std::mt19937_64 random_;  ///< the standard fixes what it yields, so results are the same everywhere
};

}  // namespace meshbound::cgal
