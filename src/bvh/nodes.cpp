// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>

#include "bvh/build.h"
#include "bvh/build_kernels.h"
#include "bvh/nearest.h"
#include "bvh/node_boxes.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

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

/// Node `index` of a level above the lowest, from the `below` members of the level below.
void build_node(Bvh::Data& data, std::uint32_t level, std::uint32_t index, std::uint32_t below) {
  BvhNode& node = data.nodes[data.level_begin[level] + index];
  for (std::uint32_t k = 0; k < node_width; ++k) {
    const std::uint32_t child = index * node_width + k;
    if (child >= below) {
      set_empty(node, k);
      continue;
    }
    const Box box = node_box(data, level - 1, child);
    set_child(node, k, coordinates(box.lo), coordinates(box.hi));
  }
}

/// A node of the lowest level is the work of so many triangles.
constexpr std::size_t nodes_per_task = triangles_per_task / (block_width * node_width);

}  // namespace

bool build_nodes_and_normals(Bvh::Data& data) {
  const std::vector<std::uint32_t> sizes = level_sizes(data.block_count());
  data.level_begin.assign(1, 0);
  data.level_begin.push_back(0);  // level 0 has no nodes: its members are the blocks
  for (std::size_t level = 1; level < sizes.size(); ++level)
    data.level_begin.push_back(data.level_begin.back() + sizes[level]);
  data.nodes.resize(data.level_begin.back());
  data.normals.resize(data.triangle_count());
  const BuildKernels kernels = build_kernels();
  std::atomic<bool> all_have_area{true};
  for_each_range(sizes[1], nodes_per_task, [&](std::size_t begin, std::size_t end) {
    if (!kernels.build_leaves(data, begin, end)) all_have_area = false;
  });
  for (std::uint32_t level = 2; level < sizes.size(); ++level) {
    for_each_range(sizes[level], nodes_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        build_node(data, level, static_cast<std::uint32_t>(i), sizes[level - 1]);
    });
  }
  return all_have_area;
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
