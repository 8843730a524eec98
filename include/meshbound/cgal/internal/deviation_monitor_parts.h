// SPDX-License-Identifier: GPL-3.0-or-later
/// A monitor that goes on where those of parts ended; included by deviation_monitor.h.
#pragma once
#include "meshbound/cgal/deviation_monitor.h"

namespace meshbound::cgal {

template <class Mesh, class VertexPointMap>
DeviationMonitor<Mesh, VertexPointMap>::DeviationMonitor(Mesh& mesh, const TriangleMesh& original, Bvh tree,
                                                         std::span<const Part> parts, double tolerance,
                                                         VertexPointMap points)
    : DeviationMonitor(mesh, original, std::move(tree), points, tolerance) {
  std::vector<Face> all;
  for (const Face f : CGAL::faces(mesh_)) {
    put(face_ids_, f, static_cast<std::uint32_t>(faces_++));
    all.push_back(f);
  }
  for (const Part& part : parts) {
    std::vector<TrackedFace> faces(part.face_of.size());
    for (std::size_t id = 0; id < faces.size(); ++id) {
      faces[id].id = part.face_of[id];
      if (part.face_of[id] == Part::none) continue;
      const std::array<Vertex, 3> v = corners(all.at(part.face_of[id]));
      faces[id].corners = {at(v[0]), at(v[1]), at(v[2])};
    }
    // Those that have no face in the mesh have the last ids, in their order.
    const std::size_t first = faces.size() - part.uncovered.size();
    for (std::size_t i = 0; i < part.uncovered.size(); ++i) {
      TrackedFace& face = faces.at(first + i);
      const Triangle& t = original.triangles.at(part.uncovered[i]);
      face.id = static_cast<std::uint32_t>(faces_ + uncovered_.size());
      face.corners = {original.vertices[t[0]], original.vertices[t[1]], original.vertices[t[2]]};
      uncovered_.push_back(part.uncovered[i]);
    }
    tracker_.take_over(part.proof, part.triangle_of, faces);
  }
}

}  // namespace meshbound::cgal
