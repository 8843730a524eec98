// SPDX-License-Identifier: MIT
#include <meshbound/mpi.h>

#include <cstdio>

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  meshbound::TriangleMesh square;
  square.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}};
  square.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  meshbound::SimplifyOptions options;
  options.tolerance = 0.01;
  const auto result = meshbound::mpi::simplify_in_tiles(square, options, MPI_COMM_WORLD);
  std::printf("%zu faces\n", result.last().faces());
  MPI_Finalize();
  return result.last().faces() == 2 ? 0 : 1;
}
