// SPDX-License-Identifier: MIT
#include "simplify/repair.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <span>

#include "geometry/boxes.h"
#include "numeric/no_index.h"
#include "numeric/sort_unique.h"
#include "simplify/mesh/faces_of_originals.h"
#include "simplify/normals/refuted_turns.h"
#include "simplify/star_samples.h"
#include "simplify/texture/refuted_texture.h"
#include "simplify/texture/texture_guard.h"

namespace meshbound {
namespace {

/// Samples may reach this share of what they could before where a proof has failed.
constexpr float smaller_share = 0.85F;

/// The mesh and what belongs to its vertices and lines. Returns how many faces came back.
std::size_t take_back(DecimationState& s, const EditLog& log, const Edit& edit) {
  std::size_t faces = 0;
  const auto k = static_cast<std::size_t>(&edit - log.edits.data());
  switch (edit.kind) {
    case Edit::Kind::Collapse: {
      s.mesh.undo_collapse(edit.edge);
      const std::uint32_t kept = s.mesh.start(edit.edge), gone = s.mesh.end(edit.edge);
      s.quadrics[kept] -= s.quadrics[gone];
      s.locked[kept] = edit.was_locked ? 1 : 0;
      if (!log.lines.empty()) s.lines.undo_collapse(s.mesh, edit.edge, log.lines[k]);
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
  for (const EditLog::FaceTexture& before : log.textures_of(k)) s.texture->restore(before.face, before.coordinates);
  return faces;
}

/// Undoes collapses, the last one first, together with everything built on them.
class Undoing {
 public:
  /// Unproven changes.
  explicit Undoing(DecimationState& state) : Undoing(state, state.last_changes, state.logs) {}
  /// `logs` has the changes, `last` the last of them.
  Undoing(DecimationState& state, LastChanges& last, std::vector<EditLog>& logs)
      : state_(state), last_(last), logs_(logs), samples_(state) {}

  /// Marks the last change of a face to be undone, and to be tried again with a smaller share of the tolerance. False
  /// if there is none.
  bool blame(std::uint32_t face) {
    const std::uint32_t number = last_.of_face(state_.mesh, face);
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
  void want_all() {
    for (const EditLog& log : logs_)
      for (std::uint32_t k = 0; k < log.edits.size(); ++k) wanted_.push(log.before + k + 1);
  }
  [[nodiscard]] std::size_t undone() const { return undone_; }
  /// The vertices of the changes that were undone.
  [[nodiscard]] const std::vector<std::uint32_t>& vertices() const { return vertices_; }
  /// The faces that this changes, ascending.
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

  /// Whether no later change has touched the faces around the vertex that the collapse kept; asks for those that have.
  bool is_on_top(std::uint32_t number) {
    const ArrayMesh& mesh = state_.mesh;
    const std::uint32_t kept = mesh.start(edit_of(number).edge);
    bool on_top = true;
    const auto look_at = [&](std::uint32_t vertex) {
      const std::uint32_t last = last_.of_vertex(vertex);
      if (last <= number) return;
      wanted_.push(last);
      on_top = false;
    };
    look_at(kept);
    if (!on_top) return false;  // it may be gone
    mesh.for_each_corner(kept, [&](Corner c) {
      look_at(mesh.end(c));
      if (mesh.twin(previous_corner(c)) == no_index) look_at(mesh.apex(c));
      return true;
    });
    return on_top;
  }

  void undo(std::uint32_t number) {
    DecimationState& s = state_;
    Edit& edit = edit_of(number);
    gather_samples(s.mesh.start(edit.edge));
    s.faces += take_back(s, log_of(number), edit);
    take_back(last_, s.mesh, edit);
    find_faces(edit.edge);
    changed_.insert(changed_.end(), faces_.begin(), faces_.end());
    for (const std::uint32_t v : {s.mesh.start(edit.edge), s.mesh.end(edit.edge)}) vertices_.push_back(v);
    give_samples();
    if (s.texture) give_back_samples(*s.texture, s.mesh, faces_);
    if (s.turns) s.turns->give_back(s.mesh, faces_);
    if (std::binary_search(at_fault_.begin(), at_fault_.end(), number)) lower_share(edit.edge);
    edit.edge = no_index;
    ++undone_;
  }
  /// Those around the ends of an edge.
  void find_faces(Corner edge) {
    const ArrayMesh& mesh = state_.mesh;
    const Corner twin = mesh.twin(edge);
    const std::uint32_t face = edge / 3, across = twin == no_index ? face : twin / 3;
    faces_.clear();
    for (const std::uint32_t v : {mesh.start(edge), mesh.end(edge)}) {
      mesh.for_each_corner(v, [&](Corner c) {
        if (c / 3 != face && c / 3 != across) faces_.push_back(c / 3);
        return true;
      });
    }
    faces_.push_back(face);
    if (across != face) faces_.push_back(across);
  }
  void lower_share(Corner edge) {
    float &at_start = state_.share[state_.mesh.start(edge)], &at_end = state_.share[state_.mesh.end(edge)];
    at_start = at_end = smaller_share * std::min(at_start, at_end);
  }

  /// Takes those of the faces around a vertex away from these.
  void gather_samples(std::uint32_t vertex) {
    faces_.clear();
    state_.mesh.for_each_corner(vertex, [&](Corner c) {
      faces_.push_back(c / 3);
      return true;
    });
    origin_ = state_.mesh.position(vertex);
    samples_.begin(origin_);
    samples_.add_faces(faces_);
    for (const std::uint32_t face : faces_) state_.samples.clear(face);
  }
  /// Gives each of them to the nearest of the faces.
  void give_samples() {
    sample_faces_.clear();
    for (const std::uint32_t face : faces_) {
      const auto [a, b, c] = state_.mesh.triangle(face);
      sample_faces_.emplace_back(a - origin_, b - origin_, c - origin_);
    }
    samples_.compare(sample_faces_);
    samples_.give_to_nearest(faces_);
  }

  DecimationState& state_;
  LastChanges& last_;
  std::vector<EditLog>& logs_;
  std::priority_queue<std::uint32_t> wanted_;
  std::size_t undone_ = 0;
  std::vector<std::uint32_t> at_fault_, changed_, vertices_;
  std::vector<std::uint32_t> faces_;  ///< around the change that is being undone
  Vec3 origin_;                       ///< a point there
  StarSamples samples_;
  std::vector<SampleFace> sample_faces_;
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
  const std::uint32_t at = state.mesh.start(edge);
  log.edits.push_back({kind, state.locked[at] != 0, edge, state.mesh.position(at), {}});
  note(state.last_changes, state.mesh, log.edits.back(), log.last_number());
  if (!state.lines.empty()) log.lines.push_back(state.lines.before(state.mesh, edge));
  if (!state.texture) return;
  for (const std::uint32_t face : faces) log.textures.push_back({face, state.texture->of(face)});
  log.textures_end.push_back(log.textures.size());
}

void undo_last(DecimationState& state, Region& region) {
  EditLog& log = region.log;
  const Edit& edit = log.edits.back();
  region.removed_faces -= take_back(state, log, edit);
  take_back(state.last_changes, state.mesh, edit);
  log.edits.pop_back();
  if (!log.lines.empty()) log.lines.pop_back();
  if (log.textures_end.empty()) return;
  log.textures_end.pop_back();
  log.textures.resize(log.textures_end.empty() ? 0 : log.textures_end.back());
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
  for (const std::uint32_t f : changed) {
    if (state.mesh.is_removed(f)) continue;
    for (Corner c = 3 * f; c < 3 * f + 3; ++c) state.notes.open(state.mesh.edge(c));
    for (const std::uint32_t v : state.mesh.corners(f)) state.reopen_at(v);
  }
  return {changed, undoing.undone()};
}

/// The last change of vertices whose faces are unproven, while no log has the change.
constexpr std::uint32_t taken_back = no_index;

/// Undoes proven changes; the faces that this changes are unproven then.
Repair undo_proven(DecimationState& state, Undoing& undoing) {
  Repair repair = undo_blamed(state, undoing);
  for (const std::uint32_t v : undoing.vertices()) state.last_changes.set(v, taken_back);
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
  if (!blame(undoing, state, unproven)) undoing.want_all();
  return undo_proven(state, undoing);
}

namespace {

/// Undoes the last change around each. Faces nearby may all be those of the start where the face that the original was
/// is gone: then it is the change that has removed it.
Repair undo_last_around(DecimationState& state, std::span<const Refuted> refuted) {
  ProvenChanges& changes = *state.proven_changes;
  Undoing undoing(state, changes.last, changes.logs);
  NearestFaces nearest(state);
  std::vector<std::uint32_t> at_start;  // by original, once it is needed
  for (const Refuted& r : refuted) {
    if (r.original != no_index && blame_around(undoing, nearest, state, r.original)) continue;
    if (r.face != no_index && undoing.blame(r.face)) continue;
    if (r.original == no_index) continue;
    if (at_start.empty()) at_start = faces_of_originals(state.source_triangle, state.triangles.size());
    if (at_start[r.original] != no_index) (void)undoing.blame(at_start[r.original]);
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
  undoing.want_all();
  (void)undoing.run();
  state.logs.clear();
}

}  // namespace meshbound
