// SPDX-License-Identifier: MIT
#include <algorithm>
#include <tuple>

#include "bvh/build.h"
#include "numeric/first_error.h"

namespace meshbound {
namespace {

constexpr std::uint32_t none = 0xffffffff;

/// Edges met at a vertex before its further ones are sorted instead of searched: 30 times what a vertex of a scan has.
constexpr std::uint32_t most_searched = 96;

/// An edge of a triangle, seen from the smaller of its vertices.
struct HalfEdge {
  std::uint32_t near, far;
  std::uint32_t id;  ///< 4 slot + edge
};

bool runs_upward(const Triangle& corners, std::uint32_t edge) { return corners[edge] < corners[(edge + 1) % 3]; }

Neighbour& neighbour_at(Bvh::Data& data, std::uint32_t id) { return data.neighbours[id / 4][id % 4]; }

void link(Bvh::Data& data, std::uint32_t from, std::uint32_t to) {
  Neighbour& neighbour = neighbour_at(data, from);
  neighbour.slot = (to / 4) & 0x7fffffff;
  neighbour.flipped =
      runs_upward(data.corners[from / 4], from % 4) == runs_upward(data.corners[to / 4], to % 4) ? 1 : 0;
}

/// The edges whose smaller vertex is one of a run of vertices: for each vertex a list of the edges met so far, with the
/// half-edge met last. Half-edges of one edge form a ring in the order of their ids: a pair on a manifold edge, more
/// where more triangles meet, nothing on a border.
class EdgeLists {
 public:
  EdgeLists(Bvh::Data& data, std::uint32_t first_vertex, std::uint32_t end_vertex, std::size_t edges)
      : data_(data), first_vertex_(first_vertex), head_(end_vertex - first_vertex) {
    met_.reserve(edges);
  }

  /// By the thread that fills the lists: the first to touch their pages.
  void clear() { std::fill(head_.begin(), head_.end(), none); }

  void add(const HalfEdge& edge) {
    std::uint32_t& head = head_[edge.near - first_vertex_];
    std::uint32_t length = 0;
    for (std::uint32_t at = head; at != none; at = met_[at].next, ++length) {
      if (met_[at].far != edge.far) continue;
      append(met_[at], edge.id);
      return;
    }
    if (length >= most_searched) {
      crowded_.push_back(edge);
      return;
    }
    met_.push_back({edge.far, edge.id, edge.id, head});
    head = static_cast<std::uint32_t>(met_.size()) - 1;
  }

  void link_crowded() {
    const auto key = [](const HalfEdge& e) { return std::tuple(e.near, e.far, e.id); };
    std::sort(crowded_.begin(), crowded_.end(), [&](const HalfEdge& a, const HalfEdge& b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < crowded_.size();) {
      const HalfEdge& edge = crowded_[i];
      Met met{edge.far, edge.id, edge.id, none};
      for (++i; i < crowded_.size() && crowded_[i].near == edge.near && crowded_[i].far == edge.far; ++i)
        append(met, crowded_[i].id);
    }
  }

 private:
  struct Met {
    std::uint32_t far;
    std::uint32_t first, last;  ///< half-edges
    std::uint32_t next;         ///< in `met_`
  };

  void append(Met& met, std::uint32_t id) {
    link(data_, met.last, id);
    link(data_, id, met.first);
    met.last = id;
  }

  Bvh::Data& data_;
  std::uint32_t first_vertex_;
  Array<std::uint32_t> head_;  ///< by vertex, in `met_`
  Array<Met> met_;
  std::vector<HalfEdge> crowded_;
};

/// One run of slots for each thread. A run owns the vertices that it is the first to use, and the edges whose smaller
/// vertex it owns.
class AdjacencyBuild {
 public:
  AdjacencyBuild(Bvh::Data& data, int threads)
      : data_(data),
        threads_(threads),
        runs_(static_cast<std::uint32_t>(threads)),
        first_vertex_(runs_ + 1, 0),
        lists_(runs_),
        of_earlier_(runs_) {}

  void run() {
    data_.neighbours.resize(data_.corners.size());
#pragma omp parallel for num_threads(threads_) schedule(static)
    for (std::uint32_t r = 0; r < runs_; ++r) first_vertex_[r + 1] = vertices_used(r);
    for (std::uint32_t r = 0; r < runs_; ++r) first_vertex_[r + 1] = std::max(first_vertex_[r], first_vertex_[r + 1]);
    // Large arrays by one thread: each thread's own heap would have to grow first, page by page.
    for (std::uint32_t r = 0; r < runs_; ++r) {
      const std::uint32_t slots = begin(r + 1) - begin(r);
      // A closed surface has 3/2 edges for each triangle; a soup has more, and then the list grows.
      lists_[r] = std::make_unique<EdgeLists>(data_, first_vertex_[r], first_vertex_[r + 1], slots + slots / 2 + 64);
    }
    FirstError error;
#pragma omp parallel for num_threads(threads_) schedule(static)
    for (std::uint32_t r = 0; r < runs_; ++r) error.guard([&] { add_edges(r); });
    error.rethrow();
    // Edges on the seams between runs: few, and by order of the runs so that ids ascend.
    for (std::uint32_t r = 1; r < runs_; ++r)
      for (const HalfEdge& edge : of_earlier_[r]) lists_[owner(edge.near)]->add(edge);
    for (auto& lists : lists_) lists->link_crowded();
  }

 private:
  [[nodiscard]] std::uint32_t begin(std::uint32_t run) const {
    return static_cast<std::uint32_t>(std::uint64_t{data_.triangle_count()} * run / runs_);
  }

  /// Vertices are numbered by first use, so all those used so far are below the largest.
  [[nodiscard]] std::uint32_t vertices_used(std::uint32_t run) const {
    if (run + 1 == runs_) return static_cast<std::uint32_t>(data_.vertices.size());
    std::uint32_t count = 0;
    for (std::uint32_t slot = begin(run); slot < begin(run + 1); ++slot)
      for (const std::uint32_t v : data_.corners[slot]) count = std::max(count, v + 1);
    return count;
  }

  [[nodiscard]] std::uint32_t owner(std::uint32_t vertex) const {
    return static_cast<std::uint32_t>(std::upper_bound(first_vertex_.begin(), first_vertex_.end(), vertex) -
                                      first_vertex_.begin() - 1);
  }

  void add_edges(std::uint32_t run) {
    lists_[run]->clear();
    for (std::uint32_t slot = begin(run); slot < begin(run + 1); ++slot) {
      const Triangle& t = data_.corners[slot];
      data_.neighbours[slot].fill({});
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto [near, far] = std::minmax(t[k], t[(k + 1) % 3]);
        const HalfEdge edge{near, far, 4 * slot + k};
        if (near >= first_vertex_[run])
          lists_[run]->add(edge);
        else
          of_earlier_[run].push_back(edge);
      }
    }
  }

  Bvh::Data& data_;
  int threads_;
  std::uint32_t runs_;
  std::vector<std::uint32_t> first_vertex_;  ///< by run
  std::vector<std::unique_ptr<EdgeLists>> lists_;
  std::vector<std::vector<HalfEdge>> of_earlier_;  ///< by run: edges at vertices of earlier runs
};

}  // namespace

void build_adjacency(Bvh::Data& data, int threads) { AdjacencyBuild(data, threads).run(); }

}  // namespace meshbound
