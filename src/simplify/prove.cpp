// SPDX-License-Identifier: MIT
#include "simplify/prove.h"

#include <omp.h>

#include <algorithm>
#include <utility>

#include "numeric/no_index.h"
#include "numeric/tasks.h"
#include "simplify/proof_worker.h"

namespace meshbound {
namespace {

/// Items that one thread takes at a time.
constexpr std::size_t items_of_run = 64;

}  // namespace

Proof::Proof(DecimationState& state, ProofWorkers& workers) : state_(state), workers_(workers) {
  originals_.reserve(state.triangles.size());  // a list that grows takes up to three times as much
  for (std::uint32_t t = 0; t < state.triangles.size(); ++t)
    if (is_stale(t)) originals_.push_back(t);
  for (std::uint32_t f = 0; f < state.mesh.face_count(); ++f)
    if (state.is_unproven(f) && !state.mesh.is_removed(f)) open_faces_.push_back(f);
  drafts_.resize(originals_.size());
}

bool Proof::is_stale(std::uint32_t original) const {
  if (state_.keeps(original)) return false;
  const auto faces = state_.cover.faces_of(original);
  return faces.empty() ||
         std::any_of(faces.begin(), faces.end(), [&](std::uint32_t f) { return state_.is_unproven(f); });
}

void Proof::run(const StopToken& stop) {
  for (std::size_t k = 0; k < workers_.count(); ++k) workers_.of_thread(k).forget_faces();
  unproven_ = {{}, find_far_faces(stop)};
  if (!unproven_.faces.empty()) return;
  if (!is_changed_.empty()) reopen_originals();
  cover(stop);
  cover_anywhere(stop);
  for (std::size_t i = 0; i < open_count(); ++i)
    if (drafts_[open_original(i)].empty()) unproven_.originals.push_back(originals_[open_original(i)]);
}

/// Calls work(worker, i) for each i below `count`, on all threads; `at_once` of them are one task.
void Proof::for_each(std::size_t count, std::size_t at_once, const StopToken& stop, const Work& work) {
  with_team(static_cast<int>(workers_.count()), [&] {
    for_each_range(count, at_once, [&](std::size_t begin, std::size_t end) {
      stop.check();
      ProofWorkers::Worker& worker = workers_.of_thread(static_cast<std::size_t>(omp_get_thread_num()));
      for (std::size_t i = begin; i < end; ++i) work(worker, i);
    });
  });
}

/// Those of the open faces that are too far from the original.
std::vector<std::uint32_t> Proof::find_far_faces(const StopToken& stop) {
  std::vector<std::uint8_t> is_near(open_faces_.size(), 0);
  for_each(open_faces_.size(), items_of_run, stop, [&](ProofWorkers::Worker& worker, std::size_t i) {
    is_near[i] = worker.is_near(open_faces_[i], state_.nearest[open_faces_[i]]);
  });
  faces_tested += open_faces_.size();
  std::vector<std::uint32_t> far;
  for (std::size_t i = 0; i < open_faces_.size(); ++i)
    if (is_near[i] == 0) far.push_back(open_faces_[i]);
  return far;
}

/// Covers the open originals by the faces that samples lead to.
void Proof::cover(const StopToken& stop) {
  for_each(open_count(), items_of_run, stop, [&](ProofWorkers::Worker& worker, std::size_t i) {
    const std::uint32_t at = open_original(i);
    drafts_[at].assign(worker.cover(originals_[at]));
  });
  originals_tested += open_count();
}

/// Covers the originals that samples have not led to a cover.
void Proof::cover_anywhere(const StopToken& stop) {
  std::vector<std::uint32_t> lost;
  std::vector<Eigen::AlignedBox3d> reaches;
  for (std::size_t i = 0; i < open_count(); ++i) {
    const std::uint32_t at = open_original(i);
    if (!drafts_[at].empty()) continue;
    lost.push_back(at);
    reaches.push_back(grown(box_of(state_.original(originals_[at])), state_.tolerance));
  }
  if (lost.empty()) return;
  const FaceBoxes boxes(state_.mesh, BoxTree(reaches));
  for_each(lost.size(), 1, stop, [&](ProofWorkers::Worker& worker, std::size_t i) {
    drafts_[lost[i]].assign(worker.cover_anywhere(originals_[lost[i]], boxes));
  });
}

void Proof::reopen(const std::vector<std::uint32_t>& changed) {
  is_changed_.resize(state_.mesh.face_count(), 0);
  open_faces_.clear();
  for (const std::uint32_t f : changed) {
    is_changed_[f] = 1;
    if (state_.is_unproven(f) && !state_.mesh.is_removed(f)) open_faces_.push_back(f);
  }
}

/// Opens the originals without a cover, and those whose new cover has a face that was changed again.
void Proof::reopen_originals() {
  has_all_open_ = false;
  open_originals_.clear();
  open_originals_.reserve(originals_.size());
  const auto is_changed = [&](std::uint32_t f) { return is_changed_[f] != 0; };
  for (std::uint32_t i = 0; i < originals_.size(); ++i) {
    if (originals_[i] == no_index) continue;
    const auto faces = drafts_[i].ids();
    if (!faces.empty() && std::none_of(faces.begin(), faces.end(), is_changed)) continue;
    drafts_[i] = {};
    if (is_stale(originals_[i]))
      open_originals_.push_back(i);
    else
      originals_[i] = no_index;  // its old cover holds again
  }
  is_changed_.clear();
}

void Proof::commit() {
  std::size_t count = 0;
  for (std::size_t i = 0; i < originals_.size(); ++i) {
    if (originals_[i] == no_index) continue;
    originals_[count] = originals_[i];
    drafts_[count++] = std::move(drafts_[i]);
  }
  if (state_.proven_changes)
    for (const EditLog& log : state_.logs) state_.proven_changes->add(state_.mesh, log);
  state_.logs.clear();  // room for the covers
  state_.cover.assign(std::span(originals_).first(count), [&](std::size_t i) { return drafts_[i].ids(); });
  state_.last_changes.clear();
}

}  // namespace meshbound
