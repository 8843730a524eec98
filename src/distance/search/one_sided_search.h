// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "distance/kernel/search_kernel.h"
#include "distance/search/one_sided.h"
#include "distance/search/search_memory.h"
#include "geometry/mapping.h"
#include "proof/goal.h"

namespace meshbound {

/// The one-sided search, step by step as `search_one_sided` calls them, by the thread that heads a team of `threads()`
/// (numeric/tasks.h). Works in B's frame. Every step that shares its work does so in fixed chunks that all start from
/// the same lower bound and are merged in order, so the result does not depend on the number of threads.
class OneSidedSearch {
 public:
  OneSidedSearch(const OneSidedTask& task, const Mapping& map);
  [[nodiscard]] int threads() const { return static_cast<int>(kernels_.size()); }

  /// A lower bound already known of the quantity that is wanted, model units (`OneSidedTask::known_lower`).
  void raise_known_lower(double lower);
  /// The largest distance that a point of A is proven to have so far, model units.
  [[nodiscard]] double proven_lower() const;

  void probe();            ///< a few vertices, for a first lower bound
  void drop_identical();   ///< triangles that B has too, if a probe lay on B: at distance 0 without arithmetic
  void drop_proven();      ///< triangles that an earlier search has proven to be near enough
  void cull_nodes();       ///< paper, Alg. 1: whole nodes of A, best first
  void sweep();            ///< triangles bounded by what bounded their neighbour along the curve, without queries
  void query_vertices();   ///< closest triangles of the vertices that are left
  void bound_triangles();  ///< paper, 4.4: triangles bounded by a closest triangle of one of their vertices
  void cross_cull();       ///< paper, section 4: whole nodes of A, then its triangles against the nodes of B
  void refine_rest();      ///< what is left, worst first, by `DistanceOptions::method`
  void remember_hints();   ///< for the next search of this model
  /// Runs one of the steps above and adds its time to a phase.
  void run(void (OneSidedSearch::*step)(), double PhaseSeconds::*phase);
  [[nodiscard]] OneSidedDistance result();

 private:
  /// A triangle of A that its vertices' closest triangles do not bound.
  struct Open {
    double bound_squared;
    std::uint32_t slot;   ///< of A
    std::uint32_t start;  ///< candidate of B
  };
  /// `Nearest` without initial values: a search that culls nearly everything does not touch what it does not need.
  struct VertexNearest {
    double squared;
    std::uint32_t slot;
  };
  /// What a chunk of work found.
  struct Found {
    LowerBound lower;
    double upper_squared = 0;
    std::uint32_t farthest_vertex = 0;
    double farthest_squared = -1;
    std::vector<Open> open;
    FoundCovers covers;       ///< with a memory only
    std::uint64_t walks = 0;  ///< triangles that were cut
  };

  /// What node culling asks of B: how far at most a node of A is, or which triangle is nearest to a vertex of it.
  struct NodeQuestion {
    static constexpr std::uint32_t no_vertex = 0xffffffff;
    std::uint32_t level, index;        ///< of the node
    std::uint32_t vertex = no_vertex;  ///< of A
    std::uint32_t slot;                ///< of B: a hint, then the triangle that gives the answer
    double squared = 0;                ///< the answer
  };

