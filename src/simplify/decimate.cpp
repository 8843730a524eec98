// SPDX-License-Identifier: MIT
#include "simplify/decimate.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "meshbound/distance.h"
#include "numeric/first_error.h"
#include "numeric/no_index.h"
#include "numeric/numbers_below.h"
#include "numeric/tasks.h"
#include "simplify/exceed_check.h"
#include "simplify/minimax_step.h"
#include "simplify/prove.h"
#include "simplify/refine.h"
#include "simplify/region_collapses.h"
#include "simplify/repair.h"
#include "simplify/stray_faces.h"

namespace meshbound {
namespace {

/// Samples may reach this share of the tolerance in the first collapses, which are proven together: beyond, edges have
/// to be looked at more closely. With 0.6 or 0.8 a run takes 3% and 6% longer (37 meshes at 0.1%).
constexpr double share_together = 0.7;

/// Where a face has so few originals or fewer, in the mean, the collapses near the tolerance are proven together too.
/// One in ten to one in three is undone then, and proven one by one; this pays while an original is proven by itself.
/// It does not where faces are so large that one proof covers whole clusters of originals.
constexpr std::size_t max_originals_of_face = OriginalClusters::size;

/// Vertices of a region at least: smaller ones lose more at their seams than threads gain. Most collapses are made at
/// first, and a proof takes much longer than a proposal. A mesh too small for two regions at the end is cut once into
/// smaller ones: else runs on two threads take 1.012 of the time, and as long on one (28 meshes of 20,000 triangles and
/// more at 0.1%).
constexpr std::size_t min_vertices_at_first = 2000, min_vertices_together = 1000, min_vertices_one_by_one = 500,
                      min_vertices_of_small = 250;

/// The first cut of a mesh of several regions leaves edges that cost more, in squared tolerances, for the cuts that
/// follow. Else its seams are as fine as the original between faces that are as large as they can be, and it takes long
/// to collapse them. Without this and the third cut runs take 1.03 of the time at 0.1%, 1.15 at 1% (28 meshes of 20,000
/// triangles and more) and 1.35 on a torus of 300,000. With 20 and 30 they take as long as with 10, with 3 longer.
constexpr double max_cost_at_first = 10;

/// After two cuts, or three with such a limit, another follows one into more than a few regions that has removed a
/// tenth of the faces: it collapses what is left at the seams. Without it tori take 1.35, 1.10 and 1.09 of the time
/// (10M, 2M and 868,000 triangles at 0.1%). With two regions for a few, meshes of 20,000 to 270,000 take 1.01.
constexpr int max_cuts = 8;
constexpr std::size_t few_regions = 4;
constexpr double min_gain_of_cut = 0.1;

/// Where a cut has removed a smaller share of the faces, those that would follow it anyway are left out: what is open
/// is at its seams, and no more likely to collapse than the rest. Seven cuts in vain took a third of the time where
/// each triangle hangs together with none.
constexpr double min_gain_for_next_cut = 0.001;

/// A closed mesh has twice as many faces as vertices.
constexpr std::size_t faces_of_vertex = 2;

/// Where not even one of so many edges is open, all get their turn in one region: the splits would take longer. With 8
/// or 16 less time is saved (37 meshes at 0.02%).
constexpr std::size_t edges_of_open = 32;

/// Passes over the edges that something has changed around end where one removes a smaller share of the faces.
constexpr double min_gain_of_pass = 0.01;

/// Where proofs failed, what was undone is proposed again with a smaller share of the tolerance, as long as it is more
/// than the first share of what was proposed and less than the second: proofs of single collapses cost many times more,
/// but where most proposals fail they avoid the failures.
constexpr int max_rounds = 4;
constexpr double min_share_taken_back = 0.05, max_share_taken_back = 0.3;

/// Edges between two checks of the time and two reports of progress.
constexpr std::uint32_t edges_between_looks = 32;

/// Once the time limit has ended a run, proofs of what was collapsed before may take this share of it more, or this
/// many seconds if the run was cancelled.
constexpr double proof_share_of_time = 0.25;
constexpr double seconds_of_last_proof = 0.3;

StopToken later(const StopToken& stop) {
  if (stop.deadline == StopToken::Clock::time_point::max()) return stop;
  return stop.until(stop.deadline, proof_share_of_time * stop.seconds_left());
}

/// Proves what is open, and undoes by `undo` what fails until the rest holds. Returns how many changes were undone.
/// Throws `Stopped` where `stop` asks for it.
std::size_t prove_or_undo(DecimationState& state, Proof& proof, Repair (*undo)(DecimationState&, const Unproven&),
                          const std::function<StopToken()>& stop) {
  std::size_t undone = 0;
  for (proof.run(stop()); !proof.unproven().empty(); proof.run(stop())) {
    const Repair repaired = undo(state, proof.unproven());
    undone += repaired.changes;
    proof.reopen(repaired.faces);
  }
  proof.commit();
  return undone;
}

/// One run of `decimate`.
class Run {
 public:
  Run(DecimationState& state, const DecimationGoal& goal, DecimationThreads& threads)
      : state_(state), goal_(goal), threads_(threads), stop_of_proof_(later(goal.stop)) {}

