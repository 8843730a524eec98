// SPDX-License-Identifier: MIT
/// Distances of meshes whose trees would not fit into memory at once.
///
/// A tile of A is compared with the clusters of B whose boxes are within a reach of its box. The upper bound of that
/// holds for all of B. The lower bound holds up to the least distance of a cluster that was left out; where the upper
/// bound is beyond that distance, a point of B that was left out might be nearer, and the reach grows.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "distance/default_error.h"
#include "distance/distance_stats.h"
#include "distance/larger_bounds.h"
#include "distance/search/one_sided.h"
#include "mesh/stored_lists.h"
#include "mesh/stored_mesh.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/mesh_view.h"
#include "meshbound/tiles.h"
#include "numeric/checked_seconds.h"
#include "numeric/rounding.h"
#include "tiles/checked_tiles.h"
#include "tiles/clusters.h"
#include "tiles/measure_in_tiles.h"
#include "tiles/tile_bytes.h"

namespace meshbound {
namespace {

/// First reach if there is no tolerance, and smallest reach after it, as shares of the diagonal of both meshes.
constexpr double first_reach = 1e-2, min_reach = 1e-5;

/// Tiles of the first batch, which start from the same lower bound, so that results do not depend on who works. Each
/// batch has twice as many as the one before: the bound of the first ones is what saves work, and the later ones have
/// work for many.
constexpr std::size_t tiles_of_first_batch = 8;

/// How far around a tile B is searched: the first reach, and the smallest one after it. Model units.
struct SearchReach {
  double first, min;
};

/// Measures one direction, h(A, B).
class TiledSearch {
 public:
  TiledSearch(const Clusters& a, const Clusters& b, const DistanceOptions& options, std::size_t max_triangles,
              const SearchReach& reach, StopToken::Clock::time_point start)
      : a_(a.mesh),
        b_(b),
        options_(options),
        reach_(reach),
        start_(start),
        tiles_(tiles_beside(a, b, reach.first, max_triangles)) {
    options_.threads = 1;
    progress_ = std::exchange(options_.progress, {});
  }

  /// `known_lower`: of the quantity that is wanted.
  OneSidedDistance run(double known_lower, JobRunner& runner) {
    OneSidedDistance all;
    all.bounds = {0, 0};
    std::size_t size = tiles_of_first_batch;
    for (std::size_t first = 0; first < tiles_.size(); first += size, size *= 2) {
      Batch batch(*this, first, std::min(size, tiles_.size() - first), std::max(known_lower, all.bounds.lower));
      runner.run(batch);
      for (const OneSidedDistance& tile : batch.found()) merge(all, tile);
    }
    all.stats.seconds = seconds_since(start_);
    return all;
  }

 private:
  /// Some tiles as jobs.
  class Batch : public TileJobs {
   public:
    Batch(const TiledSearch& search, std::size_t first, std::size_t size, double known_lower)
        : search_(search), first_(first), known_lower_(known_lower), found_(size) {}

    [[nodiscard]] std::size_t size() const override { return found_.size(); }
    [[nodiscard]] std::uint64_t weight(std::size_t job) const override { return search_.tiles_.size_of(first_ + job); }
    void run(std::size_t job) override { found_[job] = search_.search(search_.tiles_[first_ + job], known_lower_); }
    [[nodiscard]] std::string run_packed(std::size_t job) override {
      run(job);
      return packed_distance(found_[job]);
    }
    void unpack(std::size_t job, std::string_view bytes) override { found_[job] = unpacked_distance(bytes); }
    [[nodiscard]] bool is_complete(std::size_t job) const override {
      return found_[job].outcome != Outcome::BudgetExhausted;
    }
    void progress(double share) override {
      if (!search_.progress_) return;
      const double done = static_cast<double>(first_) + share * static_cast<double>(size());
      search_.progress_(done / static_cast<double>(search_.tiles_.size()));
    }
    [[nodiscard]] const std::vector<OneSidedDistance>& found() const { return found_; }

