// SPDX-License-Identifier: GPL-3.0-or-later
// bench_cgal_process A B ERROR_BOUND: what a program of CGAL's does to print the distance of two files; the opponent of
// `hausdorff_distance` where whole processes are compared.
#include <CGAL/Polygon_mesh_processing/IO/polygon_mesh_io.h>
#include <CGAL/Polygon_mesh_processing/distance.h>

#include <cstdio>
#include <cstdlib>

#include "meshbound/cgal/surface_mesh.h"

int main(int argc, char** argv) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  meshbound::cgal::SurfaceMesh a, b;
  if (argc != 4 || !PMP::IO::read_polygon_mesh(argv[1], a) || !PMP::IO::read_polygon_mesh(argv[2], b)) {
    std::fprintf(stderr, "usage: bench_cgal_process A B ERROR_BOUND, where A and B are 2-manifolds\n");
    return 2;
  }
  const double bound = std::strtod(argv[3], nullptr);
  std::printf("%.17g\n", PMP::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(a, b, bound));
  return 0;
}