  EndedBy operator()() {
    state_.grow_tolerance(goal_.tolerance);
    keep_what_has_no_face();
    if (state_.faces == 0) return ended_by_;
    if (state_.tried_tolerance != goal_.tolerance) prove_together();
    prove_one_by_one();
    const bool is_high = goal_.effort == Effort::High && goal_.on_exceed == OnExceed::Skip && !state_.proven_changes;
    if (!has_ended() && renew_quadrics()) prove_one_by_one();
    if (is_high) {
      state_.notes.open_all();
      prove_one_by_one();
      refine();
    }
    return ended_by_;
  }

 private:
  using Work = std::function<void(const Split&, Region&, Proposer&, ChangeProver&)>;

  void prove_together();
  void try_the_others_again();
  void keep_what_has_no_face();
  void propose_together(bool is_first);
  std::size_t propose(int shift, double share, float max_cost = HUGE_VALF);
  [[nodiscard]] bool proves_later() const;
  std::size_t undo_strays();
  [[nodiscard]] std::size_t proposed() const;
  std::size_t prove_and_repair();
  void prove_one_by_one();
  void collapse_and_prove(Split regions);
  [[nodiscard]] bool is_worth_a_cut() const;
  /// Whether at least this share of so many faces is gone since there were so many.
  [[nodiscard]] bool is_gain(std::size_t before, double share) const {
    return static_cast<double>(before - state_.faces) >= share * static_cast<double>(before);
  }
  [[nodiscard]] bool renew_quadrics();
  void refine();
  void in_regions(Split split, const Work& work);
  [[nodiscard]] bool is_global() const { return goal_.target_faces > 0 || goal_.on_exceed == OnExceed::Stop; }
  [[nodiscard]] bool has_ended() const { return ended_by_ != EndedBy::NothingFits; }
  [[nodiscard]] std::function<bool(std::size_t)> must_stop();
  [[nodiscard]] StopToken stop_of_proof() const;
  void note_stop() { ended_by_ = goal_.stop.cancelled() ? EndedBy::Cancelled : EndedBy::TimeLimit; }
  [[nodiscard]] bool truly_exceeds(Region& region, Proposer& proposer);