   private:
    const TiledSearch& search_;
    std::size_t first_;
    double known_lower_;
    std::vector<OneSidedDistance> found_;
  };

  [[nodiscard]] bool is_stopped() const {
    return StopToken{.cancel = options_.cancel}.until(start_, options_.budget.seconds).stopped();
  }

  /// The distance of a tile for which no time is left: between 0 and infinity.
  static OneSidedDistance unknown(std::size_t triangles) {
    OneSidedDistance result;
    result.outcome = Outcome::BudgetExhausted;
    result.stats.triangles = triangles;
    return result;
  }

  OneSidedDistance search(std::span<const std::uint32_t> tile, double known_lower) const {
    if (is_stopped()) return unknown(tile.size());
    const MeshPart part = part_of(a_, tile);
    const Eigen::AlignedBox3d box = box_of(part.mesh);
    const Bvh tree(part.mesh, BvhOptions{1});
    DistanceStats stats;
    for (double reach = reach_.first;;) {
      const double further = std::max(2 * reach, reach_.min);
      const Near near = near_to(b_, box, reach);
      if (near.triangles.empty()) {
        if (!(further > reach) || is_stopped()) return unknown(tile.size());
        reach = further;
        continue;
      }
      OneSidedDistance found = search_near(tree, near, known_lower);
      add(stats, found.stats);
      const bool may_be_nearer = found.bounds.upper > std::max(near.rest, known_lower);
      if (may_be_nearer && found.outcome != Outcome::BudgetExhausted) {
        reach = std::min(further, found.bounds.upper);
        continue;
      }
      found.bounds.lower = std::min(found.bounds.lower, near.rest);
      found.stats = stats;
      found.witness.from.triangle = tile[found.witness.from.triangle];
      found.witness.nearest.triangle = near.triangles[found.witness.nearest.triangle];
      return found;
    }
  }

  [[nodiscard]] OneSidedDistance search_near(const Bvh& tile, const Near& near, double known_lower) const {
    const MeshPart part = part_of(b_.mesh, near.triangles);
    const Bvh tree(part.mesh, BvhOptions{1});
    const PlacedModel a(tile), b(tree);
    OneSidedTask task{.a = a, .b = b, .options = options_};
    task.error_bound = *options_.error_bound;
    task.tolerance = options_.tolerance.value_or(std::numeric_limits<double>::infinity());
    task.known_lower = known_lower;
    task.start = start_;
    return search_one_sided(task);
  }

  static void merge(OneSidedDistance& all, const OneSidedDistance& tile) {
    if (all.stats.triangles == 0 || tile.bounds.lower > all.bounds.lower) all.witness = tile.witness;
    all.bounds = larger(all.bounds, tile.bounds);
    if (tile.outcome != Outcome::Converged && all.outcome != Outcome::BudgetExhausted) all.outcome = tile.outcome;
    add(all.stats, tile.stats);
  }

  const StoredMesh& a_;
  const Clusters& b_;
  DistanceOptions options_;
  std::function<void(double)> progress_;  ///< of this direction
  SearchReach reach_;
  StopToken::Clock::time_point start_;
  StoredLists tiles_;
};

/// What both directions share.
class TiledMeasurement {
 public:
  TiledMeasurement(const StoredMesh& a, const StoredMesh& b, const DistanceOptions& options, const TileOptions& tiles,
                   JobRunner& runner)
      : options_(options), tiles_(checked(tiles)), runner_(runner) {
    (void)checked_seconds(options.budget.seconds);
    const auto is_length = [](double length) { return length >= 0; };
    if (!is_length(options.error_bound.value_or(0)))
      throw InvalidInput("the error bound must be a length of 0 or more");
    if (!is_length(options.tolerance.value_or(0))) throw InvalidInput("the tolerance must be a length of 0 or more");
    const Eigen::AlignedBox3d box_of_a = used_bounding_box(a);
    const double diagonal = diagonal_of(box_of_a.merged(used_bounding_box(b)));
    if (!options.error_bound) options_.error_bound = default_error_bound(a, b, diagonal_of(box_of_a));
    reach_ = {std::min(options.tolerance.value_or(diagonal), first_reach * diagonal),
              std::max(min_reach * diagonal, std::numeric_limits<double>::denorm_min())};  // grows by doubling
    runner_.do_together([&] {
      check_floating_point_model();  // where no tree is built either
      a_.emplace(a, tiles_.max_triangles);
      b_.emplace(b, tiles_.max_triangles);
    });
  }

