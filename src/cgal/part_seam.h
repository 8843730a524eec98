// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "meshbound/cgal/surface_mesh.h"

namespace meshbound::cgal {

/// Where a mesh was cut, in vertices of the whole.
struct Seams {
  std::vector<bool> has;                                       ///< by vertex
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  ///< ascending, the smaller vertex first

  [[nodiscard]] bool has_edge(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(edges.begin(), edges.end(), std::pair(std::min(a, b), std::max(a, b)));
  }
};

/// The vertices of a part that are on seams: while the part is decimated nothing collapses into them.
///
///     s-----s-----s-----s        Collapses of v into s would be fine for the bound, but would join seam vertices by
///     new
///      \    |    / \   /         edges, and another part may have made the same: four faces at one edge. And long
///      faces
///       `---v---'   `-*          along the seam would be in the way when it is decimated itself (1% more faces).
class PartSeam {
  using Vertex = SurfaceMesh::Vertex_index;

 public:
  static constexpr std::uint32_t none = 0xffffffff;

  /// `vertices` gives by vertex of the part that of the whole, none for those not on a seam. `whole` must outlive this.
  PartSeam(const Seams& whole, std::vector<std::uint32_t> vertices) : whole_(whole), vertex_(std::move(vertices)) {
    std::vector<std::uint32_t> all;
    std::copy_if(vertex_.begin(), vertex_.end(), std::back_inserter(all), [](std::uint32_t v) { return v != none; });
    std::sort(all.begin(), all.end());
    has_copies_ = std::adjacent_find(all.begin(), all.end()) != all.end();
  }

  [[nodiscard]] std::uint32_t vertex(Vertex v) const { return vertex_[v]; }
  [[nodiscard]] bool has(Vertex v) const { return vertex_[v] != none; }
  [[nodiscard]] bool has_edge(Vertex u, Vertex v) const {
    return has(u) && has(v) && whole_.has_edge(vertex_[u], vertex_[v]);
  }

  template <class Profile>
  [[nodiscard]] bool forbids(const Profile& profile) const {
    return has(profile.v0()) || has(profile.v1()) || (has_copies_ && meets_two_copies(profile));
  }

 private:
  /// The collapse would give its vertex edges to two copies of a seam vertex, which become one when the parts are
  /// joined.
  template <class Profile>
  [[nodiscard]] bool meets_two_copies(const Profile& profile) const {
    const SurfaceMesh& mesh = profile.surface_mesh();
    std::vector<Vertex> beside;
    for (const Vertex v : {profile.v0(), profile.v1()}) {
      for (const auto h : CGAL::halfedges_around_target(mesh.halfedge(v), mesh)) {
        if (has(mesh.source(h))) beside.push_back(mesh.source(h));
      }
    }
    for (std::size_t i = 0; i < beside.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (beside[i] != beside[j] && vertex_[beside[i]] == vertex_[beside[j]]) return true;
      }
    }
    return false;
  }

  const Seams& whole_;
  std::vector<std::uint32_t> vertex_;
  bool has_copies_ = false;
};

}  // namespace meshbound::cgal