  [[nodiscard]] Vec3 vertex(std::uint32_t v) const { return map_(a_.vertices[v]); }
  /// The centroid of a triangle of A. Rounded by less than 7 u M, for which the slack of a lower bound has room
  /// (`probe_start`).
  [[nodiscard]] Vec3 centroid(std::uint32_t slot) const {
    const Triangle& t = a_.corners[slot];
    return (1.0 / 3) * (vertex(t[0]) + vertex(t[1]) + vertex(t[2]));
  }
  [[nodiscard]] bool decided() const { return goal_.decide_only && own_lower_.lower > goal_.tolerance; }
  /// That of the thread which asks.
  [[nodiscard]] SearchKernel& own_kernel() const;
  bool out_of_budget();
  void spend_cuts();
  template <class Work>
  void run_chunks(std::uint32_t count, std::uint32_t batch, std::uint32_t largest_batch, double from, double to,
                  Work&& work);
  void merge(const Found& found);
  void offer_vertex(std::uint32_t v, const Nearest& nearest);
  void probe_centroids();
  bool sample_is_identical();
  void sweep_chunk(SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found);
  void query_chunk(SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found);
  void bound_chunk(SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found);
  [[nodiscard]] double node_bound_squared(SearchKernel& kernel, std::uint32_t level, std::uint32_t index,
                                          std::uint32_t& hint) const;
  void cull_leaf_on_b(SearchKernel& kernel, std::uint32_t block, std::uint32_t& hint);
  void refine_chunk(SearchKernel& kernel, std::uint32_t begin, std::uint32_t end, Found& found);
  void sort_open();
  [[nodiscard]] double sampled_block_radius() const;
  [[nodiscard]] bool is_alive(std::uint32_t slot) const { return alive_.empty() || alive_[slot] != 0; }
  [[nodiscard]] bool some_dropped() const { return culled_ || !alive_.empty(); }
  void open_node(std::uint32_t level, std::uint32_t index, std::uint32_t slot, std::vector<NodeQuestion>& questions);
  void answer(std::vector<NodeQuestion>& questions, double accepted_squared);
  void keep_slots_below(std::uint32_t level, std::uint32_t index);
  void list_wanted_vertices();
  void probe_start();
  [[nodiscard]] double proven_length(double squared, std::uint32_t cuts) const;
  [[nodiscard]] double proven_model_length(double squared, std::uint32_t cuts) const;
  void remember_node(std::uint32_t level, std::uint32_t index, double squared, std::uint32_t face);
  void remember(std::uint32_t slot, double squared, std::uint32_t face);
  void cover_and_record(SearchKernel& kernel, std::uint32_t slot, std::uint32_t start, Found& found) const;
  void remember_cover(std::uint32_t slot, const CoverRecord& record, Found& found) const;
  void remember_walk(const Found& found);
  void remember_start(const LowerBound& lower);
  void report_progress(double fraction);
  [[nodiscard]] Witness witness_at(const LowerBound& lower) const;
  LowerBound proven_witness();
  [[nodiscard]] double farthest_apart() const;
  void fill_stats();

  const OneSidedTask& task_;
  const Bvh::Data& a_;
  const Bvh::Data& b_;
  Mapping map_;
  Goal goal_;
  double scale_to_model_;                               ///< of lengths
  std::vector<std::unique_ptr<SearchKernel>> kernels_;  ///< one per thread
  std::vector<std::uint8_t> alive_;                     ///< by A's slot, before nodes are culled; empty: all are
  bool culled_ = false;                                 ///< `left_` and `wanted_` list what is left
  std::vector<std::uint32_t> left_;                     ///< slots of A
  std::vector<std::uint32_t> wanted_;                   ///< vertices of A
  std::unique_ptr<VertexNearest[]> nearest_;            ///< by A's vertex; set for wanted ones only
  std::vector<Open> open_;
  double known_lower_;                 ///< model units
  LowerBound lower_;                   ///< never below `known_lower_`
  LowerBound own_lower_;               ///< proven for this direction
  std::uint32_t farthest_vertex_ = 0;  ///< met so far
  Nearest farthest_nearest_{-1, 0};
  double upper_squared_ = 0;
  double kept_upper_ = 0;  ///< of the triangles that `drop_proven` dropped, model units
  bool exhausted_ = false;
  bool probe_on_b_ = false;
  std::uint64_t cuts_left_ = 0;
  DistanceStats stats_;
  std::chrono::steady_clock::time_point last_progress_;
};

}  // namespace meshbound
