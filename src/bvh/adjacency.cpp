// SPDX-License-Identifier: MIT
/// What lies across the edges of the triangles. Each half-edge is put into the bucket of the smaller of its vertices
/// (a counting sort), where it meets the others of its edge. That is done chunk by chunk of the slots, so that buckets
/// stay in the cache and take no memory to speak of: the buckets of a chunk are those of the vertices that it is the
/// first to use, so half-edges of later chunks may belong into them, never those of earlier ones. Chunks are taken from
/// the last to the first. One thread takes the chunks of a run of slots.
///
/// First by the indices of the vertices. Where that leaves an edge with one triangle, edges are matched again by the
/// positions of their ends (bvh/seam_positions.cpp): a walk crosses a seam whose two sides have vertices of their own,
/// as in a triangle soup. Meshes whose triangles share all their vertices pay for a look at the result only.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "bvh/build.h"
#include "bvh/build_kernels.h"
#include "numeric/no_index.h"
#include "numeric/tasks.h"

namespace meshbound {
namespace {

/// An edge of a triangle, seen from the smaller of its vertices.
struct HalfEdge {
  std::uint32_t far;
  std::uint32_t id;     ///< 4 slot + edge
  std::uint8_t upward;  ///< 1: runs from the smaller vertex to the larger one
};

/// A half-edge whose smaller vertex belongs to an earlier chunk.
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
/// vertex, so that it belongs to the same chunk or an earlier one. Edges without length are left alone.
struct ByPosition {
  const std::uint32_t* position;
  [[nodiscard]] std::uint32_t operator()(std::uint32_t vertex) const { return position[vertex]; }
  [[nodiscard]] static bool takes(std::uint32_t u, std::uint32_t v) { return u != v && std::max(u, v) != no_index; }
};

/// Half-edges by buckets, of the chunk that a thread is at.
struct Buckets {
  /// With room for the half-edges of a chunk, and a quarter more.
  Buckets(Arena& arena, std::size_t slots)
      : far(array_in<std::uint32_t>(arena)), id(array_in<std::uint32_t>(arena)), upward(array_in<std::uint8_t>(arena)) {
    resize(3 * slots + 3 * slots / 4);
  }
  void resize(std::size_t half_edges) {
    const std::size_t read = half_edges + compared_at_once;
    far.resize(read);
    id.resize(read);
    upward.resize(read);
    std::fill_n(far.end() - compared_at_once, compared_at_once, 0);
  }

  std::vector<std::uint32_t> end;    ///< by vertex of the chunk
  std::vector<std::uint32_t> large;  ///< vertices whose half-edges are sorted
  Array<std::uint32_t> far, id;      ///< `HalfEdge::far`, `HalfEdge::id`
  Array<std::uint8_t> upward;        ///< `HalfEdge::upward`
};

/// Links the half-edges of each edge, by the ends that `Ends` gives to their vertices, as far as it takes them.
template <class Ends>
class HalfEdgeMatching {
 public:
  HalfEdgeMatching(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, std::size_t runs, Ends ends)
      : data_(data),
        ends_(ends),
        first_vertex_(first_vertex),
        chunks_(static_cast<std::uint32_t>(first_vertex.size()) - 1),
        runs_(static_cast<std::uint32_t>(std::min<std::size_t>(runs, chunks_))),
        slots_(slots_per_chunk(data.corners.size(), runs)),
        pending_(chunks_),
        handed_over_(chunks_) {}

  void run() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> later;  // runs but the first, with their chunks
    for (std::uint32_t run = 1; run < runs_; ++run)
      for (std::uint32_t chunk = first_chunk(run); chunk < first_chunk(run + 1); ++chunk)
        later.emplace_back(run, chunk);
    for_each_task(later.size(), [&](std::size_t i) { hand_over(later[i].first, later[i].second); });
    for_each_task(runs_, [&](std::size_t run) { match_run(static_cast<std::uint32_t>(run)); });
  }

 private:
  [[nodiscard]] std::uint32_t first_chunk(std::uint32_t run) const { return run_begin(chunks_, run, runs_); }
  [[nodiscard]] std::uint32_t begin(std::uint32_t chunk) const {
    return std::min(chunk * slots_, data_.triangle_count());
  }
  [[nodiscard]] std::uint32_t chunk_of(std::uint32_t vertex) const {
    const auto after = std::upper_bound(first_vertex_.begin(), first_vertex_.end(), vertex);
    return static_cast<std::uint32_t>(after - first_vertex_.begin()) - 1;
  }

  template <std::uint32_t k, class Use>
  void use_half_edge(const Triangle& t, std::uint32_t slot, Use&& use) const {
    const std::uint32_t u = ends_(t[k]), v = ends_(t[(k + 1) % 3]);
    if (!Ends::takes(u, v)) return;
    // Without a branch, which would be guessed wrong half the time.
    const std::uint32_t both = u ^ v, mask = 0U - static_cast<std::uint32_t>(u < v);
    use(v ^ (both & mask), HalfEdge{u ^ (both & mask), 4 * slot + k, static_cast<std::uint8_t>(mask & 1U)});
  }
  /// By ascending ids.
  template <class Use>
  void for_each_half_edge(std::uint32_t from, std::uint32_t to, const Use& use) const {
    for (std::uint32_t slot = from; slot < to; ++slot) {
      const Triangle t = data_.corners[slot];
      use_half_edge<0>(t, slot, use);
      use_half_edge<1>(t, slot, use);
      use_half_edge<2>(t, slot, use);
    }
  }
  /// By descending ids.
  template <class Use>
  void for_each_half_edge_back(std::uint32_t from, std::uint32_t to, const Use& use) const {
    for (std::uint32_t slot = to; slot-- > from;) {
      const Triangle t = data_.corners[slot];
      use_half_edge<2>(t, slot, use);
      use_half_edge<1>(t, slot, use);
      use_half_edge<0>(t, slot, use);
    }
  }

