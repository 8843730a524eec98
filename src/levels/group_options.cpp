// SPDX-License-Identifier: MIT
#include "levels/group_options.h"

#include <algorithm>

#include "numeric/no_index.h"
#include "simplify/option_sizes.h"

namespace meshbound {
namespace {

SimplifyOptions without_places(SimplifyOptions options) {
  options.feature_edges = {};
  options.locked_vertices = {};
  options.face_tolerances = {};
  options.texture_coordinates = {};
  options.materials = {};
  options.looks = {};
  return options;
}

/// What is given by triangle, if it is given.
template <class Values>
Values taken(const Values& from, const std::vector<std::uint32_t>& triangles) {
  Values result;
  if (from.empty()) return result;
  result.reserve(triangles.size());
  for (const std::uint32_t t : triangles) result.push_back(from[t]);
  return result;
}

}  // namespace

GroupOptions::GroupOptions(const TriangleMesh& original, const SimplifyOptions& options)
    : original_(original),
      options_(options),
      common_(without_places(options)),
      edges_(options.feature_edges),
      number_(original.vertices.size(), no_index) {
  check_sizes(options, original.vertices.size(), original.triangles.size());
  std::sort(edges_.begin(), edges_.end());
  first_edge_.assign(original.vertices.size() + 1, 0);
  for (const Edge& edge : edges_) ++first_edge_[edge[0] + 1];
  for (std::size_t v = 0; v < original.vertices.size(); ++v) first_edge_[v + 1] += first_edge_[v];
}

SimplifyOptions GroupOptions::of(const SceneGroup& group) {
  const auto number = [&](const std::vector<std::uint32_t>& vertices) {
    for (std::uint32_t v = 0; v < vertices.size(); ++v) number_[vertices[v]] = v;
    numbered_.insert(numbered_.end(), vertices.begin(), vertices.end());
  };
  if (group.copies.empty()) number(group.vertices);
  for (const SceneCopy& copy : group.copies) number(vertices_of_copy(original_, group, copy));
  SimplifyOptions result = common_;
  add_feature_edges(result);
  add_locked_vertices(result, group.vertices.size());
  add_face_tolerances(result, group);
  result.texture_coordinates = taken(options_.texture_coordinates, group.triangles);
  result.materials = taken(options_.materials, group.triangles);
  result.looks = taken(options_.looks, group.triangles);
  for (const std::uint32_t v : numbered_) number_[v] = no_index;
  numbered_.clear();
  return result;
}

void GroupOptions::add_feature_edges(SimplifyOptions& to) const {
  for (const std::uint32_t a : numbered_)
    for (std::uint32_t i = first_edge_[a]; i < first_edge_[a + 1]; ++i)
      if (const std::uint32_t b = number_[edges_[i][1]]; b != no_index) to.feature_edges.push_back({number_[a], b});
}

void GroupOptions::add_locked_vertices(SimplifyOptions& to, std::size_t count) const {
  if (options_.locked_vertices.empty()) return;
  to.locked_vertices.assign(count, false);
  for (const std::uint32_t v : numbered_)
    if (options_.locked_vertices[v]) to.locked_vertices[number_[v]] = true;
}

void GroupOptions::add_face_tolerances(SimplifyOptions& to, const SceneGroup& group) const {
  to.face_tolerances = taken(options_.face_tolerances, group.triangles);
  for (const SceneCopy& copy : group.copies)
    for (std::uint32_t i = 0; i < to.face_tolerances.size(); ++i)
      to.face_tolerances[i] = std::min(to.face_tolerances[i], options_.face_tolerances[copy.first_triangle + i]);
}

}  // namespace meshbound
