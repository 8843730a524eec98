// SPDX-License-Identifier: MIT
#include <meshbound/distance.h>
#include <meshbound/error.h>
#include <meshbound/io.h>

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  auto mesh = meshbound::read_mesh(argv[1]).mesh;
  const meshbound::Bvh at_rest(mesh);
  meshbound::Bvh moving(mesh);
  const double size = at_rest.bounding_box_diagonal();
  for (int frame = 1; frame <= 3; ++frame) {
    for (Eigen::Vector3d& v : mesh.vertices) v.z() += 0.01 * size * std::sin(frame + 10 * v.x() / size);
    moving.refit(mesh);
    if (moving.growth() > 2) moving = meshbound::Bvh(mesh);
    const auto distance = meshbound::hausdorff_distance(at_rest, moving);
    std::printf("%.17g <= H <= %.17g\n", distance.bounds.lower, distance.bounds.upper);
  }
  return 0;
} catch (const meshbound::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
