// SPDX-License-Identifier: MIT
#include "mesh/obj_attributes.h"

#include <algorithm>
#include <utility>

#include "mesh/no_value.h"
#include "mesh/opacity.h"

namespace meshbound {
namespace {

/// An index of the file counted from 0; -1 for none. `count` values have been read so far.
std::int64_t from_zero(std::int64_t index, std::size_t count) {
  return index > 0 ? index - 1 : index < 0 ? static_cast<std::int64_t>(count) + index : -1;
}

std::uint32_t checked(std::int64_t index, std::size_t count) {
  return index >= 0 && index < static_cast<std::int64_t>(count) ? static_cast<std::uint32_t>(index) : no_value;
}

bool has_values(const std::vector<Triangle>& index) {
  return std::any_of(index.begin(), index.end(), [](const Triangle& t) { return t != no_values; });
}

/// A positive index may refer to a value further down in the file, so indices are checked at the end.
void check_indices(CornerAttribute& attribute) {
  for (Triangle& t : attribute.index)
    for (std::uint32_t& i : t) i = checked(i == no_value ? -1 : std::int64_t{i}, attribute.values.size());
  if (!has_values(attribute.index)) attribute = {};
}

}  // namespace

void ObjAttributes::add_value(std::string_view keyword, const Eigen::Vector3d& value) {
  if (keyword == "vn") return attributes_.normals.values.push_back(value);
  attributes_.texture_coordinates.values.emplace_back(value.x(), value.y(), 0);
  if (value.z() != 0) ++solid_texture_coordinates_;
}

void ObjAttributes::add_colour(std::size_t vertex, const Eigen::Vector4d& colour) {
  colour_of_.resize(vertex, no_value);
  colour_of_.push_back(static_cast<std::uint32_t>(colours_.values.size() / colours_.width));
  colours_.values.insert(colours_.values.end(), colour.begin(), colour.end());
}

void ObjAttributes::take_colours(const std::vector<Triangle>& triangles) {
  for (const Triangle& t : triangles) {
    Triangle& index = colours_.index.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) index[k] = t[k] < colour_of_.size() ? colour_of_[t[k]] : no_value;
  }
  if (count_translucent(colours_) == 0) remove_opacity(colours_);
  attributes_.named.push_back(std::move(colours_));
}

void ObjAttributes::Labels::set(std::string name) {
  const auto [at, is_new] = number.try_emplace(name, static_cast<std::uint32_t>(all.names.size()));
  if (is_new) all.names.push_back(std::move(name));
  current = at->second;
}

void ObjAttributes::set_label(std::string_view keyword, std::string_view argument) {
  if (keyword == "usemtl" && !argument.empty()) materials_.set(std::string(argument));
  if (keyword == "o") objects_.set(std::string(argument));
  if (keyword == "g") groups_.set(std::string(argument));
  if (keyword == "s" && !argument.empty()) smoothing_groups_.set(argument == "0" ? "off" : std::string(argument));
  if (keyword == "mtllib" && !argument.empty()) attributes_.material_libraries.emplace_back(argument);
}

void ObjAttributes::add_corner(std::int64_t texture_coordinate, std::int64_t normal) {
  corners_.push_back({from_zero(texture_coordinate, attributes_.texture_coordinates.values.size()),
                      from_zero(normal, attributes_.normals.values.size())});
}

void ObjAttributes::end_polygon() {
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    Triangle texture, normal;
    const std::size_t fan[] = {0, i - 1, i};
    for (std::size_t k = 0; k < 3; ++k) {
      texture[k] = checked(corners_[fan[k]].texture_coordinate, no_value);
      normal[k] = checked(corners_[fan[k]].normal, no_value);
    }
    attributes_.texture_coordinates.index.push_back(texture);
    attributes_.normals.index.push_back(normal);
    materials_.all.index.push_back(materials_.current);
    objects_.all.index.push_back(objects_.current);
    groups_.all.index.push_back(groups_.current);
    smoothing_groups_.all.index.push_back(smoothing_groups_.current);
  }
}

MeshAttributes ObjAttributes::finish(const std::vector<Triangle>& triangles, DroppedAttributes& dropped) {
  check_indices(attributes_.texture_coordinates);
  check_indices(attributes_.normals);
  if (!materials_.all.names.empty()) attributes_.materials = std::move(materials_.all);
  if (!objects_.all.names.empty()) attributes_.objects = std::move(objects_.all);
  if (!groups_.all.names.empty()) attributes_.groups = std::move(groups_.all);
  const auto is_off = [](const std::string& name) { return name == "off"; };
  const std::vector<std::string>& smoothing = smoothing_groups_.all.names;
  if (!std::all_of(smoothing.begin(), smoothing.end(), is_off))
    attributes_.smoothing_groups = std::move(smoothing_groups_.all);
  if (!colours_.values.empty()) take_colours(triangles);
  dropped.texture_coordinates = solid_texture_coordinates_;
  dropped.normals = dropped.materials = dropped.groups = 0;
  dropped.colours = dropped.smoothing_groups = 0;
  return std::move(attributes_);
}

}  // namespace meshbound
