// SPDX-License-Identifier: MIT
#include "meshbound/normal_deviation.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "distance/shortcuts/triangle_table.h"
#include "geometry/eigen_vec3.h"
#include "geometry/longest_edge.h"
#include "geometry/position_table.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/error.h"
#include "numeric/tasks.h"
#include "simplify/cover/box_tree.h"

namespace meshbound {
namespace {

constexpr double tie_share = 1e-9;          ///< of the diagonal of A: distances that differ by less are equal
constexpr double rounding_share = 0x1p-40;  ///< of the largest coordinate: likewise
constexpr std::size_t grain = 1024;         ///< faces that a thread takes at once

using Corners = std::array<Eigen::Vector3d, 3>;

Corners corners_of(const MeshView& mesh, std::size_t triangle) {
  const Triangle t = mesh.triangle(triangle);
  return {mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2])};
}

/// The unit normal; absent for a triangle without area.
std::optional<Eigen::Vector3d> normal_of(const Corners& c) {
  const double longest = std::max({(c[1] - c[0]).stableNorm(), (c[2] - c[1]).stableNorm(), (c[0] - c[2]).stableNorm()});
  if (!(longest > 0)) return std::nullopt;
  const Eigen::Vector3d normal = ((c[1] - c[0]) / longest).cross((c[2] - c[0]) / longest);
  const double length = normal.norm();
  if (!(length > 0)) return std::nullopt;
  return normal / length;
}

double degrees_between(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return std::atan2(p.cross(q).norm(), p.dot(q)) * (180 / std::numbers::pi);
}

/// The faces of B that have an area.
class Faces {
 public:
  explicit Faces(const MeshView& mesh) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const Corners corners = corners_of(mesh, t);
      const auto normal = normal_of(corners);
      if (!normal) continue;
      const auto first = static_cast<std::uint32_t>(3 * triangles_.size());
      vertices_.insert(vertices_.end(), corners.begin(), corners.end());
      triangles_.push_back({first, first + 1, first + 2});
      normals_.push_back(*normal);
      source_.push_back(static_cast<std::uint32_t>(t));
    }
    if (triangles_.empty()) throw InvalidInput("no triangle has an area, so there are no normals to compare with");
  }
  [[nodiscard]] TriangleMesh mesh() const { return {vertices_, triangles_}; }
  [[nodiscard]] std::size_t size() const { return triangles_.size(); }
  [[nodiscard]] Corners corners(std::uint32_t face) const {
    return {vertices_[3 * face], vertices_[3 * face + 1], vertices_[3 * face + 2]};
  }
  [[nodiscard]] const Eigen::Vector3d& normal(std::uint32_t face) const { return normals_[face]; }
  [[nodiscard]] std::uint32_t source(std::uint32_t face) const { return source_[face]; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  [[nodiscard]] std::vector<Eigen::AlignedBox3d> boxes() const {
    std::vector<Eigen::AlignedBox3d> boxes(size());
    for (std::uint32_t f = 0; f < size(); ++f)
      for (const Eigen::Vector3d& p : corners(f)) boxes[f].extend(p);
    return boxes;
  }

 private:
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<std::uint32_t> source_;
};

/// The vector to p from the point of the triangle nearest to it. Coordinates around p are divided by the largest one,
/// so that squares neither overflow nor underflow.
Eigen::Vector3d offset_from(const Corners& corners, const Eigen::Vector3d& p) {
  double size = 0;
  for (const Eigen::Vector3d& corner : corners) size = std::max(size, (corner - p).cwiseAbs().maxCoeff());
  if (!(size > 0)) return Eigen::Vector3d::Zero();
  std::array<Vec3, 3> c;  // around p
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d way = (corners[k] - p) / size;
    c[k] = {way.x(), way.y(), way.z()};
  }
  const Vec3 offset = closest_on_triangle(longest_edge_first(c), Vec3{}).offset;
  return size * Eigen::Vector3d(offset.x, offset.y, offset.z);
}

/// Distances from a point to faces that differ by less than this count as equal.
double tie_of(const MeshView& mesh) {
  Eigen::AlignedBox3d box;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (const Eigen::Vector3d& p : corners_of(mesh, t)) box.extend(p);
  if (box.isEmpty()) return 0;
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  return std::max(tie_share * box.diagonal().stableNorm(), rounding_share * largest);
}

/// Finds the faces that stand for others.
class StandIns {
 public:
  StandIns(const MeshView& a, const MeshView& b, int threads)
      : faces_(b),
        positions_(positions_of(faces_.mesh())),
        tree_(faces_.mesh(), {threads}),
        boxes_(faces_.boxes()),
        tie_(tie_of(a)) {}

