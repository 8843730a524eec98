// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "simplify/spatial_order.h"

namespace meshbound::cgal {
namespace {

constexpr std::uint32_t none = PartSeam::none;

/// Triangles. Below, a tenth of a second is all there is to gain. Above, parts are as small as they can be without more
/// than one face in a hundred too many at the seams (igea at 0.1%): what they touch then stays in the processor's
/// caches.
constexpr std::size_t least_to_cut = 10000;
constexpr std::size_t largest_part = 34000;

using Centre = std::array<double, 3>;

/// Gives the triangles of `items` the parts `first` to `first` + `parts` - 1.
void halve(std::span<std::uint32_t> items, const std::vector<Centre>& centres, std::uint32_t first, std::size_t parts,
           std::vector<std::uint32_t>& part_of) {
  if (parts == 1) {
    for (const std::uint32_t item : items) part_of[item] = first;
    return;
  }
  Eigen::AlignedBox3d box;
  for (const std::uint32_t item : items) box.extend(Eigen::Vector3d(centres[item].data()));
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto along = static_cast<std::size_t>(axis);
  const std::size_t left = parts / 2;
  const auto middle = items.begin() + static_cast<std::ptrdiff_t>(items.size() * left / parts);
  std::nth_element(items.begin(), middle, items.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(centres[a][along], a) < std::pair(centres[b][along], b);
  });
  halve({items.begin(), middle}, centres, first, left, part_of);
  halve({middle, items.end()}, centres, first + static_cast<std::uint32_t>(left), parts - left, part_of);
}

/// Of the polygons around a vertex, which hang together: over edges at the vertex, within a part.
class Fans {
 public:
  struct Wedge {
    std::uint32_t polygon, corner, part;
    std::array<std::size_t, 2> beside;  ///< the other corners
  };

  /// Calls `visit(wedge, first wedge of its fan)` for each.
  template <class Visit>
  void for_each(const std::vector<Wedge>& wedges, const Visit& visit) {
    leader_.resize(wedges.size());
    std::iota(leader_.begin(), leader_.end(), std::size_t{0});
    sides_.clear();
    for (std::size_t i = 0; i < wedges.size(); ++i) {
      for (std::size_t k = 0; k < 2; ++k) sides_.push_back({wedges[i].beside[k], wedges[i].part, i, k});
    }
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
      return std::tie(a.other_end, a.part, a.wedge, a.corner) < std::tie(b.other_end, b.part, b.wedge, b.corner);
    });
    for (std::size_t i = 1; i < sides_.size(); ++i) {
      const Side &before = sides_[i - 1], &side = sides_[i];
      if (before.other_end == side.other_end && before.part == side.part) join(before.wedge, side.wedge);
    }
    for (std::size_t i = 0; i < wedges.size(); ++i) visit(i, find(i));
  }

  /// Calls `visit(other end)` for each edge of the vertex between two parts, of those asked about last.
  template <class Visit>
  void for_each_edge_between_parts(const Visit& visit) const {
    for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
      while (end < sides_.size() && sides_[end].other_end == sides_[begin].other_end) ++end;
      bool is_between = false;
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t j = i + 1; j < end; ++j)
          is_between |= sides_[i].part != sides_[j].part && sides_[i].corner != sides_[j].corner;
      }
      if (is_between) visit(sides_[begin].other_end);
    }
  }

 private:
  /// An edge of the vertex, as a wedge has it: of the two it has, the one that ends at its corner `corner`.
  struct Side {
    std::size_t other_end;
    std::uint32_t part;
    std::size_t wedge, corner;
  };
  void join(std::size_t i, std::size_t j) {
    const std::size_t a = find(i), b = find(j);
    leader_[std::max(a, b)] = std::min(a, b);
  }
  std::size_t find(std::size_t i) {
    while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
    return i;
  }
  std::vector<std::size_t> leader_;
  std::vector<Side> sides_;
};

}  // namespace