  /// `end`: the share of the whole measurement that is done after this direction.
  [[nodiscard]] OneSidedDistance a_to_b(double known_lower, double end) const {
    return search(*a_, *b_, known_lower, {0, end});
  }
  [[nodiscard]] OneSidedDistance b_to_a(double known_lower, double begin) const {
    return search(*b_, *a_, known_lower, {begin, 1});
  }

 private:
  /// Shares of the whole measurement.
  struct Share {
    double begin, end;
  };

  [[nodiscard]] OneSidedDistance search(const Clusters& from, const Clusters& to, double known_lower,
                                        const Share& share) const {
    DistanceOptions options = options_;
    if (options.progress)
      options.progress = [&](double done) { options_.progress(share.begin + done * (share.end - share.begin)); };
    std::optional<TiledSearch> search;
    runner_.do_together([&] { search.emplace(from, to, options, tiles_.max_triangles, reach_, start_); });
    return search->run(known_lower, runner_);
  }

  DistanceOptions options_;
  TileOptions tiles_;
  JobRunner& runner_;
  SearchReach reach_{};
  std::optional<Clusters> a_, b_;
  StopToken::Clock::time_point start_ = StopToken::Clock::now();
};

}  // namespace

double default_error_bound(const StoredMesh& a, const StoredMesh& b, double diagonal) {
  return default_error(diagonal, [&] { return used_bounding_box(a).merged(used_bounding_box(b)); });
}

OneSidedDistance measure_one_side_in_tiles(const StoredMesh& a, const StoredMesh& b, const DistanceOptions& options,
                                           const TileOptions& tiles, JobRunner& runner) {
  return TiledMeasurement(a, b, options, tiles, runner).a_to_b(0, 1);
}

HausdorffDistance measure_in_tiles(const StoredMesh& a, const StoredMesh& b, const DistanceOptions& options,
                                   const TileOptions& tiles, JobRunner& runner) {
  const TiledMeasurement measurement(a, b, options, tiles, runner);
  HausdorffDistance result;
  constexpr double share_of_first = 0.5;
  result.a_to_b = measurement.a_to_b(0, share_of_first);
  result.b_to_a = measurement.b_to_a(result.a_to_b.bounds.lower, share_of_first);
  result.bounds = larger(result.a_to_b.bounds, result.b_to_a.bounds);
  return result;
}

OneSidedDistance measure_one_side_in_tiles(const TriangleMesh& a, const TriangleMesh& b, const DistanceOptions& options,
                                           const TileOptions& tiles, JobRunner& runner) {
  validate(a);
  validate(b);
  return measure_one_side_in_tiles(MeshInMemory(a), MeshInMemory(b), options, tiles, runner);
}

HausdorffDistance measure_in_tiles(const TriangleMesh& a, const TriangleMesh& b, const DistanceOptions& options,
                                   const TileOptions& tiles, JobRunner& runner) {
  validate(a);
  validate(b);
  return measure_in_tiles(MeshInMemory(a), MeshInMemory(b), options, tiles, runner);
}

OneSidedDistance one_sided_hausdorff_distance_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                                       const DistanceOptions& options, const TileOptions& tiles) {
  ThreadRunner threads(options.threads);
  return measure_one_side_in_tiles(a, b, options, tiles, threads);
}

HausdorffDistance hausdorff_distance_in_tiles(const TriangleMesh& a, const TriangleMesh& b,
                                              const DistanceOptions& options, const TileOptions& tiles) {
  ThreadRunner threads(options.threads);
  return measure_in_tiles(a, b, options, tiles, threads);
}

}  // namespace meshbound
