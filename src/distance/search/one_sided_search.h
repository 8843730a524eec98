// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "distance/kernel/search_kernel.h"
#include "distance/search/one_sided.h"
#include "distance/search/proof_recorder.h"
#include "geometry/mapping.h"
#include "proof/goal.h"

namespace meshbound {

/// A triangle of A that still needs work.
struct OpenTriangle {
  double bound_squared;
  std::uint32_t slot;   ///< of A
  std::uint32_t start;  ///< candidate of B
};

/// What a chunk of a step found.
struct Found {
  LowerBound lower;
  double upper_squared = 0;
  std::uint32_t farthest_vertex = 0;
  Nearest farthest{-1, 0};  ///< of that vertex
  std::vector<OpenTriangle> open;
  FoundCovers covers;       ///< with a memory only
  std::uint64_t walks = 0;  ///< triangles that were cut
};

/// One direction of a measurement: what it has proven, what it may still spend, and the team that works on it. The
/// steps (distance/search/steps.h) hand to one another what is left to do. Works in B's frame. A step that shares its
/// work does so in fixed chunks that all start from the same lower bound and are merged in order, so the result does
/// not depend on the number of threads. For the thread that heads a team of `threads()` (numeric/tasks.h).
class OneSidedSearch {
 public:
  /// `task` must outlive this.
  OneSidedSearch(const OneSidedTask& task, const Mapping& map);

  [[nodiscard]] const OneSidedTask& task() const { return task_; }
  [[nodiscard]] const Bvh::Data& a() const { return a_; }
  [[nodiscard]] const Bvh::Data& b() const { return b_; }
  [[nodiscard]] const Mapping& map() const { return map_; }
  [[nodiscard]] const Goal& goal() const { return goal_; }
  [[nodiscard]] Vec3 vertex(std::uint32_t v) const { return map_(a_.vertices[v]); }
  [[nodiscard]] TriangleCorners triangle(std::uint32_t slot) const {
    const Triangle& t = a_.corners[slot];
    return {vertex(t[0]), vertex(t[1]), vertex(t[2])};
  }

  // What an earlier search has left.

  /// A slot of B that was near a vertex of A, or `no_slot`.
  [[nodiscard]] std::uint32_t hint_before(std::uint32_t v) const {
    return has_hints_ ? task_.memory->hints[v] : no_slot;
  }
  /// The models have moved so far that the triangle of a neighbour is a better hint.
  void forget_hints() { has_hints_ = false; }

  // What is proven.

  /// A lower bound already known of the quantity that is wanted, model units (`OneSidedTask::known_lower`).
  void raise_known_lower(double lower);
  /// The largest distance that a point of A is proven to have so far, model units.
  [[nodiscard]] double proven_lower() const;
  /// The bound that pieces are compared with: proven in this direction, or known.
  [[nodiscard]] const LowerBound& lower() const { return lower_; }
  /// In a decision: nothing more needs to be looked at.
  [[nodiscard]] bool decided() const { return goal_.decide_only && own_lower_.lower > goal_.tolerance; }
  void offer_lower(const LowerBound& lower);
  /// Triangles of A are within the root of this of B.
  void offer_upper_squared(double squared);
  /// Triangles of A are within this of B by an earlier search, model units.
  void offer_known_upper(double upper);
  /// Notes the closest triangle of a vertex that may be the farthest one met.
  void note_vertex(std::uint32_t v, const Nearest& nearest);
  /// Notes a vertex, and raises the lower bound by it where it proves one.
  void offer_vertex(std::uint32_t v, const Nearest& nearest);

  // What it may spend.

  /// True from the moment when a budget has run out.
  bool out_of_budget();
  /// As the last call of `out_of_budget` found it.
  [[nodiscard]] bool exhausted() const { return exhausted_; }
  [[nodiscard]] std::uint64_t cuts_left() const { return cuts_left_; }

  // The team.

  [[nodiscard]] int threads() const { return static_cast<int>(kernels_.size()); }
  /// The kernel of the thread that heads the team, begun at the current lower bound.
  SearchKernel& begin_own_batch();
  /// The kernel of the thread that asks.
  [[nodiscard]] SearchKernel& own_kernel() const;

  struct Batches {
    std::uint32_t per_chunk = 1;      ///< items of a chunk
    std::uint32_t first, max_chunks;  ///< chunks of the first batch and of the largest: batches double
    double from = 0, to = 1;          ///< progress before and after
  };
  using ChunkWork = std::function<void(SearchKernel&, std::uint32_t begin, std::uint32_t end, Found&)>;
  /// Runs work(kernel, begin, end, found) for chunks of the items 0 ... count - 1, in batches: the lower bound that a
  /// batch starts from is the one of all batches before it. Returns what the chunks left open, in order; ends early
  /// once all is decided.
  [[nodiscard]] std::vector<OpenTriangle> run_chunks(std::uint32_t count, const Batches& batches,
                                                     const ChunkWork& work);

  // What is told about it.

  [[nodiscard]] DistanceStats& stats() { return stats_; }
  [[nodiscard]] const ProofRecorder& recorder() const { return recorder_; }
  void report_progress(double fraction);
  /// Runs a step and adds its time to a phase.
  template <class Step>
  auto timed(double PhaseSeconds::*phase, Step&& step) {
    struct Timer {
      double& seconds;
      StopToken::Clock::time_point start = StopToken::Clock::now();
      ~Timer() { seconds += seconds_since(start); }
    } const timer{stats_.phases.*phase};
    return step();
  }
  /// To be called once, after the steps.
  [[nodiscard]] OneSidedDistance result();

 private:
  void spend_cuts();
  [[nodiscard]] Witness witness_at(const LowerBound& lower) const;
  [[nodiscard]] LowerBound proven_witness();
  [[nodiscard]] double farthest_apart() const;
  void remember_front(double upper);
  void fill_stats();

  const OneSidedTask& task_;
  const Bvh::Data& a_;
  const Bvh::Data& b_;
  Mapping map_;
  Goal goal_;
  std::vector<std::unique_ptr<SearchKernel>> kernels_;  ///< one per thread
  ProofRecorder recorder_;
  bool has_hints_;
  double known_lower_ = 0;             ///< model units
  LowerBound lower_;                   ///< never below `known_lower_`
  LowerBound own_lower_;               ///< proven for this direction
  std::uint32_t farthest_vertex_ = 0;  ///< met so far
  Nearest farthest_nearest_{-1, 0};
  double upper_squared_ = 0;
  double known_upper_ = 0;  ///< model units
  bool exhausted_ = false;
  std::uint64_t cuts_left_;
  DistanceStats stats_;
  StopToken::Clock::time_point last_progress_;
};

}  // namespace meshbound
