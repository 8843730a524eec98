// SPDX-License-Identifier: MIT
/// The quadric error metric of Garland and Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH
/// 1997, with planes weighted as CGAL's `GarlandHeckbert_plane_policies` weights them.
#pragma once
#include <optional>
#include <vector>

#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// Sum of squared distances to planes, x.A x + 2 b.x + c with a symmetric A.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< A
  double x = 0, y = 0, z = 0;                             ///< b
  double constant = 0;

  /// `weight` times the squared distance to the plane through `p` with the unit vector `normal`.
  static Quadric of_plane(Vec3 normal, Vec3 p, double weight);
  Quadric& operator+=(const Quadric& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    x += o.x, y += o.y, z += o.z, constant += o.constant;
    return *this;
  }
  Quadric& operator-=(const Quadric& other);
  [[nodiscard]] double at(Vec3 p) const {
    const double ax = xx * p.x + xy * p.y + xz * p.z, ay = xy * p.x + yy * p.y + yz * p.z,
                 az = xz * p.x + yz * p.y + zz * p.z;
    return (ax + 2 * x) * p.x + (ay + 2 * y) * p.y + (az + 2 * z) * p.z + constant;
  }
  /// The weights of all planes together.
  [[nodiscard]] double planes() const { return xx + yy + zz; }
  /// The point with the least value; absent where A is singular.
  [[nodiscard]] std::optional<Vec3> minimum() const;
};

/// The weight of a face's plane in the quadrics of a mesh.
enum class PlaneWeights {
  /// 1 for each face, more at borders: favours few faces within a largest distance.
  Equal,
  /// The area of the face, or half a square on the border edge, divided by the mean area of all faces: favours a small
  /// distance on average, which pictures show.
  Area
};

/// By vertex: the planes of the faces around it, and through border edges, perpendicular to their face. O(n) shared by
/// the threads. What `storage` holds does not matter: its memory is used.
[[nodiscard]] std::vector<Quadric> vertex_quadrics(const ArrayMesh& mesh, PlaneWeights weights, int threads = 1,
                                                   std::vector<Quadric> storage = {});

struct Placement {
  Vec3 point;
  double cost = 0;
};
/// Where the sum of the quadrics of an edge's ends, at p and q, is least. Where that is too far away to be believed,
/// the best of the middle and the ends.
[[nodiscard]] Placement best_placement(const Quadric& of_p, const Quadric& of_q, Vec3 p, Vec3 q);

}  // namespace meshbound
