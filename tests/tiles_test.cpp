// SPDX-License-Identifier: MIT
// Meshes in tiles: the same bounds as in one piece, whatever the tiles, and the same bits for any number of threads.
#include "meshbound/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "datasets.h"
#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "numeric/numbers_below.h"
#include "tiles/compact_bytes.h"
#include "tiles/decimate_in_tiles.h"
#include "tiles/measure_in_tiles.h"
#include "tiles/tile_cut.h"

namespace meshbound {
namespace tiles_test {

SimplifyOptions share_of_diagonal(const TriangleMesh& mesh, double share) {
  SimplifyOptions options;
  options.tolerance = share * bounding_box_diagonal(mesh);
  options.threads = 1;
  return options;
}

void expect_within(const TriangleMesh& original, const SimplifyResult& result, double tolerance) {
  EXPECT_EQ(result.last().verdict, Verdict::Within);
  EXPECT_LE(result.last().distance->bounds.upper, tolerance);
  EXPECT_EQ(check_tolerance(original, result.last().mesh, tolerance, {}).verdict, Verdict::Within);
}

/// By position: edges that do not have exactly two triangles.
std::size_t open_edges(const TriangleMesh& mesh) {
  using Point = std::array<double, 3>;
  std::map<std::pair<Point, Point>, int> triangles;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d &p = mesh.vertices[t[k]], &q = mesh.vertices[t[(k + 1) % 3]];
      const Point a{p.x(), p.y(), p.z()}, b{q.x(), q.y(), q.z()};
      ++triangles[std::minmax(a, b)];
    }
  }
  return static_cast<std::size_t>(
      std::count_if(triangles.begin(), triangles.end(), [](const auto& edge) { return edge.second != 2; }));
}

/// `mesh` and, at the origin, a flat square of 2 * 20 * 20 triangles.
TriangleMesh flat_sheet_beside(TriangleMesh mesh) {
  TriangleMesh sheet = datasets::terrain(1, 20, 5);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (Eigen::Vector3d& p : sheet.vertices) mesh.vertices.emplace_back(p.x(), p.y(), 0);
  for (const Triangle& t : sheet.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(TileCut, PutsEachTriangleIntoOneTileThatIsNotTooHeavy) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  std::vector<CutItem> items;
  for (std::uint32_t t = 0; t < torus.triangles.size(); ++t)
    items.push_back({to_vec3(sum_of_corners(torus, t)), t, 1 + t % 7});
  std::set<std::uint32_t> seen;
  std::size_t tiles = 0;
  cut_into_tiles(items, 500, {1, 1.0 / 3}, [&](std::span<const std::uint32_t> tile) {
    EXPECT_TRUE(std::is_sorted(tile.begin(), tile.end()));
    std::uint64_t weight = 0;
    for (const std::uint32_t t : tile) {
      weight += items[t].weight;
      EXPECT_TRUE(seen.insert(t).second);
    }
    EXPECT_LE(weight, 500u);
    ++tiles;
  });
  EXPECT_EQ(seen.size(), torus.triangles.size());
  EXPECT_GT(tiles, 20u);
}

TEST(TileCut, LeavesATriangleThatIsTooHeavyAlone) {
  const TriangleMesh cube = datasets::cube(1, 1);
  std::vector<CutItem> items;
  for (std::uint32_t t = 0; t < cube.triangles.size(); ++t)
    items.push_back({to_vec3(sum_of_corners(cube, t)), t, t == 5 ? 100u : 1u});
  std::size_t alone = 0;
  cut_into_tiles(items, 4, {}, [&](std::span<const std::uint32_t> tile) {
    if (std::find(tile.begin(), tile.end(), 5u) != tile.end() && tile.size() == 1) ++alone;
  });
  EXPECT_EQ(alone, 1u);
}

TEST(SimplifyInTiles, HoldsTheToleranceWithHardlyMoreFacesThanInOnePiece) {
  for (const TriangleMesh& mesh : {datasets::torus(1, 0.3, 120, 48), datasets::terrain(1, 80, 3)}) {
    const SimplifyOptions options = share_of_diagonal(mesh, 0.002);
    const SimplifyResult tiled = simplify_in_tiles(mesh, options, {3000});
    expect_within(mesh, tiled, options.tolerance);
    const std::size_t whole = simplify_with_bound(mesh, options).last().faces();
    EXPECT_LT(static_cast<double>(tiled.last().faces()), 1.2 * static_cast<double>(whole));
    EXPECT_LT(tiled.last().faces(), mesh.triangles.size() / 4);
  }
}

TEST(SimplifyInTiles, LeavesNoMoreThanOnePieceWhereTheToleranceIsCoarseAndLaterTilesHoldAllThatIsLeft) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 120, 48);
  const SimplifyOptions options = share_of_diagonal(torus, 0.01);
  const std::size_t tiled = simplify_in_tiles(torus, options, {6000}).last().faces();
  EXPECT_LT(static_cast<double>(tiled), 1.1 * static_cast<double>(simplify_with_bound(torus, options).last().faces()));
}

