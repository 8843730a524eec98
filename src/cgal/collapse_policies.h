// SPDX-License-Identifier: GPL-3.0-or-later
/// Cost, placement and constraints of our `edge_collapse` runs. Both costs are behind one type, chosen at run time, so
/// that the collapse loop, half a minute of compilation, is instantiated once.
#pragma once
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cgal/part_seam.h"
#include "cgal/quadrics.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/stop_token.h"

namespace meshbound::cgal {

namespace SMS = CGAL::Surface_mesh_simplification;

/// Vertices that stay where they are, by descriptor; collapses keep it up to date through the monitor that it asks.
using LockQuery = std::function<bool(SurfaceMesh::Vertex_index)>;

/// Edges with one face are constrained when `enabled`, edges between two locked vertices always, and where `only` tells
/// by vertex what is to be decimated, all edges elsewhere.
struct KeptParts {
  using key_type = SurfaceMesh::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;

  const SurfaceMesh* mesh = nullptr;
  bool enabled = false;
  LockQuery is_locked;                      ///< none: nothing is
  const std::vector<bool>* only = nullptr;  ///< null: everything

  friend bool get(const KeptParts& map, key_type edge) {
    if (map.enabled && map.mesh->is_border(edge)) return true;
    if (map.only != nullptr && !(*map.only)[map.mesh->vertex(edge, 0)] && !(*map.only)[map.mesh->vertex(edge, 1)])
      return true;
    return map.is_locked && map.is_locked(map.mesh->vertex(edge, 0)) && map.is_locked(map.mesh->vertex(edge, 1));
  }
};

/// A locked vertex, or one on the border when that is to stay as it is.
inline bool is_fixed(const KeptParts& constraint, SurfaceMesh::Vertex_index v) {
  return (constraint.enabled && constraint.mesh->is_border(v)) || (constraint.is_locked && constraint.is_locked(v));
}

/// Garland-Heckbert or Lindstrom-Turk as cost and placement. Quadrics are computed once, from the mesh of the first
/// run, and summed up by collapses ever after, so a later pass or level still knows the shape it started from.
class CollapsePolicies {
 public:
  using Update_tag = CGAL::Tag_true;  // CGAL then calls initialize and update_after_collapse

  /// `seam` is null for a mesh that is no part of another, and must outlive this otherwise.
  CollapsePolicies(CollapseCost cost, KeptParts constraint, const PartSeam* seam)
      : cost_(cost), constraint_(constraint), seam_(seam), quadrics_(std::make_shared<std::optional<Quadrics>>()) {}

  template <class VertexPointMap>
  void initialize(const SurfaceMesh& mesh, const VertexPointMap&, const Kernel&) const {
    if (cost_ != CollapseCost::GarlandHeckbert) return;
    if (*quadrics_)
      (*quadrics_)->forget_edges();
    else
      quadrics_->emplace(mesh, [this](auto u, auto v) { return seam_ != nullptr && seam_->has_edge(u, v); });
  }
  /// Calls for a cost throw `Stopped` from then on. CGAL asks for all edges before the first collapse, and for those
  /// around a collapse when that is complete.
  void stop_by(const StopToken& stop) { stop_ = stop; }
  /// In place of the quadrics of the mesh of the first run: by vertex.
  void start_from(std::vector<Quadric> quadrics, const SurfaceMesh& mesh) {
    if (cost_ == CollapseCost::GarlandHeckbert) quadrics_->emplace(std::move(quadrics), mesh);
  }
  /// Zero before the first run, and for another cost.
  [[nodiscard]] Quadric quadric(SurfaceMesh::Vertex_index v) const {
    return *quadrics_ ? (*quadrics_)->of_vertex(v) : Quadric();
  }

  template <class Profile, class Vertex>
  void update_after_collapse(const Profile& profile, Vertex kept) const {
    if (cost_ == CollapseCost::GarlandHeckbert)
      (*quadrics_)->collapsed(profile.v0(), profile.v1(), kept, profile.surface_mesh());
  }

  /// Cost of a placement.
  template <class Profile>
  boost::optional<double> operator()(const Profile& profile, const boost::optional<Kernel::Point_3>& placement) const {
    if (++asked_ % costs_between_looks == 0) stop_.check();
    if (!placement) return boost::none;
    if (cost_ == CollapseCost::LindstromTurk) return lindstrom_turk_cost_(profile, placement);
    const Quadrics::Collapse& best = of_edge(profile);
    return *placement == best.placement ? best.cost : (*quadrics_)->cost(profile.v0(), profile.v1(), *placement);
  }

  /// Placement. None where both ends are to stay: a locked vertex and one of a border.
  template <class Profile>
  boost::optional<Kernel::Point_3> operator()(const Profile& profile) const {
    if (seam_ != nullptr && seam_->forbids(profile)) return boost::none;
    const bool first = is_fixed(constraint_, profile.v0()), second = is_fixed(constraint_, profile.v1());
    if (first && second) return boost::none;
    if (first) return Kernel::Point_3(profile.p0());
    if (second) return Kernel::Point_3(profile.p1());
    if (cost_ == CollapseCost::LindstromTurk) return lindstrom_turk_placement_(profile);
    return of_edge(profile).placement;
  }

 private:
  template <class Profile>
  const Quadrics::Collapse& of_edge(const Profile& profile) const {
    const SurfaceMesh::Edge_index edge = profile.surface_mesh().edge(profile.v0_v1());
    return (*quadrics_)->of_edge(edge, profile.v0(), profile.v1(), profile.p0(), profile.p1());
  }

  static constexpr std::uint32_t costs_between_looks = 64;

  CollapseCost cost_;
  StopToken stop_;
  mutable std::uint32_t asked_ = 0;  ///< costs
  KeptParts constraint_;
  const PartSeam* seam_;
  std::shared_ptr<std::optional<Quadrics>> quadrics_;
  SMS::LindstromTurk_placement<SurfaceMesh> lindstrom_turk_placement_;
  SMS::LindstromTurk_cost<SurfaceMesh> lindstrom_turk_cost_;
};

}  // namespace meshbound::cgal
