// SPDX-License-Identifier: MIT
#include "meshbound/face_tolerances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/boxes.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/bvh.h"
#include "meshbound/error.h"
#include "meshbound/proximity.h"
#include "simplify/cover/local_tolerance.h"

namespace meshbound {
namespace {

using InputCorners = std::array<Eigen::Vector3d, 3>;

/// The triangles of a mesh by their corners, whatever order these are in.
class TriangleSet {
 public:
  explicit TriangleSet(const MeshView& mesh) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) keys_.push_back(key(corners_of(mesh, t)));
    std::sort(keys_.begin(), keys_.end());
  }
  [[nodiscard]] bool contains(const InputCorners& corners) const {
    return std::binary_search(keys_.begin(), keys_.end(), key(corners));
  }

 private:
  using Key = std::array<std::array<double, 3>, 3>;
  static Key key(const InputCorners& corners) {
    Key key{};
    for (std::size_t i = 0; i < 3; ++i) key[i] = {corners[i].x(), corners[i].y(), corners[i].z()};
    std::sort(key.begin(), key.end());
    return key;
  }
  std::vector<Key> keys_;
};

void check_arguments(const MeshView& original, std::span<const double> tolerances, double tolerance) {
  if (tolerances.size() != original.triangle_count())
    throw InvalidInput("tolerances of triangles must be given for every triangle of the original");
  if (std::any_of(tolerances.begin(), tolerances.end(), [](double t) { return !(t >= 0); }))
    throw InvalidInput("the tolerance of a triangle must be a length, 0 or more");
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) throw InvalidInput("the tolerance must be a length, 0 or more");
}

}  // namespace

FaceToleranceCheck check_face_tolerances(const MeshView& original, std::span<const double> tolerances, double tolerance,
                                         const MeshView& simplified) {
  check_arguments(original, tolerances, tolerance);
  const auto [original_tree, simplified_tree] = build_trees(original, simplified);
  Proximity to_simplified(simplified_tree);
  const TriangleSet unchanged_in_simplified(simplified), unchanged_in_original(original);
  std::vector<Eigen::AlignedBox3d> boxes(original.triangle_count());
  std::uint32_t hint = 0;
  for (std::uint32_t t = 0; t < boxes.size(); ++t) {
    const InputCorners corners = corners_of(original, t);
    boxes[t] = box_of(corners);
    if (unchanged_in_simplified.contains(corners)) continue;
    const Verdict verdict = to_simplified.triangle_within(corners, std::min(tolerance, tolerances[t]), hint);
    if (verdict != Verdict::Within) return {verdict, t, std::nullopt};
  }
  const LocalTolerance local(boxes, tolerances);
  Proximity to_original(original_tree);
  hint = 0;
  for (std::uint32_t t = 0; t < simplified.triangle_count(); ++t) {
    const InputCorners corners = corners_of(simplified, t);
    if (unchanged_in_original.contains(corners)) continue;
    const double limit = local.sufficient_around(box_of(corners), tolerance);
    if (to_original.triangle_within(corners, limit, hint) != Verdict::Within)
      return {Verdict::Undecided, std::nullopt, t};
  }
  return {};
}

}  // namespace meshbound