  DecimationState& state_;
  const DecimationGoal& goal_;
  DecimationThreads& threads_;
  StopToken stop_of_proof_;
  std::atomic<EndedBy> ended_by_{EndedBy::NothingFits};
  std::atomic<std::size_t> removed_{0};  ///< faces, from all regions of a split; told at every look
  FirstError error_;                     ///< of a region: the others end
  ExceedCheck exceed_check_{state_};
};

/// Triangles of the original that the mesh was not made from need a face that covers them; those that have none stay.
void Run::keep_what_has_no_face() {
  Proof proof(state_, threads_.workers);
  proof.run(goal_.stop);
  for (const std::uint32_t t : proof.unproven().originals) state_.keep(t);
  proof.commit();
}

/// Runs `work` for the regions of a split side by side.
void Run::in_regions(Split split, const Work& work) {
  removed_ = 0;
  if (goal_.progress) goal_.progress(state_.faces);
  on_any_thread(threads_.count(), split.regions.size(), [&](std::size_t r) {
    if (error_.has_error()) return;
    error_.guard([&] {
      const auto thread = static_cast<std::size_t>(omp_get_thread_num());
      threads_.proposers[thread]->enter(split, split.regions[r]);
      work(split, split.regions[r], *threads_.proposers[thread], *threads_.provers[thread]);
      split.regions[r].log.shrink_to_fit();  // it is kept until the next proof
    });
  });
  merge(state_, std::move(split));
  error_.rethrow();
}

/// Whether a region must stop; asked before each collapse.
std::function<bool(std::size_t)> Run::must_stop() {
  const bool tells = omp_get_thread_num() == 0 && goal_.progress;
  return [this, tells, edges = std::uint32_t{0}, known = std::size_t{0}](std::size_t removed) mutable {
    if (has_ended() || error_.has_error()) return true;
    if (goal_.target_faces > 0 && state_.faces - removed <= goal_.target_faces) {
      ended_by_ = EndedBy::Target;
      return true;
    }
    if (edges++ % edges_between_looks != 0) return false;
    removed_ += removed - known;
    known = removed;
    if (goal_.stop.stopped()) note_stop();
    if (tells) goal_.progress(state_.faces - removed_);
    return has_ended();
  };
}

/// Makes the first collapses, in cuts of several directions. Levels after the first begin with large faces everywhere:
/// there a limit for the first cut would cost up to a tenth of the time.
void Run::propose_together(bool is_first) {
  const bool is_fine = state_.tried_tolerance == 0;
  const bool is_staged = is_fine && !is_global() && state_.faces >= faces_of_vertex * 2 * min_vertices_at_first;
  const double cheap = max_cost_at_first * state_.tolerance * state_.tolerance;
  if (!is_staged || is_first) propose(0, share_together, is_staged ? static_cast<float>(cheap) : HUGE_VALF);
  const int cuts_anyway = is_staged ? 3 : 2;
  bool is_worth_another = true;
  for (int cut = 1; cut < max_cuts && is_worth_another; ++cut) {
    const std::size_t before = state_.faces;
    const std::size_t regions = propose(cut % 2 == 1 ? 1 : 2, share_together);
    const bool follows_anyway = cut + 1 < cuts_anyway;
    is_worth_another = follows_anyway ? is_gain(before, min_gain_for_next_cut)
                                      : regions > few_regions && is_gain(before, min_gain_of_cut);
  }
}

/// Makes the collapses that samples find within this share of the tolerance, without proofs. Leaves edges that cost
/// more than `max_cost`. Returns the number of regions.
std::size_t Run::propose(int shift, double share, float max_cost) {
  if (has_ended() || (is_global() && shift > 0)) return 0;
  const bool is_first = shift == 0 && share < 1;
  const std::size_t min_vertices = is_first ? min_vertices_at_first : min_vertices_together;
  Split cut = is_worth_a_cut() ? split(state_, shift, min_vertices, threads_.count()) : whole(state_);
  const std::size_t regions = cut.regions.size();
  in_regions(std::move(cut), [&](const Split& split, Region& region, Proposer& proposer, ChangeProver&) {
    RegionCollapses::Limits limits{share, must_stop(), nullptr, max_cost};
    if (goal_.on_exceed == OnExceed::Stop) limits.ends_at_refusal = [] { return true; };
    RegionCollapses(state_, split, region, proposer, nullptr, std::move(limits)).collapse_all();
  });
  return regions;
}

/// Number of changes that are not proven yet.
std::size_t Run::proposed() const {
  std::size_t changes = 0;
  for (const EditLog& log : state_.logs)
    changes += static_cast<std::size_t>(
        std::ranges::count_if(log.edits, [](const Edit& edit) { return edit.edge != no_index; }));  // others are undone
  return changes;
}

StopToken Run::stop_of_proof() const {
  if (!goal_.stop.cancelled()) return stop_of_proof_;
  return StopToken().until(StopToken::Clock::now(), seconds_of_last_proof);
}

/// Proves the proposals, and undoes what cannot be proven until the rest is. If the time ends before, all of them are
/// undone. Returns how many were undone.
std::size_t Run::prove_and_repair() {
  if (state_.logs.empty()) return 0;
  const std::size_t changes = proposed();
  std::size_t taken_back = changes;
  const std::size_t faces = state_.faces;
  Proof proof(state_, threads_.workers);
  try {
    taken_back = prove_or_undo(state_, proof, repair, [this] { return stop_of_proof(); });
  } catch (const Stopped&) {
    undo_all(state_);
    note_stop();
  }
  threads_.together.taken_back += taken_back;
  threads_.together.proven_together += changes - taken_back;
  threads_.together.originals_tested += proof.originals_tested;
  threads_.together.faces_tested += proof.faces_tested;
  if (ended_by_ == EndedBy::Target && state_.faces > goal_.target_faces && state_.faces > faces)
    ended_by_ = EndedBy::NothingFits;  // what was taken back is to be removed elsewhere
  return taken_back;
}

/// Whether collapses near the tolerance are proven together with those before them.
bool Run::proves_later() const {
  return !has_ended() && goal_.on_exceed == OnExceed::Skip &&
         state_.triangles.size() <= max_originals_of_face * state_.faces;
}

/// Undoes what has led to edges that are too far from the original. A proof would find them too, but if it comes later
/// much has been built on them. Returns how many changes were undone.
std::size_t Run::undo_strays() {
  std::size_t undone = 0;
  std::vector<std::uint32_t> changed = numbers_below(state_.mesh.face_count());
  try {
    for (;;) {
      const Unproven strays{{}, stray_faces(state_, changed, threads_, goal_.stop)};
      if (strays.empty()) break;
      Repair repaired = repair(state_, strays);
      undone += repaired.changes;
      changed = std::move(repaired.faces);
    }
  } catch (const Stopped&) {
    note_stop();
  }
  threads_.together.taken_back += undone;
  return undone;
}

/// Most collapses; those that are still refused for a share of the tolerance are open again then.
void Run::prove_together() {
  state_.refuted.clear();
  for (int round = 0; round < max_rounds; ++round) {
    propose_together(round == 0);
    const auto changes = static_cast<double>(proposed());
    const auto share =
        static_cast<double>(proves_later() ? undo_strays() : prove_and_repair()) / std::max(1.0, changes);
    if (share < min_share_taken_back || share > max_share_taken_back) break;
  }
  try_the_others_again();
  if (proves_later() || goal_.on_exceed == OnExceed::Stop) propose(0, 1);
  (void)prove_and_repair();
  std::fill(state_.share.begin(), state_.share.end(), 1.0F);
  state_.tried_tolerance = goal_.tolerance;
}

/// Makes edges open again that were refused for a smaller share of the tolerance.
void Run::try_the_others_again() {
  for (Corner e = 0; e < state_.notes.size(); ++e)
    if (state_.notes.deviation(e) <= hopeless_deviation) state_.notes.open(e);
  std::fill(state_.share.begin(), state_.share.end(), 1.0F);
}

/// Whether enough edges are open for regions to be worth it.
bool Run::is_worth_a_cut() const {
  if (is_global() || has_ended()) return false;
  const ArrayMesh& mesh = state_.mesh;
  std::size_t edges = 0, open = 0;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_removed(f)) continue;
    for (Corner e = 3 * f; e < 3 * f + 3; ++e) {
      if (mesh.edge(e) != e) continue;
      ++edges;
      open += state_.is_open(e) ? 1 : 0;
    }
    if (edges_of_open * open >= 3 * state_.faces) return true;  // there cannot be more edges
  }
  return edges_of_open * open >= edges;
}

