// SPDX-License-Identifier: MIT
#include "mesh/writers.h"

namespace meshbound {

void write_off(AtomicFile& file, const TriangleMesh& mesh) {
  file.write("OFF\n");
  put(file, mesh.vertices.size(), ' ');
  put(file, mesh.triangles.size(), ' ');
  file.write("0\n");
  for (const Eigen::Vector3d& p : mesh.vertices) put(file, p, '\n');
  for (const Triangle& t : mesh.triangles) {
    file.write("3 ");
    put(file, t[0], ' ');
    put(file, t[1], ' ');
    put(file, t[2], '\n');
  }
}

}  // namespace meshbound
