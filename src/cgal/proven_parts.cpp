// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/proven_parts.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshbound::cgal {
namespace {

constexpr std::uint32_t none = PartSeam::none;

}  // namespace

ProvenCutting::ProvenCutting(ProvenMesh mesh, const TriangleMesh& original, std::size_t parts)
    : mesh_(std::move(mesh)), original_(original) {
  ManifoldPolygons& whole = mesh_.polygons;
  for (const Kernel::Point_3& p : whole.points) soup_.vertices.emplace_back(p.x(), p.y(), p.z());
  for (const Polygon& corners : whole.polygons)
    soup_.triangles.push_back({static_cast<std::uint32_t>(corners[0]), static_cast<std::uint32_t>(corners[1]),
                               static_cast<std::uint32_t>(corners[2])});
  named_after_ = std::exchange(whole.triangle_of_face, {});
  whole.triangle_of_face.resize(whole.polygons.size());
  std::iota(whole.triangle_of_face.begin(), whole.triangle_of_face.end(), 0u);
  part_of_ = cut(whole.points, whole.polygons, parts);
  std::vector<bool> fixed = distribute(parts);
  cutting_.emplace(soup_, whole, parts, part_of_, std::move(fixed));
}

/// Returns by vertex of the mesh whether a face at it covers a triangle together with faces of another part.
std::vector<bool> ProvenCutting::distribute(std::size_t parts) {
  std::vector<std::uint32_t> faces_of_part(parts, 0);
  for (const std::uint32_t part : part_of_) place_.push_back(faces_of_part[part]++);
  originals_.resize(parts);
  std::vector<bool> fixed(soup_.vertices.size(), false);
  std::vector<std::uint32_t> covering;
  for (std::uint32_t t = 0; t < original_.triangles.size(); ++t) {
    covering.clear();
    for (const std::uint32_t f : cover(t)) covering.push_back(part_of_[f]);
    std::sort(covering.begin(), covering.end());
    covering.erase(std::unique(covering.begin(), covering.end()), covering.end());
    for (const std::uint32_t part : covering) originals_[part].push_back(t);
    if (covering.size() == 1) continue;
    shared_.push_back(t);
    for (const std::uint32_t f : cover(t)) {
      for (const std::uint32_t v : soup_.triangles[f]) fixed[v] = true;
    }
  }
  return fixed;
}

ProvenPart ProvenCutting::part(std::size_t index) const {
  ProvenPart result;
  Part& part = result.part;
  part = cutting_->part(index);
  part.original = TriangleMesh();
  part.triangle_of = originals_[index];
  for (const std::uint32_t v : part.whole_of) result.quadrics.push_back(mesh_.quadrics[v]);
  // Any triangle near a face will do: one that it stands for.
  result.proof.tolerance = mesh_.proof.tolerance;
  result.proof.nearest.assign(part.named_after.size(), 0);
  std::vector<std::uint32_t> vertex(original_.vertices.size(), none);
  for (std::uint32_t k = 0; k < part.triangle_of.size(); ++k) {
    Triangle& corners = part.original.triangles.emplace_back(original_.triangles[part.triangle_of[k]]);
    for (std::uint32_t& v : corners) {
      if (vertex[v] == none) {
        vertex[v] = static_cast<std::uint32_t>(part.original.vertices.size());
        part.original.vertices.push_back(original_.vertices[v]);
      }
      v = vertex[v];
    }
    for (const std::uint32_t f : cover(part.triangle_of[k])) {
      if (part_of_[f] != index) continue;
      result.proof.faces.push_back(place_[f]);
      result.proof.nearest[place_[f]] = k;
    }
    result.proof.ends.push_back(result.proof.faces.size());
  }
  for (std::uint32_t& f : part.named_after) f = named_after_[f];
  return result;
}

DeviationMonitor<SurfaceMesh>::Part ProvenCutting::shared_proof(
    const std::vector<DeviationMonitor<SurfaceMesh>::Part>& parts) const {
  DeviationMonitor<SurfaceMesh>::Part result;
  result.triangle_of = shared_;
  result.proof.tolerance = mesh_.proof.tolerance;
  result.proof.nearest.assign(soup_.triangles.size(), 0);
  result.face_of.assign(soup_.triangles.size(), DeviationMonitor<SurfaceMesh>::Part::none);
  for (std::uint32_t k = 0; k < shared_.size(); ++k) {
    for (const std::uint32_t f : cover(shared_[k])) {
      result.proof.faces.push_back(f);
      result.proof.nearest[f] = k;
      result.face_of[f] = parts[part_of_[f]].face_of[place_[f]];
    }
    result.proof.ends.push_back(result.proof.faces.size());
  }
  return result;
}

}  // namespace meshbound::cgal
