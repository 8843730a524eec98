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
#include <bit>

#include "bvh/build.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

/// Half-edges in a bucket from which they are sorted instead of compared with each other, which is done by the bits of
/// a word: ten times what a vertex of a scan has.
constexpr std::uint32_t most_compared = 64;

/// They are compared eight at a time, so what lies behind a bucket is read too; not beyond the buckets of a task, which
/// another thread may be sorting.
constexpr std::uint32_t compared_at_once = 8;

/// A closed surface has twice as many triangles as vertices.
constexpr std::size_t vertices_per_task = triangles_per_task / 2;

/// An edge of a triangle, seen from the smaller of its vertices.
struct HalfEdge {
  std::uint32_t far;
  std::uint32_t id;  ///< 4 slot + edge
};

/// One on a seam: its smaller vertex belongs to an earlier run.
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
  [[nodiscard]] static bool takes(std::uint32_t u, std::uint32_t v) { return u != v && std::max(u, v) != no_position; }
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
        edges_(array_in<HalfEdge>(scratch)),
        seams_(runs_),
        size_(runs_, 0) {
    bucket_end_.resize(data.vertices.size());
    edges_.resize(3 * data.corners.size());
  }

  void run() {
    for_each_run([&](std::uint32_t r) { count(r); });
    for_each_run([&](std::uint32_t r) { size_[r] = add_seams_and_sum(r); });
    for_each_run([&](std::uint32_t r) {
      fill(r);
      match(r);
    });
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
        use(v ^ (both & mask), HalfEdge{u ^ (both & mask), 4 * slot + k});
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

  /// Turns counts into the begins of buckets, counted from the first of the run. Returns the sum.
  std::uint32_t add_seams_and_sum(std::uint32_t run) {
    for_each_seam_edge(run, [&](std::uint32_t near, const HalfEdge&) { ++bucket_end_[near]; });
    std::uint32_t sum = 0;
    for (std::uint32_t v = first_vertex_[run]; v < first_vertex_[run + 1]; ++v) {
      const std::uint32_t size = bucket_end_[v];
      bucket_end_[v] = sum;
      sum += size;
    }
    return sum;
  }

  [[nodiscard]] HalfEdge* edges_of(std::uint32_t run) {
    HalfEdge* edges = edges_.data();
    for (std::uint32_t r = 0; r < run; ++r) edges += size_[r];
    return edges;
  }

  /// By ascending ids, so that each bucket is in their order: later runs have larger ones.
  void fill(std::uint32_t run) {
    HalfEdge* const edges = edges_of(run);
    std::uint32_t* const at = bucket_end_.data();
    const auto add = [=](std::uint32_t near, const HalfEdge& edge) { edges[at[near]++] = edge; };
    const std::uint32_t first = first_vertex_[run];
    for_each_half_edge(run, [=](std::uint32_t near, const HalfEdge& edge) {
      if (near >= first) add(near, edge);
    });
    for_each_seam_edge(run, add);
  }

  /// Half-edges of one edge form a ring in the order of their ids: a pair on a manifold edge, more where more triangles
  /// meet, nothing on a border.
  void match(std::uint32_t run) {
    HalfEdge* const edges = edges_of(run);
    const std::uint32_t first = first_vertex_[run], count = first_vertex_[run + 1] - first;
    for_each_range(count, vertices_per_task, [&](std::size_t begin, std::size_t end) {
      match_buckets(edges, first, first + static_cast<std::uint32_t>(begin), first + static_cast<std::uint32_t>(end));
    });
  }

  /// Those of the vertices from `from` to below `to`, in a run that begins with vertex `first`.
  void match_buckets(HalfEdge* edges, std::uint32_t first, std::uint32_t from, std::uint32_t to) {
    std::uint32_t begin = from == first ? 0 : bucket_end_[from - 1];
    const std::uint32_t end_of_all = bucket_end_[to - 1];
    for (std::uint32_t v = from; v < to; ++v) {
      const std::uint32_t end = bucket_end_[v];
      if (end - begin > most_compared)
        match_by_sorting(edges + begin, edges + end);
      else if (end_of_all - end >= compared_at_once)
        match_by_comparing(edges + begin, end - begin);
      else
        match_copy(edges + begin, end - begin);
      begin = end;
    }
  }

  void match_copy(const HalfEdge* edges, std::uint32_t count) {
    std::array<HalfEdge, most_compared> copy{};
    std::copy_n(edges, count, copy.begin());
    match_by_comparing(copy.data(), count);
  }

  /// Each with all others, without branches that depend on where its like is.
  void match_by_comparing(const HalfEdge* edges, std::uint32_t count) {
    const std::uint64_t all = ~std::uint64_t{0} >> (most_compared - count) % most_compared;
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint64_t like = 0;
      for (std::uint32_t begin = 0; begin < count; begin += compared_at_once)
        for (std::uint32_t j = begin; j < begin + compared_at_once; ++j)
          like |= std::uint64_t{edges[j].far == edges[i].far} << j;
      like &= all & ~(std::uint64_t{1} << i);
      if (like == 0) continue;
      const std::uint64_t later = like >> i << i;
      link(edges[i].id, edges[std::countr_zero(later != 0 ? later : like)].id);
    }
  }

  void match_by_sorting(HalfEdge* begin, HalfEdge* end) {
    std::sort(begin, end,
              [](const HalfEdge& a, const HalfEdge& b) { return a.far != b.far ? a.far < b.far : a.id < b.id; });
    for (HalfEdge* i = begin; i != end;) {
      HalfEdge* j = i + 1;
      for (; j != end && j->far == i->far; ++j) link(j[-1].id, j->id);
      if (j != i + 1) link(j[-1].id, i->id);
      i = j;
    }
  }

  void link(std::uint32_t from, std::uint32_t to) {
    data_.neighbours[from / 4][from % 4] = {to / 4 & no_slot, runs_upward(from) == runs_upward(to) ? 1U : 0U};
  }

  [[nodiscard]] bool runs_upward(std::uint32_t id) const {
    const Triangle& t = data_.corners[id / 4];
    return ends_(t[id % 4]) < ends_(t[(id % 4 + 1) % 3]);
  }

  Bvh::Data& data_;
  Ends ends_;
  const std::vector<std::uint32_t>& first_vertex_;  ///< by run
  std::uint32_t runs_;
  Array<std::uint32_t> bucket_end_;           ///< by vertex, from the first half-edge of its run
  Array<HalfEdge> edges_;                     ///< by vertex
  std::vector<std::vector<SeamEdge>> seams_;  ///< by run, in the order of their ids
  std::vector<std::uint32_t> size_;           ///< half-edges by run
};

template <class Ends>
void match_half_edges(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, Arena& scratch, Ends ends) {
  HalfEdgeMatching<Ends>(data, first_vertex, scratch, ends).run();
  scratch.clear();
}

}  // namespace

void build_adjacency(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, Arena& scratch) {
  data.neighbours.resize(data.corners.size());
  for_each_range(data.corners.size(), triangles_per_task, [&](std::size_t begin, std::size_t end) {
    std::fill(data.neighbours.begin() + static_cast<std::ptrdiff_t>(begin),
              data.neighbours.begin() + static_cast<std::ptrdiff_t>(end), std::array<Neighbour, 3>{});
  });
  const bool shares_vertices = data.vertices.size() < 3 * data.corners.size();
  if (shares_vertices) match_half_edges(data, first_vertex, scratch, ByIndex{});
  const Array<std::uint32_t> position = seam_positions(data);
  if (!position.empty()) match_half_edges(data, first_vertex, scratch, ByPosition{position.data()});
}

}  // namespace meshbound