TEST(SimplifyInTiles, LeavesFewFacesWhereATileEndsWithFewerThanItsSeamsHave) {
  const TriangleMesh torus = datasets::mesh_of_size("torus", 40'000);
  const SimplifyOptions options = share_of_diagonal(torus, 0.02);
  ThreadRunner runner(1);
  const SimplifyResult tiled = decimate_in_tiles(MeshInMemory(torus), options, {1500}, runner);
  EXPECT_LT(tiled.last().faces(), 650U) << "800 where planes alone say which tile a vertex belongs to";
}

TEST(SimplifyInTiles, LeavesAloneWhatCoversAnOriginalInSeveralTiles) {
  // The long triangles at the poles are covered by triangles of several tiles: where one of these changed, it throws.
  const TriangleMesh sphere = datasets::mesh_of_size("uv-sphere", 4000);
  const SimplifyOptions options = share_of_diagonal(sphere, 0.0005);
  for (const std::size_t max_triangles : {150, 400})
    expect_within(sphere, simplify_in_tiles(sphere, options, {max_triangles}), options.tolerance);
}

TEST(SimplifyInTiles, GivesWhatOnePieceGivesWhereThereIsOneTile) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 40, 16);
  const SimplifyOptions options = share_of_diagonal(torus, 0.01);
  const SimplifyResult tiled = simplify_in_tiles(torus, options), whole = simplify_with_bound(torus, options);
  EXPECT_EQ(tiled.last().mesh.triangles, whole.last().mesh.triangles);
  EXPECT_EQ(tiled.last().mesh.vertices, whole.last().mesh.vertices);
  EXPECT_EQ(tiled.last().source_vertex, whole.last().source_vertex);
}

TEST(SimplifyInTiles, GivesTheSameBitsForAnyNumberOfThreads) {
  const TriangleMesh terrain = datasets::terrain(1, 60, 7);
  SimplifyOptions options = share_of_diagonal(terrain, 0.001);
  const SimplifyResult one = simplify_in_tiles(terrain, options, {700});
  for (const int threads : {2, 3, 5}) {
    options.threads = threads;
    const SimplifyResult more = simplify_in_tiles(terrain, options, {700});
    EXPECT_EQ(more.last().mesh.triangles, one.last().mesh.triangles);
    EXPECT_EQ(more.last().mesh.vertices, one.last().mesh.vertices);
    EXPECT_EQ(more.last().distance->bounds.lower, one.last().distance->bounds.lower);
    EXPECT_EQ(more.last().distance->bounds.upper, one.last().distance->bounds.upper);
  }
}

