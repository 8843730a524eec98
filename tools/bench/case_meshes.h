// SPDX-License-Identifier: GPL-3.0-or-later
/// Generated meshes of the kinds that are hard for a search over neighbouring triangles or for the simplifier. Counts
/// are of triangles; the same arguments give the same mesh on every machine.
#pragma once
#include <cstddef>
#include <cstdint>

#include "meshbound/triangle_mesh.h"

namespace meshbound::bench {

/// The mesh with vertices of its own for each triangle.
[[nodiscard]] TriangleMesh unwelded(const TriangleMesh& mesh);

/// The unit square at z = 0, `cells` x `cells` squares of two triangles each.
[[nodiscard]] TriangleMesh flat_square(std::size_t cells);

/// A cone: `count` triangles around its apex, 0.5 above the unit circle.
[[nodiscard]] TriangleMesh fan(std::size_t count);

/// Radius 1, height 4, one row of `sides` quadrilaterals, closed by two fans of `sides` triangles: 4 * sides.
[[nodiscard]] TriangleMesh capped_cylinder(std::size_t sides);

/// Radius 1, height 4 along z, open at both ends, at most `count` triangles.
[[nodiscard]] TriangleMesh open_cylinder(std::size_t count);

/// `count` triangles of zero area that follow one another along the axis of `open_cylinder`.
[[nodiscard]] TriangleMesh chain_on_axis(std::size_t count);

/// `count` long thin triangles on top of one another along the axis of `open_cylinder`.
[[nodiscard]] TriangleMesh needle_stack(std::size_t count);

/// `count` narrow triangles in random directions that share one vertex.
[[nodiscard]] TriangleMesh star(std::size_t count);

/// `count` triangles around one common edge.
[[nodiscard]] TriangleMesh around_an_edge(std::size_t count);

/// `count` triangles with random corners in [-2,2]^3, vertices of their own.
[[nodiscard]] TriangleMesh large_random_triangles(std::size_t count);

/// `count` triangles with random corners in [-2,2]^2 at this height, every corner moved by up to `shift` within the
/// plane.
[[nodiscard]] TriangleMesh overlapping_layer(std::size_t count, double height, double shift);

/// A closed or open manifold of at most 1,300 triangles, of a random kind, size and roughness, and another one that
/// overlaps it or is a copy with moved vertices. The first has a diagonal of about 1.
struct MeshPair {
  TriangleMesh a, b;
};
[[nodiscard]] MeshPair random_pair(std::uint32_t seed);

}  // namespace meshbound::bench
