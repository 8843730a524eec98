// SPDX-License-Identifier: MIT
#include "simplify/repair.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <span>

#include "numeric/no_index.h"
#include "numeric/sort_unique.h"
#include "simplify/mesh/face_box.h"
#include "simplify/mesh/nearest_triangle.h"
#include "simplify/normals/refuted_turns.h"
#include "simplify/texture/refuted_texture.h"
#include "simplify/texture/texture_guard.h"

namespace meshbound {
namespace {

/// Samples may reach this share of what they could before where a proof has failed.
constexpr float smaller_share = 0.85F;

/// The mesh and what belongs to its vertices, but for samples and stamps. Returns how many faces came back.
std::size_t take_back(DecimationState& s, const EditLog& log, const Edit& edit) {
  std::size_t faces = 0;
  switch (edit.kind) {
    case Edit::Kind::Collapse: {
      s.mesh.undo_collapse(edit.edge);
      const std::uint32_t kept = s.mesh.start(edit.edge), gone = s.mesh.end(edit.edge);
      s.quadrics[kept] -= s.quadrics[gone];
      s.locked[kept] = edit.was_locked ? 1 : 0;
      if (!log.lines.empty())
        s.lines.undo_collapse(s.mesh, edit.edge, log.lines[static_cast<std::size_t>(&edit - log.edits.data())]);
      faces = s.mesh.twin(edit.edge) == no_index ? 1 : 2;
      break;
    }
    case Edit::Kind::Move:
      break;
    case Edit::Kind::Flip:
      s.mesh.undo_flip(edit.edge);
      break;
  }
  s.mesh.move(s.mesh.start(edit.edge), edit.position);
  return faces;
}

/// Restores the texture coordinates that the faces had before they got these stamps.
void restore_coordinates(DecimationState& s, const EditLog& log, std::size_t first, std::size_t end) {
  if (!s.texture) return;
  for (std::size_t i = first; i < end; ++i) s.texture->restore(log.stamps[i].face, log.coordinates[i]);
}

/// Undoes changes, the last one first, together with everything built on them.
class Undoing {
 public:
  /// Unproven changes.
  explicit Undoing(DecimationState& state) : Undoing(state, state.stamp, state.logs) {}
  /// `last` has the number of the last change of each face, 0 for none, `logs` the changes.
  Undoing(DecimationState& state, std::vector<std::uint32_t>& last, std::vector<EditLog>& logs)
      : state_(state), last_(last), logs_(logs) {}

  /// Marks the last change of a face to be undone, and to be tried again with a smaller share of the tolerance. False
  /// if there is none.
  bool blame(std::uint32_t face) {
    const std::uint32_t number = last_[face];
    if (number == 0) return false;
    wanted_.push(number);
    at_fault_.push_back(number);
    return true;
  }
  /// Those of the changes that were marked by `blame`.
  [[nodiscard]] std::vector<Corner> blamed_edges() const {
    std::vector<Corner> edges;
    for (const std::uint32_t number : at_fault_) edges.push_back(edit_of(number).edge);
    return edges;
  }
  void want(std::uint32_t number) {
    if (number != 0) wanted_.push(number);
  }
  [[nodiscard]] std::size_t undone() const { return undone_; }
  std::vector<std::uint32_t> run() {
    std::sort(at_fault_.begin(), at_fault_.end());
    while (!wanted_.empty()) {
      const std::uint32_t number = wanted_.top();
      if (edit_of(number).edge == no_index) {
        wanted_.pop();  // it is undone already
      } else if (is_on_top(number)) {
        undo(number);
      }
    }
    sort_unique(changed_);
    return std::move(changed_);
  }

 private:
  [[nodiscard]] EditLog& log_of(std::uint32_t number) const {
    const auto after = std::upper_bound(logs_.begin(), logs_.end(), number,
                                        [](std::uint32_t n, const EditLog& log) { return n <= log.before; });
    return *(after - 1);
  }
  [[nodiscard]] Edit& edit_of(std::uint32_t number) const {
    EditLog& log = log_of(number);
    return log.edits[number - log.before - 1];
  }
  [[nodiscard]] std::span<const EditLog::Stamp> stamps_of(std::uint32_t number) const {
    return log_of(number).stamps_of(number);
  }

  /// Whether no later change has touched its faces; asks for those that have.
  bool is_on_top(std::uint32_t number) {
    bool on_top = true;
    for (const EditLog::Stamp& stamp : stamps_of(number)) {
      if (last_[stamp.face] == number) continue;
      wanted_.push(last_[stamp.face]);
      on_top = false;
    }
    return on_top;
  }

