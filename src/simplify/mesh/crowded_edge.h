// SPDX-License-Identifier: MIT
/// Faces around an edge of more than two: which of them bound the same piece of space, and so go on in one another.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace meshbound {

/// Where a triangle leaves one of its edges: a number from 0 to 4 that grows with the angle around the edge, counter-
/// clockwise where the edge points at the viewer. Angles count from `zero`, a point beside the edge.
class AngleAroundEdge {
 public:
  /// The edge runs from `from` to `to`.
  AngleAroundEdge(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& zero);

  /// The angle of the triangle with this third corner. None where it is so flat over the edge that rounding hides it.
  [[nodiscard]] std::optional<double> of(const Eigen::Vector3d& corner) const;

 private:
  /// The way from the edge to a point, at a right angle to the edge; none where that is short beside the triangle.
  [[nodiscard]] std::optional<Eigen::Vector3d> height(const Eigen::Vector3d& corner) const;

  Eigen::Vector3d from_, to_, along_, x_, y_;
};

/// Which edges of a fan are to be joined: pairs of indices into `runs_upward`, which has the faces around an edge in
/// their order, counter-clockwise as seen from its upper end, and tells which of them run towards that end. Faces of a
/// pair run in opposite directions, and no two pairs cross. With `around_material`, pairs bound what lies behind the
/// faces where these are seen counter-clockwise from outside: two solids that touch along the edge come apart. Without,
/// they bound what lies in front: the solids are one. Empty where not as many run upward as downward. O(n).
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_around_edge(
    std::span<const std::uint8_t> runs_upward, bool around_material);

}  // namespace meshbound
