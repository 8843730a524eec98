// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/edge_collapse_driver.h"

#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <optional>
#include <utility>

#include "cgal/region_mesh.h"
#include "numeric/no_index.h"

namespace meshbound::cgal {
namespace {

namespace SMS = CGAL::Surface_mesh_simplification;
using Point = Kernel::Point_3;
using Vertex = SurfaceMesh::Vertex_index;
using Edge = SurfaceMesh::Edge_index;
using Profile = SMS::Edge_profile<SurfaceMesh, SurfaceMesh::Property_map<Vertex, Point>, Kernel>;
using Tuned = SMS::LindstromTurk_placement<SurfaceMesh>;
/// boost::optional in CGAL 5, std::optional in CGAL 6.
using OptionalPoint = decltype(std::declval<const Tuned&>()(std::declval<const Profile&>()));
using OptionalCost = decltype(std::declval<const SMS::LindstromTurk_cost<SurfaceMesh>&>()(
    std::declval<const Profile&>(), std::declval<const OptionalPoint&>()));

Vec3 to_vec3(const Point& p) { return {p.x(), p.y(), p.z()}; }
Point to_point(Vec3 p) { return {p.x, p.y, p.z}; }

/// Thrown out of `edge_collapse` to end the collapses while it asks for costs.
struct Ended {};

/// Costs between two looks at whether to end.
constexpr std::uint32_t costs_between_looks = 64;

/// One run of `edge_collapse`; the policies below are copyable handles on it.
struct Run {
  RegionCollapses& collapses;
  RegionMesh& region;
  CollapseCost cost;
  bool collects = true;  ///< CGAL is about to put edges into its queue: at the start, and after each collapse
  std::uint32_t asked = 0;

  [[nodiscard]] Placement best_placement(const Profile& profile) const {
    const std::vector<Quadric>& quadrics = collapses.state().quadrics;
    return meshbound::best_placement(quadrics[region.vertex[profile.v0()]], quadrics[region.vertex[profile.v1()]],
                                     to_vec3(profile.p0()), to_vec3(profile.p1()));
  }
  [[nodiscard]] Corner corner_of(Vertex a, Vertex b) const {
    return corner_between(collapses.mesh(), region.vertex[a], region.vertex[b]);
  }
  /// The corner of an edge whose collapse may be tried, as it is open and CGAL has all that is around it; or none.
  [[nodiscard]] Corner open_corner(Vertex a, Vertex b) const {
    if (region.is_inner[a] == 0 || region.is_inner[b] == 0) return no_index;
    const Corner corner = corner_of(a, b);
    return corner != no_index && collapses.is_open(corner) ? corner : no_index;
  }
  /// Absent if the planes refuse the edge: CGAL passes over edges without a cost before it looks at what is around
  /// them.
  [[nodiscard]] OptionalCost quadric_cost(const Profile& profile, const Point& placement) const {
    const DecimationState& state = collapses.state();
    Quadric sum = state.quadrics[region.vertex[profile.v0()]];
    sum += state.quadrics[region.vertex[profile.v1()]];
    const double squared_distances = sum.at(to_vec3(placement));
    if (squared_distances > sum.planes() * state.limit * state.limit) {  // else it is near its planes
      const Corner corner = corner_of(profile.v0(), profile.v1());
      if (corner != no_index && collapses.refuses_unseen(corner)) return {};
    }
    return squared_distances;
  }
  void look() {
    if (++asked % costs_between_looks == 0 && collapses.must_stop()) throw Ended();
  }
};

struct CollapsePlacement {
  Run* run;

  OptionalPoint operator()(const Profile& profile) const {
    if (run->cost == CollapseCost::LindstromTurk) return Tuned()(profile);
    return to_point(run->best_placement(profile).point);
  }
};

struct Cost {
  Run* run;

  OptionalCost operator()(const Profile& profile, const OptionalPoint& placement) const {
    run->look();
    if (!placement) return {};
    if (run->cost == CollapseCost::LindstromTurk) return SMS::LindstromTurk_cost<SurfaceMesh>()(profile, placement);
    return run->quadric_cost(profile, *placement);
  }
};

struct Stop {
  Run* run;

  template <class Value, class Size>
  bool operator()(const Value&, const Profile&, Size, Size) const {
    return run->collapses.must_stop();
  }
};

/// CGAL's last question before it collapses an edge: here the array mesh makes and proves the collapse.
struct Filter {
  Run* run;

  OptionalPoint operator()(const Profile& profile, const OptionalPoint& placement) const {
    const Corner corner = run->open_corner(profile.v0(), profile.v1());
    if (corner == no_index) return {};
    // Without a wish the core takes the placement of the quadrics, which is what they gave here.
    std::optional<Vec3> wanted;
    if (run->cost != CollapseCost::GarlandHeckbert) wanted = to_vec3(*placement);
    return run->collapses.collapse(corner, wanted) ? placement : OptionalPoint();
  }
};

/// Moves the vertex of a collapse in CGAL's mesh to where the array mesh has put it.
struct Visitor : SMS::Edge_collapse_visitor_base<SurfaceMesh> {
  Run* run;

  explicit Visitor(Run& of) : run(&of) {}
  template <class Size>
  void OnSelected(const Profile&, const OptionalCost&, Size, Size) const {
    run->collects = false;
  }
  void OnCollapsed(const Profile&, Vertex kept) const {
    const std::uint32_t vertex = run->collapses.kept();
    run->region.vertex[kept] = vertex;
    run->region.mesh.point(kept) = to_point(run->collapses.mesh().position(vertex));
    run->collects = true;
  }
};

/// After each collapse CGAL puts all edges around the neighbours of its vertex into its queue. Those that may not be
/// collapsed as they are stay out: one that was refused is open again only if a face at one of its ends has changed,
/// and one that leads beyond what CGAL has of the region waits.
struct Constraint {
  using key_type = Edge;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;

  const Run* run;
  friend bool get(const Constraint& map, Edge edge) {
    const SurfaceMesh& mesh = map.run->region.mesh;
    return map.run->collects && map.run->open_corner(mesh.vertex(edge, 0), mesh.vertex(edge, 1)) == no_index;
  }
};

}  // namespace

void EdgeCollapseDriver::collapse(RegionCollapses& collapses) const {
  RegionMesh region(collapses);
  if (region.max_edges_of_vertex > max_edges_of_vertex || region.has_edge_of_no_length) {
    collapses.collapse_all();
    return;
  }
  Run run{collapses, region, cost_};
  try {
    SMS::edge_collapse(region.mesh, Stop{&run},
                       CGAL::parameters::get_cost(Cost{&run})
                           .get_placement(CollapsePlacement{&run})
                           .filter(Filter{&run})
                           .visitor(Visitor(run))
                           .edge_is_constrained_map(Constraint{&run}));
  } catch (const Ended&) {
  }
}

std::shared_ptr<const CollapseDriver> edge_collapse_driver(CollapseCost cost) {
  return std::make_shared<EdgeCollapseDriver>(cost);
}

}  // namespace meshbound::cgal
