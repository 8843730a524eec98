// SPDX-License-Identifier: GPL-3.0-or-later
/// Components that the rest of the mesh stands for; included by deviation_monitor.h.
#pragma once
#include "meshbound/cgal/deviation_monitor.h"

namespace meshbound::cgal {

/// Faces that hang together over edges, smallest component first.
template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::components() const -> std::vector<std::vector<Face>> {
  const auto seen = get(CGAL::dynamic_face_property_t<bool>(), mesh_);
  for (const Face f : CGAL::faces(mesh_)) put(seen, f, false);
  std::vector<std::vector<Face>> all;
  for (const Face seed : CGAL::faces(mesh_)) {
    if (get(seen, seed)) continue;
    put(seen, seed, true);
    std::vector<Face> component{seed};
    for (std::size_t i = 0; i < component.size(); ++i) {
      for (const Halfedge h : CGAL::halfedges_around_face(halfedge(component[i], mesh_), mesh_)) {
        const Face other = face(opposite(h, mesh_), mesh_);
        if (other == Graph::null_face() || get(seen, other)) continue;
        put(seen, other, true);
        component.push_back(other);
      }
    }
    all.push_back(std::move(component));
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return all;
}

template <class Mesh, class VertexPointMap>
void DeviationMonitor<Mesh, VertexPointMap>::remove_component(const std::vector<Face>& component) {
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
  for (const Face f : component) {
    for (const Halfedge h : CGAL::halfedges_around_face(halfedge(f, mesh_), mesh_)) {
      vertices.push_back(target(h, mesh_));
      edges.push_back(edge(h, mesh_));
    }
  }
  const auto make_unique = [](auto& all) {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  };
  make_unique(vertices);
  make_unique(edges);
  for (const Face f : component) remove_face(f, mesh_);
  for (const Edge e : edges) remove_edge(e, mesh_);
  for (const Vertex v : vertices) remove_vertex(v, mesh_);
  faces_ -= component.size();
}

template <class Mesh, class VertexPointMap>
auto DeviationMonitor<Mesh, VertexPointMap>::drop_components(std::size_t least_faces) -> Dropped {
  refuse_unproven();
  Dropped dropped;
  const std::vector<std::vector<Face>> all = components();
  if (all.size() < 2) return dropped;
  tracker_.begin_removals();
  for (const std::vector<Face>& component : all) {
    if (component.size() + least_faces > faces_ || (should_stop && should_stop(faces_))) break;
    const bool is_kept = std::any_of(component.begin(), component.end(), [&](Face f) {
      const std::array<Vertex, 3> v = corners(f);
      return std::any_of(v.begin(), v.end(),
                         [&](Vertex w) { return is_locked(w) || (preserve_boundary && is_border(w)); });
    });
    if (is_kept) continue;
    removed_.clear();
    for (const Face f : component) removed_.push_back(get(face_ids_, f));
    if (!tracker_.admits_removal(removed_)) continue;
    tracker_.commit();
    remove_component(component);
    ++dropped.components;
    dropped.faces += component.size();
  }
  return dropped;
}

}  // namespace meshbound::cgal