  void undo(std::uint32_t number) {
    DecimationState& s = state_;
    Edit& edit = edit_of(number);
    gather_samples(number);
    s.faces += take_back(s, log_of(number), edit);
    for (const EditLog::Stamp& stamp : stamps_of(number)) {
      last_[stamp.face] = stamp.before;
      changed_.push_back(stamp.face);
    }
    give_samples(number);
    restore_appearance(number);
    if (std::binary_search(at_fault_.begin(), at_fault_.end(), number)) lower_share(edit.edge);
    edit.edge = no_index;
    ++undone_;
  }
  void lower_share(Corner edge) {
    float &at_start = state_.share[state_.mesh.start(edge)], &at_end = state_.share[state_.mesh.end(edge)];
    at_start = at_end = smaller_share * std::min(at_start, at_end);
  }

  void gather_samples(std::uint32_t number) {
    samples_.clear();
    for (const EditLog::Stamp& stamp : stamps_of(number)) {
      for (std::uint32_t s = state_.samples.first(stamp.face); s != no_index; s = state_.samples.following(s))
        samples_.push_back(s);
      state_.samples.clear(stamp.face);
    }
  }
  void give_samples(std::uint32_t number) {
    nearest_.clear();
    faces_.clear();
    for (const EditLog::Stamp& stamp : stamps_of(number)) {
      if (state_.mesh.is_removed(stamp.face)) continue;
      nearest_.add(state_.mesh.triangle(stamp.face));
      faces_.push_back(stamp.face);
    }
    for (const std::uint32_t s : samples_) state_.samples.give_to(s, faces_[nearest_(state_.samples.at(s))]);
  }

  void restore_appearance(std::uint32_t number) {
    const EditLog& log = log_of(number);
    const std::span<const EditLog::Stamp> stamps = stamps_of(number);
    const auto first = static_cast<std::size_t>(stamps.data() - log.stamps.data());
    restore_coordinates(state_, log, first, first + stamps.size());
    faces_.clear();
    for (const EditLog::Stamp& stamp : stamps) faces_.push_back(stamp.face);
    if (state_.texture) give_back_samples(*state_.texture, state_.mesh, faces_);
    if (state_.turns) state_.turns->give_back(state_.mesh, faces_);
  }

  DecimationState& state_;
  std::vector<std::uint32_t>& last_;
  std::vector<EditLog>& logs_;
  std::priority_queue<std::uint32_t> wanted_;
  std::size_t undone_ = 0;
  std::vector<std::uint32_t> at_fault_, changed_, samples_, faces_;
  NearestTriangle nearest_;
};

/// The face nearest to a vertex of the original.
class NearestFaces {
 public:
  explicit NearestFaces(const DecimationState& state) : state_(state) {}

  std::uint32_t to(std::uint32_t vertex) {
    const std::uint32_t known = state_.samples.face_of(vertex);
    const double squared_reach = state_.tolerance * state_.tolerance;
    if (known != no_index && !state_.mesh.is_removed(known) && squared_from(known, vertex) <= squared_reach)
      return known;
    return search(vertex);
  }

 private:
  [[nodiscard]] double squared_from(std::uint32_t face, std::uint32_t vertex) const {
    return squared_distance(state_.mesh.triangle(face), state_.vertices[vertex]);
  }
  /// Finds the face where samples do not know it: in boxes that grow until they contain a face nearer than their reach.
  std::uint32_t search(std::uint32_t vertex) {
    if (!boxes_) boxes_.emplace(state_.mesh);
    const Eigen::Vector3d p = to_eigen(state_.vertices[vertex]);
    for (double reach = state_.tolerance;; reach *= growth_of_reach) {
      found_.clear();
      boxes_->find(grown(Eigen::AlignedBox3d(p, p), reach), found_);
      double min_squared = HUGE_VAL;
      std::uint32_t best = 0;
      for (const std::uint32_t f : found_)
        if (const double squared = squared_from(f, vertex); squared < min_squared) min_squared = squared, best = f;
      if (min_squared <= reach * reach || reach > 4 * state_.magnitude) return best;
    }
  }
  static constexpr double growth_of_reach = 4;

