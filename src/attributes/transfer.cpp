// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "attributes/chart_surface.h"
#include "attributes/sectors.h"
#include "mesh/attribute_check.h"
#include "mesh/first_use.h"
#include "mesh/no_value.h"
#include "mesh/round_to_floats.h"
#include "mesh/split_vertices.h"
#include "meshbound/error.h"
#include "meshbound/simplify.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// Where a corner belongs is looked up at a point this share of the way from the corner to the middle of its triangle.
constexpr double share_inside = 0.1;

/// Cosine of 5 degrees: normals that differ by less look alike. Neighbouring corners with such normals get one common
/// normal; sharper edges have a normal on each side.
constexpr double smooth_cosine = 0.9962;

/// Cosine of 20 degrees: triangles of level and original within this angle have the same direction.
constexpr double min_alignment = 0.9397;

/// Weights below this are what rounding leaves of 0: that of points on an edge, some thousand units of the last place.
constexpr double rounding_of_weights = 0x1p-40;

/// The interpolated value at a point, by values at corners. Between corners with one value it is this value exactly:
/// where a wall has its texture from above, all of a vertical edge keeps one texture coordinate.
template <class Value, class ValueAtCorner>
Value interpolated(const WeightedPoint& at, const ValueAtCorner& value) {
  const std::size_t nearest = at.nearest_corner();
  const Value base = value(nearest);
  Value sum = base;
  for (const std::size_t k : {(nearest + 1) % 3, (nearest + 2) % 3})
    if (const double weight = at.weights[static_cast<Eigen::Index>(k)]; weight > rounding_of_weights)
      sum += weight * (value(k) - base);
  return sum;
}

/// The interpolated value at a point; absent if a corner of its triangle has none.
std::optional<Eigen::Vector3d> value_at(const CornerAttribute& attribute, const WeightedPoint& at) {
  const Triangle& index = attribute.index[at.triangle];
  if (!all_have_values(index)) return std::nullopt;
  return interpolated<Eigen::Vector3d>(
      at, [&](std::size_t k) -> const Eigen::Vector3d& { return attribute.values[index[k]]; });
}

/// Appends the value of an attribute at a point to `values`; false if a corner of its triangle has none.
bool append_value(const NamedAttribute& attribute, const WeightedPoint& at, std::vector<double>& values) {
  const Triangle& index = attribute.index[at.triangle];
  if (!all_have_values(index)) return false;
  const auto number = [&](std::size_t corner, std::size_t i) {
    return attribute.values[index[corner] * attribute.width + i];
  };
  const std::size_t nearest = at.nearest_corner(), first = values.size();
  for (std::size_t i = 0; i < attribute.width; ++i) {
    const bool is_mean = attribute.interpolation == Interpolation::Linear ||
                         (attribute.interpolation == Interpolation::Direction && i < 3);
    values.push_back(is_mean ? interpolated<double>(at, [&](std::size_t k) { return number(k, i); })
                             : number(nearest, i));
  }
  if (attribute.interpolation != Interpolation::Direction || attribute.width < 3) return true;
  Eigen::Map<Eigen::Vector3d> direction(values.data() + first);
  if (direction.norm() > 0) {
    direction.normalize();
  } else {
    for (std::size_t i = 0; i < 3; ++i) values[first + i] = number(nearest, i);
  }
  return true;
}

/// Means of colours that a file holds as bytes are bytes again, which all formats then keep.
void round_to_bytes(NamedAttribute& colours) {
  constexpr double max_byte = 255;
  for (double& value : colours.values) value = std::round(max_byte * value) / max_byte;
}

/// The unit normal of a triangle; not a unit vector where it has no area.
Eigen::Vector3d direction(const std::array<Eigen::Vector3d, 3>& corners) {
  const Eigen::Vector3d u = (corners[1] - corners[0]).stableNormalized();
  return u.cross((corners[2] - corners[0]).stableNormalized()).stableNormalized();
}

/// Whether the second point is the first one, or its rounding to floats.
bool is_rounded(const Eigen::Vector3d& p, const Eigen::Vector3d& rounded) {
  return rounded == p || rounded == rounded_to_float(p);
}

