// SPDX-License-Identifier: MIT
#include "penetration/nodes_apart.h"

#include <algorithm>
#include <cmath>

#include "bvh/build.h"
#include "bvh/oriented_nodes.h"
#include "geometry/unit.h"
#include "numeric/no_index.h"
#include "penetration/contact.h"

namespace meshbound {
namespace {

/// A vertex with more triangles is a hub: fewer make some two thousand pairs, which take less than a millisecond.
constexpr std::uint32_t max_triangles_at_vertex = 64;

/// More is at stake than for queries, as a pair takes longer to decide than a triangle of a query. Of 122 shared meshes
/// of 1,000 to 400,000 triangles 14 have points in more than 8 boxes.
constexpr OrientedUse use_for_pairs{8, 0.5};

/// Rotations of oriented boxes miss by 2^-42, coordinates by less than 2^-48, both of at most 4; what is computed from
/// them here is off by less than 2^-44.
constexpr double rounding_of_boxes = 0x1p-36;

/// More than the roundings of a direction, which are some 2^-50.
constexpr double rounding_of_directions = 0x1p-46;

std::vector<std::uint32_t> triangles_at_vertices(const ClosedModel::Data& model) {
  std::vector<std::uint32_t> count(model.positions.size(), 0);
  for (const Triangle& t : model.triangles)
    for (const std::uint32_t v : t) ++count[v];
  return count;
}

void unite(Box& box, const Box& other) {
  extend(box, other.lo);
  extend(box, other.hi);
}

/// Around the arc between two directions as seen from a point. It is the image of the straight line between their
/// ends, which it leaves by no more than that line is inside the sphere: 1 - |a + b| / 2.
Box box_of_arc(const Vec3& from, const Vec3& p, const Vec3& q) {
  const Vec3 a = unit(p - from), b = unit(q - from);
  const double room = 1 - 0.5 * length(a + b) + rounding_of_directions;
  Box box;
  extend(box, a);
  extend(box, b);
  const Vec3 grown{room, room, room};
  return {box.lo - grown, box.hi + grown};
}

/// Whether the direction of a way is accurate: the square of a longer or shorter one may be no normal number.
bool has_direction(const Vec3& way) {
  const double size = length(way);
  return size > least_accurate_length && size < 1 / least_accurate_length;
}

/// The box of a node in the frame of the node above it.
struct PlacedBox {
  const OrientedNode& frame;
  Vec3 middle, half;  ///< along the axes of the frame
  Vec3 centre;        ///< in the frame of the tree
};

PlacedBox placed_box(const Bvh::Data& tree, const std::vector<OrientedNode>& nodes, std::uint32_t level,
                     std::uint32_t index) {
  const OrientedNode& above = nodes[tree.level_begin[level + 1] + index / node_width];
  const Box box = child_box(above.children, index % node_width);
  const Vec3 middle = 0.5 * (box.lo + box.hi);
  const Vec3 centre = above.centre + middle.x * above.axes[0] + middle.y * above.axes[1] + middle.z * above.axes[2];
  return {above, middle, 0.5 * (box.hi - box.lo), centre};
}

/// Whether a plane across an axis of p's frame has the boxes on different sides, by this margin.
bool separates(const PlacedBox& p, const PlacedBox& q, double margin) {
  const Vec3 way = q.centre - p.frame.centre;
  for (int k = 0; k < 3; ++k) {
    const Vec3& axis = p.frame.axes[static_cast<std::size_t>(k)];
    const double reach = std::fabs(dot(axis, q.frame.axes[0])) * q.half.x +
                         std::fabs(dot(axis, q.frame.axes[1])) * q.half.y +
                         std::fabs(dot(axis, q.frame.axes[2])) * q.half.z;
    if (std::fabs(dot(axis, way) - coordinate(p.middle, k)) > coordinate(p.half, k) + reach + margin) return true;
  }
  return false;
}

}  // namespace

NodesApart::NodesApart(const ClosedModel::Data& model)
    : model_(model),
      tree_(model.tree.data()),
      oriented_(oriented_nodes(tree_, use_for_pairs)),
      margin_(rounding_of_boxes + 4 * tree_.frame.error) {
  make_fans();
}

void NodesApart::make_fans() {
  const std::vector<std::uint32_t> triangles_at = triangles_at_vertices(model_);
  if (*std::max_element(triangles_at.begin(), triangles_at.end()) <= max_triangles_at_vertex) return;
  std::vector<Fan>& blocks = fans_.emplace_back();
  for (std::uint32_t block = 0; block < tree_.block_count(); ++block)
    blocks.push_back(fan_of_block(block, triangles_at));
  for (std::uint32_t level = 1; level < tree_.levels(); ++level) {
    const std::vector<Fan>& below = fans_.back();
    std::vector<Fan> fans((below.size() + node_width - 1) / node_width);
    for (std::size_t i = 0; i < below.size(); ++i) {
      Fan& fan = fans[i / node_width];
      if (i % node_width == 0) fan = below[i];
      if (below[i].hub != fan.hub) fan.hub = no_index;
      unite(fan.arcs, below[i].arcs);
    }
    fans_.push_back(std::move(fans));
  }
}

NodesApart::Fan NodesApart::fan_of_block(std::uint32_t block, const std::vector<std::uint32_t>& triangles_at) const {
  const auto [begin, end] = slots_below(tree_, 0, block);
  const auto triangle = [&](std::uint32_t slot) -> const Triangle& {
    return model_.triangles[tree_.triangle_of_slot[slot]];
  };
  Fan fan;
  for (const std::uint32_t v : triangle(begin))
    if (triangles_at[v] > max_triangles_at_vertex) fan.hub = v;
  for (std::uint32_t slot = begin; slot < end && fan.hub != no_index; ++slot) {
    Triangle t = triangle(slot);
    const auto at = std::find(t.begin(), t.end(), fan.hub);
    if (at == t.end()) return {};
    std::rotate(t.begin(), at, t.end());
    const Vec3 &from = model_.positions[t[0]], &p = model_.positions[t[1]], &q = model_.positions[t[2]];
    if (!has_direction(p - from) || !has_direction(q - from)) return {};
    unite(fan.arcs, box_of_arc(from, p, q));
  }
  return fan;
}

bool NodesApart::are_fans_apart(const NodePair& pair) const {
  const Fan &a = fans_[pair.level_a][pair.a], &b = fans_[pair.level_b][pair.b];
  return a.hub != no_index && a.hub == b.hub && !boxes_meet(a.arcs, b.arcs);
}

bool NodesApart::are_boxes_apart(const NodePair& pair) const {
  if (std::max(pair.level_a, pair.level_b) + 1 >= tree_.levels()) return false;
  const PlacedBox p = placed_box(tree_, oriented_, pair.level_a, pair.a),
                  q = placed_box(tree_, oriented_, pair.level_b, pair.b);
  return separates(p, q, margin_) || separates(q, p, margin_);
}

}  // namespace meshbound
