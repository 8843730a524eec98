// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/region_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

#include "numeric/no_index.h"
#include "numeric/ranked_numbers.h"

namespace meshbound::cgal {
namespace {

using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Face = SurfaceMesh::Face_index;

class Builder {
 public:
  Builder(const RegionCollapses& collapses, RegionMesh& into)
      : collapses_(collapses),
        source_(collapses.mesh()),
        into_(into),
        mesh_(into.mesh),
        inner_(inner_vertices(collapses)),
        faces_(faces_of_inner()),
        vertices_(corners_of_faces()) {}

  void run() {
    add_vertices();
    add_edges();
    add_faces();
    close_borders();
  }

 private:
  /// Vertices of the region: all, or those near open edges where few are open.
  static RankedNumbers inner_vertices(const RegionCollapses& collapses) {
    const bool are_few_open = RegionMesh::edges_of_open * collapses.open_edges().size() < collapses.edge_count();
    std::vector<std::uint32_t> ends;
    const auto add_ends = [&](Corner edge) {
      for (const std::uint32_t v : {collapses.mesh().start(edge), collapses.mesh().end(edge)})
        if (collapses.owns_vertex(v)) ends.push_back(v);
    };
    if (are_few_open)
      std::for_each(collapses.open_edges().begin(), collapses.open_edges().end(), add_ends);
    else
      collapses.for_each_edge(add_ends);
    RankedNumbers inner(std::array{std::move(ends)});
    if (!are_few_open) return inner;
    for (int ring = 0; ring < RegionMesh::rings_around_open; ++ring) inner = with_neighbours(collapses, inner);
    return inner;
  }

  static RankedNumbers with_neighbours(const RegionCollapses& collapses, const RankedNumbers& vertices) {
    const ArrayMesh& mesh = collapses.mesh();
    std::vector<std::uint32_t> found = vertices.ascending();
    for (const std::uint32_t v : vertices.ascending()) {
      mesh.for_each_corner(v, [&](Corner c) {
        for (const std::uint32_t other : {mesh.end(c), mesh.apex(c)})
          if (collapses.owns_vertex(other)) found.push_back(other);
        return true;
      });
    }
    return RankedNumbers(std::array{std::move(found)});
  }

  [[nodiscard]] RankedNumbers faces_of_inner() const {
    std::vector<std::uint32_t> faces;
    for (const std::uint32_t v : inner_.ascending()) {
      source_.for_each_corner(v, [&](Corner c) {
        if (collapses_.owns_face(c / 3)) faces.push_back(c / 3);
        return true;
      });
    }
    return RankedNumbers(std::array{std::move(faces)});
  }

  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> corners_of_faces() const {
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (const std::uint32_t f : faces_.ascending()) corners.push_back(source_.corners(f));
    return corners;
  }

  void add_vertices() {
    into_.vertex = vertices_.ascending();
    mesh_.reserve(static_cast<SurfaceMesh::size_type>(into_.vertex.size()),
                  static_cast<SurfaceMesh::size_type>(2 * faces_.ascending().size()),
                  static_cast<SurfaceMesh::size_type>(faces_.ascending().size()));
    for (const std::uint32_t v : into_.vertex) {
      const Vec3 p = source_.position(v);
      mesh_.add_vertex({p.x, p.y, p.z});
      into_.is_inner.push_back(inner_.contains(v) ? 1 : 0);
    }
  }
  [[nodiscard]] Vertex vertex_of(std::uint32_t v) const {
    return Vertex(static_cast<SurfaceMesh::size_type>(vertices_.index_of(v)));
  }

  [[nodiscard]] bool has_face(Corner corner) const { return corner != no_index && faces_.contains(corner / 3); }
  [[nodiscard]] Halfedge& halfedge_of(Corner corner) { return halfedges_[faces_.index_of(corner / 3)][corner % 3]; }

  void add_edges() {
    halfedges_.resize(faces_.ascending().size());
    std::vector<std::uint32_t> edges_at(into_.vertex.size(), 0);
    for (const std::uint32_t f : faces_.ascending()) {
      for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
        const Corner twin = source_.twin(c);
        const bool is_rim = !has_face(twin);
        if (!is_rim && twin < c) continue;
        const Vertex start = vertex_of(source_.start(c)), end = vertex_of(source_.end(c));
        const Halfedge h = mesh_.add_edge(start, end);
        halfedge_of(c) = h;
        if (is_rim)
          rim_.push_back(c);
        else
          halfedge_of(twin) = mesh_.opposite(h);
        if (collapses_.is_open(c) && mesh_.point(start) == mesh_.point(end)) into_.has_edge_of_no_length = true;
        for (const Vertex v : {start, end})
          into_.max_edges_of_vertex = std::max<std::size_t>(into_.max_edges_of_vertex, ++edges_at[v]);
      }
    }
  }

  void add_faces() {
    for (const auto& around : halfedges_) {
      const Face face = mesh_.add_face();
      for (std::size_t k = 0; k < 3; ++k) {
        mesh_.set_next(around[k], around[(k + 1) % 3]);
        mesh_.set_face(around[k], face);
        mesh_.set_halfedge(mesh_.target(around[k]), around[k]);
      }
      mesh_.set_halfedge(face, around[0]);
    }
  }

  /// The half-edge beyond the rim at corner c ends at its start, and the one that follows is found around that vertex:
  ///
  ///        \  .. /                                                ///
  ///         \  d/                                                 ///
  ///    <- - -\ / <- - - - -    beyond c
  ///           v --- c ----
  void close_borders() {
    for (const Corner c : rim_) {
      Corner d = previous_corner(c);
      while (has_face(source_.twin(d))) d = previous_corner(source_.twin(d));
      const Halfedge beyond = mesh_.opposite(halfedge_of(c));
      mesh_.set_next(beyond, mesh_.opposite(halfedge_of(d)));
      mesh_.set_halfedge(mesh_.target(beyond), beyond);
    }
  }

  const RegionCollapses& collapses_;
  const ArrayMesh& source_;
  RegionMesh& into_;
  SurfaceMesh& mesh_;
  RankedNumbers inner_, faces_, vertices_;
  std::vector<std::array<Halfedge, 3>> halfedges_;  ///< by face there and corner
  std::vector<Corner> rim_;                         ///< corners whose edge has no other face in the region
};

}  // namespace

RegionMesh::RegionMesh(const RegionCollapses& collapses) { Builder(collapses, *this).run(); }

Corner corner_between(const ArrayMesh& mesh, std::uint32_t a, std::uint32_t b) {
  Corner found = no_index;
  mesh.for_each_corner(a, [&](Corner c) {
    if (mesh.end(c) == b) found = c;
    if (mesh.apex(c) == b) found = previous_corner(c);
    return found == no_index;
  });
  return found;
}

}  // namespace meshbound::cgal
