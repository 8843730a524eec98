// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bvh/bvh_data.h"
#include "geometry/vec3.h"
#include "meshbound/penetration_depth.h"

namespace meshbound {

/// An edge with its two triangles: the first runs from `from` to `to`, the second back.
struct ModelEdge {
  std::uint32_t from = 0, to = 0;
  std::array<std::uint32_t, 2> triangle{};
};

/// Triangles that are connected across edges.
struct ModelComponent {
  std::uint32_t triangle = 0;             ///< its first one
  std::array<std::uint32_t, 6> extremes;  ///< vertices with the least x, y, z and the largest x, y, z
};

struct ClosedModel::Data {
  explicit Data(Bvh&& model_tree) : tree(std::move(model_tree)) {}

  Bvh tree;                                            ///< over `triangles`, which its slots lead to
  std::vector<Vec3> positions;                         ///< of vertices, all different; model units
  std::vector<Triangle> triangles;                     ///< none repeats a vertex
  std::vector<std::uint32_t> source_triangle;          ///< by triangle: its index in the mesh as it was given
  std::vector<std::array<std::uint32_t, 3>> edges_of;  ///< by triangle: [k] runs from corner k to corner k + 1
  std::vector<ModelEdge> edges;                        ///< by edge
  std::vector<std::uint32_t> component_of;             ///< by triangle
  std::vector<std::uint32_t> plane_of;                 ///< by triangle: equal numbers lie in one plane (model_planes.h)
  std::vector<ModelComponent> components;              ///< by component
  std::size_t given_triangles = 0;                     ///< of the mesh as it was given
  int lowest_bit = 0;                                  ///< every coordinate is a multiple of 2^lowest_bit
  double reach = 0;                                    ///< largest magnitude of a coordinate, model units

  /// The triangle across edge k of a triangle.
  [[nodiscard]] std::uint32_t across(std::uint32_t triangle, std::size_t k) const {
    const ModelEdge& edge = edges[edges_of[triangle][k]];
    return edge.triangle[0] == triangle ? edge.triangle[1] : edge.triangle[0];
  }
  /// Whether both triangles of an edge lie in one plane.
  [[nodiscard]] bool is_within_plane(const ModelEdge& edge) const {
    return plane_of[edge.triangle[0]] == plane_of[edge.triangle[1]];
  }
};

inline constexpr std::size_t next_corner(std::size_t k) { return k == 2 ? 0 : k + 1; }

}  // namespace meshbound
