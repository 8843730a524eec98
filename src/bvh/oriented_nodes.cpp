// SPDX-License-Identifier: MIT
#include "bvh/oriented_nodes.h"

#include <Eigen/Eigenvalues>

#include "bvh/build.h"
#include "bvh/node_boxes.h"
#include "geometry/eigen_vec3.h"
#include "geometry/vec_lanes.h"

namespace meshbound {
namespace {

/// For queries: a point of the mesh lies in 3 boxes on half of 122 shared meshes, in more than 16 on six of them, and
/// in 50 to 1,000 with thousands of needles askew or of large triangles at random. Each oriented box takes a rotation
/// to look at.
constexpr OrientedUse use_for_queries{16, 0.25};

/// Triangles whose middles stand for the points of the mesh.
constexpr std::uint32_t middles = 64;

/// How far the axes of a frame may be from a rotation: Eigen misses it by some 2^-50.
constexpr double rotation_error = 0x1p-42;

/// Half the surface area of a box with these sides.
double half_area(double x, double y, double z) { return x * y + y * z + z * x; }

/// Half the surface area of the boxes of all children of a node together.
double half_area(const BvhNode& node) {
  double sum = 0;
  for (std::uint32_t k = 0; k < node_width; ++k) {
    const auto size = [&](int axis) { return double{node.hi[axis][k]} - double{node.lo[axis][k]}; };
    if (size(0) >= 0) sum += half_area(size(0), size(1), size(2));
  }
  return sum;
}

class OrientedBuild {
 public:
  OrientedBuild(const Bvh::Data& data, const OrientedUse& use) : data_(data), use_(use) {}

  std::vector<OrientedNode> run() {
    if (!are_many_boxes_at_points()) return {};
    double aligned = 0, oriented = 0;  // half the areas of the boxes of blocks
    for (std::uint32_t i = data_.level_begin[1]; i < data_.level_begin[2]; ++i) aligned += half_area(data_.nodes[i]);
    nodes_.reserve(data_.nodes.size());
    add_level(1);
    for (const OrientedNode& node : nodes_) oriented += half_area(node.children);
    if (!(oriented < use_.max_share_of_areas * aligned)) return {};
    for (std::uint32_t level = 2; level < data_.levels(); ++level) add_level(level);
    return std::move(nodes_);
  }

 private:
  /// Whether points of the mesh lie in more boxes of blocks than is allowed, in the mean.
  [[nodiscard]] bool are_many_boxes_at_points() const {
    const int allowed = use_.max_boxes_at_point * static_cast<int>(middles);
    int count = 0;
    for (std::uint64_t i = 0; i < middles && count <= allowed; ++i) {
      const auto& [a, b, c] = data_.corners[i * data_.triangle_count() / middles];
      count_boxes_at((1.0 / 3) * (data_.vertices[a] + data_.vertices[b] + data_.vertices[c]), data_.levels() - 1, 0,
                     allowed, count);
    }
    return count > allowed;
  }
  /// Adds the boxes of blocks below a node that hold a point to `count`, until it is more than allowed.
  void count_boxes_at(const Vec3& p, std::uint32_t level, std::uint32_t index, int allowed, int& count) const {
    const BvhNode& node = data_.nodes[data_.level_begin[level] + index];
    for (std::uint32_t k = 0; k < node_width && count <= allowed; ++k) {
      const auto holds = [&](int axis, double at) { return node.lo[axis][k] <= at && at <= node.hi[axis][k]; };
      if (!holds(0, p.x) || !holds(1, p.y) || !holds(2, p.z)) continue;
      if (level == 1)
        ++count;
      else
        count_boxes_at(p, level - 1, index * node_width + k, allowed, count);
    }
  }

  void add_level(std::uint32_t level) {
    const std::uint32_t count = data_.level_begin[level + 1] - data_.level_begin[level];
    for (std::uint32_t i = 0; i < count; ++i) {
      OrientedNode node = frame_along(level, i);
      for (std::uint32_t k = 0; k < node_width; ++k) set_box(node, k, level - 1, i * node_width + k);
      nodes_.push_back(node);
    }
  }

  /// Calls `on_corner` for each corner of the triangles below a node or in a block, or of every so many of them.
  template <class OnCorner>
  void for_each_corner(std::uint32_t level, std::uint32_t index, std::uint32_t step, const OnCorner& on_corner) const {
    const auto [begin, end] = slots_below(data_, level, index);
    for (std::uint32_t slot = begin; slot < end; slot += step)
      for (const std::uint32_t v : data_.corners[slot]) on_corner(data_.vertices[v]);
  }

  /// A node without boxes: its axes are those in which the corners below it are spread. As many triangles as the lowest
  /// nodes have tell.
  [[nodiscard]] OrientedNode frame_along(std::uint32_t level, std::uint32_t index) const {
    const std::uint32_t step = 1U << (3 * (level - 1));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for_each_corner(level, index, step, [&](const Vec3& p) { sum += to_eigen(p), ++count; });
    const Eigen::Vector3d mean = sum / count;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for_each_corner(level, index, step, [&](const Vec3& p) {
      const Eigen::Vector3d from_mean = to_eigen(p) - mean;
      spread += from_mean * from_mean.transpose();
    });
    Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
    if (!((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm() < rotation_error)) axes.setIdentity();
    return {to_vec3(mean), {to_vec3(axes.col(0)), to_vec3(axes.col(1)), to_vec3(axes.col(2))}, {}};
  }

  /// The box of child k, which is a node or a block of the level.
  void set_box(OrientedNode& node, std::uint32_t k, std::uint32_t level, std::uint32_t index) const {
    Box box;
    for_each_corner(level, index, 1, [&](const Vec3& p) { extend(box, in_frame_of(node, p)); });
    if (box.lo.x > box.hi.x) return set_empty(node.children, k);
    constexpr double rounding = 0x1p-48;  // corners are less than 4 from the centre
    const Double4 room = broadcast4(rounding);
    set_child(node.children, k, coordinates(box.lo) - room, coordinates(box.hi) + room);
  }

  const Bvh::Data& data_;
  const OrientedUse use_;
  std::vector<OrientedNode> nodes_;
};

}  // namespace

std::vector<OrientedNode> oriented_nodes(const Bvh::Data& data, const OrientedUse& use) {
  return OrientedBuild(data, use).run();
}

void make_oriented_nodes(const Bvh::Data& data) {
  const std::scoped_lock lock(data.oriented.making);
  if (data.oriented.made.load(std::memory_order_relaxed)) return;
  data.oriented.nodes = oriented_nodes(data, use_for_queries);
  data.oriented.made.store(true, std::memory_order_release);
}

}  // namespace meshbound
