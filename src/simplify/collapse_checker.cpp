// SPDX-License-Identifier: MIT
#include "meshbound/collapse_checker.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "geometry/position_table.h"
#include "mesh/mesh_arrays.h"
#include "mesh/validated.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/mesh_view.h"
#include "numeric/no_index.h"
#include "numeric/numbers_below.h"
#include "numeric/rounding.h"
#include "simplify/change_prover.h"
#include "simplify/mesh/indexed_manifold.h"
#include "simplify/propose.h"
#include "simplify/prove.h"
#include "simplify/repair.h"
#include "simplify/working_frame.h"

namespace meshbound {
namespace {

TriangleMesh in_frame(const TriangleMesh& mesh, const WorkingFrame& frame) {
  TriangleMesh result{mesh.vertices, mesh.triangles};
  for (Eigen::Vector3d& p : result.vertices) p = frame.to_frame(p);
  return result;
}

}  // namespace

class CollapseChecker::Impl {
 public:
  Impl(const TriangleMesh& original, double tolerance)
      : model_(validated(original).vertices),
        frame_(used_bounding_box(original)),
        framed_(in_frame(original, frame_)),
        vertices_(positions_of(framed_)),
        tree_(framed_),
        state_(original_of_decimation(vertices_, framed_.triangles, tree_), indexed_manifold(framed_),
               numbers_below(framed_.vertices.size()), numbers_below(framed_.triangles.size())),
        split_(whole(state_)),
        proposer_(state_),
        workers_(state_, 1),
        prover_(state_, workers_, 0) {
    proposer_.enter(split_, region());
    set_tolerance(tolerance);
    state_.set_samples(state_.tolerance);
  }

  bool admits(std::uint32_t u, std::uint32_t v, const Eigen::Vector3d& point);
  std::optional<Eigen::Vector3d> admitted_placement(std::uint32_t u, std::uint32_t v, const Eigen::Vector3d& wanted);
  std::uint32_t commit();
  void limit_triangles(std::span<const double> tolerances);
  void set_tolerance(double tolerance);
  void take_back();

  [[nodiscard]] std::uint32_t checked(std::uint32_t vertex) const {
    if (vertex < state_.mesh.vertex_count() && state_.mesh.is_vertex(vertex)) return vertex;
    throw InvalidInput("there is no vertex " + std::to_string(vertex) + " in the mesh any more, or there never was");
  }
  DecimationState& state() { return state_; }
  [[nodiscard]] const DecimationState& state() const { return state_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }
  [[nodiscard]] std::size_t faces() const {
    const std::size_t made = state_.faces - split_.regions.front().removed_faces;
    return admitted_ ? made + proposer_.star().removed.size() : made;
  }
  Counts counts;

 private:
  /// Asked for last: an edge by its vertices, and where it was to go.
  struct Question {
    std::uint32_t u, v;
    Eigen::Vector3d point;
    [[nodiscard]] bool is(std::uint32_t a, std::uint32_t b, const Eigen::Vector3d& p) const {
      return ((u == a && v == b) || (u == b && v == a)) && point == p;
    }
  };

