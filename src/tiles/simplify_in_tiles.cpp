// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "levels/measured_level.h"
#include "mesh/round_to_floats.h"
#include "meshbound/error.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/mesh_view.h"
#include "meshbound/tiles.h"
#include "numeric/rounding.h"
#include "simplify/ended_by.h"
#include "tiles/checked_tiles.h"
#include "tiles/decimate_in_tiles.h"
#include "tiles/measure_in_tiles.h"
#include "tiles/tiled_mesh.h"

namespace meshbound {
namespace {

/// Throws where an option asks for what tiles cannot do.
void check_for_tiles(const SimplifyOptions& options) {
  check_options(options);
  const auto refuse = [](bool asked, const char* what) {
    if (asked) throw InvalidInput(std::string("a mesh in tiles cannot be simplified with ") + what);
  };
  refuse(!options.levels.empty(), "several levels: ask for one tolerance at a time");
  refuse(options.target_faces || options.target_ratio, "a target: ask for a tolerance alone");
  refuse(options.on_exceed == OnExceed::Stop, "an end at the first refusal: let refused collapses be skipped");
  refuse(options.prune, "components pruned");
  refuse(options.line_tolerance || !options.feature_edges.empty() || options.feature_angle, "feature lines or angles");
  refuse(!options.face_tolerances.empty(), "tolerances of triangles");
  refuse(!options.texture_coordinates.empty(), "texture coordinates");
  refuse(!options.looks.empty(), "looks of triangles");
  refuse(options.keep_sides, "the sides of triangles kept");
  refuse(options.normal_tolerance.has_value(), "a normal tolerance");
  refuse(options.certificate, "a certificate");
}

/// The cuts of the passes: the planes of each run where earlier ones have left no seams. A fifth and a sixth pass would
/// take 7% of the time and still remove two fifths of what is left where a tile ends with ten triangles.
constexpr std::array<TileCut, 4> cuts = {{{0, 1.0 / 2}, {1, 1.0 / 3}, {2, 1.0 / 3}, {0, 2.0 / 3}}};

/// Smallest share of the triangles that a pass must remove for another one to follow.
constexpr double min_gain_of_pass = 0.01;

/// Tiles of later passes weigh so many times as many triangles of the original. They take no more memory, as an
/// original whose own triangle has gone takes a quarter of what it took in the first pass.
constexpr std::size_t growth_of_later_tiles = 4;

/// Smaller tiles would hold less than the faces around a vertex.
constexpr std::size_t min_triangles_of_tile = 8;

/// Rings of triangles around a seam that the second pass goes over, and each later one: the seams of the first are
/// small triangles among large ones. What lies further away was simplified as far as possible.
constexpr int rings_of_second_pass = 4, rings_of_later_pass = 2;

/// Share of the whole progress that the first pass counts for.
constexpr double share_of_first_pass = 0.6;

/// All passes over one mesh.
class TiledRun {
 public:
  TiledRun(const StoredMesh& original, const SimplifyOptions& options, const TileOptions& tiles, JobRunner& runner)
      : options_(options),
        tiles_(checked(tiles)),
        runner_(runner),
        stop_(StopToken{.cancel = options.cancel}.until(StopToken::Clock::now(), options.time_limit)),
        mesh_(original, options.locked_vertices) {
    of_tile_.threads = 1;
  }

  SimplifyResult run() {
    const auto start = StopToken::Clock::now();
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const std::size_t before = mesh_.faces();
      const std::size_t tiles = pass(k);
      const auto gain = static_cast<double>(before - mesh_.faces());
      if (runner_.any(stop_.stopped()) || tiles == 1 || gain < min_gain_of_pass * static_cast<double>(before)) break;
    }
    SimplifyResult result;
    SimplifiedLevel& level = result.levels.emplace_back();
    level.tolerance = options_.tolerance;
    runner_.do_together([&] { mesh_.current_mesh(level); });
    if (options_.precision == Precision::Single) round_to_floats(level.mesh);
    level.ended_by = ended_by_;
    level.collapses_performed = counts_.proven_together + counts_.proven_alone;
    level.collapses_refused = counts_.refused;
    result.kept_triangles = mesh_.kept_triangles();
    result.dropped_triangles = dropped_;
    result.split = split_;
    result.tolerance_below_rounding = ended_by_ == EndedBy::Rounding;
    result.counts = counts_;
    result.seconds.simplify = seconds_since(start);
    return result;
  }

 private:
  std::size_t pass(std::size_t k) {
    if (k > 0) of_tile_.effort = Effort::Normal;  // flips would change triangles whose vertices stay
    TiledMesh::Pass how{cuts[k],
                        (k > 0 ? growth_of_later_tiles : 1) * std::max(tiles_.max_triangles, min_triangles_of_tile),
                        k > 1 ? rings_of_later_pass : rings_of_second_pass,
                        options_.tolerance,
                        [&](const TileInput& input) { return simplify_tile(input, of_tile_, stop_); },
                        {}};
    if (options_.progress) how.progress = [&](double share) { options_.progress(progress_at(k, share)); };
    const TiledMesh::PassFacts facts = mesh_.pass(how, runner_);
    counts_ += facts.counts;
    ended_by_ = joint_reason(ended_by_, facts.ended_by);
    if (k == 0) {
      dropped_ = facts.dropped_triangles;
      split_ = facts.split;
    }
    return facts.tiles;
  }

  static double progress_at(std::size_t pass, double share) {
    if (pass == 0) return share_of_first_pass * share;
    return share_of_first_pass +
           (1 - share_of_first_pass) * (static_cast<double>(pass - 1) + share) / static_cast<double>(cuts.size() - 1);
  }

  const SimplifyOptions& options_;
  const TileOptions& tiles_;
  JobRunner& runner_;
  StopToken stop_;
  SimplifyOptions of_tile_ = options_;
  TiledMesh mesh_;
  std::size_t dropped_ = 0;
  EndedBy ended_by_ = EndedBy::Rounding;
  CollapseCounts counts_;
  bool split_ = false;
};

}  // namespace

SimplifyResult decimate_in_tiles(const StoredMesh& original, const SimplifyOptions& options, const TileOptions& tiles,
                                 JobRunner& runner) {
  check_for_tiles(options);
  runner.do_together(check_floating_point_model);
  if (!options.locked_vertices.empty() && options.locked_vertices.size() != original.vertex_count())
    throw InvalidInput("the locked vertices must be given for every vertex of the original, or not at all");
  return TiledRun(original, options, tiles, runner).run();
}

SimplifyResult simplify_in_tiles(const TriangleMesh& original, const SimplifyOptions& options, const TileOptions& tiles,
                                 JobRunner& runner) {
  validate(original);
  SimplifyResult result = decimate_in_tiles(MeshInMemory(original), options, tiles, runner);
  const auto measuring = StopToken::Clock::now();
  SimplifiedLevel& level = result.levels.back();
  DistanceOptions distance;
  distance.tolerance = level.tolerance;
  distance.cancel = options.cancel;
  level.distance = measure_in_tiles(original, level.mesh, distance, tiles, runner);
  level.verdict = verdict_of(level.distance->bounds, level.tolerance);
  result.seconds.measure = seconds_since(measuring);
  return result;
}

SimplifyResult simplify_in_tiles(const TriangleMesh& original, const SimplifyOptions& options,
                                 const TileOptions& tiles) {
  ThreadRunner threads(options.threads);
  return simplify_in_tiles(original, options, tiles, threads);
}

}  // namespace meshbound
