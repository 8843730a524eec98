// SPDX-License-Identifier: GPL-3.0-or-later
/// The policies that `DeviationMonitor` hands to `edge_collapse`; included by its header.
#pragma once
#include <utility>

#include "meshbound/cgal/deviation_monitor.h"

namespace meshbound::cgal {

/// Takes a profile and an optional placement of CGAL (boost:: or std::optional), returns it, or none to refuse. Throws
/// `InvalidInput` in an `edge_collapse` that was not given the visitor: without it, collapses that were admitted are
/// never committed, and the next proof starts from a mesh that is no longer there.
template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::Filter {
 public:
  explicit Filter(DeviationMonitor& monitor) : monitor_(&monitor) {}

  template <class Profile, class OptionalPoint>
  OptionalPoint operator()(const Profile& profile, const OptionalPoint& placement) const {
    if (!monitor_->visited_)
      throw InvalidInput("edge_collapse was given the filter of the deviation monitor only: pass its visitor too");
    if (!placement || !monitor_->admits(profile, *placement)) return OptionalPoint();
    return placement;
  }

 private:
  DeviationMonitor* monitor_;
};

/// Gives the placement of `base`, but when CGAL is about to collapse the edge: then the first of that one, a point
/// where the sampled deviation is least, the middle and the ends of the edge, that keeps the bound. (CGAL asks a
/// placement for the costs of all edges, too, where a proof would be wasted, and ignores the placement that a filter
/// returns.)
template <class Mesh, class VertexPointMap>
template <class Base>
class DeviationMonitor<Mesh, VertexPointMap>::Placement {
 public:
  Placement(DeviationMonitor& monitor, const Base& base) : monitor_(&monitor), base_(base) {}

  template <class Profile>
  auto operator()(const Profile& profile) const -> decltype(std::declval<const Base&>()(profile)) {
    auto placement = base_(profile);
    if (!placement || monitor_->selected_ != profile.v0_v1()) return placement;
    monitor_->selected_.reset();
    if (const std::optional<Point> admitted = monitor_->admitted_placement(profile, *placement)) *placement = *admitted;
    return placement;
  }

 private:
  DeviationMonitor* monitor_;
  Base base_;
};

template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::StopPredicate {
 public:
  explicit StopPredicate(DeviationMonitor& monitor) : monitor_(&monitor) {}

  template <class Cost, class Profile, class Size>
  bool operator()(const Cost&, const Profile&, Size, Size) const {
    return monitor_->should_stop && monitor_->should_stop(monitor_->faces());
  }

 private:
  DeviationMonitor* monitor_;
};

template <class Mesh, class VertexPointMap>
class DeviationMonitor<Mesh, VertexPointMap>::Visitor {
 public:
  explicit Visitor(DeviationMonitor& monitor) : monitor_(&monitor) {}

  template <class AnyMesh>
  void OnStarted(AnyMesh&) const {
    monitor_->visited_ = true;
  }
  template <class AnyMesh>
  void OnFinished(AnyMesh&) const {
    monitor_->visited_ = false;
  }
  template <class Profile>
  void OnStopConditionReached(const Profile&) const {}
  template <class Profile, class OptionalCost>
  void OnCollected(const Profile&, const OptionalCost&) const {}
  template <class Profile, class OptionalCost, class Size>
  void OnSelected(const Profile& profile, const OptionalCost&, Size, Size) const {
    monitor_->selected_ = profile.v0_v1();
  }
  template <class Profile>
  void OnNonCollapsable(const Profile&) const {}

  /// Throws `Error` when the collapse is not the one that the filter admitted last.
  template <class Profile, class OptionalPoint>
  void OnCollapsing(const Profile& profile, const OptionalPoint& placement) const {
    auto& admitted = monitor_->admitted_;
    if (!admitted || !placement || admitted->first != profile.v0_v1() || admitted->second != *placement)
      throw Error("a collapse that the deviation monitor has not admitted: pass its filter to edge_collapse too");
    admitted.reset();
    monitor_->tracker_.commit();
    monitor_->collapsing_ = true;
    monitor_->collapsing_locked_ = monitor_->is_locked(profile.v0()) || monitor_->is_locked(profile.v1());
    monitor_->faces_ -= (profile.left_face_exists() ? 1u : 0u) + (profile.right_face_exists() ? 1u : 0u);
  }
  /// Throws `Error` for the collapses of zero-length edges that CGAL makes without asking.
  template <class Profile, class AnyVertex>
  void OnCollapsed(const Profile&, const AnyVertex& v) const {
    if (!monitor_->collapsing_)
      throw Error("a zero-length edge was collapsed without asking the deviation monitor; weld equal vertices first");
    monitor_->collapsing_ = false;
    monitor_->collapsed_into(v);
  }

 private:
  DeviationMonitor* monitor_;
};

}  // namespace meshbound::cgal
