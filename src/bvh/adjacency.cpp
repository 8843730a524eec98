// SPDX-License-Identifier: MIT
/// What lies across the edges of the triangles. Each half-edge is put into the bucket of the smaller of its vertices
/// (a counting sort), where it meets the others of its edge. One thread fills the buckets of a run of vertices, which
/// are those that its run of slots is the first to use: but for the seams between runs no thread writes where another
/// one does.
///
/// First by the indices of the vertices. Where that leaves an edge with one triangle, edges are matched again by the
/// positions of their ends (bvh/seam_positions.cpp): a walk crosses a seam whose two sides have vertices of their own,
/// as in a triangle soup. Meshes whose triangles share all their vertices pay for a look at the result only.
#include <algorithm>
#include <array>
#include <vector>

#include "bvh/build.h"
#include "bvh/build_kernels.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

/// Vertices that make one task: a closed surface has twice as many triangles as vertices.
constexpr std::size_t vertices_per_task = triangles_per_task / 2;

/// An edge of a triangle, seen from the smaller of its vertices.
struct HalfEdge {
  std::uint32_t far;
  std::uint32_t id;     ///< 4 slot + edge
  std::uint8_t upward;  ///< 1: runs from the smaller vertex to the larger one
};

/// A half-edge on a seam between runs: its smaller vertex belongs to an earlier run.
struct SeamEdge {
  std::uint32_t near;
  HalfEdge edge;
};

/// Edges are one edge when they join the same vertices.
struct ByIndex {
  [[nodiscard]] std::uint32_t operator()(std::uint32_t vertex) const { return vertex; }
  [[nodiscard]] static bool takes(std::uint32_t, std::uint32_t) { return true; }
};

/// Edges are one edge when they join the same positions. `position`: see `seam_positions`; never above the index of the
/// vertex, so that it belongs to the same run or an earlier one. Edges without length are left alone.
struct ByPosition {
  const std::uint32_t* position;
  [[nodiscard]] std::uint32_t operator()(std::uint32_t vertex) const { return position[vertex]; }
  [[nodiscard]] static bool takes(std::uint32_t u, std::uint32_t v) { return u != v && std::max(u, v) != no_index; }
};

/// Links the half-edges of each edge, by the ends that `Ends` gives to their vertices, as far as it takes them.
template <class Ends>
class HalfEdgeMatching {
 public:
  HalfEdgeMatching(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, Arena& scratch, Ends ends)
      : data_(data),
        ends_(ends),
        first_vertex_(first_vertex),
        runs_(static_cast<std::uint32_t>(first_vertex.size()) - 1),
        bucket_end_(array_in<std::uint32_t>(scratch)),
        far_(array_in<std::uint32_t>(scratch)),
        id_(array_in<std::uint32_t>(scratch)),
        upward_(array_in<std::uint8_t>(scratch)),
        seams_(runs_),
        large_(runs_),
        size_(runs_, 0) {
    bucket_end_.resize(data.vertices.size());
    const std::size_t read = 3 * data.corners.size() + compared_at_once;
    far_.resize(read);
    id_.resize(read);
    upward_.resize(read);
    std::fill_n(far_.end() - compared_at_once, compared_at_once, 0);
  }

  void run() {
    for_each_run([&](std::uint32_t r) { count(r); });
    for_each_run([&](std::uint32_t r) { size_[r] = add_seams_and_sum(r); });
    for_each_run([&](std::uint32_t r) { fill(r); });
    for_each_run([&](std::uint32_t r) { match(r); });
  }

 private:
  template <class Work>
  void for_each_run(Work&& work) {
    for_each_task(runs_, [&](std::size_t r) { work(static_cast<std::uint32_t>(r)); });
  }

  [[nodiscard]] std::uint32_t begin(std::uint32_t run) const { return run_begin(data_.triangle_count(), run, runs_); }

