// SPDX-License-Identifier: MIT
#include "simplify/cover/slab_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/unit.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

constexpr std::size_t width = SlabBlock::lanes;

struct Node {
  Vec3 centre, normal;
  double radius = 0, half_thickness = 0;
  bool is_closed = true;
};

Node node_of(const OriginalSoup& soup, const OriginalClusters& clusters, std::uint32_t cluster) {
  const std::span vertices = clusters.vertices(cluster);
  Node node;
  for (const std::uint32_t v : vertices) node.centre = node.centre + soup.vertices[v];
  node.centre = (1.0 / static_cast<double>(vertices.size())) * node.centre;
  std::uint32_t t = cluster * OriginalClusters::size;
  for (const OriginalClusters::Corners& corners : clusters.triangles(cluster)) {
    const auto at = [&](std::size_t k) { return soup.vertices[vertices[corners[k]]]; };
    node.normal = node.normal + cross(at(1) - at(0), at(2) - at(0));
    for (std::size_t k = 0; k < 3; ++k)
      if (soup.neighbour(t, k) == no_index) node.is_closed = false;
    ++t;
  }
  node.normal = unit(node.normal);
  double squared_radius = 0;
  for (const std::uint32_t v : vertices) {
    const Vec3 offset = soup.vertices[v] - node.centre;
    squared_radius = std::max(squared_radius, squared_length(offset));
    node.half_thickness = std::max(node.half_thickness, std::abs(dot(offset, node.normal)));
  }
  node.radius = std::sqrt(squared_radius);
  return node;
}

/// How far a node reaches at most from its centre along a direction of unit length, to both sides.
double extent(const Node& node, Vec3 direction) {
  const double cosine = dot(direction, node.normal);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine) + squared_sine_error);
  return std::min(node.radius, node.radius * sine + node.half_thickness);
}

Node parent_of(std::span<const Node> children) {
  Node node;
  for (const Node& child : children) {
    node.centre = node.centre + child.centre;
    node.normal = node.normal + child.normal;
    node.is_closed &= child.is_closed;
  }
  node.centre = (1.0 / static_cast<double>(children.size())) * node.centre;
  node.normal = unit(node.normal);
  for (const Node& child : children) {
    const Vec3 offset = child.centre - node.centre;
    node.radius = std::max(node.radius, length(offset) + child.radius);
    node.half_thickness =
        std::max(node.half_thickness, std::abs(dot(offset, node.normal)) + extent(child, node.normal));
  }
  return node;
}

SlabTree::Block block_of(std::span<const Node> nodes) {
  SlabTree::Block block{};
  SlabBlock& slabs = block.slabs;
  std::fill_n(slabs.radius, SlabBlock::lanes, -std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Node& node = nodes[k];
    slabs.x[k] = node.centre.x, slabs.y[k] = node.centre.y, slabs.z[k] = node.centre.z;
    slabs.normal_x[k] = node.normal.x, slabs.normal_y[k] = node.normal.y, slabs.normal_z[k] = node.normal.z;
    slabs.radius[k] = node.radius, slabs.half_thickness[k] = node.half_thickness;
    block.is_closed |= (node.is_closed ? 1U : 0U) << k;
  }
  return block;
}

struct Leaf {
  Vec3 centre;
  std::uint32_t cluster;
};

double Vec3::*longest_axis(std::span<const Leaf> leaves) {
  Vec3 low = leaves.front().centre, high = low;
  for (const Leaf& leaf : leaves) {
    const Vec3 p = leaf.centre;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 size = high - low;
  if (size.x >= size.y && size.x >= size.z) return &Vec3::x;
  return size.y >= size.z ? &Vec3::y : &Vec3::z;
}

/// Halves leaves where they are furthest apart, and the halves in turn, down to the blocks of a tree. A curve leaves a
/// surface and comes back: nodes of clusters that follow one another would be twice as wide.
void arrange(std::span<Leaf> leaves) {
  if (leaves.size() <= width) return;
  std::size_t child = width;  // leaves of a child of the node that these make up
  while (child * width < leaves.size()) child *= width;
  const std::size_t half = (leaves.size() + child - 1) / child / 2 * child;
  std::nth_element(leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(half), leaves.end(),
                   [axis = longest_axis(leaves)](const Leaf& a, const Leaf& b) {
                     return std::pair(a.centre.*axis, a.cluster) < std::pair(b.centre.*axis, b.cluster);
                   });
  arrange(leaves.first(half));
  arrange(leaves.subspan(half));
}

/// The nodes in blocks.
std::vector<SlabTree::Block> blocks_of(std::span<const Node> nodes) {
  std::vector<SlabTree::Block> blocks;
  for (std::size_t first = 0; first < nodes.size(); first += width)
    blocks.push_back(block_of(nodes.subspan(first, std::min(width, nodes.size() - first))));
  return blocks;
}

std::vector<Node> parents_of(std::span<const Node> nodes) {
  std::vector<Node> parents;
  for (std::size_t first = 0; first < nodes.size(); first += width)
    parents.push_back(parent_of(nodes.subspan(first, std::min(width, nodes.size() - first))));
  return parents;
}

}  // namespace

SlabTree::SlabTree(const OriginalSoup& soup, const OriginalClusters& clusters) : cluster_of_leaf_(clusters.count()) {
  std::vector<Node> of_clusters(clusters.count());
  std::vector<Leaf> leaves(clusters.count());
  for (std::uint32_t c = 0; c < clusters.count(); ++c) {
    of_clusters[c] = node_of(soup, clusters, c);
    leaves[c] = {of_clusters[c].centre, c};
  }
  arrange(leaves);
  std::vector<Node> nodes(leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    cluster_of_leaf_[i] = leaves[i].cluster;
    nodes[i] = of_clusters[leaves[i].cluster];
  }
  levels_.push_back(blocks_of(nodes));
  while (levels_.back().size() > 1) {
    nodes = parents_of(nodes);
    levels_.push_back(blocks_of(nodes));
  }
}

}  // namespace meshbound