std::size_t number_of_parts(std::size_t triangles) {
  if (triangles < least_to_cut) return 1;
  std::size_t parts = 2;
  while (parts * largest_part < triangles) parts *= 2;
  return parts;
}

std::vector<std::uint32_t> cut(const std::vector<Kernel::Point_3>& points, std::span<const Polygon> polygons,
                               std::size_t parts) {
  std::vector<Centre> centres;
  centres.reserve(polygons.size());
  for (const Polygon& corners : polygons) {
    const auto sum = [&](int axis) {
      return points[corners[0]][axis] + points[corners[1]][axis] + points[corners[2]][axis];
    };
    centres.push_back({sum(0), sum(1), sum(2)});
  }
  std::vector<std::uint32_t> items(polygons.size()), part_of(polygons.size());
  std::iota(items.begin(), items.end(), 0u);
  halve(items, centres, 0, parts, part_of);
  return part_of;
}

Cutting::Cutting(const TriangleMesh& soup, const ManifoldPolygons& whole, std::size_t parts)
    : Cutting(soup, whole, parts, cut(whole.points, whole.polygons, parts),
              std::vector<bool>(whole.points.size(), false)) {}

Cutting::Cutting(const TriangleMesh& soup, const ManifoldPolygons& whole, std::size_t parts,
                 std::vector<std::uint32_t> part_of, std::vector<bool> fixed)
    : soup_(soup),
      whole_(whole),
      parts_(parts),
      part_of_(std::move(part_of)),
      polygons_(whole.polygons),
      whole_of_(whole.points.size()),
      dropped_(parts) {
  std::iota(whole_of_.begin(), whole_of_.end(), 0u);
  seams_.has = std::move(fixed);
  find_seam_vertices();
  split_fans();
  place_dropped_triangles();
}

void Cutting::find_seam_vertices() {
  std::vector<std::uint32_t> part_at(whole_.points.size(), none);
  for (std::size_t f = 0; f < polygons_.size(); ++f) {
    for (const std::size_t v : polygons_[f]) {
      if (part_at[v] == none) part_at[v] = part_of_[f];
      if (part_at[v] != part_of_[f]) seams_.has[v] = true;
    }
  }
}

void Cutting::split_fans() {
  std::vector<std::pair<std::uint32_t, Fans::Wedge>> wedges;
  for (std::uint32_t f = 0; f < polygons_.size(); ++f) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Polygon& corners = whole_.polygons[f];
      if (seams_.has[corners[k]])
        wedges.emplace_back(static_cast<std::uint32_t>(corners[k]),
                            Fans::Wedge{f, k, part_of_[f], {corners[(k + 1) % 3], corners[(k + 2) % 3]}});
    }
  }
  std::stable_sort(wedges.begin(), wedges.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Fans fans;
  std::vector<Fans::Wedge> around;
  std::vector<std::uint32_t> copy;  // by wedge
  for (std::size_t begin = 0, end = 0; begin < wedges.size(); begin = end) {
    const std::uint32_t v = wedges[begin].first;
    around.clear();
    for (end = begin; end < wedges.size() && wedges[end].first == v; ++end) around.push_back(wedges[end].second);
    copy.assign(around.size(), none);
    fans.for_each(around, [&](std::size_t i, std::size_t leader) {
      if (copy[leader] == none) {
        copy[leader] = static_cast<std::uint32_t>(whole_of_.size());
        whole_of_.push_back(v);
      }
      polygons_[around[i].polygon][around[i].corner] = copy[leader];
    });
    fans.for_each_edge_between_parts(
        [&](std::size_t other) { seams_.edges.push_back(std::minmax(v, static_cast<std::uint32_t>(other))); });
  }
  std::sort(seams_.edges.begin(), seams_.edges.end());
  seams_.edges.erase(std::unique(seams_.edges.begin(), seams_.edges.end()), seams_.edges.end());
}

