// SPDX-License-Identifier: MIT
/// Meshes of known shape at any resolution: inputs of tests and benchmarks, and what the tools run on where no data set
/// can be had. All lengths are in model units. Every function is pure and safe to call from many threads, takes time
/// and memory in proportion to the faces it makes, and throws `InvalidInput` for a length that is not positive and
/// finite or a count below the smallest that gives the shape. Outward faces are counter-clockwise.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "meshbound/triangle_mesh.h"

namespace meshbound::datasets {

/// Icosahedron cut `level` times, each triangle into four: 20 * 4^level faces, vertices on the sphere up to rounding.
/// Closed. `level` from 0 to 12.
[[nodiscard]] TriangleMesh icosphere(double radius, int level);

/// Meridians and parallels: 2 * segments * (rings - 1) faces, long thin ones at the poles. Closed. `rings` at least 2,
/// `segments` at least 3.
[[nodiscard]] TriangleMesh uv_sphere(double radius, std::size_t rings, std::size_t segments);

/// Around the z axis; 2 * around * across faces. Closed. `tube_radius` below `radius`, both counts at least 3.
[[nodiscard]] TriangleMesh torus(double radius, double tube_radius, std::size_t around, std::size_t across);

/// The surface of [0,size.x] x [0,size.y] x [0,size.z], each side a grid; cells of both directions of a side are cut
/// into two triangles. 4 * (x*y + y*z + z*x) faces for counts x, y, z. Closed. Counts at least 1.
[[nodiscard]] TriangleMesh box(const Eigen::Vector3d& size, const std::array<std::uint32_t, 3>& cells);

/// A cube of cells x cells squares a side: 12 * cells^2 faces. Closed.
[[nodiscard]] TriangleMesh cube(double side, std::uint32_t cells);

/// Two parallel grids `thickness` apart, closed by a wall one cell high: 4 * cells^2 + 8 * cells faces. Closed. With a
/// tolerance above the thickness a checker must not take one sheet for the other's inside.
[[nodiscard]] TriangleMesh thin_sheet(double side, double thickness, std::uint32_t cells);

/// The square [0,side]^2 at z = 0 with a grid of cells x cells squares; every `spacing`-th inner vertex of both
/// directions is raised to `height`. 2 * cells^2 faces, open. Its one-sided distance to the flat square is `height`.
[[nodiscard]] TriangleMesh spiked_plane(double side, double height, std::size_t cells, std::size_t spacing);

/// About the z axis, from z = 0 to `height`: a wall one cell high between two caps, each a fan of `segments` triangles
/// around one vertex, as CAD programs write them. 4 * segments faces. Closed. `segments` at least 3.
[[nodiscard]] TriangleMesh cylinder(double radius, double height, std::size_t segments);

/// An involute-like spur gear about the z axis, from z = 0 to `width`: outer radius `radius`, tooth depth radius / 8.
/// 2 * m * (layers + 1) faces with m = teeth * points_per_tooth. Closed. At least 3 teeth, 4 points and 1 layer.
[[nodiscard]] TriangleMesh gear(double radius, double width, std::size_t teeth, std::size_t points_per_tooth,
                                std::size_t layers);

/// Fractal value noise over [0,side]^2, heights from 0 to about side / 4: 2 * cells^2 faces, open. Integer hashing and
/// the four basic operations only, so the same seed gives the same bits on every machine.
[[nodiscard]] TriangleMesh terrain(double side, std::size_t cells, std::uint64_t seed);

/// A shape that `mesh_of_size` makes.
struct Kind {
  std::string_view name, description;
};
[[nodiscard]] std::span<const Kind> kinds();

/// "icosphere, uv-sphere, ..."
[[nodiscard]] std::string kind_names();

/// The shape `kind` at unit size with about `faces` triangles: never more, and at least half as many (icosphere: a
/// quarter), for `faces` of 1,000 or more. Throws `InvalidInput` for an unknown kind or fewer than 1,000 faces.
[[nodiscard]] TriangleMesh mesh_of_size(std::string_view kind, std::size_t faces);

}  // namespace meshbound::datasets
