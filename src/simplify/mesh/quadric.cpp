// SPDX-License-Identifier: MIT
#include "simplify/mesh/quadric.h"

#include <algorithm>
#include <cmath>

#include "geometry/unit.h"
#include "numeric/no_index.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

/// Weight of a plane through a border edge, where that of a face is 1: CGAL's default.
constexpr double border_weight = 100;

/// Where the surface is flat the quadric is singular but for rounding, and its minimum may be anywhere: it is believed
/// within this many edge lengths only.
constexpr double max_way = 5;

/// Perpendicular to a face, twice as long as its area.
Vec3 doubled_area(const ArrayMesh& mesh, std::uint32_t face) {
  const auto [p, q, r] = mesh.triangle(face);
  return cross(q - p, r - p);
}

double mean_doubled_area(const ArrayMesh& mesh) {
  double sum = 0, count = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_removed(f)) continue;
    sum += length(doubled_area(mesh, f));
    ++count;
  }
  return sum / count;
}

constexpr std::size_t faces_of_chunk = 4096;  ///< that a thread takes at once

/// Sums of the planes around vertices. Those of one vertex are added in the order of the faces, whatever the threads.
class PlaneSums {
 public:
  PlaneSums(const ArrayMesh& mesh, PlaneWeights weights, std::vector<Quadric> storage)
      : mesh_(mesh), mean_(weights == PlaneWeights::Area ? mean_doubled_area(mesh) : 0), sums_(std::move(storage)) {
    sums_.assign(mesh.vertex_count(), {});
  }

  std::vector<Quadric> add_all(int threads) && {
    const std::size_t chunks = (mesh_.face_count() + faces_of_chunk - 1) / faces_of_chunk;
    std::vector<std::uint32_t> first_new(chunks + 1, 0);  // by chunk: no chunk before has this vertex or later ones
    std::vector<std::vector<std::uint32_t>> at_seams(chunks);
    with_team(threads, [&] {
      for_each_task(chunks, [&](std::size_t c) { first_new[c + 1] = last_vertex(c) + 1; });
      for (std::size_t c = 0; c < chunks; ++c) first_new[c + 1] = std::max(first_new[c], first_new[c + 1]);
      for_each_task(chunks, [&](std::size_t c) { at_seams[c] = add_to_new(c, first_new[c]); });
    });
    for (std::size_t c = 0; c < chunks; ++c)
      for (const std::uint32_t f : at_seams[c]) add(f, [&](std::uint32_t v) { return v < first_new[c]; });
    return std::move(sums_);
  }

 private:
  template <class Use>
  void for_each_face(std::size_t chunk, const Use& use) const {
    const std::size_t end = std::min(mesh_.face_count(), (chunk + 1) * faces_of_chunk);
    for (auto f = static_cast<std::uint32_t>(chunk * faces_of_chunk); f < end; ++f)
      if (!mesh_.is_removed(f)) use(f);
  }
  [[nodiscard]] std::uint32_t last_vertex(std::size_t chunk) const {
    std::uint32_t last = 0;
    for_each_face(chunk, [&](std::uint32_t f) {
      for (const std::uint32_t v : mesh_.corners(f)) last = std::max(last, v);
    });
    return last;
  }
  /// Adds the planes of a chunk to vertices from `first` on. Returns the faces that have others too.
  std::vector<std::uint32_t> add_to_new(std::size_t chunk, std::uint32_t first) {
    std::vector<std::uint32_t> with_others;
    for_each_face(chunk, [&](std::uint32_t f) {
      const auto [a, b, c] = mesh_.corners(f);
      if (std::min({a, b, c}) < first) with_others.push_back(f);
      add(f, [first](std::uint32_t v) { return v >= first; });
    });
    return with_others;
  }

  /// Adds the planes of a face to those of its vertices that are wanted.
  template <class IsWanted>
  void add(std::uint32_t f, const IsWanted& is_wanted) {
    const auto add_to = [&](std::uint32_t v, const Quadric& plane) {
      if (is_wanted(v)) sums_[v] += plane;
    };
    const Vec3 area = doubled_area(mesh_, f), normal = unit(area);
    const double weight = mean_ > 0 ? length(area) / mean_ : 1;
    const Quadric plane = Quadric::of_plane(normal, mesh_.position(mesh_.start(3 * f)), weight);
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
      add_to(mesh_.start(c), plane);
      if (mesh_.twin(c) != no_index) continue;
      const Vec3 from = mesh_.position(mesh_.start(c)), to = mesh_.position(mesh_.end(c));
      const double border = mean_ > 0 ? squared_length(to - from) / mean_ : border_weight;
      const Quadric wall = Quadric::of_plane(unit(cross(to - from, normal)), to, border);
      add_to(mesh_.start(c), wall);
      add_to(mesh_.end(c), wall);
    }
  }

  const ArrayMesh& mesh_;
  double mean_;  ///< twice the mean area of a face, where planes are weighted by area; else 0
  std::vector<Quadric> sums_;
};

}  // namespace

Quadric Quadric::of_plane(Vec3 n, Vec3 p, double weight) {
  const double offset = -dot(n, p);
  const double wx = weight * n.x, wy = weight * n.y, wz = weight * n.z;
  return {wx * n.x, wx * n.y,    wx * n.z,    wy * n.y,    wy * n.z,
          wz * n.z, wx * offset, wy * offset, wz * offset, weight * offset * offset};
}

Quadric& Quadric::operator-=(const Quadric& o) {
  xx -= o.xx, xy -= o.xy, xz -= o.xz, yy -= o.yy, yz -= o.yz, zz -= o.zz;
  x -= o.x, y -= o.y, z -= o.z, constant -= o.constant;
  return *this;
}

/// By Cramer's rule: A is tiny and its entries are all of the same kind.
std::optional<Vec3> Quadric::minimum() const {
  const double c_xx = yy * zz - yz * yz, c_xy = xz * yz - xy * zz, c_xz = xy * yz - xz * yy;
  const double c_yy = xx * zz - xz * xz, c_yz = xy * xz - xx * yz, c_zz = xx * yy - xy * xy;
  const double determinant = xx * c_xx + xy * c_xy + xz * c_xz;
  if (determinant == 0) return std::nullopt;
  const double scale = -1 / determinant;
  return Vec3{scale * (c_xx * x + c_xy * y + c_xz * z), scale * (c_xy * x + c_yy * y + c_yz * z),
              scale * (c_xz * x + c_yz * y + c_zz * z)};
}

std::vector<Quadric> vertex_quadrics(const ArrayMesh& mesh, PlaneWeights weights, int threads,
                                     std::vector<Quadric> storage) {
  return PlaneSums(mesh, weights, std::move(storage)).add_all(threads);
}

Placement best_placement(const Quadric& of_p, const Quadric& of_q, Vec3 p, Vec3 q) {
  Quadric sum = of_p;
  sum += of_q;
  const double reach = max_way * max_way * squared_length(q - p);
  const auto is_local = [&](Vec3 at) { return squared_length(at - p) < reach && squared_length(at - q) < reach; };
  if (const auto minimum = sum.minimum(); minimum && is_local(*minimum)) return {*minimum, sum.at(*minimum)};
  const Vec3 middle = 0.5 * (p + q);
  Placement best{middle, sum.at(middle)};
  for (const Vec3 end : {p, q}) {
    if (const double cost = sum.at(end); cost < best.cost) best = {end, cost};
  }
  return best;
}

}  // namespace meshbound
