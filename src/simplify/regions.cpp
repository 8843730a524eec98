// SPDX-License-Identifier: MIT
#include "simplify/regions.h"

#include <algorithm>
#include <span>

namespace meshbound {
namespace {

/// Smaller regions lose more at their seams than threads gain.
constexpr std::size_t min_vertices_of_region = 4000;
constexpr std::uint32_t max_regions = 64;

/// Where the first cut of a shifted split runs; all others halve.
constexpr double shifted_cut = 1.0 / 3;

class Cutter {
 public:
  Cutter(const DecimationState& state, Split& into, int shift) : state_(state), into_(into), shift_(shift) {
    for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v)
      if (state.mesh.is_vertex(v)) vertices_.push_back(v);
  }
  [[nodiscard]] std::size_t vertices() const { return vertices_.size(); }
  /// By region: its vertices.
  std::vector<std::vector<std::uint32_t>> run(std::uint32_t regions) {
    cut(vertices_, regions, shift_ == 0 ? 0.5 : shifted_cut);
    return std::move(of_region_);
  }

 private:
  void cut(std::span<std::uint32_t> vertices, std::uint32_t regions, double share) {
    if (regions == 1) {
      for (const std::uint32_t v : vertices) into_.region_of[v] = static_cast<std::uint32_t>(of_region_.size());
      std::vector<std::uint32_t>& of_region = of_region_.emplace_back(vertices.begin(), vertices.end());
      std::sort(of_region.begin(), of_region.end());
      return;
    }
    Eigen::AlignedBox3d box;
    for (const std::uint32_t v : vertices) box.extend(position(v));
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto along = [&](std::uint32_t v) { return position(v)[axis]; };
    const auto middle = static_cast<std::size_t>(share * static_cast<double>(vertices.size()));
    std::nth_element(
        vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(middle), vertices.end(),
        [&](std::uint32_t a, std::uint32_t b) { return along(a) < along(b) || (along(a) == along(b) && a < b); });
    cut(vertices.first(middle), regions / 2, 0.5);
    cut(vertices.subspan(middle), regions - regions / 2, 0.5);
  }

  /// A shifted split has axes of other directions, scaled by 3: planes of both splits share lines at most, where
  /// planes along the same axes through the middles of a symmetric mesh would be the same ones.
  [[nodiscard]] Eigen::Vector3d position(std::uint32_t v) const {
    const Vec3 p = state_.mesh.position(v);
    if (shift_ == 0) return {p.x, p.y, p.z};
    return {2 * p.x + 2 * p.y + p.z, p.y - 2 * p.x + 2 * p.z, p.x - 2 * p.y + 2 * p.z};
  }

  const DecimationState& state_;
  Split& into_;
  const int shift_;
  std::vector<std::uint32_t> vertices_;
  std::vector<std::vector<std::uint32_t>> of_region_;
};

/// The numbers of changes of a region follow those of the regions before: there are fewer than faces.
void make_regions(const DecimationState& state, Split& split, std::uint32_t count) {
  std::vector<std::uint32_t> faces(count, 0);
  for (std::uint32_t f = 0; f < state.mesh.face_count(); ++f) {
    if (state.mesh.is_removed(f)) continue;
    const std::uint32_t r = split.region_of.empty() ? 0 : split.region_of[state.mesh.vertex(3 * f)];
    ++faces[r];
  }
  std::uint32_t number = state.last_number();
  for (std::uint32_t r = 0; r < count; ++r) {
    split.regions.push_back({r, EditLog{number, {}, {}}, 0, state.clock, {}});
    number += faces[r];
  }
}

}  // namespace

Split split(const DecimationState& state, int shift) {
  Split result;
  Cutter cutter(state, result, shift);
  std::uint32_t count = 1;
  while (count < max_regions && cutter.vertices() >= 2 * std::size_t{count} * min_vertices_of_region) count *= 2;
  if (count > 1) {
    result.region_of.assign(state.mesh.vertex_count(), ArrayMesh::none);
    if (shift != 0) ++count;
    auto vertices = cutter.run(count);
    make_regions(state, result, count);
    for (std::uint32_t r = 0; r < count; ++r) result.regions[r].vertices = std::move(vertices[r]);
    return result;
  }
  make_regions(state, result, count);
  return result;
}

Split whole(const DecimationState& state) {
  Split result;
  make_regions(state, result, 1);
  return result;
}

void merge(DecimationState& state, Split split) {
  for (Region& region : split.regions) {
    state.faces -= region.removed_faces;
    state.clock = std::max(state.clock, region.clock);
    if (!region.log.edits.empty()) state.logs.push_back(std::move(region.log));
  }
}

}  // namespace meshbound
