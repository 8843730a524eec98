// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "geometry/magnitude.h"
#include "geometry/position_table.h"
#include "mesh/first_use.h"
#include "meshbound/error.h"
#include "meshbound/penetration_depth.h"
#include "numeric/no_index.h"
#include "penetration/closed_model_check.h"
#include "penetration/closed_model_data.h"
#include "penetration/exact_point.h"
#include "penetration/model_planes.h"

namespace meshbound {
namespace {

/// The mesh that `ClosedModel::Data` is made from: vertices at equal positions merged, triangles that repeat a vertex
/// dropped.
struct WeldedMesh {
  TriangleMesh mesh;
  std::vector<std::uint32_t> source_triangle;
};

WeldedMesh welded(const MeshView& view) {
  std::vector<Vec3> given(view.vertex_count());
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Eigen::Vector3d p = view.vertex(i);
    given[i] = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};  // -0 becomes 0
  }
  const std::vector<std::uint32_t> first = first_at_position(given);
  WeldedMesh result;
  FirstUse number(given.size());
  for (std::uint32_t i = 0; i < view.triangle_count(); ++i) {
    Triangle t = view.triangle(i);
    for (std::uint32_t& v : t) v = first[v];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    result.mesh.triangles.push_back(number(t));
    result.source_triangle.push_back(i);
  }
  for (const std::uint32_t v : number.used()) result.mesh.vertices.emplace_back(given[v].x, given[v].y, given[v].z);
  if (result.mesh.triangles.empty())
    throw InvalidInput("the mesh bounds no solid: each of its triangles repeats a position");
  return result;
}

void extend(ModelComponent& component, const std::vector<Vec3>& positions, std::uint32_t v) {
  const Vec3& p = positions[v];
  const auto at = [&](std::size_t k) -> const Vec3& { return positions[component.extremes[k]]; };
  if (p.x < at(0).x) component.extremes[0] = v;
  if (p.y < at(1).y) component.extremes[1] = v;
  if (p.z < at(2).z) component.extremes[2] = v;
  if (p.x > at(3).x) component.extremes[3] = v;
  if (p.y > at(4).y) component.extremes[4] = v;
  if (p.z > at(5).z) component.extremes[5] = v;
}

/// Components by flooding across edges, in the order of their first triangles.
void set_components(ClosedModel::Data& model) {
  model.component_of.assign(model.triangles.size(), no_index);
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < model.triangles.size(); ++first) {
    if (model.component_of[first] != no_index) continue;
    const auto component = static_cast<std::uint32_t>(model.components.size());
    ModelComponent& added = model.components.emplace_back();
    added.triangle = first;
    added.extremes.fill(model.triangles[first][0]);
    model.component_of[first] = component;
    open.assign(1, first);
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (const std::uint32_t v : model.triangles[t]) extend(added, model.positions, v);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = model.across(t, k);
        if (model.component_of[next] != no_index) continue;
        model.component_of[next] = component;
        open.push_back(next);
      }
    }
  }
}

}  // namespace

ClosedModel::ClosedModel(const MeshView& mesh, const BvhOptions& options) {
  validate(mesh);
  WeldedMesh closed = welded(mesh);
  auto data = std::make_shared<Data>(Bvh(closed.mesh, options));
  data->given_triangles = mesh.triangle_count();
  data->source_triangle = std::move(closed.source_triangle);
  data->triangles = std::move(closed.mesh.triangles);
  data->positions.reserve(closed.mesh.vertices.size());
  const Vec3& center = data->tree.data().frame.center;
  data->lowest_bit = std::min({lowest_bit(center.x), lowest_bit(center.y), lowest_bit(center.z)});
  for (const Eigen::Vector3d& p : closed.mesh.vertices) {
    const Vec3& v = data->positions.emplace_back(Vec3{p.x(), p.y(), p.z()});
    data->lowest_bit = std::min({data->lowest_bit, lowest_bit(v.x), lowest_bit(v.y), lowest_bit(v.z)});
    data->reach = std::max(data->reach, largest_magnitude_of(v - center));
  }
  require_closed(*data);
  set_components(*data);
  require_no_crossing(*data, options.stop);
  find_planes(*data, options.stop);
  require_outward(*data, options.stop);
  data_ = std::move(data);
}

const Bvh& ClosedModel::bvh() const { return data_->tree; }
std::size_t ClosedModel::triangle_count() const { return data_->given_triangles; }
std::size_t ClosedModel::component_count() const { return data_->components.size(); }
double ClosedModel::bounding_box_diagonal() const { return data_->tree.bounding_box_diagonal(); }

}  // namespace meshbound
