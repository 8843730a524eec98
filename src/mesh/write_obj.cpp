// SPDX-License-Identifier: MIT
#include "mesh/writers.h"

namespace meshbound {

void write_obj(AtomicFile& file, const TriangleMesh& mesh) {
  for (const Eigen::Vector3d& p : mesh.vertices) {
    file.write("v ");
    put(file, p, '\n');
  }
  for (const Triangle& t : mesh.triangles) {
    file.write("f ");
    put(file, std::uint64_t{t[0]} + 1, ' ');
    put(file, std::uint64_t{t[1]} + 1, ' ');
    put(file, std::uint64_t{t[2]} + 1, '\n');
  }
}

}  // namespace meshbound
