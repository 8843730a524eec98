// SPDX-License-Identifier: GPL-3.0-or-later
/// An original is cut into parts that are decimated alone, in parallel, and joined again.
///
///     +---------+---------+      Vertices of seams stay where they are while the parts are decimated. A seam vertex
///     |         s         |      whose triangles in one part hang together only there gets a copy for each fan of
///     |    A    s    B    |      them in that part, so that the part is a 2-manifold. A bound of each part against its
///     |         s         |      own triangles is a bound of the whole against all.
///     +---------+---------+
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "cgal/manifold_polygons.h"
#include "cgal/part_seam.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::cgal {

/// Depends on the size of the original only, so that results do not depend on the number of threads. 1: not cut.
[[nodiscard]] std::size_t number_of_parts(std::size_t triangles);

/// By triangle: its part, 0 to `parts` - 1. The triangles are halved again and again, across the longest side of the
/// box of their centres, so parts are of equal size and seams are short. O(n log parts).
[[nodiscard]] std::vector<std::uint32_t> cut(const std::vector<Kernel::Point_3>& points,
                                             std::span<const Polygon> polygons, std::size_t parts);

struct Part {
  TriangleMesh original;                   ///< its triangles of the soup, those that no face is made of included
  std::vector<std::uint32_t> triangle_of;  ///< by triangle of `original`: that of the soup
  ManifoldPolygons copy;                   ///< made from `original`; `vertex_of_vertex` gives vertices of the soup
  std::vector<std::uint32_t> whole_of;     ///< by vertex of the copy: that of the polygons which were cut
  std::vector<std::uint32_t> named_after;  ///< by face of the copy: the triangle of the soup that it was made from
  std::vector<std::uint32_t> seam_vertex;  ///< the same for vertices on seams, `PartSeam::none` for others
};

class Cutting {
 public:
  /// `whole` was made from `soup`. Both must outlive this. O(n log n).
  Cutting(const TriangleMesh& soup, const ManifoldPolygons& whole, std::size_t parts);
  /// With the part of each polygon given, and vertices that are to stay as if they were on a seam.
  Cutting(const TriangleMesh& soup, const ManifoldPolygons& whole, std::size_t parts,
          std::vector<std::uint32_t> part_of, std::vector<bool> fixed);

  [[nodiscard]] std::size_t parts() const { return parts_; }
  [[nodiscard]] const Seams& seams() const { return seams_; }
  /// Safe to call from several threads. O(size of the part).
  [[nodiscard]] Part part(std::size_t index) const;

 private:
  void find_seam_vertices();
  void split_fans();
  void place_dropped_triangles();

  const TriangleMesh& soup_;
  const ManifoldPolygons& whole_;
  std::size_t parts_;
  std::vector<std::uint32_t> part_of_;               ///< by polygon
  std::vector<Polygon> polygons_;                    ///< with a vertex of its own for each fan at a seam
  std::vector<std::uint32_t> whole_of_;              ///< by vertex of `polygons_`
  std::vector<std::vector<std::uint32_t>> dropped_;  ///< by part: triangles of the soup without a face
  Seams seams_;
};

}  // namespace meshbound::cgal
