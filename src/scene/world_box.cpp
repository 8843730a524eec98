// SPDX-License-Identifier: MIT
#include "scene/world_box.h"

#include <algorithm>
#include <array>
#include <limits>

#include "bvh/build.h"
#include "geometry/mapping.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// Finds the largest dot product of `direction` with a vertex of a tree, depth first; nodes that cannot hold it are
/// skipped.
class FarthestVertex {
 public:
  FarthestVertex(const Bvh::Data& tree, const Vec3& direction) : tree_(tree), direction_(direction) {}

  double find() {
    visit(tree_.levels() - 1, 0);
    return best_;
  }

 private:
  /// The largest dot product over a box.
  [[nodiscard]] double bound(const Box& box) const {
    const Vec3 corner{direction_.x > 0 ? box.hi.x : box.lo.x, direction_.y > 0 ? box.hi.y : box.lo.y,
                      direction_.z > 0 ? box.hi.z : box.lo.z};
    return dot(direction_, corner);
  }

  void visit(std::uint32_t level, std::uint32_t index) {
    if (!(bound(node_box(tree_, level, index)) > best_)) return;
    const auto [begin, end] = slots_below(tree_, level, index);
    if (level == 0) {
      for (std::uint32_t slot = begin; slot < end; ++slot)
        for (const std::uint32_t v : tree_.corners[slot]) best_ = std::max(best_, dot(direction_, tree_.vertices[v]));
      return;
    }
    for (std::uint32_t child = index * node_width; child < (index + 1) * node_width; ++child) {
      const auto [first, last] = slots_below(tree_, level - 1, child);
      if (first == last) break;
      visit(level - 1, child);
    }
  }

  const Bvh::Data& tree_;
  Vec3 direction_;
  double best_ = -std::numeric_limits<double>::infinity();
};

constexpr std::array axes = {&Vec3::x, &Vec3::y, &Vec3::z};

/// A difference of coordinates, rounded down by the errors of both boxes.
double certain(double difference, const WorldBox& a, const WorldBox& b) {
  return next_down(next_down(difference) - next_up(a.error + b.error));
}

}  // namespace

WorldBox world_box(const PlacedModel& model) {
  const Bvh::Data& tree = model.bvh->data();
  const Mapping map = mapping_between(tree.frame, model.pose, Frame{}, Pose::Identity());
  WorldBox box;
  const std::array offset = {map.translation.x, map.translation.y, map.translation.z};
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo.*axes[k] = offset[k] - FarthestVertex(tree, -1.0 * map.rows[k]).find();
    box.hi.*axes[k] = offset[k] + FarthestVertex(tree, map.rows[k]).find();
  }
  // Rounding of a dot product and a sum with terms of at most this magnitude, and of the bounds by which nodes were
  // skipped.
  const double scale = length(map.rows[0]);
  box.error = next_up(map.error + tree.frame.error * scale * 2 + 32 * unit_roundoff * map.magnitude);
  return box;
}

double distance_at_least(const WorldBox& a, const WorldBox& b) {
  double largest = 0;
  for (double Vec3::*axis : axes) {
    largest = std::max(largest, certain(std::fabs(a.lo.*axis - b.lo.*axis), a, b));
    largest = std::max(largest, certain(std::fabs(a.hi.*axis - b.hi.*axis), a, b));
  }
  return largest;
}

bool may_be_near(const WorldBox& a, const WorldBox& b, double margin) {
  return std::all_of(axes.begin(), axes.end(), [&](double Vec3::*axis) {
    return !(certain(std::max(a.lo.*axis - b.hi.*axis, b.lo.*axis - a.hi.*axis), a, b) > margin);
  });
}

}  // namespace meshbound