/// Triangles of the soup that no face is made of go to the part that shares most of their corners.
void Cutting::place_dropped_triangles() {
  if (whole_.triangle_of_face.size() == soup_.triangles.size()) return;
  const auto less = [&](std::uint32_t a, std::uint32_t b) { return is_before(soup_.vertices[a], soup_.vertices[b]); };
  // Equal points have several vertices in a soup: they are found by place.
  std::vector<char> has_face(soup_.triangles.size(), 0);
  for (const std::uint32_t t : whole_.triangle_of_face) has_face[t] = 1;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> wanted;  // vertex, triangle
  for (std::uint32_t t = 0; t < soup_.triangles.size(); ++t) {
    for (const std::uint32_t v : soup_.triangles[t]) {
      if (!has_face[t]) wanted.emplace_back(v, t);
    }
  }
  std::sort(wanted.begin(), wanted.end(), [&](const auto& a, const auto& b) {
    return less(a.first, b.first) || (!less(b.first, a.first) && a.second < b.second);
  });
  struct Best {
    std::size_t shared = 0;
    std::uint32_t part = 0;
  };
  std::vector<Best> best(soup_.triangles.size());
  std::vector<std::uint32_t> beside;
  for (std::size_t f = 0; f < whole_.polygons.size(); ++f) {
    beside.clear();
    for (const std::size_t v : whole_.polygons[f]) {
      const std::uint32_t corner = whole_.vertex_of_vertex[v];
      const auto before = [&](const auto& item, std::uint32_t at) { return less(item.first, at); };
      for (auto at = std::lower_bound(wanted.begin(), wanted.end(), corner, before);
           at != wanted.end() && !less(corner, at->first); ++at)
        beside.push_back(at->second);
    }
    std::sort(beside.begin(), beside.end());
    for (std::size_t i = 0, end = 0; i < beside.size(); i = end) {
      while (end < beside.size() && beside[end] == beside[i]) ++end;
      if (end - i > best[beside[i]].shared) best[beside[i]] = {end - i, part_of_[f]};
    }
  }
  for (std::uint32_t t = 0; t < soup_.triangles.size(); ++t) {
    if (!has_face[t]) dropped_[best[t].part].push_back(t);
  }
}

Part Cutting::part(std::size_t index) const {
  Part part;
  std::vector<std::uint32_t> vertex(whole_of_.size(), none), soup_vertex(soup_.vertices.size(), none);
  const auto add_original = [&](std::uint32_t t) {
    Triangle& corners = part.original.triangles.emplace_back(soup_.triangles[t]);
    for (std::uint32_t& v : corners) {
      if (soup_vertex[v] == none) {
        soup_vertex[v] = static_cast<std::uint32_t>(part.original.vertices.size());
        part.original.vertices.push_back(soup_.vertices[v]);
      }
      v = soup_vertex[v];
    }
    part.triangle_of.push_back(t);
  };
  for (std::size_t f = 0; f < polygons_.size(); ++f) {
    if (part_of_[f] != index) continue;
    part.copy.triangle_of_face.push_back(static_cast<std::uint32_t>(part.triangle_of.size()));
    part.named_after.push_back(whole_.triangle_of_face[f]);
    add_original(whole_.triangle_of_face[f]);
    Polygon& corners = part.copy.polygons.emplace_back(polygons_[f]);
    for (std::size_t& v : corners) {
      if (vertex[v] == none) {
        vertex[v] = static_cast<std::uint32_t>(part.whole_of.size());
        const std::uint32_t whole = whole_of_[v];
        part.whole_of.push_back(whole);
        part.copy.points.push_back(whole_.points[whole]);
        part.copy.vertex_of_vertex.push_back(whole_.vertex_of_vertex[whole]);
        part.seam_vertex.push_back(seams_.has[whole] ? whole : PartSeam::none);
      }
      v = vertex[v];
    }
  }
  for (const std::uint32_t t : dropped_[index]) add_original(t);
  part.copy.dropped_triangles = dropped_[index].size();
  return part;
}

}  // namespace meshbound::cgal