/// Does each job and puts it back from its bytes, as other processes would take it.
class PackingRunner : public JobRunner {
 public:
  void run(TileJobs& jobs) override {
    for (const std::size_t job : heaviest_first(jobs)) {
      const std::string bytes = jobs.run_packed(job);
      EXPECT_THROW(jobs.unpack(job, std::string_view(bytes).substr(0, bytes.size() - 1)), InvalidInput);
      EXPECT_THROW(jobs.unpack(job, bytes + "0"), InvalidInput);
      jobs.unpack(job, bytes);
      size_ += bytes.size();
    }
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::size_t size_ = 0;
};

/// Weighs the tiles of each pass.
class WeighingRunner : public ThreadRunner {
 public:
  WeighingRunner() : ThreadRunner(1) {}
  void run(TileJobs& jobs) override {
    std::uint64_t weight = 0;
    for (std::size_t job = 0; job < jobs.size(); ++job) weight += jobs.weight(job);
    weights_.push_back(weight);
    ThreadRunner::run(jobs);
  }
  [[nodiscard]] const std::vector<std::uint64_t>& weights() const { return weights_; }

 private:
  std::vector<std::uint64_t> weights_;
};

TEST(SimplifyInTiles, GoesOverASeamUntilItHasBeenInsideATile) {
  const TriangleMesh terrain = datasets::terrain(1, 160, 3);
  WeighingRunner runner;
  (void)decimate_in_tiles(MeshInMemory(terrain), share_of_diagonal(terrain, 0.001), {3000}, runner);
  ASSERT_GT(runner.weights().size(), 3U);
  EXPECT_LT(runner.weights().back(), runner.weights()[1] / 3);
}

TEST(SimplifyInTiles, GivesTheSameBitsFromPackedResults) {
  TriangleMesh turned = datasets::terrain(1, 60, 7);
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3)
    std::swap(turned.triangles[t][1], turned.triangles[t][2]);
  for (const TriangleMesh& mesh :
       {turned, datasets::mesh_of_size("uv-sphere", 4000), unwelded(datasets::torus(1, 0.3, 60, 24))}) {
    const SimplifyOptions options = share_of_diagonal(mesh, 0.001);
    const TileOptions tiles{500};
    PackingRunner packing;
    const SimplifyResult packed = simplify_in_tiles(mesh, options, tiles, packing);
    const SimplifyResult direct = simplify_in_tiles(mesh, options, tiles);
    EXPECT_EQ(packed.last().mesh.triangles, direct.last().mesh.triangles);
    EXPECT_EQ(packed.last().mesh.vertices, direct.last().mesh.vertices);
    EXPECT_EQ(packed.last().source_triangle, direct.last().source_triangle);
    EXPECT_EQ(packed.last().collapses_refused, direct.last().collapses_refused);
    EXPECT_EQ(packed.dropped_triangles, direct.dropped_triangles);
    EXPECT_EQ(packed.last().turned_faces, direct.last().turned_faces);
    EXPECT_EQ(packed.last().distance->bounds.lower, direct.last().distance->bounds.lower);
    EXPECT_EQ(packed.last().distance->bounds.upper, direct.last().distance->bounds.upper);
    EXPECT_EQ(packed.last().distance->a_to_b.witness.from.position,
              direct.last().distance->a_to_b.witness.from.position);
    EXPECT_EQ(packed.last().distance->a_to_b.stats.subdivisions, direct.last().distance->a_to_b.stats.subdivisions);
  }
}

TEST(SimplifyInTiles, PacksHardlyAnyBytesWhereNothingChanges) {
  const TriangleMesh mesh = datasets::terrain(1, 120, 7);
  PackingRunner packing;
  const SimplifyResult same = simplify_in_tiles(mesh, share_of_diagonal(mesh, 1e-9), TileOptions{2000}, packing);
  EXPECT_EQ(same.last().mesh.triangles.size(), mesh.triangles.size());
  EXPECT_LE(packing.size(), mesh.triangles.size() / 4);  // of all passes and the measurement
}

