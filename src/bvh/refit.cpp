// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>

#include "bvh/build.h"
#include "geometry/longest_edge.h"
#include "meshbound/error.h"
#include "numeric/rounding.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

template <class T>
std::array<T, 3> rotated(const std::array<T, 3>& x, std::uint32_t by) {
  return {x[by], x[(by + 1) % 3], x[(by + 2) % 3]};
}

constexpr std::uint8_t no_turn = 3;

/// By how many corners the tree has rotated a triangle of the mesh (`longest_edge`); trees never mirror them.
std::uint8_t turn_of(const Bvh::Data& data, std::uint32_t slot, const Triangle& in_mesh) {
  const Triangle& t = data.corners[slot];
  const Triangle in_tree{data.source_vertex[t[0]], data.source_vertex[t[1]], data.source_vertex[t[2]]};
  for (std::uint8_t by = 0; by < no_turn; ++by)
    if (in_tree == rotated(in_mesh, by)) return by;
  return no_turn;
}

/// `turn_of` for each slot. Throws `InvalidInput` when a triangle is another one than in the tree.
std::vector<std::uint8_t> turns(const Bvh::Data& data, const MeshView& moved) {
  if (moved.triangle_count() != data.triangle_count())
    throw InvalidInput("a mesh of " + std::to_string(moved.triangle_count()) + " triangles cannot refit a tree of " +
                       std::to_string(data.triangle_count()) + "; build a new tree");
  std::vector<std::uint8_t> result(data.triangle_count());
  for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
    const std::uint32_t triangle = data.triangle_of_slot[slot];
    result[slot] = turn_of(data, slot, moved.triangle(triangle));
    if (result[slot] == no_turn)
      throw InvalidInput("triangle " + std::to_string(triangle) +
                         " has other vertices than in the tree; only vertices may move, build a new tree");
  }
  return result;
}

/// Box of the vertices that the tree uses. Throws as `validate`, which reads every triangle, only looks where a vertex
/// is missing or cannot be used, for the sake of its message.
Eigen::AlignedBox3d box_of(const Bvh::Data& data, const MeshView& moved) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t v : data.source_vertex) {
    if (v >= moved.vertex_count() || !(moved.vertex(v).cwiseAbs().maxCoeff() <= largest_coordinate) ||
        !moved.vertex(v).allFinite())
      validate(moved);
    box.extend(moved.vertex(v));
  }
  return box;
}

void move_vertices(Bvh::Data& data, const MeshView& moved) {
  const Frame frame = data.frame;
  const FrameMap to_working(frame);
  const std::size_t n = data.source_vertex.size();
  data.vertices.resize(n);
  std::vector<double> errors(n / triangles_per_task + 1, 0);  // by task
  for_each_range(n, triangles_per_task, [&](std::size_t begin, std::size_t end) {
    double error = 0;
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Vector3d p = moved.vertex(data.source_vertex[v]);
      data.vertices[v] = to_working({p.x(), p.y(), p.z()});
      error = std::max(error, frame.rounding_of({p.x(), p.y(), p.z()}));
    }
    errors[begin / triangles_per_task] = error;
  });
  data.frame.error = *std::max_element(errors.begin(), errors.end());
}

/// Rotates the corners of each triangle as a build would: its longest edge first, ties by the order in the mesh.
void turn_triangles(Bvh::Data& data, const std::vector<std::uint8_t>& turned) {
  for_each_range(data.triangle_count(), triangles_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const std::uint32_t back = no_turn - turned[slot];
      const Triangle t = rotated(data.corners[slot], back % 3);
      const std::uint32_t first = longest_edge(data.vertices[t[0]], data.vertices[t[1]], data.vertices[t[2]]);
      data.corners[slot] = rotated(t, first);
      data.neighbours[slot] = rotated(data.neighbours[slot], (back + first) % 3);
    }
  });
}

/// What a query on the surface costs, relatively: the sum of the squared diagonals of all boxes divided by that of the
/// whole box, since the chance that a query opens a box grows with its extent in the two directions of the surface. 1
/// for a mesh that is a point.
double tree_cost(const Bvh::Data& data) {
  const double whole = squared_length(data.working_box.hi - data.working_box.lo);
  if (!(whole > 0)) return 1;
  double sum = 0;
  for (const BvhNode& node : data.nodes) {
    for (std::uint32_t k = 0; k < node_width; ++k) {
      if (node.lo[0][k] > node.hi[0][k]) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double size = static_cast<double>(node.hi[axis][k]) - static_cast<double>(node.lo[axis][k]);
        sum += size * size;
      }
    }
  }
  return sum / whole;
}

}  // namespace

void Bvh::refit(const MeshView& moved, const BvhOptions& options) {
  check_floating_point_model();
  const std::vector<std::uint8_t> turned = turns(*data_, moved);
  auto next = std::make_unique<Data>();
  set_frame(*next, box_of(*data_, moved));
  next->built_cost = data_->built_cost > 0 ? data_->built_cost : tree_cost(*data_);
  next->source_vertex = data_->source_vertex;
  next->corners = data_->corners;
  next->neighbours = data_->neighbours;
  next->triangle_of_slot = data_->triangle_of_slot;
  with_team(static_cast<int>(useful_threads(options.threads, moved.triangle_count())), [&] {
    move_vertices(*next, moved);
    turn_triangles(*next, turned);
    build_nodes_and_normals(*next);
  });
  data_ = std::move(next);
}

double Bvh::growth() const { return data_->built_cost > 0 ? tree_cost(*data_) / data_->built_cost : 1; }

}  // namespace meshbound
