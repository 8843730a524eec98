// SPDX-License-Identifier: MIT
#include "meshbound/penetration_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "distance/default_error.h"
#include "geometry/frame.h"
#include "geometry/longest_edge.h"
#include "meshbound/error.h"
#include "meshbound/stop_token.h"
#include "meshbound/transform.h"
#include "numeric/checked_seconds.h"
#include "numeric/rounding.h"
#include "penetration/contact.h"
#include "penetration/parity.h"
#include "penetration/volumes.h"

namespace meshbound {
namespace {

struct Scratch {
  PlacedPair pair;
  CrossingCurves curves;
  Pieces pieces;
  VolumeFinder volumes;
  BoxPairMemory box_pairs;
};

/// Memory that a thread keeps from call to call. A call takes it away while it lasts: `progress` may ask for other
/// pairs in the midst of it, which then have memory of their own.
class BorrowedScratch {
 public:
  BorrowedScratch() : memory_(std::move(kept())) {
    if (!memory_) memory_ = std::make_unique<Scratch>();
  }
  ~BorrowedScratch() { kept() = std::move(memory_); }
  BorrowedScratch(const BorrowedScratch&) = delete;
  BorrowedScratch& operator=(const BorrowedScratch&) = delete;
  [[nodiscard]] Scratch& operator*() const { return *memory_; }

 private:
  static std::unique_ptr<Scratch>& kept() {
    thread_local std::unique_ptr<Scratch> of_thread;
    return of_thread;
  }

  std::unique_ptr<Scratch> memory_;
};

double checked(double length, const char* name) {
  if (!(length >= 0)) throw InvalidInput(std::string(name) + " must be a length of 0 or more");
  return length;
}

/// A patch as a mesh in local coordinates.
TriangleMesh local_mesh(PlacedPair& pair, const CrossingCurves& curves, std::uint32_t side, const Patch& patch) {
  thread_local std::array<SparseArray<std::uint32_t>, 3> index_of;  // by kind of corner
  index_of[0].clear(pair.model(side).positions.size());
  index_of[1].clear(curves.nodes.size());
  index_of[2].clear(curves.flush_corners.size());
  TriangleMesh mesh;
  mesh.triangles.reserve(patch.triangles.size());
  mesh.vertices.reserve(patch.triangles.size() + 2);  // of a disc; shells with more handles or parts need less
  for (const PatchTriangle& t : patch.triangles) {
    Triangle& triangle = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const PieceCorner corner = t.corners[k];
      SparseArray<std::uint32_t>& index = index_of[static_cast<std::size_t>(corner.kind)];
      if (!index.has(corner.index)) {
        index.set(corner.index, static_cast<std::uint32_t>(mesh.vertices.size()));
        const Vec3 p = position_of(pair, curves, side, corner);
        mesh.vertices.emplace_back(p.x, p.y, p.z);
      }
      triangle[k] = index[corner.index];
    }
  }
  return mesh;
}

/// Measures the volumes found, one after another.
class Measurement {
 public:
  Measurement(Scratch& memory, const PenetrationOptions& options, double error_bound)
      : memory_(memory), options_(options), error_bound_(error_bound) {
    frame_.exponent = memory.pair.exponent();
  }

  PenetrationVolume operator()(const IntersectionVolume& volume, StopToken stop) {
    PenetrationVolume result;
    result.overlap = volume.overlap;
    result.faces_on_a = volume.patches[0].faces;
    result.faces_on_b = volume.patches[1].faces;
    result.volume = content_of(volume);
    const std::array<TriangleMesh, 2> meshes{local_mesh(memory_.pair, memory_.curves, 0, volume.patches[0]),
                                             local_mesh(memory_.pair, memory_.curves, 1, volume.patches[1])};
    const double displacement = next_up(volume.patches[0].displacement + volume.patches[1].displacement);
    measure(meshes, displacement, stop, volume, result);
    return result;
  }

  /// The boundary of a volume of which each piece was cut into triangles by itself.
  [[nodiscard]] PenetrationParts parts_of(const IntersectionVolume& volume) {
    PenetrationParts parts;
    for (std::uint32_t side = 0; side < 2; ++side) {
      const Patch& patch = volume.patches[side];
      TriangleMesh& mesh = side == 0 ? parts.on_a : parts.on_b;
      mesh = local_mesh(memory_.pair, memory_.curves, side, patch);
      for (Eigen::Vector3d& p : mesh.vertices) p = memory_.pair.to_world({p.x(), p.y(), p.z()});
      for (const PatchTriangle& t : patch.triangles)
        (side == 0 ? parts.triangle_of_a : parts.triangle_of_b).push_back(given(side, patch.sources[t.first_source]));
    }
    return parts;
  }