TEST(CompactBytes, GiveBackWhatWasWritten) {
  CompactWriter writer;
  const std::vector<std::uint64_t> numbers{0, 1, 127, 128, 300, ~std::uint64_t{0}};
  for (const std::uint64_t number : numbers) writer.number(number);
  const std::vector<std::uint32_t> steps{5, 0, 0xffffffff, 0x80000000, 7};
  std::uint32_t before = 3;
  for (const std::uint32_t step : steps) writer.step(std::exchange(before, step), step);
  writer.raw(-0.0);
  writer.raw(std::vector<std::uint32_t>{1, 2, 3});
  const std::string bytes = writer.take();
  CompactReader reader(bytes);
  for (const std::uint64_t number : numbers) EXPECT_EQ(reader.number(), number);
  before = 3;
  for (const std::uint32_t step : steps) EXPECT_EQ(before = reader.step(before), step);
  double zero = 1;
  reader.raw(zero);
  EXPECT_TRUE(zero == 0 && std::signbit(zero));
  std::vector<std::uint32_t> list;
  reader.raw(list);
  EXPECT_EQ(list, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_TRUE(reader.at_end());
  EXPECT_THROW((void)reader.number(), InvalidInput);
}

TEST(SimplifyInTiles, LeavesNoCracksWhereTrianglesShareNoVertices) {
  const TriangleMesh torus = datasets::torus(1, 0.3, 60, 24);
  const TriangleMesh soup = unwelded(torus);
  const SimplifyOptions options = share_of_diagonal(torus, 0.003);
  const SimplifyResult result = simplify_in_tiles(soup, options, {400});
  expect_within(soup, result, options.tolerance);
  EXPECT_LT(result.last().faces(), torus.triangles.size() / 2);
  EXPECT_EQ(open_edges(result.last().mesh), 0u);
  EXPECT_TRUE(summarise(result.last().mesh).closed);  // by vertices, too
}

TEST(SimplifyInTiles, SaysWhereVerticesAndTrianglesComeFrom) {
  const TriangleMesh terrain = datasets::terrain(1, 40, 5);
  SimplifyOptions options = share_of_diagonal(terrain, 0.002);
  options.placements = CollapsePlacements::Subset;
  const SimplifiedLevel level = simplify_in_tiles(terrain, options, {500}).last();
  ASSERT_EQ(level.source_vertex.size(), level.mesh.vertices.size());
  ASSERT_EQ(level.source_triangle.size(), level.faces());
  for (std::size_t v = 0; v < level.mesh.vertices.size(); ++v)
    EXPECT_EQ(level.mesh.vertices[v], terrain.vertices[level.source_vertex[v]]);
  EXPECT_TRUE(std::is_sorted(level.source_triangle.begin(), level.source_triangle.end()));
}

TEST(SimplifyInTiles, KeepsLockedVerticesAndBorders) {
  const TriangleMesh terrain = datasets::terrain(1, 40, 5);
  SimplifyOptions options = share_of_diagonal(terrain, 0.01);
  options.locked_vertices.assign(terrain.vertices.size(), false);
  const std::uint32_t locked = terrain.triangles[777][0];
  options.locked_vertices[locked] = true;
  options.preserve_boundary = true;
  const SimplifiedLevel level = simplify_in_tiles(terrain, options, {500}).last();
  const auto has = [&](const Eigen::Vector3d& p) {
    return std::find(level.mesh.vertices.begin(), level.mesh.vertices.end(), p) != level.mesh.vertices.end();
  };
  EXPECT_TRUE(has(terrain.vertices[locked]));
  EXPECT_EQ(open_edges(level.mesh), open_edges(terrain));
}

TEST(SimplifyInTiles, KeepsTrianglesWithoutAreaThatLieAlone) {
  TriangleMesh mesh = datasets::torus(1, 0.3, 40, 16);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(3, 0, 0);
  mesh.vertices.emplace_back(3, 1, 0);
  mesh.triangles.push_back({first, first, first + 1});
  const SimplifyOptions options = share_of_diagonal(mesh, 0.003);
  const SimplifyResult result = simplify_in_tiles(mesh, options, {300});
  expect_within(mesh, result, options.tolerance);
  EXPECT_EQ(result.kept_triangles, 1u);
  EXPECT_EQ(result.last().source_triangle.back(), mesh.triangles.size() - 1);
}

TEST(SimplifyInTiles, HoldsForTheFloatsThatItGives) {
  TriangleMesh terrain = datasets::terrain(1, 40, 5);
  for (Eigen::Vector3d& p : terrain.vertices) p += Eigen::Vector3d(1000.1, -77.7, 3.3);
  SimplifyOptions options = share_of_diagonal(terrain, 0.003);
  options.precision = Precision::Single;
  const SimplifyResult result = simplify_in_tiles(terrain, options, {500});
  expect_within(terrain, result, options.tolerance);
  for (const Eigen::Vector3d& p : result.last().mesh.vertices) EXPECT_EQ(p, p.cast<float>().cast<double>());
}

TEST(SimplifyInTiles, EndsWithAMeshThatHoldsWhenItIsCancelled) {
  const TriangleMesh terrain = datasets::terrain(1, 60, 5);
  SimplifyOptions options = share_of_diagonal(terrain, 0.003);
  std::atomic<bool> cancel = false;
  options.cancel = &cancel;
  options.progress = [&](double) { cancel = true; };
  const SimplifiedLevel level = simplify_in_tiles(terrain, options, {500}).last();
  EXPECT_EQ(level.ended_by, EndedBy::Cancelled);
  EXPECT_EQ(check_tolerance(terrain, level.mesh, options.tolerance).verdict, Verdict::Within);
  EXPECT_LT(level.faces(), terrain.triangles.size());
}

/// At 1e10 doubles are 2e-6 apart: too far for the tolerance there, but not where the other tiles are.
TEST(SimplifyInTiles, EndsByRoundingOnlyWhereNoTileCanCollapse) {
  const TriangleMesh near_origin = datasets::terrain(1, 20, 5);
  TriangleMesh far_away = near_origin;
  for (Eigen::Vector3d& p : far_away.vertices) p.x() += 1e10;
  SimplifyOptions options = share_of_diagonal(near_origin, 0.01);
  options.tolerance = std::min(options.tolerance, 1e-6);
  const auto ended = [&](const TriangleMesh& mesh) { return simplify_in_tiles(mesh, options, {100}); };
  EXPECT_EQ(ended(far_away).last().ended_by, EndedBy::Rounding);
  EXPECT_TRUE(ended(far_away).tolerance_below_rounding);

  TriangleMesh both = flat_sheet_beside(far_away);
  const SimplifyResult result = ended(both);
  EXPECT_EQ(result.last().ended_by, EndedBy::NothingFits);
  EXPECT_FALSE(result.tolerance_below_rounding);
  EXPECT_LT(result.last().faces(), both.triangles.size());
}

/// Each triangle has vertices of its own, and any of those at a position may be the one that is locked.
TEST(SimplifyInTiles, KeepsLockedVerticesOfTrianglesThatShareNone) {
  const TriangleMesh grid = datasets::terrain(1, 24, 5);
  TriangleMesh apart;
  SimplifyOptions options = share_of_diagonal(grid, 0.05);
  for (const Triangle& t : grid.triangles) {
    for (const std::uint32_t v : t) {
      options.locked_vertices.push_back(apart.vertices.size() % 97 == 95);
      apart.vertices.push_back(grid.vertices[v]);
    }
    const auto end = static_cast<std::uint32_t>(apart.vertices.size());
    apart.triangles.push_back({end - 3, end - 2, end - 1});
  }
  const SimplifiedLevel level = simplify_in_tiles(apart, options, {100}).last();
  EXPECT_LT(level.faces(), apart.triangles.size() / 4);
  for (std::size_t v = 0; v < apart.vertices.size(); ++v)
    EXPECT_TRUE(!options.locked_vertices[v] || std::find(level.mesh.vertices.begin(), level.mesh.vertices.end(),
                                                         apart.vertices[v]) != level.mesh.vertices.end())
        << v;
}

TEST(SimplifyInTiles, TakesTilesOfAnySize) {
  const TriangleMesh cube = datasets::cube(1, 3);
  for (const std::size_t triangles : {1, 2, 5})
    EXPECT_EQ(simplify_in_tiles(cube, share_of_diagonal(cube, 0.01), {triangles}).last().verdict, Verdict::Within);
}

TEST(DistanceInTiles, TellsItsProgressAndEndsWhenItIsAskedTo) {
  const TriangleMesh a = datasets::terrain(1, 40, 5), b = datasets::terrain(1, 40, 6);
  DistanceOptions options;
  options.threads = 1;
  std::vector<double> shares;
  options.progress = [&](double share) { shares.push_back(share); };
  const Bounds truth = hausdorff_distance_in_tiles(a, b, options, {100}).bounds;
  EXPECT_GT(shares.size(), 20U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1);
  std::atomic<bool> cancel = false;
  options.cancel = &cancel;
  options.progress = [&](double share) { cancel = share > 0.2; };
  shares.clear();
  const HausdorffDistance ended = hausdorff_distance_in_tiles(a, b, options, {100});
  EXPECT_EQ(ended.a_to_b.outcome, Outcome::BudgetExhausted);
  EXPECT_LE(ended.bounds.lower, truth.upper);
  EXPECT_EQ(ended.bounds.upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(ended.b_to_a.stats.closest_point_queries, 0U);
}

TEST(SimplifyInTiles, RefusesWhatTilesCannotDo) {
  const TriangleMesh cube = datasets::cube(1, 2);
  const auto refuses = [&](const auto& change) {
    SimplifyOptions options = share_of_diagonal(cube, 0.01);
    change(options);
    EXPECT_THROW((void)simplify_in_tiles(cube, options), InvalidInput);
  };
  refuses([](SimplifyOptions& o) { o.levels = {0.001}; });
  refuses([](SimplifyOptions& o) { o.target_faces = 4; });
  refuses([](SimplifyOptions& o) { o.on_exceed = OnExceed::Stop; });
  refuses([](SimplifyOptions& o) { o.prune = true; });
  refuses([](SimplifyOptions& o) { o.texture_tolerance = 1; });
  refuses([](SimplifyOptions& o) { o.line_tolerance = 0.1; });
  refuses([&](SimplifyOptions& o) { o.face_tolerances.assign(cube.triangles.size(), 1); });
  refuses([&](SimplifyOptions& o) { o.texture_coordinates.resize(cube.triangles.size()); });
  refuses([](SimplifyOptions& o) { o.keep_sides = true; });
  refuses([](SimplifyOptions& o) { o.normal_tolerance = 20; });
  refuses([](SimplifyOptions& o) { o.certificate = true; });
  refuses([](SimplifyOptions& o) { o.locked_vertices = {true}; });
  refuses([](SimplifyOptions& o) { o.tolerance = -1; });
}

TEST(SimplifyInTiles, HoldsOnRealMeshes) {
  for (const char* name : {"scan/igl_bunny.off", "cad/thingi_112932.stl", "game/gltf_VC.obj", "organic/igl_cow.off"}) {
    const auto file = test::dataset(name);
    if (!file) GTEST_SKIP() << name << " is not on this machine";
    const TriangleMesh mesh = read_mesh(*file).mesh;
    const SimplifyOptions options = share_of_diagonal(mesh, 0.002);
    SCOPED_TRACE(name);
    expect_within(mesh, simplify_in_tiles(mesh, options, {900}), options.tolerance);
  }
}

/// From a point to the triangle that is named with it.
double distance_to(const TriangleMesh& mesh, const SurfacePoint& point) {
  TriangleMesh named;
  for (const std::uint32_t v : mesh.triangles.at(point.triangle)) named.vertices.push_back(mesh.vertices[v]);
  named.triangles = {{0, 1, 2}};
  return closest_point(Bvh(named), point.position).distance.upper;
}

void expect_same_interval(const TriangleMesh& a, const TriangleMesh& b, const DistanceOptions& options) {
  const HausdorffDistance whole = hausdorff_distance(a, b, options);
  for (const std::size_t max_triangles : {800, 5000, 100000}) {
    const HausdorffDistance tiled = hausdorff_distance_in_tiles(a, b, options, {max_triangles});
    EXPECT_LE(tiled.bounds.lower, whole.bounds.upper);
    EXPECT_GE(tiled.bounds.upper, whole.bounds.lower);
    EXPECT_LE(tiled.bounds.upper - tiled.bounds.lower, *options.error_bound);
    const bool is_a = tiled.a_to_b.bounds.lower >= tiled.b_to_a.bounds.lower;
    const Witness& witness = (is_a ? tiled.a_to_b : tiled.b_to_a).witness;
    EXPECT_NEAR((witness.from.position - witness.nearest.position).norm(), tiled.bounds.lower, *options.error_bound);
    const TriangleMesh &from = is_a ? a : b, &to = is_a ? b : a;
    const Bvh tree(to);
    EXPECT_GE(closest_point(tree, witness.from.position).distance.upper, tiled.bounds.lower * (1 - 1e-9));
    EXPECT_NEAR(distance_to(from, witness.from), 0, 1e-9);
    EXPECT_NEAR(distance_to(to, witness.nearest), 0, 1e-9);
  }
}

/// A torus of several clusters, so that not all of it is near a tile.
TriangleMesh large_torus() { return datasets::torus(1, 0.3, 160, 64); }

TEST(DistanceInTiles, GivesTheIntervalOfTheWholeMeshes) {
  const TriangleMesh torus = large_torus(), terrain = datasets::terrain(1, 40, 3);
  TriangleMesh moved = torus;
  for (Eigen::Vector3d& p : moved.vertices) p += Eigen::Vector3d(0.01, 0.02, -0.03);
  TriangleMesh far = terrain;
  for (Eigen::Vector3d& p : far.vertices) p += Eigen::Vector3d(50, 0, 1);
  DistanceOptions options;
  options.threads = 2;
  options.error_bound = 1e-6;
  expect_same_interval(torus, moved, options);
  expect_same_interval(torus, terrain, options);
  expect_same_interval(terrain, far, options);
  expect_same_interval(far, datasets::cube(1, 1), options);
}

TEST(DistanceInTiles, LooksFurtherWhereTheToleranceIsExceeded) {
  const TriangleMesh torus = large_torus();
  TriangleMesh moved = torus;
  for (Eigen::Vector3d& p : moved.vertices) p += Eigen::Vector3d(0, 0, 0.2);
  DistanceOptions options;
  options.threads = 1;
  options.error_bound = 1e-6;
  for (const double tolerance : {0.0, 1e-12, 0.05, 0.3}) {
    options.tolerance = tolerance;
    expect_same_interval(torus, moved, options);
    const HausdorffDistance tiled = hausdorff_distance_in_tiles(torus, moved, options, {300});
    EXPECT_EQ(verdict_of(tiled.bounds, tolerance), tolerance > 0.2 ? Verdict::Within : Verdict::Exceeds);
  }
}

/// Small triangles around a point.
void add_heap(TriangleMesh& mesh, const Eigen::Vector3d& at, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const double x = 1e-4 * static_cast<double>(i % 50), z = 1e-4 * static_cast<double>(i / 50);
    mesh.vertices.insert(mesh.vertices.end(), {at + Eigen::Vector3d(x, 0, z), at + Eigen::Vector3d(x + 1e-4, 0, z),
                                               at + Eigen::Vector3d(x, 1e-4, z + 1e-4)});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
}

TEST(DistanceInTiles, FindsWhatIsNearerThanWhatLiesInBoxesThatAreNearer) {
  TriangleMesh a, b;
  a.vertices = {{0, 0, 0}, {1e-3, 0, 0}, {0, 0, 1e-3}};
  a.triangles = {{0, 1, 2}};
  // Two clusters: the box of the first one, to y = 0.5, holds A, whose distance from it is 5; the second is 1 away.
  add_heap(b, {0, -100, 0}, 2000);
  add_heap(b, {-5, 0.5, 0}, 500);
  add_heap(b, {5, 0.5, 0}, 500);
  add_heap(b, {0, 1, 0}, 3000);
  DistanceOptions options;
  options.error_bound = 1e-6;
  options.tolerance = 0;
  const Bounds tiled = one_sided_hausdorff_distance_in_tiles(a, b, options).bounds;
  const Bounds whole = one_sided_hausdorff_distance(Bvh(a), Bvh(b), options).bounds;
  EXPECT_LE(tiled.upper - tiled.lower, 1e-6);
  EXPECT_LE(tiled.lower, whole.upper);
  EXPECT_GE(tiled.upper, whole.lower);
  EXPECT_NEAR(tiled.upper, 1, 1e-2);
}

TEST(DistanceInTiles, EndsWhereAShareOfTheSizeIsNoNumber) {
  TriangleMesh a = datasets::cube(1, 1), b = a;
  for (Eigen::Vector3d& p : a.vertices) p *= 1e-321;
  for (Eigen::Vector3d& p : b.vertices) p = (p + Eigen::Vector3d(2, 0, 0)) * 1e-321;
  DistanceOptions options;
  options.tolerance = 0;
  const Bounds tiled = hausdorff_distance_in_tiles(a, b, options, {4}).bounds;
  const Bounds whole = hausdorff_distance(a, b, options).bounds;
  EXPECT_LE(tiled.lower, whole.upper);
  EXPECT_GE(tiled.upper, whole.lower);
}

TEST(DistanceInTiles, MeasuresOneSideOnly) {
  const TriangleMesh terrain = datasets::terrain(1, 40, 3);
  TriangleMesh part = terrain;
  part.triangles.resize(part.triangles.size() / 3);
  DistanceOptions options;
  options.error_bound = 1e-6;
  EXPECT_LE(one_sided_hausdorff_distance_in_tiles(part, terrain, options, {200}).bounds.upper, 1e-6);
  EXPECT_GT(one_sided_hausdorff_distance_in_tiles(terrain, part, options, {200}).bounds.lower, 0.1);
}

TEST(DistanceInTiles, RefusesLengthsThatAreNone) {
  const TriangleMesh cube = datasets::cube(1, 1);
  DistanceOptions options;
  options.error_bound = -1;
  EXPECT_THROW((void)hausdorff_distance_in_tiles(cube, cube, options), InvalidInput);
  options.error_bound.reset();
  options.tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)hausdorff_distance_in_tiles(cube, cube, options), InvalidInput);
}

TEST(TileOptions, AreRefusedWhereATileHasNoTriangles) {
  const TriangleMesh cube = datasets::cube(1, 1);
  EXPECT_THROW((void)hausdorff_distance_in_tiles(cube, cube, {}, {0}), InvalidInput);
  EXPECT_THROW((void)simplify_in_tiles(cube, share_of_diagonal(cube, 0.01), {0}), InvalidInput);
}

}  // namespace tiles_test
}  // namespace meshbound
