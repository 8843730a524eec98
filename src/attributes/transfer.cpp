// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "attributes/seams.h"
#include "geometry/position_table.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/bvh.h"
#include "meshbound/simplify.h"
#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"

namespace meshbound {
namespace {

constexpr std::uint32_t none = CornerAttribute::none;

/// How far from its corner towards the middle of its triangle the normal of a corner is looked up, as a share.
constexpr double share_inside = 0.1;

/// Barycentric coordinates of a point of a triangle's plane; the first corner where the triangle has no area.
Eigen::Vector3d barycentric(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& p) {
  const Eigen::Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0], w = p - corners[0];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 0)) return {1, 0, 0};
  const double second = std::clamp((vv * uw - uv * vw) / determinant, 0.0, 1.0);
  const double third = std::clamp((uu * vw - uv * uw) / determinant, 0.0, 1.0 - second);
  return {1 - second - third, second, third};
}

/// The original with its charts, and closest points on one chart at a time.
class Original {
 public:
  Original(const TriangleMesh& mesh, const MeshAttributes& attributes)
      : mesh_(mesh), charts_(charts(mesh, attributes)), triangles_of_(charts_.count), trees_(charts_.count) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) triangles_of_[charts_.chart_of[t]].push_back(t);
    positions_ = positions_of(mesh);
    at_position_.emplace(positions_);
    corners_at_.resize(mesh.vertices.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) corners_at_[charts_.first[mesh.triangles[t][k]]].push_back(3 * t + k);
  }

  [[nodiscard]] std::uint32_t chart_of(std::uint32_t triangle) const { return charts_.chart_of[triangle]; }
  /// Corners 3 t + k of triangles at exactly this position.
  [[nodiscard]] const std::vector<std::uint32_t>& corners_at(const Eigen::Vector3d& p) const {
    static const std::vector<std::uint32_t> no_corners;
    const std::uint32_t v = at_position_->find({p.x(), p.y(), p.z()});
    return v == no_index ? no_corners : corners_at_[v];
  }
  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t t) const {
    const Triangle& v = mesh_.triangles[t];
    return {mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]};
  }
  /// The closest point of a chart, by its triangle of the original.
  [[nodiscard]] SurfacePoint closest(std::uint32_t chart, const Eigen::Vector3d& p) {
    if (!trees_[chart]) {
      trees_[chart] = std::make_unique<Bvh>(part_of(triangles_of_[chart]));
    }
    SurfacePoint found = closest_point(*trees_[chart], p).point;
    found.triangle = triangles_of_[chart][found.triangle];
    return found;
  }
  /// The value at a point of a triangle; nothing where a corner has none.
  [[nodiscard]] std::optional<Eigen::Vector3d> value_at(const CornerAttribute& attribute,
                                                        const SurfacePoint& at) const {
    const Triangle& index = attribute.index[at.triangle];
    const Eigen::Vector3d weights = barycentric(corners(at.triangle), at.position);
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      if (index[k] == none) return std::nullopt;
      value += weights[static_cast<Eigen::Index>(k)] * attribute.values[index[k]];
    }
    return value;
  }

 private:
  [[nodiscard]] TriangleMesh part_of(const std::vector<std::uint32_t>& triangles) const {
    TriangleMesh part;
    for (const std::uint32_t t : triangles) {
      const auto first = static_cast<std::uint32_t>(part.vertices.size());
      for (const Eigen::Vector3d& p : corners(t)) part.vertices.push_back(p);
      part.triangles.push_back({first, first + 1, first + 2});
    }
    return part;
  }

  const TriangleMesh& mesh_;
  Charts charts_;
  std::vector<Vec3> positions_;
  std::optional<PositionTable> at_position_;
  std::vector<std::vector<std::uint32_t>> corners_at_;    ///< by first vertex at a position
  std::vector<std::vector<std::uint32_t>> triangles_of_;  ///< by chart
  std::vector<std::unique_ptr<Bvh>> trees_;               ///< by chart, made when asked for
};

/// The corners of a level, in sectors: those around one vertex that hang together without crossing a line.
class Sectors {
 public:
  explicit Sectors(const SimplifiedLevel& level) : parent_(3 * level.mesh.triangles.size()) {
    for (std::uint32_t c = 0; c < parent_.size(); ++c) parent_[c] = c;
    std::vector<Edge> lines = level.lines;
    for (Edge& edge : lines) std::sort(edge.begin(), edge.end());
    std::sort(lines.begin(), lines.end());
    const std::vector<Triangle>& triangles = level.mesh.triangles;
    std::map<Edge, std::uint32_t> open;  // edges seen once, with their corner
    for (std::uint32_t c = 0; c < parent_.size(); ++c) {
      Edge edge = {triangles[c / 3][c % 3], triangles[c / 3][(c + 1) % 3]};
      std::sort(edge.begin(), edge.end());
      if (std::binary_search(lines.begin(), lines.end(), edge)) continue;
      const auto [at, is_new] = open.emplace(edge, c);
      if (is_new) continue;
      const std::uint32_t d = at->second;
      for (const std::uint32_t i : {c, next(c)})
        for (const std::uint32_t j : {d, next(d)})
          if (triangles[i / 3][i % 3] == triangles[j / 3][j % 3]) parent_[root(i)] = root(j);
    }
  }
  /// A corner that stands for the sector.
  [[nodiscard]] std::uint32_t root(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }

 private:
  static std::uint32_t next(std::uint32_t c) { return c % 3 == 2 ? c - 2 : c + 1; }
  std::vector<std::uint32_t> parent_;
};

class Transfer {
 public:
  Transfer(const TriangleMesh& mesh, const MeshAttributes& attributes, const SimplifiedLevel& level)
      : original_(mesh, attributes), from_(attributes), level_(level), on_line_(level.mesh.vertices.size(), 0) {
    for (const Edge& edge : level.lines)
      for (const std::uint32_t v : edge) on_line_[v] = 1;
  }

  MeshAttributes run() {
    MeshAttributes result;
    result.material_libraries = from_.material_libraries;
    result.materials = labels(from_.materials);
    result.groups = labels(from_.groups);
    if (!from_.texture_coordinates.empty()) result.texture_coordinates = texture_coordinates();
    if (!from_.normals.empty()) result.normals = normals();
    return result;
  }

 private:
  [[nodiscard]] TriangleLabels labels(const TriangleLabels& from) const {
    TriangleLabels result{from.names, {}};
    if (from.empty()) return result;
    for (const std::uint32_t source : level_.source_triangle) result.index.push_back(from.index[source]);
    return result;
  }

  [[nodiscard]] Eigen::Vector3d position(std::uint32_t corner) const {
    return level_.mesh.vertices[level_.mesh.triangles[corner / 3][corner % 3]];
  }
  [[nodiscard]] Eigen::Vector3d point_inside(std::uint32_t corner, double share) const {
    const Triangle& t = level_.mesh.triangles[corner / 3];
    const auto& v = level_.mesh.vertices;
    const Eigen::Vector3d middle = (v[t[0]] + v[t[1]] + v[t[2]]) / 3;
    return position(corner) + share * (middle - position(corner));
  }
  [[nodiscard]] std::uint32_t chart(std::uint32_t corner) const {
    return original_.chart_of(level_.source_triangle[corner / 3]);
  }

  /// One value for each sector, that of its corners together.
  CornerAttribute texture_coordinates() {
    CornerAttribute result;
    Sectors sectors(level_);
    std::map<std::uint32_t, std::vector<std::uint32_t>> corners_of;
    for (std::uint32_t c = 0; c < 3 * level_.mesh.triangles.size(); ++c) corners_of[sectors.root(c)].push_back(c);
    result.index.assign(level_.mesh.triangles.size(), {none, none, none});
    for (const auto& [root, corners] : corners_of) {
      const std::optional<Eigen::Vector3d> value = value_of_sector(corners);
      if (!value) continue;
      for (const std::uint32_t c : corners)
        result.index[c / 3][c % 3] = static_cast<std::uint32_t>(result.values.size());
      result.values.push_back(*value);
    }
    return result;
  }

  std::optional<Eigen::Vector3d> value_of_sector(const std::vector<std::uint32_t>& corners) {
    const std::uint32_t c = corners.front();
    const std::uint32_t vertex = level_.mesh.triangles[c / 3][c % 3];
    if (on_line_[vertex] != 0) {
      if (const auto value = value_on_line(corners)) return value;
    }
    return original_.value_at(from_.texture_coordinates, original_.closest(chart(c), position(c)));
  }

  /// Among the corners of the original at the position, in the same chart, the one whose triangle is nearest to the
  /// sector: all have the same value unless the chart meets itself at the line.
  std::optional<Eigen::Vector3d> value_on_line(const std::vector<std::uint32_t>& corners) const {
    const CornerAttribute& from = from_.texture_coordinates;
    const Eigen::Vector3d p = position(corners.front());
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    for (const std::uint32_t c : corners) way += (point_inside(c, 1) - p).normalized();
    double best = -HUGE_VAL;
    std::optional<Eigen::Vector3d> value;
    for (const std::uint32_t c : original_.corners_at(p)) {
      const std::uint32_t index = from.index[c / 3][c % 3];
      if (index == none || original_.chart_of(c / 3) != chart(corners.front())) continue;
      const auto t = original_.corners(c / 3);
      const double alike = ((t[0] + t[1] + t[2]) / 3 - p).normalized().dot(way);
      if (alike > best) best = alike, value = from.values[index];
    }
    return value;
  }

  CornerAttribute normals() {
    CornerAttribute result;
    for (std::uint32_t c = 0; c < 3 * level_.mesh.triangles.size(); ++c) {
      if (c % 3 == 0) result.index.push_back({none, none, none});
      const auto value = original_.value_at(from_.normals, original_.closest(chart(c), point_inside(c, share_inside)));
      if (!value || !(value->norm() > 0)) continue;
      const Eigen::Vector3d unit = value->normalized();
      const auto [at, is_new] =
          number_.try_emplace({unit.x(), unit.y(), unit.z()}, static_cast<std::uint32_t>(result.values.size()));
      if (is_new) result.values.push_back(unit);
      result.index.back()[c % 3] = at->second;
    }
    return result;
  }

  Original original_;
  const MeshAttributes& from_;
  const SimplifiedLevel& level_;
  std::vector<std::uint8_t> on_line_;  ///< by vertex
  std::map<std::array<double, 3>, std::uint32_t> number_;
};

}  // namespace

MeshAttributes transferred_attributes(const TriangleMesh& original, const MeshAttributes& attributes,
                                      const SimplifiedLevel& level) {
  return Transfer(original, attributes, level).run();
}

}  // namespace meshbound