 private:
  void measure(const std::array<TriangleMesh, 2>& meshes, double displacement, const StopToken& stop,
               const IntersectionVolume& volume, PenetrationVolume& result) {
    DistanceOptions options;
    options.threads = options_.threads;
    options.cancel = options_.cancel;
    options.budget = options_.budget;
    options.budget.seconds = stop.seconds_left();
    const double wanted = std::ldexp(error_bound_, -frame_.exponent);
    // Displaced parts widen the interval on both sides.
    options.error_bound = std::max(wanted - 2 * displacement, wanted / 2);
    const auto [tree_a, tree_b] = build_trees(meshes[0], meshes[1], {options_.threads, {}});
    OneSidedDistance a_to_b, b_to_a;
    Bounds local;
    if (options_.decide) {
      ToleranceCheck check = check_tolerance(tree_a, tree_b, std::ldexp(*options_.decide, -frame_.exponent), options);
      local = check.bounds;
      a_to_b = check.a_to_b;
      b_to_a = check.b_to_a;
    } else {
      HausdorffDistance distance = hausdorff_distance(tree_a, tree_b, options);
      local = distance.bounds;
      a_to_b = distance.a_to_b;
      b_to_a = distance.b_to_a;
    }
    local = widened(local, displacement);
    result.depth = {frame_.length_down(local.lower), frame_.length_up(local.upper)};
    const bool is_from_a = a_to_b.bounds.lower >= b_to_a.bounds.lower;
    const OneSidedDistance& leading = is_from_a ? a_to_b : b_to_a;
    result.on_a = on_model(0, is_from_a ? leading.witness.from : leading.witness.nearest, volume);
    result.on_b = on_model(1, is_from_a ? leading.witness.nearest : leading.witness.from, volume);
    conclude(a_to_b, b_to_a, result);
  }

  void conclude(const OneSidedDistance& a_to_b, const OneSidedDistance& b_to_a, PenetrationVolume& result) const {
    const bool ran_out = a_to_b.outcome == Outcome::BudgetExhausted || b_to_a.outcome == Outcome::BudgetExhausted;
    bool is_reached = result.depth.upper - result.depth.lower <= error_bound_;
    if (options_.decide) {
      result.verdict = verdict_of(result.depth, *options_.decide);
      is_reached = result.verdict != Verdict::Undecided;
    }
    if (is_reached)
      result.outcome = result.verdict == Verdict::Exceeds ? Outcome::ExceedsTolerance : Outcome::Converged;
    else
      result.outcome = ran_out ? Outcome::BudgetExhausted : Outcome::PrecisionReached;
  }

  [[nodiscard]] SurfacePoint on_model(std::uint32_t side, const SurfacePoint& local,
                                      const IntersectionVolume& volume) const {
    const Eigen::Vector3d& p = local.position;
    const Vec3 point{p.x(), p.y(), p.z()};
    return {memory_.pair.to_world(point), given(side, source_at(side, point, volume.patches[side], local.triangle))};
  }

  /// The triangle of the model that a point of a triangle of a patch lies on: of all that the latter lies on, the
  /// nearest, as the point is rounded.
  [[nodiscard]] std::uint32_t source_at(std::uint32_t side, const Vec3& point, const Patch& patch,
                                        std::uint32_t triangle) const {
    const auto [first, end, corners] = patch.triangles[triangle];
    const auto distance = [&](std::uint32_t source) {
      const Triangle& t = memory_.pair.model(side).triangles[source];
      PlacedPair& pair = memory_.pair;
      return closest_on_triangle(
                 longest_edge_first({pair.local({side, t[0]}), pair.local({side, t[1]}), pair.local({side, t[2]})}),
                 point)
          .squared_distance;
    };
    std::uint32_t nearest = patch.sources[first];
    for (std::uint32_t i = first + 1; i < end; ++i)
      if (distance(patch.sources[i]) < distance(nearest)) nearest = patch.sources[i];
    return nearest;
  }

  /// A triangle of a model as the caller numbers it.
  [[nodiscard]] std::uint32_t given(std::uint32_t side, std::uint32_t triangle) const {
    return memory_.pair.model(side).source_triangle[triangle];
  }

  [[nodiscard]] Bounds content_of(const IntersectionVolume& volume) const {
    const double unit = std::ldexp(1.0, frame_.exponent);
    const auto cubed = [unit](double x) { return x * unit * unit * unit; };
    const auto [lower, upper] = volume.content;
    // The products are exact unless they leave the range of normal numbers.
    return {std::max(0.0, next_down(cubed(lower))), next_up(cubed(upper))};
  }

