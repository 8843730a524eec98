// SPDX-License-Identifier: MIT
#include "mesh/mesh_assembler.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "meshbound/mesh_view.h"

namespace meshbound {

void MeshAssembler::reserve(std::size_t vertices, std::size_t triangles) {
  if (source_.sink != nullptr) return;
  file_.mesh.vertices.reserve(vertices);
  file_.mesh.triangles.reserve(triangles);
}

void MeshAssembler::look() {
  source_.end_if_stopped();
  give();
}

void MeshAssembler::give() {
  if (source_.sink == nullptr) return;
  TriangleMesh& mesh = file_.mesh;
  source_.sink->append(mesh.vertices);
  source_.sink->append(mesh.triangles);
  vertices_given_ += mesh.vertices.size();
  mesh.vertices.clear();
  mesh.triangles.clear();
}

bool MeshAssembler::usable(const Eigen::Vector3d& p) {
  // False for NaN, as every comparison with it is.
  return std::abs(p.x()) <= largest_coordinate && std::abs(p.y()) <= largest_coordinate &&
         std::abs(p.z()) <= largest_coordinate;
}

void MeshAssembler::add_polygon(std::span<const std::uint32_t> corners) {
  if (corners.size() < 3) return ignore_element();
  if (file_.mesh.triangles.size() % look_interval == 0) look();
  for (std::size_t i = 2; i < corners.size(); ++i)
    file_.mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  if (corners.size() > 3) ++file_.triangulated_polygons;
}

void MeshAssembler::add_strips(std::span<const std::int64_t> corners) {
  auto from = corners.begin();
  while (from != corners.end()) {
    const auto to = std::find(from, corners.end(), -1);
    if (from != to) add_strip({from, to});
    from = to == corners.end() ? to : to + 1;
  }
}

void MeshAssembler::add_strip(std::span<const std::int64_t> corners) {
  if (corners.size() < 3) return ignore_element();
  ++file_.decoded_strips;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const auto a = static_cast<std::uint32_t>(corners[i - 2]);
    const auto b = static_cast<std::uint32_t>(corners[i - 1]);
    const auto c = static_cast<std::uint32_t>(corners[i]);
    if (a == b || b == c || c == a) continue;
    file_.mesh.triangles.push_back(i % 2 == 0 ? Triangle{a, b, c} : Triangle{b, a, c});
  }
}

std::vector<bool> MeshAssembler::used() const {
  return source_.sink != nullptr ? used_vertices(*source_.sink) : used_vertices(MeshInMemory(file_.mesh));
}

void MeshAssembler::refuse_used_suspects() const {
  if (suspects_.empty()) return;
  const std::vector<bool> used = this->used();
  for (const Suspect& s : suspects_) {
    if (used[s.vertex])
      fail(s.offset, "vertex " + std::to_string(s.vertex) +
                         " (counted from 0) is used by a face but has a coordinate that is not finite or beyond "
                         "2^1000; repair or rescale the mesh");
  }
}

void MeshAssembler::fail(std::size_t offset, const std::string& defect) const {
  if (position_ == Position::Line) source_.fail_at_line(offset, defect);
  source_.fail_at_byte(offset, defect);
}

MeshFile MeshAssembler::finish() {
  give();
  if (file_.mesh.triangles.empty() && (source_.sink == nullptr || source_.sink->triangle_count() == 0)) {
    const std::string found = vertex_count() == 0 ? "no vertices and no faces" : "vertices but no faces";
    fail(source_.size(), "the file holds " + found + "; a mesh needs at least one triangle");
  }
  refuse_used_suspects();
  file_.dropped.other_elements = file_.ignored_elements;
  return std::move(file_);
}

std::optional<MeshFile> MeshAssembler::finish_share() {
  give();
  if (!suspects_.empty() || file_.triangulated_polygons > 0 || file_.ignored_elements > 0) return std::nullopt;
  return std::move(file_);
}

}  // namespace meshbound
