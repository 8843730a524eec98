// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "cgal/collapse_policies.h"
#include "cgal/height_field.h"
#include "meshbound/cgal/normal_guard.h"

namespace meshbound::cgal {

/// Collapses far from the tolerance, made without a proof: a running estimate of the deviation says when to stop. What
/// comes out must be proven as a whole afterwards, and may turn out not to hold.
///
/// Each vertex keeps the interval of heights at which the original lies above the mesh around it. A collapse into p
/// shifts the intervals of both ends by the heights of these above the new faces, and that of p, which lies between, by
/// the height of p above the old ones, less:
///
///        v0____v1                          .-' p '-.
///     .-'  |  |  '-.        ---->       .-' /  |  \ '-.        the new interval holds all three
///
/// Heights to both sides cancel, so the estimate does not grow with the number of collapses.
class EstimatedPhase {
 public:
  /// The mesh must outlive this. `locked` is empty or tells by vertex which of them stay where they are, `frozen` which
  /// ones no collapse may take or move. `should_stop` is asked before each collapse.
  EstimatedPhase(SurfaceMesh& mesh, const NormalGuard& guard, std::vector<bool> locked, std::vector<bool> frozen,
                 std::function<bool(std::size_t faces)> should_stop);

  /// Collapses edges, but those whose estimate comes out above `limit`, a length, until `most_exceeded` did.
  void run(const CollapsePolicies& policies, const KeptParts& kept, double limit, std::uint64_t most_exceeded);

  [[nodiscard]] bool is_locked(SurfaceMesh::Vertex_index v) const { return !locked_.empty() && locked_[v]; }
  [[nodiscard]] const std::vector<bool>& locked() const { return locked_; }
  [[nodiscard]] std::uint64_t collapses() const { return collapses_; }
  /// By vertex: what goes on in another phase, of a mesh that was joined from several.
  [[nodiscard]] const std::vector<Heights>& heights() const { return heights_; }
  void start_from(std::vector<Heights> heights) { heights_ = std::move(heights); }

 private:
  class Filter;
  class Stop;
  class Visitor;
  template <class Profile>
  [[nodiscard]] bool admits(const Profile& profile, const Kernel::Point_3& placement);
  template <class Profile>
  [[nodiscard]] bool gather(const Profile& profile, const Kernel::Point_3& placement);
  [[nodiscard]] Vec3 at(SurfaceMesh::Vertex_index v) const {
    const Kernel::Point_3& p = mesh_.point(v);
    return {p.x(), p.y(), p.z()};
  }
  [[nodiscard]] bool may_move(SurfaceMesh::Vertex_index v, const Kernel::Point_3& placement) const {
    return (frozen_.empty() || !frozen_[v]) && (!is_locked(v) || mesh_.point(v) == placement);
  }

  SurfaceMesh& mesh_;
  NormalGuard guard_;
  std::vector<bool> locked_, frozen_;
  std::function<bool(std::size_t)> should_stop_;
  double limit_ = 0;
  std::uint64_t exceeded_ = 0, most_exceeded_ = 0;
  std::vector<Heights> heights_;  ///< by vertex
  HeightField before_, after_;
  std::vector<Heights> shifts_before_, shifts_after_;  ///< heights that the points asked for shift
  Heights next_;                                       ///< of the vertex of the collapse that was admitted
  bool next_locked_ = false, collapsing_ = false;
  std::uint64_t collapses_ = 0;
};

}  // namespace meshbound::cgal