/// Whether every vertex of a level is known to stand where its source does, but for the rounding to floats.
bool stands_on_vertices(const TriangleMesh& original, const SimplifiedLevel& level) {
  if (level.source_vertex.size() != level.mesh.vertices.size()) return false;
  for (std::size_t v = 0; v < level.mesh.vertices.size(); ++v) {
    if (!is_rounded(original.vertices[level.source_vertex[v]], level.mesh.vertices[v])) return false;
  }
  return true;
}

void check_sources(const TriangleMesh& original, const SimplifiedLevel& level) {
  const auto all_below = [](const std::vector<std::uint32_t>& numbers, std::size_t count) {
    return std::all_of(numbers.begin(), numbers.end(), [&](std::uint32_t i) { return i < count; });
  };
  if (level.source_triangle.size() != level.mesh.triangles.size() ||
      !all_below(level.source_triangle, original.triangles.size()) ||
      !all_below(level.source_vertex, original.vertices.size()))
    throw InvalidInput("the level does not come from this mesh: its sources are no vertices and triangles of it");
}

class Transfer {
 public:
  Transfer(const TriangleMesh& mesh, const MeshAttributes& attributes, const SimplifiedLevel& level)
      : original_mesh_(mesh),
        from_(attributes),
        level_(level),
        keeps_vertices_(stands_on_vertices(mesh, level)),
        on_line_(level.mesh.vertices.size(), 0) {
    for (const Edge& edge : level.lines)
      for (const std::uint32_t v : edge) on_line_[v] = 1;
  }