  Region& region() { return split_.regions.front(); }
  [[nodiscard]] double room() const { return 4 * frame_.rounding(); }
  [[nodiscard]] Corner corner_between(std::uint32_t u, std::uint32_t v) const;
  [[nodiscard]] std::optional<Vec3> point_in_frame(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d point_in_model(Vec3 p, const Question& wanted) const;
  [[nodiscard]] bool is_on_neighbour(const Eigen::Vector3d& point) const;
  bool prove(Vec3 point, const Question& question);

  std::vector<Eigen::Vector3d> model_;  ///< by vertex: where it is now, in model coordinates
  WorkingFrame frame_;
  TriangleMesh framed_;
  std::vector<Vec3> vertices_;
  Bvh tree_;
  DecimationState state_;
  Split split_;
  Proposer proposer_;
  ProofWorkers workers_;
  ChangeProver prover_;
  double tolerance_ = 0;
  std::optional<Question> admitted_;  ///< made and proven, not yet part of the mesh
  std::optional<Question> refused_;   ///< by `admitted_placement`
};

/// From u to v, but at a border where only the other way has a face.
Corner CollapseChecker::Impl::corner_between(std::uint32_t u, std::uint32_t v) const {
  const ArrayMesh& mesh = state_.mesh;
  for (const std::uint32_t end : {u, v}) (void)checked(end);
  Corner found = no_index;
  mesh.for_each_corner(u, [&](Corner c) {
    if (mesh.end(c) == v) found = c;
    if (mesh.apex(c) == v) found = previous_corner(c);
    return found == no_index;
  });
  if (found == no_index)
    throw InvalidInput("vertices " + std::to_string(u) + " and " + std::to_string(v) + " have no edge in common");
  if (mesh.start(found) != u && mesh.twin(found) != no_index) found = mesh.twin(found);
  return found;
}

/// None for a point that is too far away to be within the tolerance of anything.
std::optional<Vec3> CollapseChecker::Impl::point_in_frame(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d framed = frame_.to_frame(p);
  if (!(framed.cwiseAbs().maxCoeff() <= state_.magnitude + state_.tolerance)) return std::nullopt;
  return Vec3{framed.x(), framed.y(), framed.z()};
}

/// What the caller gave is given back to the bit: the way into the frame and back may round.
Eigen::Vector3d CollapseChecker::Impl::point_in_model(Vec3 p, const Question& wanted) const {
  const auto framed = point_in_frame(wanted.point);
  if (framed && same_position(*framed, p)) return wanted.point;
  for (const std::uint32_t end : {wanted.u, wanted.v})
    if (same_position(state_.mesh.position(end), p)) return model_[end];
  return frame_.to_model({p.x, p.y, p.z});
}

/// Faces of the frame that have an area may have an edge of no length in model coordinates.
bool CollapseChecker::Impl::is_on_neighbour(const Eigen::Vector3d& point) const {
  const ArrayMesh& mesh = state_.mesh;
  return !mesh.for_each_corner(proposer_.star().kept,
                               [&](Corner c) { return model_[mesh.end(c)] != point && model_[mesh.apex(c)] != point; });
}

bool CollapseChecker::Impl::prove(Vec3 point, const Question& question) {
  const Eigen::Vector3d in_model = point_in_model(point, question);
  proposer_.collapse(region(), point);
  if (is_on_neighbour(in_model)) {
    undo_last(state_, region());
    return false;
  }
  if (!prover_.prove(split_, region(), proposer_.changed_faces())) return false;
  admitted_ = Question{question.u, question.v, in_model};
  return true;
}

void CollapseChecker::Impl::take_back() {
  refused_.reset();
  if (!admitted_) return;
  undo_last(state_, region());
  admitted_.reset();
}

bool CollapseChecker::Impl::admits(std::uint32_t u, std::uint32_t v, const Eigen::Vector3d& point) {
  check_floating_point_model();
  if (admitted_ && admitted_->is(u, v, point)) return true;
  const bool is_refused = refused_ && refused_->is(u, v, point);
  take_back();
  if (is_refused) return false;
  const Corner edge = corner_between(u, v);
  const std::optional<Vec3> wanted = state_.limit > 0 ? point_in_frame(point) : std::nullopt;
  if (wanted) {
    const std::optional<Vec3> found = proposer_.placement(edge, 1, wanted);
    if (found && same_position(*found, *wanted) && prove(*wanted, {u, v, point}) && admitted_->point == point)
      return true;
  }
  take_back();
  ++counts.refused;
  return false;
}

std::optional<Eigen::Vector3d> CollapseChecker::Impl::admitted_placement(std::uint32_t u, std::uint32_t v,
                                                                         const Eigen::Vector3d& wanted) {
  check_floating_point_model();
  take_back();
  const Corner edge = corner_between(u, v);
  const Question question{u, v, wanted};
  if (!state_.is_open(edge)) {
    ++counts.repeated;
    refused_ = question;
    return std::nullopt;
  }
  if (state_.limit > 0) {
    std::optional<Vec3> point = proposer_.placement(edge, 1, point_in_frame(wanted));
    for (; point; point = proposer_.next_placement(prover_.lost_point(), *point))
      if (prove(*point, question)) return admitted_->point;
  }
  state_.refuse(edge, 0);
  refused_ = question;
  ++counts.refused;
  return std::nullopt;
}

std::uint32_t CollapseChecker::Impl::commit() {
  if (!admitted_) throw Error("a collapse that was not admitted: ask the collapse checker first");
  prover_.accept(region());
  proposer_.make_final(region());
  const std::uint32_t kept = proposer_.star().kept;
  model_[kept] = admitted_->point;
  admitted_.reset();
  refused_.reset();
  ++counts.performed;
  return kept;
}

void CollapseChecker::Impl::limit_triangles(std::span<const double> tolerances) {
  take_back();
  if (tolerances.size() != framed_.triangles.size())
    throw InvalidInput("tolerances of triangles must be given for every triangle of the original");
  if (counts.performed > 0) throw InvalidInput("tolerances of triangles must be given before the first collapse");
  std::vector<double> limits;
  std::vector<Eigen::AlignedBox3d> boxes(framed_.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    if (!(tolerances[t] >= 0)) throw InvalidInput("the tolerance of a triangle must be a length, 0 or more");
    limits.push_back(tolerances[t] > 0 ? std::max(0.0, frame_.length_to_frame(tolerances[t]) - room()) : 0);
    for (const std::uint32_t v : framed_.triangles[t]) boxes[t].extend(framed_.vertices[v]);
  }
  state_.local.emplace(std::move(boxes), limits);
}

/// Edges that were refused for a smaller tolerance are tried again. One that is smaller than the rounding of
/// coordinates admits nothing.
void CollapseChecker::Impl::set_tolerance(double tolerance) {
  take_back();
  if (!std::isfinite(tolerance) || !(tolerance >= tolerance_))
    throw InvalidInput("the tolerance must be a length, and may only grow");
  tolerance_ = tolerance;
  state_.grow_tolerance(std::max(0.0, frame_.length_to_frame(tolerance) - room()));
  if (state_.tolerance <= room()) state_.limit = 0;
}

CollapseChecker::CollapseChecker(const TriangleMesh& original, double tolerance)
    : impl_(std::make_unique<Impl>(original, tolerance)) {}
CollapseChecker::CollapseChecker(CollapseChecker&&) noexcept = default;
CollapseChecker& CollapseChecker::operator=(CollapseChecker&&) noexcept = default;
CollapseChecker::~CollapseChecker() = default;

bool CollapseChecker::admits(std::uint32_t u, std::uint32_t v, const Eigen::Vector3d& point) {
  return impl_->admits(u, v, point);
}
std::optional<Eigen::Vector3d> CollapseChecker::admitted_placement(std::uint32_t u, std::uint32_t v,
                                                                   const Eigen::Vector3d& wanted) {
  return impl_->admitted_placement(u, v, wanted);
}
std::uint32_t CollapseChecker::commit() { return impl_->commit(); }
void CollapseChecker::lock(std::uint32_t vertex) {
  impl_->take_back();
  impl_->state().locked[impl_->checked(vertex)] = 1;
}
bool CollapseChecker::is_locked(std::uint32_t vertex) const {
  return impl_->state().locked[impl_->checked(vertex)] != 0;
}
void CollapseChecker::limit_triangles(std::span<const double> tolerances) { impl_->limit_triangles(tolerances); }
void CollapseChecker::grow_tolerance(double tolerance) { impl_->set_tolerance(tolerance); }
double CollapseChecker::tolerance() const { return impl_->tolerance(); }
std::size_t CollapseChecker::faces() const { return impl_->faces(); }
const CollapseChecker::Counts& CollapseChecker::counts() const { return impl_->counts; }

}  // namespace meshbound
