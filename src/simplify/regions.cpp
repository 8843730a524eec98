// SPDX-License-Identifier: MIT
#include "simplify/regions.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "geometry/cut_axes.h"
#include "numeric/disjoint_sets.h"
#include "numeric/no_index.h"
#include "numeric/tasks.h"
#include "simplify/propose.h"

namespace meshbound {
namespace {

constexpr std::uint32_t max_regions = 1024;

/// Where the first cut of a shifted split runs; all others halve.
constexpr double shifted_cut = 1.0 / 3;

/// A shifted split has one region more, as its first cut takes a third off; instead of three thirds, which keep one of
/// two threads waiting, it has two thirds and two sixths. With three thirds runs on two threads take 1.015 of the time,
/// on one thread 1.01 (28 meshes of 20,000 triangles and more at 0.1%).
std::uint32_t regions_of_shifted(std::uint32_t count) { return count == 2 ? 4 : count + 1; }

/// At most so many vertices, and half as many as a rule, tell by their edges along which axis a cut meets fewest.
constexpr std::size_t looks_at_edges = 256;

/// An axis is better than another by this factor at least: the order in which lengths are summed must not decide.
constexpr float min_gain_of_axis = 1.001F;

class Cutter {
 public:
  Cutter(const DecimationState& state, Split& into, int shift)
      : state_(state), into_(into), shift_(shift), axes_(cut_axes[static_cast<std::size_t>(shift)]) {
    for (std::uint32_t v = 0; v < state.mesh.vertex_count(); ++v) {
      if (!state.mesh.is_vertex(v)) continue;
      vertices_.push_back({along_axes(state.mesh.position(v)), v});
    }
  }
  [[nodiscard]] std::size_t vertices() const { return vertices_.size(); }
  /// By region: its vertices, ascending.
  std::vector<std::vector<std::uint32_t>> run(std::uint32_t regions, int threads) {
    count_ = regions;
    with_team(threads, [&] { cut(vertices_, 0, regions, shift_ == 0 ? 0.5 : shifted_cut); });
    join_at_hubs();
    std::vector<std::vector<std::uint32_t>> of_region(count_);
    for (std::uint32_t v = 0; v < into_.region_of.size(); ++v)
      if (into_.region_of[v] != no_index) of_region[into_.region_of[v]].push_back(v);
    return of_region;
  }

 private:
  struct Placed {
    Eigen::Vector3f along;  ///< the axes of the cuts
    std::uint32_t vertex;
  };

  /// Gives these vertices to regions from number `first` on.
  void cut(std::span<Placed> vertices, std::uint32_t first, std::uint32_t regions, double share) {
    if (regions == 1) {
      for (const Placed& placed : vertices) into_.region_of[placed.vertex] = first;
      return;
    }
    const Eigen::Index axis = axis_of_cut(vertices);
    const auto middle = static_cast<std::size_t>(share * static_cast<double>(vertices.size()));
    std::nth_element(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(middle), vertices.end(),
                     [axis](const Placed& p, const Placed& q) {
                       return p.along[axis] < q.along[axis] || (p.along[axis] == q.along[axis] && p.vertex < q.vertex);
                     });
    const std::uint32_t half = regions / 2;
    do_both([&] { cut(vertices.first(middle), first, half, 0.5); },
            [&] { cut(vertices.subspan(middle), first + half, regions - half, 0.5); });
  }

  [[nodiscard]] Eigen::Vector3f along_axes(Vec3 p) const {
    return Eigen::Vector3d(dot(axes_[0], p), dot(axes_[1], p), dot(axes_[2], p)).cast<float>();
  }
  /// The axis along which the vertices reach the most lengths of their edges: a cut across it meets fewest edges. Where
  /// edges are as long along all axes, the vertices reach farthest along it. The wall of a cylinder may be one edge
  /// high: a cut across that would leave no edge within a region.
  [[nodiscard]] Eigen::Index axis_of_cut(std::span<const Placed> vertices) const {
    const auto between_looks = static_cast<std::uint32_t>(std::bit_ceil(vertices.size() / looks_at_edges + 1));
    Eigen::AlignedBox3f box;
    Eigen::Array3f edges = Eigen::Array3f::Zero();
    for (const Placed& placed : vertices) {
      box.extend(placed.along);
      if (placed.vertex % between_looks != 0) continue;
      state_.mesh.for_each_corner(placed.vertex, [&](Corner c) {
        edges += (along_axes(state_.mesh.position(state_.mesh.end(c))) - placed.along).array().abs();
        return true;
      });
    }
    Eigen::Index axis = 0;
    float most = 0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const float lengths = box.sizes()[k] / edges[k];
      if (lengths > min_gain_of_axis * most) most = lengths, axis = k;
    }
    return axis;
  }

