// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "bvh/build.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// At least one step of a float: 2^-23 of it, or the least normal number.
float step(float f) { return std::fabs(f) * 0x1p-23F + std::numeric_limits<float>::min(); }

/// Rounded outward by at most two steps, without a branch, which would be guessed wrong half the time.
float round_down(double x) {
  const auto f = static_cast<float>(x);
  return f - (static_cast<double>(f) > x ? step(f) : 0.0F);
}

float round_up(double x) {
  const auto f = static_cast<float>(x);
  return f + (static_cast<double>(f) < x ? step(f) : 0.0F);
}

void extend(Box& box, const Vec3& p) {
  box.lo = {std::min(box.lo.x, p.x), std::min(box.lo.y, p.y), std::min(box.lo.z, p.z)};
  box.hi = {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y), std::max(box.hi.z, p.z)};
}

void set_child(BvhNode& node, std::uint32_t child, const Box& box) {
  const double lo[3] = {box.lo.x, box.lo.y, box.lo.z}, hi[3] = {box.hi.x, box.hi.y, box.hi.z};
  for (int axis = 0; axis < 3; ++axis) {
    node.lo[axis][child] = round_down(lo[axis]);
    node.hi[axis][child] = round_up(hi[axis]);
  }
}

void set_empty(BvhNode& node, std::uint32_t child) {
  for (int axis = 0; axis < 3; ++axis) {
    node.lo[axis][child] = infinity;
    node.hi[axis][child] = -infinity;
  }
}

Box block_box(const Bvh::Data& data, std::uint32_t block) {
  Box box;
  const std::uint32_t end = std::min(data.triangle_count(), (block + 1) * block_width);
  for (std::uint32_t slot = block * block_width; slot < end; ++slot)
    for (const std::uint32_t v : data.corners[slot]) extend(box, data.vertices[v]);
  return box;
}

/// Number of nodes of each level, blocks first, up to the level with a single one.
std::vector<std::uint32_t> level_sizes(std::uint32_t blocks) {
  std::vector<std::uint32_t> sizes{blocks};
  do {
    sizes.push_back((sizes.back() + node_width - 1) / node_width);
  } while (sizes.back() > 1);
  return sizes;
}

/// Node `index` of a level, from the `below` members of the level below.
void build_node(Bvh::Data& data, std::uint32_t level, std::uint32_t index, std::uint32_t below) {
  BvhNode& node = data.nodes[data.level_begin[level] + index];
  for (std::uint32_t k = 0; k < node_width; ++k) {
    const std::uint32_t child = index * node_width + k;
    if (child >= below)
      set_empty(node, k);
    else
      set_child(node, k, level == 1 ? block_box(data, child) : node_box(data, level - 1, child));
  }
}

/// A node of the lowest level is the work of so many triangles.
constexpr std::size_t nodes_per_task = triangles_per_task / (block_width * node_width);

}  // namespace

void build_normals(Bvh::Data& data) {
  data.normals.resize(data.triangle_count());
  for_each_range(data.triangle_count(), triangles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const Triangle& t = data.corners[slot];
      const Vec3 a = data.vertices[t[0]], ab = data.vertices[t[1]] - a, ac = data.vertices[t[2]] - a;
      const Vec3 normal = cross(ab, ac);
      const double norm = length(normal), scale = norm > 0 ? 1 / norm : 0;
      data.normals[slot] = {static_cast<float>(normal.x * scale), static_cast<float>(normal.y * scale),
                            static_cast<float>(normal.z * scale)};
    }
  });
}

void build_nodes(Bvh::Data& data) {
  const std::vector<std::uint32_t> sizes = level_sizes(data.block_count());
  data.level_begin.assign(1, 0);
  data.level_begin.push_back(0);  // level 0 has no nodes: its members are the blocks
  for (std::size_t level = 1; level < sizes.size(); ++level)
    data.level_begin.push_back(data.level_begin.back() + sizes[level]);
  data.nodes.resize(data.level_begin.back());
  for (std::uint32_t level = 1; level < sizes.size(); ++level) {
    for_each_range(sizes[level], nodes_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        build_node(data, level, static_cast<std::uint32_t>(i), sizes[level - 1]);
    });
  }
}

Box node_box(const Bvh::Data& data, std::uint32_t level, std::uint32_t index) {
  if (level == 0) return block_box(data, index);
  const BvhNode& node = data.nodes[data.level_begin[level] + index];
  Box box;
  for (std::uint32_t k = 0; k < node_width; ++k) {
    if (node.lo[0][k] > node.hi[0][k]) continue;
    extend(box, {node.lo[0][k], node.lo[1][k], node.lo[2][k]});
    extend(box, {node.hi[0][k], node.hi[1][k], node.hi[2][k]});
  }
  return box;
}

std::pair<std::uint32_t, std::uint32_t> slots_below(const Bvh::Data& data, std::uint32_t level, std::uint32_t index) {
  const std::uint64_t size = std::uint64_t{block_width} << (3 * level);
  const std::uint64_t n = data.triangle_count();
  return {static_cast<std::uint32_t>(std::min(n, index * size)),
          static_cast<std::uint32_t>(std::min(n, (index + 1) * size))};
}

}  // namespace meshbound