  /// Lists the half-edges of a chunk that belong to earlier runs.
  void hand_over(std::uint32_t run, std::uint32_t chunk) {
    const std::uint32_t first = first_vertex_[first_chunk(run)];
    for_each_half_edge_back(begin(chunk), begin(chunk + 1), [&](std::uint32_t near, const HalfEdge& edge) {
      if (near < first) handed_over_[chunk].push_back({near, edge});
    });
  }

  void match_run(std::uint32_t run) {
    const std::uint32_t from = first_chunk(run), to = first_chunk(run + 1);
    for (std::uint32_t later = chunks_; later-- > to;)
      for (const SeamEdge& seam : handed_over_[later])
        if (seam.near >= first_vertex_[from] && seam.near < first_vertex_[to])
          pending_[chunk_of(seam.near)].push_back(seam);
    Buckets buckets(data_.arena, slots_);
    for (std::uint32_t chunk = to; chunk-- > from;) {
      const std::uint32_t half_edges = count(buckets, chunk, first_vertex_[from]);
      buckets.resize(half_edges);
      fill(buckets, chunk);
      match(buckets, chunk);
    }
  }

  /// Sets the ends of the buckets to where they begin, and returns how many half-edges the chunk has. Those that belong
  /// to earlier chunks of the run are left to these, by descending ids.
  std::uint32_t count(Buckets& buckets, std::uint32_t chunk, std::uint32_t first_of_run) {
    const std::uint32_t first = first_vertex_[chunk];
    buckets.end.assign(first_vertex_[chunk + 1] - first, 0);
    std::uint32_t* const size = buckets.end.data();
    for_each_half_edge_back(begin(chunk), begin(chunk + 1), [&](std::uint32_t near, const HalfEdge& edge) {
      if (near >= first)
        ++size[near - first];
      else if (near >= first_of_run)
        pending_[chunk_of(near)].push_back({near, edge});
    });
    for (const SeamEdge& seam : pending_[chunk]) ++size[seam.near - first];
    buckets.large.clear();
    std::uint32_t sum = 0;
    for (std::uint32_t v = 0; v < buckets.end.size(); ++v) {
      if (size[v] > max_compared) buckets.large.push_back(v);
      sum += std::exchange(size[v], sum);
    }
    return sum;
  }

  /// By ascending ids, so that each bucket is in their order.
  void fill(Buckets& buckets, std::uint32_t chunk) {
    const std::uint32_t first = first_vertex_[chunk];
    std::uint32_t *const far = buckets.far.data(), *const id = buckets.id.data(), *const at = buckets.end.data();
    std::uint8_t* const upward = buckets.upward.data();
    const auto add = [=](std::uint32_t near, const HalfEdge& edge) {
      const std::uint32_t to = at[near - first]++;
      far[to] = edge.far;
      id[to] = edge.id;
      upward[to] = edge.upward;
    };
    for_each_half_edge(begin(chunk), begin(chunk + 1), [=](std::uint32_t near, const HalfEdge& edge) {
      if (near >= first) add(near, edge);
    });
    std::vector<SeamEdge> seams = std::move(pending_[chunk]);
    for (auto seam = seams.rbegin(); seam != seams.rend(); ++seam) add(seam->near, seam->edge);
  }

  void match(const Buckets& buckets, std::uint32_t chunk) {
    const HalfEdges edges{buckets.far.data(), buckets.id.data(), buckets.upward.data()};
    kernels_.match_half_edges(edges, buckets.end.data(), 0, first_vertex_[chunk + 1] - first_vertex_[chunk],
                              data_.neighbours.data());
    for (const std::uint32_t v : buckets.large) {
      const std::uint32_t from = v == 0 ? 0 : buckets.end[v - 1];
      match_by_sorting(buckets, from, buckets.end[v] - from);
    }
  }

  void match_by_sorting(const Buckets& buckets, std::size_t from, std::uint32_t count) {
    std::vector<HalfEdge> edges(count);
    for (std::uint32_t i = 0; i < count; ++i)
      edges[i] = {buckets.far[from + i], buckets.id[from + i], buckets.upward[from + i]};
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
  const std::vector<std::uint32_t>& first_vertex_;  ///< by chunk
  std::uint32_t chunks_, runs_, slots_;
  BuildKernels kernels_ = build_kernels();
  std::vector<std::vector<SeamEdge>> pending_;      ///< by chunk: of later chunks, by descending ids
  std::vector<std::vector<SeamEdge>> handed_over_;  ///< by chunk: those of earlier runs, by descending ids
};

}  // namespace

void build_adjacency(Bvh::Data& data, const std::vector<std::uint32_t>& first_vertex, std::size_t runs) {
  data.neighbours.resize(data.corners.size());
  const Arena::Loan loan(data.arena);
  if (data.vertices.size() < 3 * data.corners.size())
    HalfEdgeMatching(data, first_vertex, runs, ByIndex{}).run();
  else  // no vertex is shared
    for_each_range(data.corners.size(), triangles_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t slot = begin; slot < end; ++slot) data.neighbours[slot].fill({});
    });
  const Array<std::uint32_t> position = seam_positions(data);
  if (!position.empty()) HalfEdgeMatching(data, first_vertex, runs, ByPosition{position.data()}).run();
}

}  // namespace meshbound
