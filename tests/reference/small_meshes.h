// SPDX-License-Identifier: MIT
/// Meshes small enough to reason about. Named builders, so that a test reads as the sentence it proves.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "meshbound/triangle_mesh.h"

namespace meshbound::reference {

/// Triangles with vertices of their own.
[[nodiscard]] TriangleMesh soup(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles);
[[nodiscard]] TriangleMesh single_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                           const Eigen::Vector3d& c);

/// [0,1]^2 x {0} in n x n squares of two triangles each.
[[nodiscard]] TriangleMesh unit_square(int n);

/// A disc of radius 1, `n` triangles around one vertex, which is the last.
[[nodiscard]] TriangleMesh fan(std::uint32_t n);

/// The wall of a tube of radius 1 and length 20 whose axis is askew to all coordinates: 2 n needles.
[[nodiscard]] TriangleMesh needles(std::uint32_t n);

/// The surface of [-half, half]^3, 12 triangles.
[[nodiscard]] TriangleMesh cube(double half);

/// Icosahedron split `levels` times, vertices on the unit sphere up to rounding.
[[nodiscard]] TriangleMesh icosphere(int levels);

/// Distance from the centre to the nearest point of a mesh whose vertices lie on the unit sphere around it: the
/// smallest height of its face planes, up to rounding. All its points lie between this radius and 1.
[[nodiscard]] double inscribed_radius(const TriangleMesh& mesh);

/// Every triangle into four by its edge midpoints.
[[nodiscard]] TriangleMesh subdivided(const TriangleMesh& mesh);

[[nodiscard]] TriangleMesh scaled(TriangleMesh mesh, double factor);
[[nodiscard]] TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by);
[[nodiscard]] TriangleMesh both(TriangleMesh a, const TriangleMesh& b);

/// `count` triangles of about the given size around random points of the unit cube; the same for the same seed.
[[nodiscard]] TriangleMesh random_soup(std::uint32_t seed, int count, double size);

}  // namespace meshbound::reference