  MeshAttributes run() {
    MeshAttributes result;
    result.texture_precision = from_.texture_precision;
    result.material_libraries = from_.material_libraries;
    result.document = from_.document;
    result.materials = labels(from_.materials);
    result.objects = labels(from_.objects);
    result.groups = labels(from_.groups);
    result.smoothing_groups = labels(from_.smoothing_groups);
    result.part = by_source_triangle(from_.part);
    if (!from_.texture_coordinates.empty() || !from_.named.empty()) take_values_of_sectors(result);
    for (std::size_t i = 0; i < result.named.size(); ++i)
      if (from_.named[i].name == "COLOR_0" && holds_bytes(from_.named[i])) round_to_bytes(result.named[i]);
    if (!from_.normals.empty()) result.normals = normals();
    return result;
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> by_source_triangle(const std::vector<std::uint32_t>& from) const {
    std::vector<std::uint32_t> result;
    if (from.empty()) return result;
    for (const std::uint32_t source : level_.source_triangle) result.push_back(from[source]);
    return result;
  }
  [[nodiscard]] TriangleLabels labels(const TriangleLabels& from) const {
    return {from.names, by_source_triangle(from.index)};
  }

  ChartSurface& original() {
    if (!original_) original_.emplace(original_mesh_, charts(original_mesh_, from_));
    return *original_;
  }
  [[nodiscard]] Sectors sectors(const MayJoin& may_join = {}) {
    if (!sectors_) sectors_.emplace(level_);
    return sectors_->find(may_join);
  }
  [[nodiscard]] std::uint32_t vertex(std::uint32_t corner) const {
    return level_.mesh.triangles[corner / 3][corner % 3];
  }
  [[nodiscard]] Eigen::Vector3d position(std::uint32_t corner) const { return level_.mesh.vertices[vertex(corner)]; }
  [[nodiscard]] Eigen::Vector3d point_inside(std::uint32_t corner, double share) const {
    const Triangle& t = level_.mesh.triangles[corner / 3];
    const auto& v = level_.mesh.vertices;
    const Eigen::Vector3d middle = (v[t[0]] + v[t[1]] + v[t[2]]) / 3;
    return position(corner) + share * (middle - position(corner));
  }
  [[nodiscard]] std::uint32_t chart(std::uint32_t corner) {
    return original().chart_of(level_.source_triangle[corner / 3]);
  }
  [[nodiscard]] std::vector<Triangle> all_without_values() const {
    return std::vector<Triangle>(level_.mesh.triangles.size(), no_values);
  }

  /// Texture coordinates and named attributes: one value for all corners of a sector.
  void take_values_of_sectors(MeshAttributes& result) {
    if (!from_.texture_coordinates.empty()) result.texture_coordinates.index = all_without_values();
    for (const NamedAttribute& from : from_.named)
      result.named.push_back({from.name, from.width, from.interpolation, from.has_seams, {}, all_without_values()});
    const bool has_own_coordinates = !level_.texture_coordinates.empty();
    const bool needs_points = !has_own_coordinates || !from_.named.empty();
    const Sectors sectors = this->sectors();
    for (std::size_t s = 0; s < sectors.size(); ++s) {
      const std::span<const std::uint32_t> corners = sectors[s];
      const WeightedPoint at = needs_points ? point_of_sector(corners) : WeightedPoint();
      if (!from_.texture_coordinates.empty()) {
        const auto value =
            has_own_coordinates ? own_coordinate(corners.front()) : value_at(from_.texture_coordinates, at);
        if (value) {
          set_index(result.texture_coordinates.index, corners, result.texture_coordinates.values.size());
          result.texture_coordinates.values.push_back(*value);
        }
      }
      for (std::size_t i = 0; i < from_.named.size(); ++i) {
        NamedAttribute& to = result.named[i];
        const std::size_t count = to.values.size() / to.width;
        if (append_value(from_.named[i], at, to.values)) set_index(to.index, corners, count);
      }
    }
  }

  /// The texture coordinate that the level has at a corner, if it has one there.
  [[nodiscard]] std::optional<Eigen::Vector3d> own_coordinate(std::uint32_t corner) const {
    const Eigen::Vector2d& value = level_.texture_coordinates[corner / 3][corner % 3];
    if (!value.allFinite()) return std::nullopt;
    return Eigen::Vector3d(value.x(), value.y(), 0);
  }

  static void set_index(std::vector<Triangle>& index, std::span<const std::uint32_t> corners, std::size_t value) {
    for (const std::uint32_t c : corners) index[c / 3][c % 3] = static_cast<std::uint32_t>(value);
  }

  WeightedPoint point_of_sector(std::span<const std::uint32_t> corners) {
    const std::uint32_t c = corners.front();
    if (keeps_vertices_ || on_line_[vertex(c)] != 0) {
      if (const auto of_original = corner_of_original(corners)) return WeightedPoint::at_corner(*of_original);
    }
    return original().closest(chart(c), position(c));
  }

  /// The corners of the original where a corner stands.
  [[nodiscard]] std::span<const std::uint32_t> corners_at(std::uint32_t corner) {
    return original().corners_at(keeps_vertices_ ? original_mesh_.vertices[level_.source_vertex[vertex(corner)]]
                                                 : position(corner));
  }

  /// Among the corners of the original at the position, in the same chart, the one whose triangle is nearest to the
  /// sector. All of them have equal values unless the chart touches itself along a line.
  [[nodiscard]] std::optional<std::uint32_t> corner_of_original(std::span<const std::uint32_t> corners) {
    const Eigen::Vector3d p = position(corners.front());
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    for (const std::uint32_t c : corners) way += (point_inside(c, 1) - p).stableNormalized();
    double best = -HUGE_VAL;
    std::optional<std::uint32_t> found;
    for (const std::uint32_t c : corners_at(corners.front())) {
      if (original().chart_of(c / 3) != chart(corners.front())) continue;
      const auto t = original().corners(c / 3);
      const double alike = ((t[0] + t[1] + t[2]) / 3 - p).stableNormalized().dot(way);
      if (alike > best) best = alike, found = c;
    }
    return found;
  }

  /// Zero where the original has no normal. One of length 0, which some exporters write, stands for that of its
  /// triangle.
  [[nodiscard]] Eigen::Vector3d normal_at(const WeightedPoint& at) {
    const auto value = value_at(from_.normals, at);
    if (!value) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d normal = value->stableNormalized();
    if (normal.squaredNorm() > 0.5) return normal;  // also false where it is not a number
    const Eigen::Vector3d of_triangle = direction(original().corners(at.triangle));
    return of_triangle.squaredNorm() > 0.5 ? of_triangle : Eigen::Vector3d::UnitZ();
  }

  /// Cosine of the angle between a triangle of the level and one of the original.
  [[nodiscard]] double alignment(std::uint32_t triangle, std::uint32_t of_original) {
    const Triangle& v = level_.mesh.triangles[triangle];
    const auto& p = level_.mesh.vertices;
    return direction({p[v[0]], p[v[1]], p[v[2]]}).dot(direction(original().corners(of_original)));
  }

  /// The point of the original that a point inside a triangle of the level stands for: the closest one. Where the
  /// original has another direction there, as it does at edges and on the other side of thin sheets, the closest one of
  /// the smooth surface that the triangle comes from, if that is better aligned.
  WeightedPoint counterpart(std::uint32_t triangle, const Eigen::Vector3d& inside, ChartSurface& smooth) {
    const std::uint32_t source = level_.source_triangle[triangle];
    const WeightedPoint closest = original().closest(original().chart_of(source), inside);
    const double aligned = alignment(triangle, closest.triangle);
    if (aligned >= min_alignment || &smooth == &original()) return closest;
    const WeightedPoint of_source = smooth.closest(smooth.chart_of(source), inside);
    return alignment(triangle, of_source.triangle) > aligned ? of_source : closest;
  }

  /// The normal of a corner, zero if the original has none there: that of the original where its smooth surface is
  /// nearest to the vertex. Where the normal changes much from there to a point inside the triangle, as where a rounded
  /// edge has become a sharp one, it is that of the original near the inner point.
  Eigen::Vector3d normal_of(std::uint32_t corner, ChartSurface& smooth) {
    const WeightedPoint at = counterpart(corner / 3, point_inside(corner, share_inside), smooth);
    const Eigen::Vector3d normal_inside = normal_at(at);
    const Eigen::Vector3d normal = normal_of_vertex(vertex(corner), smooth.chart_of(at.triangle), smooth);
    return normal.dot(normal_inside) >= smooth_cosine ? normal : normal_inside;
  }

  /// The normal of the original where the smooth surface is nearest to a vertex. Most corners of a vertex ask for the
  /// same surface.
  const Eigen::Vector3d& normal_of_vertex(std::uint32_t v, std::uint32_t chart, ChartSurface& smooth) {
    NormalOnChart& known = normal_of_vertex_[v];
    if (known.chart != chart) known = {chart, normal_at(smooth.closest(chart, level_.mesh.vertices[v]))};
    return known.normal;
  }

  /// Where a triangle is one of the original as it was: which corner of that one its first corner is.
  [[nodiscard]] std::optional<std::uint32_t> turn_of_unchanged(std::uint32_t triangle) const {
    const Triangle& now = level_.mesh.triangles[triangle];
    const Triangle& before = original_mesh_.triangles[level_.source_triangle[triangle]];
    const auto is_same = [&](std::size_t k, std::size_t j) {
      return is_rounded(original_mesh_.vertices[before[j]], level_.mesh.vertices[now[k]]);
    };
    for (std::uint32_t turn = 0; turn < 3; ++turn)
      if (is_same(0, turn) && is_same(1, (turn + 1) % 3) && is_same(2, (turn + 2) % 3)) return turn;
    return std::nullopt;
  }

  CornerAttribute normals() {
    ChartPartition cut = original().charts();
    std::optional<ChartSurface> own;
    if (cut_at_normals(original_mesh_, from_.normals, cut)) own.emplace(original_mesh_, std::move(cut));
    ChartSurface& smooth = own ? *own : original();
    normal_of_vertex_.resize(level_.mesh.vertices.size());
    std::vector<Eigen::Vector3d> by_corner;
    for (std::uint32_t t = 0; t < level_.mesh.triangles.size(); ++t) {
      const auto turn = turn_of_unchanged(t);
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (turn)
          by_corner.push_back(normal_at(WeightedPoint::at_corner(3 * level_.source_triangle[t] + (k + *turn) % 3)));
        else
          by_corner.push_back(normal_of(3 * t + k, smooth));
      }
    }
    return keeps_vertices_ ? normals_of_vertices(by_corner) : shared_means(by_corner);
  }