  /// Makes one region of those around a vertex with so many faces that a collapse next to one of its edges may be
  /// refused: the cap of a cylinder would be decimated in one sector only, and the other cap in another one.
  void join_at_hubs() {
    const ArrayMesh& mesh = state_.mesh;
    std::vector<std::uint32_t> faces(mesh.vertex_count(), 0);
    DisjointSets regions(count_);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
      if (!mesh.is_removed(f))
        for (const std::uint32_t v : mesh.corners(f)) ++faces[v];
    for (const Placed& placed : vertices_) {
      const std::uint32_t hub = placed.vertex;
      if (faces[hub] <= max_faces_of_star) continue;
      mesh.for_each_corner(hub, [&](Corner c) {
        for (const std::uint32_t v : {mesh.end(c), mesh.apex(c)})
          regions.unite(into_.region_of[hub], into_.region_of[v]);
        return true;
      });
    }
    std::vector<std::uint32_t> joined(count_);
    for (std::uint32_t r = 0; r < count_; ++r) joined[r] = regions.find(r);
    join(joined);
  }
  /// `joined` names for each region the one that it becomes part of, which has no higher number.
  void join(const std::vector<std::uint32_t>& joined) {
    std::vector<std::uint32_t> number(count_);
    count_ = 0;
    for (std::uint32_t r = 0; r < joined.size(); ++r) number[r] = joined[r] == r ? count_++ : number[joined[r]];
    for (const Placed& placed : vertices_) into_.region_of[placed.vertex] = number[into_.region_of[placed.vertex]];
  }

  const DecimationState& state_;
  Split& into_;
  const int shift_;
  const std::array<Vec3, 3>& axes_;
  std::vector<Placed> vertices_;
  std::uint32_t count_ = 0;  ///< of regions
};

/// Faces that one thread takes at a time.
constexpr std::size_t faces_at_once = 16384;

/// A mesh stays whole where cuts leave fewer of its faces in regions: what lies between regions is proven change by
/// change. Where faces reach from one end of a mesh to the other, a cut may meet all of them. With 50 a ruled
/// hyperboloid of 40,000 triangles takes 1.05 s at 1% instead of 14.1 s; with 25 a star of needles as long as with 0.
constexpr std::size_t min_percent_in_regions = 50;

bool is_mostly_in_regions(const DecimationState& state, const Split& split) {
  const auto outside =
      static_cast<std::size_t>(std::count(split.region_of_face.begin(), split.region_of_face.end(), no_index));
  const std::size_t inside = split.region_of_face.size() - outside;
  return 100 * inside >= min_percent_in_regions * state.faces;
}

/// Gives faces to the region of all their vertices. Returns how many have their first vertex in each region.
std::vector<std::uint32_t> assign_faces(const DecimationState& state, Split& split, std::uint32_t regions,
                                        int threads) {
  const ArrayMesh& mesh = state.mesh;
  split.region_of_face.resize(mesh.face_count());
  std::vector<std::vector<std::uint32_t>> counts(mesh.face_count() / faces_at_once + 1);
  const auto assign = [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> count(regions, 0);
    for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f) {
      split.region_of_face[f] = no_index;
      if (mesh.is_removed(f)) continue;
      const auto [a, b, c] = mesh.corners(f);
      const std::uint32_t region = split.region_of[a];
      ++count[region];
      if (split.region_of[b] == region && split.region_of[c] == region) split.region_of_face[f] = region;
    }
    counts[begin / faces_at_once] = std::move(count);
  };
  with_team(threads, [&] { for_each_range(mesh.face_count(), faces_at_once, assign); });
  std::vector<std::uint32_t> faces(regions, 0);
  for (const std::vector<std::uint32_t>& count : counts)
    for (std::uint32_t r = 0; r < count.size(); ++r) faces[r] += count[r];
  return faces;
}

}  // namespace

Split split(const DecimationState& state, int shift, std::size_t min_vertices, int threads) {
  Split result;
  Cutter cutter(state, result, shift);
  std::uint32_t count = 1;
  while (count < max_regions && cutter.vertices() >= 2 * std::size_t{count} * min_vertices) count *= 2;
  if (count == 1) return whole(state);
  result.region_of.assign(state.mesh.vertex_count(), no_index);
  auto vertices = cutter.run(shift == 0 ? count : regions_of_shifted(count), threads);
  count = static_cast<std::uint32_t>(vertices.size());
  if (count == 1) return whole(state);
  const std::vector<std::uint32_t> faces = assign_faces(state, result, count, threads);
  if (!is_mostly_in_regions(state, result)) return whole(state);
  // The numbers of changes of a region follow those of the regions before: there are fewer than faces.
  std::uint32_t number = state.last_number();
  for (std::uint32_t r = 0; r < count; number += faces[r++])
    result.regions.push_back({r, EditLog{number, {}, {}, {}, {}}, {}, 0, std::move(vertices[r]), {}});
  return result;
}

Split whole(const DecimationState& state) {
  Split result;
  result.regions.push_back({0, EditLog{state.last_number(), {}, {}, {}, {}}, {}, 0, {}, {}});
  return result;
}

void reopen_around(DecimationState& state, const Split& split, Region& region, std::uint32_t vertex) {
  if (state.has_refused[vertex] == 0 || state.is_hub(vertex)) return;
  state.has_refused[vertex] = 0;
  bool is_at_seam = false;
  state.mesh.for_each_edge(vertex, [&](Corner e) {
    if (split.owns(region.id, state.mesh.start(e)) && split.owns(region.id, state.mesh.end(e)))
      state.notes.reopen(e);
    else
      is_at_seam = true;
  });
  if (is_at_seam) region.changed_at_seams.push_back(vertex);
}

void merge(DecimationState& state, Split split) {
  for (Region& region : split.regions) {
    state.faces -= region.removed_faces;
    for (const std::uint32_t v : region.changed_at_seams) state.reopen_at(v);
    if (!region.log.edits.empty()) state.logs.push_back(std::move(region.log));
    if (state.proven_changes) state.proven_changes->add(state.mesh, region.proven);
  }
}

}  // namespace meshbound
