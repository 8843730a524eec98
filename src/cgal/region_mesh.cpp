// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/region_mesh.h"

#include <algorithm>
#include <array>

#include "numeric/no_index.h"

namespace meshbound::cgal {
namespace {

using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Face = SurfaceMesh::Face_index;

class Builder {
 public:
  Builder(const RegionCollapses& collapses, RegionMesh& into)
      : collapses_(collapses), source_(collapses.mesh()), into_(into), mesh_(into.mesh) {}

  void run() {
    list_faces();
    add_vertices();
    add_edges();
    add_faces();
    close_borders();
  }

 private:
  void list_faces() {
    collapses_.for_each_edge([&](Corner c) {
      for (const Corner side : {c, source_.twin(c)})
        if (side != no_index && collapses_.owns_face(side / 3)) faces_.push_back(side / 3);
    });
    std::sort(faces_.begin(), faces_.end());
    faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
    for (const std::uint32_t f : faces_)
      for (const std::uint32_t v : source_.corners(f)) into_.vertex.push_back(v);
    std::sort(into_.vertex.begin(), into_.vertex.end());
    into_.vertex.erase(std::unique(into_.vertex.begin(), into_.vertex.end()), into_.vertex.end());
  }

  void add_vertices() {
    mesh_.reserve(static_cast<SurfaceMesh::size_type>(into_.vertex.size()),
                  static_cast<SurfaceMesh::size_type>(2 * faces_.size()),
                  static_cast<SurfaceMesh::size_type>(faces_.size()));
    for (const std::uint32_t v : into_.vertex) {
      const Vec3 p = source_.position(v);
      mesh_.add_vertex({p.x, p.y, p.z});
    }
  }
  [[nodiscard]] Vertex vertex_of(std::uint32_t v) const {
    const auto at = std::lower_bound(into_.vertex.begin(), into_.vertex.end(), v);
    return Vertex(static_cast<SurfaceMesh::size_type>(at - into_.vertex.begin()));
  }

  [[nodiscard]] bool has_face(Corner corner) const {
    return corner != no_index && std::binary_search(faces_.begin(), faces_.end(), corner / 3);
  }
  [[nodiscard]] Halfedge& halfedge_of(Corner corner) {
    const auto at = std::lower_bound(faces_.begin(), faces_.end(), corner / 3);
    return halfedges_[static_cast<std::size_t>(at - faces_.begin())][corner % 3];
  }

  void add_edges() {
    halfedges_.resize(faces_.size());
    std::vector<std::uint32_t> edges_at(into_.vertex.size(), 0);
    for (const std::uint32_t f : faces_) {
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
        const bool is_open = collapses_.is_open(c);
        into_.is_open.push_back(is_open ? 1 : 0);
        if (is_open && mesh_.point(start) == mesh_.point(end)) into_.has_edge_of_no_length = true;
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
  std::vector<std::uint32_t> faces_;                ///< ascending
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