  Scratch& memory_;
  const PenetrationOptions& options_;
  double error_bound_;
  Frame frame_;
};

struct FoundVolumes {
  std::vector<IntersectionVolume> of_faces;   ///< with as few triangles as possible, for the measurement
  std::vector<IntersectionVolume> of_pieces;  ///< with a source for each triangle; only where parts are wanted
};

/// The volumes of the pair in `memory`; absent if the token ended the search.
std::optional<FoundVolumes> find_volumes(Scratch& memory, const PenetrationOptions& options, double error_bound,
                                         const StopToken& stop) try {
  memory.pair.stop_by(stop);
  // Share of the error bound by which a node may be off.
  constexpr double node_share = 1.0 / 64;
  memory.curves.find(memory.pair, std::max(node_share * std::ldexp(error_bound, -memory.pair.exponent()), 0x1p-46));
  stop.check();
  memory.pieces.find(memory.pair, memory.curves);
  stop.check();
  FoundVolumes found{memory.volumes.find(memory.pair, memory.curves, memory.pieces, VolumeFinder::Cut::Faces), {}};
  if (options.keep_parts)
    found.of_pieces = memory.volumes.find(memory.pair, memory.curves, memory.pieces, VolumeFinder::Cut::Pieces);
  return found;
} catch (const Stopped&) {
  return std::nullopt;
}

void measure_all(const FoundVolumes& found, Scratch& memory, const PenetrationOptions& options, double error_bound,
                 const StopToken& stop, PenetrationDepth& result) {
  Measurement measure(memory, options, error_bound);
  bool ended = false;
  const std::size_t count = found.of_faces.size();
  for (std::size_t i = 0; i < count && !ended; ++i) {
    result.volumes.push_back(measure(found.of_faces[i], stop));
    if (options.keep_parts) result.volumes.back().parts = measure.parts_of(found.of_pieces[i]);
    const Bounds& depth = result.volumes.back().depth;
    result.depth = {std::max(result.depth.lower, depth.lower), std::max(result.depth.upper, depth.upper)};
    ended = options.stop_when_deeper && result.volumes.back().verdict == Verdict::Exceeds;
    if (options.progress) options.progress(static_cast<double>(i + 1) / static_cast<double>(count));
  }
  if (result.volumes.size() < count) result.depth.upper = std::numeric_limits<double>::infinity();
  std::stable_sort(result.volumes.begin(), result.volumes.end(),
                   [](const auto& a, const auto& b) { return a.depth.lower > b.depth.lower; });
}

}  // namespace

PenetrationDepth penetration_depth(const PlacedClosedModel& a, const PlacedClosedModel& b,
                                   const PenetrationOptions& options) {
  const auto start = StopToken::Clock::now();
  const double error_bound = options.error_bound ? checked(*options.error_bound, "the error bound")
                                                 : default_error_share * a.model->bounding_box_diagonal();
  if (options.decide) checked(*options.decide, "the depth to decide");
  const StopToken stop = StopToken{.cancel = options.cancel}.until(start, checked_seconds(options.budget.seconds));
  const BorrowedScratch scratch;
  Scratch& memory = *scratch;
  memory.pair.place(a.model->data(), a.pose, b.model->data(), b.pose);
  PenetrationDepth result;
  const auto found = find_volumes(memory, options, error_bound, stop);
  if (stop.cancelled()) throw Interrupted("cancelled before the depths were measured");
  result.stats.seconds_intersecting = seconds_since(start);
  if (found) {
    measure_all(*found, memory, options, error_bound, stop, result);
    result.stats.seconds_measuring = seconds_since(start) - result.stats.seconds_intersecting;
  } else {
    result.volumes_known = false;
    result.depth.upper = std::numeric_limits<double>::infinity();
  }
  result.stats.node_pairs = memory.curves.counters.node_pairs;
  result.stats.triangle_pairs = memory.curves.counters.triangle_pairs;
  result.stats.crossings = memory.curves.nodes.size();
  result.stats.clipped = memory.curves.crossed[0].size() + memory.curves.crossed[1].size();
  result.stats.exact_decisions = memory.pair.exact_decisions();
  return result;
}

PenetrationDepth penetration_depth(const MeshView& a, const MeshView& b, const PenetrationOptions& options) {
  const ClosedModel model_a(a, {options.threads, {}}), model_b(b, {options.threads, {}});
  return penetration_depth(PlacedClosedModel(model_a), PlacedClosedModel(model_b), options);
}

bool in_contact(const PlacedClosedModel& a, const PlacedClosedModel& b) {
  const BorrowedScratch scratch;
  Scratch& memory = *scratch;
  PlacedPair& pair = memory.pair;
  pair.place(a.model->data(), a.pose, b.model->data(), b.pose);
  PairCounters counters;
  const bool are_apart = visit_triangle_pairs(pair, memory.box_pairs, counters, [&](std::uint32_t s, std::uint32_t t) {
    const Triangle &p = pair.model(0).triangles[s], &q = pair.model(1).triangles[t];
    return !triangles_meet(pair, {{{0, p[0]}, {0, p[1]}, {0, p[2]}}}, {{{1, q[0]}, {1, q[1]}, {1, q[2]}}});
  });
  if (!are_apart) return true;
  for (std::uint32_t side = 0; side < 2; ++side)
    for (std::uint32_t i = 0; i < pair.model(side).components.size(); ++i)
      if (may_be_inside(pair, side, i) &&
          is_inside(pair, {side, pair.model(side).triangles[pair.model(side).components[i].triangle][0]}))
        return true;
  return false;
}

}  // namespace meshbound
