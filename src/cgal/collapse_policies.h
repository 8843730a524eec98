// SPDX-License-Identifier: GPL-3.0-or-later
/// Cost, placement and constraints of our `edge_collapse` runs. Both costs are behind one type, chosen at run time, so
/// that the collapse loop, half a minute of compilation, is instantiated once.
#pragma once
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>

#include <functional>
#include <memory>

#include "meshbound/cgal/simplify_with_bound.h"

namespace meshbound::cgal {

namespace SMS = CGAL::Surface_mesh_simplification;

/// Vertices that stay where they are, by descriptor; collapses keep it up to date through the monitor that it asks.
using LockQuery = std::function<bool(SurfaceMesh::Vertex_index)>;

/// Edges with one face are constrained when `enabled`, edges between two locked vertices always.
struct KeptParts {
  using key_type = SurfaceMesh::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;

  const SurfaceMesh* mesh = nullptr;
  bool enabled = false;
  LockQuery is_locked;  ///< none: nothing is

  friend bool get(const KeptParts& map, key_type edge) {
    if (map.enabled && map.mesh->is_border(edge)) return true;
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
  using GarlandHeckbert = SMS::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel>;

 public:
  using Update_tag = CGAL::Tag_true;  // CGAL then calls initialize and update_after_collapse

  CollapsePolicies(SurfaceMesh& mesh, CollapseCost cost, KeptParts constraint)
      : cost_(cost),
        constraint_(constraint),
        quadrics_(std::make_shared<GarlandHeckbert>(mesh)),
        initialized_(std::make_shared<bool>(false)) {}

  template <class VertexPointMap>
  void initialize(const SurfaceMesh& mesh, const VertexPointMap& points, const Kernel& kernel) const {
    if (*initialized_ || cost_ != CollapseCost::GarlandHeckbert) return;
    quadrics_->initialize(mesh, points, kernel);
    *initialized_ = true;
  }

  template <class Profile, class Vertex>
  void update_after_collapse(const Profile& profile, Vertex kept) const {
    if (cost_ == CollapseCost::GarlandHeckbert) quadrics_->update_after_collapse(profile, kept);
  }

  /// Cost of a placement.
  template <class Profile>
  boost::optional<double> operator()(const Profile& profile, const boost::optional<Kernel::Point_3>& placement) const {
    if (cost_ == CollapseCost::LindstromTurk) return lindstrom_turk_cost_(profile, placement);
    return (*quadrics_)(profile, placement);
  }

  /// Placement.
  template <class Profile>
  boost::optional<Kernel::Point_3> operator()(const Profile& profile) const {
    if (is_fixed(constraint_, profile.v0())) return Kernel::Point_3(profile.p0());
    if (is_fixed(constraint_, profile.v1())) return Kernel::Point_3(profile.p1());
    if (cost_ == CollapseCost::LindstromTurk) return lindstrom_turk_placement_(profile);
    const boost::optional<Kernel::Point_3> optimum = (*quadrics_)(profile);
    return optimum && is_local(profile, *optimum) ? optimum : best_on_edge(profile);
  }

 private:
  /// Where the surface is flat the quadric is singular but for rounding, and its optimum may be anywhere: it is
  /// believed within five edge lengths only.
  template <class Profile>
  static bool is_local(const Profile& profile, const Kernel::Point_3& p) {
    const double reach = 25 * CGAL::squared_distance(profile.p0(), profile.p1());
    return CGAL::squared_distance(profile.p0(), p) < reach && CGAL::squared_distance(profile.p1(), p) < reach;
  }

  template <class Profile>
  boost::optional<Kernel::Point_3> best_on_edge(const Profile& profile) const {
    boost::optional<Kernel::Point_3> best;
    double least = 0;
    for (const Kernel::Point_3& p :
         {CGAL::midpoint(profile.p0(), profile.p1()), Kernel::Point_3(profile.p0()), Kernel::Point_3(profile.p1())}) {
      const double cost = *(*quadrics_)(profile, boost::optional<Kernel::Point_3>(p));
      if (!best || cost < least) best = p, least = cost;
    }
    return best;
  }

  CollapseCost cost_;
  KeptParts constraint_;
  std::shared_ptr<GarlandHeckbert> quadrics_;
  std::shared_ptr<bool> initialized_;
  SMS::LindstromTurk_placement<SurfaceMesh> lindstrom_turk_placement_;
  SMS::LindstromTurk_cost<SurfaceMesh> lindstrom_turk_cost_;
};

}  // namespace meshbound::cgal