/// Collapses near the tolerance, each proven before the next.
void Run::prove_one_by_one() {
  while (!has_ended()) {
    const std::size_t before = state_.faces;
    for (int shift = 0; shift < shifts_of_split && is_worth_a_cut(); ++shift) {
      const std::size_t before_cut = state_.faces;
      Split regions = split(state_, shift, min_vertices_one_by_one, threads_.count());
      const bool is_small = regions.regions.size() == 1;
      if (is_small && shift == 0) regions = split(state_, shift, min_vertices_of_small, threads_.count());
      if (regions.regions.size() > 1) collapse_and_prove(std::move(regions));
      if (is_small || !is_gain(before_cut, min_gain_for_next_cut)) break;
    }
    if (!has_ended()) collapse_and_prove(whole(state_));
    if (!is_gain(before, min_gain_of_pass)) return;
  }
}

/// The driver collapses what is open in each region.
void Run::collapse_and_prove(Split regions) {
  in_regions(std::move(regions), [&](const Split& split, Region& region, Proposer& proposer, ChangeProver& prover) {
    RegionCollapses::Limits limits{1, must_stop(), nullptr};
    if (goal_.on_exceed == OnExceed::Stop) {
      limits.ends_at_refusal = [&] {
        if (!truly_exceeds(region, proposer)) return false;
        ended_by_ = EndedBy::Tolerance;
        if (goal_.stop.stopped()) note_stop();
        return true;
      };
      limits.made = [&](std::uint32_t kept) { exceed_check_.note_change(kept); };
    }
    RegionCollapses collapses(state_, split, region, proposer, &prover, std::move(limits));
    if (collapses.open_edges().empty()) return;
    if (goal_.driver != nullptr)
      goal_.driver->collapse(collapses);
    else
      collapses.collapse_all();
  });
}