  /// The turns of the faces of A from `begin` to below `end`: of those above the tolerance, of the first that turns
  /// most, and of some others.
  [[nodiscard]] std::vector<FaceTurn> of(const MeshView& a, std::size_t begin, std::size_t end,
                                         double tolerance) const {
    std::vector<SurfacePoint> middles;
    std::vector<Eigen::Vector3d> positions, normals;
    std::optional<FaceTurn> unchanged;  // the first
    for (std::size_t t = begin; t < end; ++t) {
      const Corners corners = corners_of(a, t);
      const auto normal = normal_of(corners);
      if (!normal) continue;
      const SurfacePoint middle{(corners[0] + corners[1] + corners[2]) / 3, static_cast<std::uint32_t>(t)};
      if (const auto same = unturned(corners, *normal)) {
        if (!unchanged) unchanged = {middle, {middle.position, *same}, 0};
        continue;
      }
      middles.push_back(middle);
      positions.push_back(middles.back().position);
      normals.push_back(*normal);
    }
    const std::vector<ClosestPoint> closest = closest_points(tree_, positions, {1});
    std::vector<FaceTurn> turns;
    if (unchanged) turns.push_back(*unchanged);
    double worst = 0;
    for (std::size_t i = 0; i < middles.size(); ++i) {
      // The face that stands for this one turns no more than the one that is found nearest.
      const double at_most = degrees_between(normals[i], faces_.normal(closest[i].point.triangle));
      if (at_most < worst && at_most <= tolerance) continue;
      turns.push_back(turn_of(middles[i], normals[i], closest[i].distance.upper + tie_));
      worst = std::max(worst, turns.back().degrees);
    }
    return turns;
  }

 private:
  /// The face of B with the same corners and the same normal, up to rounding, if there is one: no other one turns less.
  [[nodiscard]] std::optional<std::uint32_t> unturned(const Corners& corners, const Eigen::Vector3d& normal) const {
    const Triangle at = {vertex_at_.find(to_vec3(corners[0])), vertex_at_.find(to_vec3(corners[1])),
                         vertex_at_.find(to_vec3(corners[2]))};
    if (std::find(at.begin(), at.end(), no_index) != at.end()) return std::nullopt;
    const std::uint32_t same = face_at_.find(at);
    if (same == no_index || !(normal.dot(faces_.normal(same)) > 0)) return std::nullopt;
    return faces_.source(same);
  }
  /// The turn from a face to that of the faces within `reach` of its middle which turns least.
  [[nodiscard]] FaceTurn turn_of(const SurfacePoint& middle, const Eigen::Vector3d& normal, double reach) const {
    FaceTurn turn{middle, {}, HUGE_VAL};
    std::vector<std::uint32_t> near;
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(reach);
    boxes_.find({middle.position - around, middle.position + around}, near);
    for (const std::uint32_t f : near) {
      const Eigen::Vector3d offset = offset_from(faces_.corners(f), middle.position);
      const double degrees = degrees_between(normal, faces_.normal(f));
      if (offset.stableNorm() > reach || degrees >= turn.degrees) continue;
      turn.degrees = degrees;
      turn.nearest = {middle.position - offset, faces_.source(f)};
    }
    return turn;
  }

  Faces faces_;
  std::vector<Vec3> positions_;  ///< of the corners of the faces
  PositionTable vertex_at_{positions_};
  TriangleTable face_at_{faces_.triangles(), positions_, vertex_at_};
  Bvh tree_;
  BoxTree boxes_;
  double tie_;
};

}  // namespace

NormalDeviation normal_deviation(const MeshView& a, const MeshView& b, const NormalDeviationOptions& options) {
  validate(a);
  validate(b);
  if (options.tolerance && !(*options.tolerance >= 0))
    throw InvalidInput("the normal tolerance must be an angle in degrees, 0 or more");
  const StandIns stand_ins(a, b, options.threads);
  std::vector<std::vector<FaceTurn>> turns(a.triangle_count() / grain + 1);  // by range
  with_team(options.threads > 0 ? options.threads : omp_get_max_threads(), [&] {
    for_each_range(a.triangle_count(), grain, [&](std::size_t begin, std::size_t end) {
      turns[begin / grain] = stand_ins.of(a, begin, end, options.tolerance.value_or(180));
    });
  });
  NormalDeviation result;
  for (const std::vector<FaceTurn>& of_range : turns) {
    for (const FaceTurn& turn : of_range) {
      if (!result.worst || turn.degrees > result.degrees) {
        result.degrees = turn.degrees;
        result.worst = turn;
      }
      if (options.tolerance && turn.degrees > *options.tolerance) result.exceeding.push_back(turn);
    }
  }
  return result;
}

}  // namespace meshbound