  const DecimationState& state_;
  std::optional<FaceBoxes> boxes_;
  std::vector<std::uint32_t> found_;
};

}  // namespace

void note_edit(DecimationState& state, Region& region, Edit::Kind kind, Corner edge,
               std::span<const std::uint32_t> faces) {
  EditLog& log = region.log;
  const std::uint32_t number = log.last_number() + 1, at = state.mesh.start(edge);
  log.edits.push_back(
      {kind, state.locked[at] != 0, edge, state.mesh.position(at), static_cast<std::uint32_t>(log.stamps.size())});
  if (!state.lines.empty()) log.lines.push_back(state.lines.before(state.mesh, edge));
  for (const std::uint32_t face : faces) {
    log.stamps.push_back({face, state.stamp[face]});
    state.stamp[face] = number;
    if (state.texture) log.coordinates.push_back(state.texture->of(face));
  }
}

void undo_last(DecimationState& state, Region& region) {
  EditLog& log = region.log;
  const Edit& edit = log.edits.back();
  region.removed_faces -= take_back(state, log, edit);
  for (std::size_t i = edit.first_stamp; i < log.stamps.size(); ++i)
    state.stamp[log.stamps[i].face] = log.stamps[i].before;
  restore_coordinates(state, log, edit.first_stamp, log.stamps.size());
  log.stamps.resize(edit.first_stamp);
  if (state.texture) log.coordinates.resize(edit.first_stamp);
  log.edits.pop_back();
  if (!log.lines.empty()) log.lines.pop_back();
}

namespace {

/// Blames the last changes around a triangle of the original. Returns whether there are any.
bool blame_around(Undoing& undoing, NearestFaces& nearest, const DecimationState& state, std::uint32_t original) {
  bool found = false;
  for (const std::uint32_t v : state.triangles[original]) found = undoing.blame(nearest.to(v)) || found;
  if (found) return true;
  for (const std::uint32_t f : state.cover.faces_of(original)) found = undoing.blame(f) || found;
  return found;
}

/// Blames the changes that caused what could not be proven. Returns whether there are any.
bool blame(Undoing& undoing, const DecimationState& state, const Unproven& unproven) {
  NearestFaces nearest(state);
  bool found = false;
  for (const std::uint32_t f : unproven.faces) found = undoing.blame(f) || found;
  for (const std::uint32_t t : unproven.originals) found = blame_around(undoing, nearest, state, t) || found;
  return found;
}

/// Undoes what was blamed. What lies around may be tried again.
Repair undo_blamed(DecimationState& state, Undoing& undoing) {
  const std::vector<std::uint32_t> changed = undoing.run();
  ++state.clock;
  for (const std::uint32_t f : changed) {
    for (const std::uint32_t v : state.mesh.corners(f)) state.touched[v] = state.clock;
    if (state.mesh.is_removed(f)) continue;
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) state.refused_at[state.mesh.edge(c)] = 0;
  }
  return {changed, undoing.undone()};
}

/// Faces with this stamp are unproven, and no log has their changes.
constexpr std::uint32_t taken_back = no_index;

/// Undoes proven changes; the faces that this changes are unproven then.
Repair undo_proven(DecimationState& state, Undoing& undoing) {
  Repair repair = undo_blamed(state, undoing);
  for (const std::uint32_t f : repair.faces) state.stamp[f] = taken_back;
  return repair;
}

}  // namespace

Repair repair(DecimationState& state, const Unproven& unproven) {
  Undoing undoing(state);
  (void)blame(undoing, state, unproven);
  return undo_blamed(state, undoing);
}

Repair repair_proven(DecimationState& state, const Unproven& unproven) {
  ProvenChanges& changes = *state.proven_changes;
  Undoing undoing(state, changes.last, changes.logs);
  if (!blame(undoing, state, unproven))
    for (std::uint32_t f = 0; f < changes.last.size(); ++f) undoing.want(changes.last[f]);
  return undo_proven(state, undoing);
}

namespace {

/// Undoes the last change around each.
Repair undo_last_around(DecimationState& state, std::span<const Refuted> refuted) {
  ProvenChanges& changes = *state.proven_changes;
  Undoing undoing(state, changes.last, changes.logs);
  NearestFaces nearest(state);
  for (const Refuted& r : refuted) {
    if (r.original != no_index && blame_around(undoing, nearest, state, r.original)) continue;
    if (r.face != no_index) (void)undoing.blame(r.face);
  }
  const std::vector<Corner> edges = undoing.blamed_edges();
  const Repair repair = undo_proven(state, undoing);
  for (const Corner edge : edges)
    for (const std::uint32_t v : {state.mesh.start(edge), state.mesh.end(edge)}) state.refuted[v] = 1;
  return repair;
}

/// What is still refuted after changes of these faces were undone.
std::vector<Refuted> still_refuted(const DecimationState& state, std::span<const Refuted> refuted,
                                   std::span<const std::uint32_t> changed) {
  std::vector<Refuted> left;
  const auto add = [&](const std::vector<Refuted>& more) { left.insert(left.end(), more.begin(), more.end()); };
  if (state.texture) add(refuted_by_texture(*state.texture, state.mesh, refuted, changed));
  if (state.turns)
    add(refuted_by_turns(*state.turns, state.mesh, state.source_triangle, state.triangles.size(), refuted));
  return left;
}

}  // namespace

std::size_t undo_refuted(DecimationState& state, std::span<const Refuted> refuted) {
  state.refuted.resize(state.mesh.vertex_count(), 0);
  std::size_t undone = 0;
  for (std::vector<Refuted> left(refuted.begin(), refuted.end()); !left.empty();) {
    const Repair repair = undo_last_around(state, left);
    if (repair.changes == 0) break;
    undone += repair.changes;
    left = still_refuted(state, left, repair.faces);
  }
  return undone;
}

void undo_all(DecimationState& state) {
  Undoing undoing(state);
  for (const EditLog& log : state.logs)
    for (const EditLog::Stamp& stamp : log.stamps) undoing.want(state.stamp[stamp.face]);
  (void)undoing.run();
  state.logs.clear();
}

}  // namespace meshbound
