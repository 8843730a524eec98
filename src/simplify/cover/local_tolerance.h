// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace meshbound {

/// For a mesh whose triangles have tolerances of their own: how near must something be, so that it is near enough for
/// each triangle around it?
///
/// Let r be such that all triangles whose boxes meet a box, grown by r on all sides, have tolerances of at least r. A
/// point of the box that is within r of the mesh is then within the own tolerance of the triangle g nearest to it: g is
/// within r of the point, so the box of g meets the grown one.
class LocalTolerance {
 public:
  /// The bounding box and the tolerance of each triangle. O(n log n) time, O(n) memory.
  LocalTolerance(const std::vector<Eigen::AlignedBox3d>& boxes, std::span<const double> tolerances);

  /// Such an r, at most `max`: the largest one but for 2^-30 `max`. Expected O(log n).
  [[nodiscard]] double sufficient_around(const Eigen::AlignedBox3d& box, double max) const;

 private:
  /// A binary tree by halves of the triangles [first, last) in order; node i has children 2i+1 and 2i+2.
  struct Node {
    Eigen::AlignedBox3d box;
    double smallest = 0;
  };
  struct Input {
    const std::vector<Eigen::AlignedBox3d>& boxes;
    std::span<const double> tolerances;
    std::vector<std::uint32_t> order;
  };
  void build(std::size_t node, std::size_t first, std::size_t last, Input& input);
  /// The smallest tolerance of the triangles whose boxes meet `box` grown by `reach`; infinity where there is none. A
  /// subtree is left out when it holds none that is smaller than what was found.
  [[nodiscard]] double smallest_near(const Eigen::AlignedBox3d& box, double reach) const;
  void search(std::size_t node, std::size_t first, std::size_t last, const Eigen::AlignedBox3d& box,
              double& smallest) const;

  std::vector<Node> nodes_;
  std::size_t count_ = 0;
};

}  // namespace meshbound