/// Gives each vertex the planes of the mesh that is left. Its quadric had all planes of the original that have come
/// together, with their noise. Edges that only the old planes refused are open again. Returns whether they are so many
/// that it is worth a pass.
bool Run::renew_quadrics() {
  const ArrayMesh& mesh = state_.mesh;
  std::vector<Corner> refused;
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.is_removed(f)) continue;
    for (Corner e = 3 * f; e < 3 * f + 3; ++e)
      if (mesh.edge(e) == e && is_far_beyond(state_.notes.deviation(e)) && is_refused_by_planes(state_, e))
        refused.push_back(e);
  }
  if (refused.empty()) return false;
  state_.reset_quadrics(threads_.count());
  std::size_t open = 0;
  for (const Corner e : refused) {
    if (is_refused_by_planes(state_, e)) continue;
    state_.notes.open(e);
    ++open;
  }
  return static_cast<double>(open) > min_gain_of_pass * static_cast<double>(state_.faces);
}

/// Moves vertices and flips edges to make room for further collapses.
void Run::refine() {
  if (has_ended()) return;
  RefinementGoal goal;
  goal.target_faces = goal_.target_faces;
  goal.stop = [this] {
    if (!has_ended() && goal_.stop.stopped()) note_stop();
    return has_ended();
  };
  meshbound::refine(state_, goal, threads_);
  if (!has_ended() && goal_.target_faces > 0 && state_.faces <= goal_.target_faces) ended_by_ = EndedBy::Target;
}

/// Whether the mesh would leave the tolerance by the collapse refused last.
bool Run::truly_exceeds(Region& region, Proposer& proposer) {
  DistanceOptions options;
  options.threads = threads_.count();
  options.cancel = goal_.stop.cancel;
  options.budget.seconds = goal_.stop.seconds_left();
  return exceed_check_.exceeds(region, proposer, goal_.tolerance, options);
}

/// A triangle with two equal corners is a point or a segment and no face of the mesh. Where no face near shows its part
/// of the texture, it stays as it is. Returns what else is refuted.
std::vector<Refuted> keep_points_and_segments(DecimationState& state, std::span<const Refuted> refuted) {
  std::vector<Refuted> left;
  for (const Refuted& r : refuted) {
    if (!r.coordinate || r.original == no_index || !state.has_equal_corners(r.original))
      left.push_back(r);
    else if (!state.keeps(r.original))
      state.keep(r.original);
  }
  return left;
}

}  // namespace

EndedBy decimate(DecimationState& state, const DecimationGoal& goal, DecimationThreads& threads) {
  return Run(state, goal, threads)();
}

bool take_back(DecimationState& state, std::span<const Refuted> refuted, DecimationThreads& threads) {
  state.refuse_all();  // only what this changes is tried again
  const std::size_t kept_before = state.kept.size();
  std::size_t restored = undo_refuted(state, keep_points_and_segments(state, refuted));
  Proof proof(state, threads.workers);
  restored += prove_or_undo(state, proof, repair_proven, [] { return StopToken(); });
  state.reset_quadrics(threads.count());  // those of vertices that came back are unknown
  threads.together.restored += restored;
  return restored > 0 || state.kept.size() > kept_before;
}

}  // namespace meshbound
