// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/estimated_phase.h"

#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>

#include <algorithm>
#include <cmath>

#include "cgal/hub_collapse.h"
#include "meshbound/error.h"

namespace meshbound::cgal {
namespace {

Vec3 to_vec3(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

std::array<Eigen::Vector3d, 3> to_eigen(const std::array<Vec3, 3>& c) {
  return {Eigen::Vector3d(c[0].x, c[0].y, c[0].z), Eigen::Vector3d(c[1].x, c[1].y, c[1].z),
          Eigen::Vector3d(c[2].x, c[2].y, c[2].z)};
}

}  // namespace

class EstimatedPhase::Filter {
 public:
  explicit Filter(EstimatedPhase& phase) : phase_(&phase) {}
  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& placement) const {
    return placement && phase_->admits(profile, *placement) ? placement : OptionalPoint();
  }

 private:
  EstimatedPhase* phase_;
};

class EstimatedPhase::Stop {
 public:
  explicit Stop(EstimatedPhase& phase) : phase_(&phase) {}
  template <class Cost, class Profile, class Size>
  bool operator()(const Cost&, const Profile&, Size, Size) const {
    return phase_->exceeded_ >= phase_->most_exceeded_ || phase_->should_stop_(phase_->mesh_.number_of_faces());
  }

 private:
  EstimatedPhase* phase_;
};

class EstimatedPhase::Visitor : public SMS::Edge_collapse_visitor_base<SurfaceMesh> {
 public:
  explicit Visitor(EstimatedPhase& phase) : phase_(&phase) {}
  template <class Profile, class OptionalPoint>
  void OnCollapsing(const Profile&, const OptionalPoint&) const {
    phase_->collapsing_ = true;
  }
  /// Throws `Error` for the collapses of zero-length edges that CGAL makes without asking.
  template <class Profile>
  void OnCollapsed(const Profile&, SurfaceMesh::Vertex_index v) const {
    if (!phase_->collapsing_) throw Error("a zero-length edge was collapsed unasked; weld equal vertices first");
    phase_->collapsing_ = false;
    phase_->heights_[v] = phase_->next_;
    if (!phase_->locked_.empty()) phase_->locked_[v] = phase_->next_locked_;
    ++phase_->collapses_;
  }

 private:
  EstimatedPhase* phase_;
};

EstimatedPhase::EstimatedPhase(SurfaceMesh& mesh, const NormalGuard& guard, std::vector<bool> locked,
                               std::vector<bool> frozen, std::function<bool(std::size_t faces)> should_stop)
    : mesh_(mesh),
      guard_(guard),
      locked_(std::move(locked)),
      frozen_(std::move(frozen)),
      should_stop_(std::move(should_stop)),
      heights_(mesh.num_vertices()) {}

void EstimatedPhase::run(const CollapsePolicies& policies, const KeptParts& kept, double limit,
                         std::uint64_t most_exceeded) {
  limit_ = limit;
  most_exceeded_ = most_exceeded;
  collapse_edges(mesh_, Stop(*this), policies, policies, Filter(*this), Visitor(*this), kept);
}

/// The faces around the edge as they are and as they would be. False where one would be folded or lose its area.
template <class Profile>
bool EstimatedPhase::gather(const Profile& profile, const Kernel::Point_3& placement) {
  const Vec3 moved = to_vec3(placement);
  before_.clear(moved);
  after_.clear(moved);
  for (const auto& t : profile.triangles()) {
    const std::array<SurfaceMesh::Vertex_index, 3> v = {t.v0, t.v1, t.v2};
    std::array<Vec3, 3> corners, changed;
    int ends = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_end = v[i] == profile.v0() || v[i] == profile.v1();
      ends += is_end ? 1 : 0;
      corners[i] = at(v[i]);
      changed[i] = is_end ? moved : corners[i];
    }
    before_.add(corners);
    if (ends == 2) continue;
    const auto c = to_eigen(changed);
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0] || !guard_.allows(to_eigen(corners), c)) return false;
    after_.add(changed);
  }
  // The tracker refuses more, and the time spent here grows with the square.
  return after_.size() > 0 && after_.size() <= DeviationTracker::most_added_faces;
}

/// Vertices and the middles of edges, of the old faces and of the new ones: where edges cross at a saddle, no vertex
/// tells how far they are apart.
template <class Profile>
bool EstimatedPhase::admits(const Profile& profile, const Kernel::Point_3& placement) {
  const auto v0 = profile.v0(), v1 = profile.v1();
  if (!may_move(v0, placement) || !may_move(v1, placement) || !gather(profile, placement)) return false;
  shifts_before_.clear();
  shifts_after_.clear();
  const auto ask = [](HeightField& field, std::vector<Heights>& shifts, Vec3 p, const Heights& shifted) {
    field.ask(p);
    shifts.push_back(shifted);
  };
  const Heights between = heights_[v0].joined(heights_[v1]);
  const Vec3 moved = to_vec3(placement);
  ask(before_, shifts_before_, moved, between);
  for (const auto r : profile.link()) ask(before_, shifts_before_, 0.5 * (moved + at(r)), between.middle(heights_[r]));
  for (const auto v : {v0, v1}) {
    const Vec3 p = at(v);
    ask(after_, shifts_after_, p, heights_[v]);
    for (const auto h : CGAL::halfedges_around_target(mesh_.halfedge(v), mesh_)) {
      const auto r = mesh_.source(h);
      if (r != v0 && r != v1) ask(after_, shifts_after_, 0.5 * (p + at(r)), heights_[v].middle(heights_[r]));
    }
  }
  const auto old_heights = before_.heights(), new_heights = after_.heights();
  next_ = shifts_before_[0].lowered(old_heights[0]);
  for (std::size_t i = 1; i < old_heights.size(); ++i) next_ = next_.joined(shifts_before_[i].lowered(old_heights[i]));
  for (std::size_t i = 0; i < new_heights.size(); ++i) next_ = next_.joined(shifts_after_[i].raised(new_heights[i]));
  next_locked_ = is_locked(v0) || is_locked(v1);
  if (std::max(-next_.least, next_.most) <= limit_) return true;
  ++exceeded_;
  return false;
}

}  // namespace meshbound::cgal