  template <class Use>
  void for_each_half_edge(std::uint32_t run, Use&& use) {
    const std::uint32_t end = begin(run + 1);
    for (std::uint32_t slot = begin(run); slot < end; ++slot) {
      const Triangle t = data_.corners[slot];
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t u = ends_(t[k]), v = ends_(t[(k + 1) % 3]);
        if (!Ends::takes(u, v)) continue;
        // Without a branch, which would be guessed wrong half the time.
        const std::uint32_t both = u ^ v, mask = 0U - static_cast<std::uint32_t>(u < v);
        use(v ^ (both & mask), HalfEdge{u ^ (both & mask), 4 * slot + k, static_cast<std::uint8_t>(mask & 1U)});
      }
    }
  }

  template <class Use>
  void for_each_seam_edge(std::uint32_t run, Use&& use) {
    for (std::uint32_t later = run + 1; later < runs_; ++later)
      for (const SeamEdge& seam : seams_[later])
        if (seam.near >= first_vertex_[run] && seam.near < first_vertex_[run + 1]) use(seam.near, seam.edge);
  }

  void count(std::uint32_t run) {
    std::fill(bucket_end_.begin() + first_vertex_[run], bucket_end_.begin() + first_vertex_[run + 1], 0);
    const std::uint32_t first = first_vertex_[run];
    std::uint32_t* const size = bucket_end_.data();
    for_each_half_edge(run, [&](std::uint32_t near, const HalfEdge& edge) {
      if (near >= first)
        ++size[near];
      else
        seams_[run].push_back({near, edge});
    });
  }

  /// Turns counts into the offsets of buckets within the run. Returns their sum.
  std::uint32_t add_seams_and_sum(std::uint32_t run) {
    for_each_seam_edge(run, [&](std::uint32_t near, const HalfEdge&) { ++bucket_end_[near]; });
    std::uint32_t sum = 0;
    for (std::uint32_t v = first_vertex_[run]; v < first_vertex_[run + 1]; ++v) {
      const std::uint32_t size = bucket_end_[v];
      if (size > max_compared) large_[run].push_back(v);
      bucket_end_[v] = sum;
      sum += size;
    }
    return sum;
  }

  /// Where the half-edges of a run begin.
  [[nodiscard]] std::size_t edges_before(std::uint32_t run) const {
    std::size_t count = 0;
    for (std::uint32_t r = 0; r < run; ++r) count += size_[r];
    return count;
  }

  /// By ascending ids, so that each bucket is in their order: later runs have larger ones.
  void fill(std::uint32_t run) {
    std::uint32_t *const far = far_.data() + edges_before(run), *const id = id_.data() + edges_before(run);
    std::uint8_t* const upward = upward_.data() + edges_before(run);
    std::uint32_t* const at = bucket_end_.data();
    const auto add = [=](std::uint32_t near, const HalfEdge& edge) {
      const std::uint32_t to = at[near]++;
      far[to] = edge.far;
      id[to] = edge.id;
      upward[to] = edge.upward;
    };
    const std::uint32_t first = first_vertex_[run];
    for_each_half_edge(run, [=](std::uint32_t near, const HalfEdge& edge) {
      if (near >= first) add(near, edge);
    });
    for_each_seam_edge(run, add);
  }

  void match(std::uint32_t run) {
    const std::size_t before = edges_before(run);
    const HalfEdges edges{far_.data() + before, id_.data() + before, upward_.data() + before};
    const std::uint32_t first = first_vertex_[run], count = first_vertex_[run + 1] - first;
    for_each_range(count, vertices_per_task, [&](std::size_t begin, std::size_t end) {
      kernels_.match_half_edges(edges, bucket_end_.data() + first, begin, end, data_.neighbours.data());
    });
    for (const std::uint32_t v : large_[run]) {
      const std::uint32_t from = v == first ? 0 : bucket_end_[v - 1];
      match_by_sorting(before + from, bucket_end_[v] - from);
    }
  }

  void match_by_sorting(std::size_t from, std::uint32_t count) {
    std::vector<HalfEdge> edges(count);
    for (std::uint32_t i = 0; i < count; ++i) edges[i] = {far_[from + i], id_[from + i], upward_[from + i]};
    std::sort(edges.begin(), edges.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return a.far != b.far ? a.far < b.far : a.id < b.id; });
    for (auto i = edges.begin(); i != edges.end();) {
      auto last = i;
      for (auto next = i + 1; next != edges.end() && next->far == i->far; last = next++) link(*last, *next);
      if (last == i)
        data_.neighbours[i->id / 4][i->id % 4] = {};
      else
        link(*last, *i);
      i = last + 1;
    }
  }

  void link(const HalfEdge& from, const HalfEdge& to) {
    data_.neighbours[from.id / 4][from.id % 4] = {to.id / 4 & no_slot, from.upward == to.upward ? 1U : 0U};
  }

  Bvh::Data& data_;
  Ends ends_;
  const std::vector<std::uint32_t>& first_vertex_;  ///< by run
  std::uint32_t runs_;
  BuildKernels kernels_ = build_kernels();
  Array<std::uint32_t> bucket_end_;                ///< by vertex, from the first half-edge of its run
  Array<std::uint32_t> far_;                       ///< by bucket: `HalfEdge::far` of its half-edges
  Array<std::uint32_t> id_;                        ///< by bucket: `HalfEdge::id`
  Array<std::uint8_t> upward_;                     ///< by bucket: `HalfEdge::upward`
  std::vector<std::vector<SeamEdge>> seams_;       ///< by run, in the order of their ids
  std::vector<std::vector<std::uint32_t>> large_;  ///< by run: vertices whose half-edges are sorted
  std::vector<std::uint32_t> size_;                ///< half-edges by run
};

template <class Ends>
void match_half_edges(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, Arena& scratch, Ends ends) {
  HalfEdgeMatching<Ends>(data, first_vertex, scratch, ends).run();
  scratch.clear();
}

}  // namespace

void build_adjacency(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, Arena& scratch) {
  data.neighbours.resize(data.corners.size());
  if (data.vertices.size() < 3 * data.corners.size())
    match_half_edges(data, first_vertex, scratch, ByIndex{});
  else  // no vertex is shared
    for_each_range(data.corners.size(), triangles_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) data.neighbours[slot].fill({});
    });
  const Array<std::uint32_t> position = seam_positions(data);
  if (!position.empty()) match_half_edges(data, first_vertex, scratch, ByPosition{position.data()});
}

}  // namespace meshbound