  [[nodiscard]] CornerAttribute shared_means(const std::vector<Eigen::Vector3d>& by_corner) {
    CornerAttribute result;
    result.index = all_without_values();
    const auto is_smooth = [&](std::uint32_t i, std::uint32_t j) {
      return by_corner[i].dot(by_corner[j]) >= smooth_cosine;
    };
    const Sectors sectors = this->sectors(is_smooth);
    for (std::size_t s = 0; s < sectors.size(); ++s) {
      const std::span<const std::uint32_t> corners = sectors[s];
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const std::uint32_t c : corners) sum += by_corner[c];
      if (!(sum.norm() > 0)) sum = by_corner[corners.front()];
      if (!(sum.norm() > 0)) continue;
      set_index(result.index, corners, result.values.size());
      result.values.push_back(sum.normalized());
    }
    return result;
  }

  /// For each corner, the normal most like the given one among the corners of the original at its vertex that have the
  /// other values of its sector.
  [[nodiscard]] CornerAttribute normals_of_vertices(const std::vector<Eigen::Vector3d>& by_corner) {
    CornerAttribute result;
    result.index = all_without_values();
    FirstUse number_of(from_.normals.values.size());
    const Sectors sectors = this->sectors();
    for (std::size_t s = 0; s < sectors.size(); ++s) {
      const std::span<const std::uint32_t> corners = sectors[s];
      const auto of_original = corner_of_original(corners);
      if (!of_original) continue;
      for (const std::uint32_t c : corners) {
        const std::uint32_t normal = normal_most_like(by_corner[c], *of_original, corners_at(c));
        if (normal != no_value) result.index[c / 3][c % 3] = number_of(normal);
      }
    }
    for (const std::uint32_t normal : number_of.used()) result.values.push_back(from_.normals.values[normal]);
    return result;
  }

  /// The index of a normal of `candidates`, corners of the original that have all other values of `corner`; `none`
  /// where these have no normal.
  [[nodiscard]] std::uint32_t normal_most_like(const Eigen::Vector3d& given, std::uint32_t corner,
                                               std::span<const std::uint32_t> candidates) {
    double best = -HUGE_VAL;
    std::uint32_t found = no_value;
    for (const std::uint32_t c : candidates) {
      const std::uint32_t normal = from_.normals.index[c / 3][c % 3];
      if (normal == no_value || !has_equal_values(corner, c)) continue;
      const double alike = given.dot(from_.normals.values[normal]);
      if (alike > best) best = alike, found = normal;
    }
    return found;
  }

  /// Whether two corners of the original have the same chart, texture coordinates and named attributes.
  [[nodiscard]] bool has_equal_values(std::uint32_t a, std::uint32_t b) {
    const auto is_equal = [&](const std::vector<Triangle>& index, const auto& value) {
      if (index.empty()) return true;
      const std::uint32_t i = index[a / 3][a % 3], j = index[b / 3][b % 3];
      return i == j || (i != no_value && j != no_value && value(i) == value(j));
    };
    return original().chart_of(a / 3) == original().chart_of(b / 3) &&
           is_equal(from_.texture_coordinates.index,
                    [&](std::size_t i) { return from_.texture_coordinates.values[i]; }) &&
           std::all_of(from_.named.begin(), from_.named.end(), [&](const NamedAttribute& named) {
             return is_equal(named.index, [&](std::size_t i) {
               return Eigen::Map<const Eigen::VectorXd>(named.values.data() + i * named.width,
                                                        static_cast<Eigen::Index>(named.width));
             });
           });
  }

  struct NormalOnChart {
    std::uint32_t chart = no_index;
    Eigen::Vector3d normal;
  };

  const TriangleMesh& original_mesh_;
  std::optional<ChartSurface> original_;  ///< once asked for
  const MeshAttributes& from_;
  const SimplifiedLevel& level_;
  std::optional<SectorFinder> sectors_;          ///< once asked for
  bool keeps_vertices_;                          ///< every vertex of the level is one of the original
  std::vector<std::uint8_t> on_line_;            ///< by vertex
  std::vector<NormalOnChart> normal_of_vertex_;  ///< by vertex: the one found last
};

}  // namespace

MeshAttributes transferred_attributes(const TriangleMesh& original, const MeshAttributes& attributes,
                                      const SimplifiedLevel& level) {
  check_attributes(attributes, original.triangles.size());
  check_sources(original, level);
  return Transfer(original, attributes, level).run();
}

}  // namespace meshbound
