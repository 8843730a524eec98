// SPDX-License-Identifier: GPL-3.0-or-later
// Large meshes are cut into parts that are decimated side by side: the result is the same for any number of threads,
// holds its bound, and is as small as without parts; every kind of input and every way to end comes through.
#include "cgal/parts.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <thread>

#include "cgal/estimate_fault.h"
#include "cgal/oriented_manifold.h"
#include "cgal/proven_parts.h"
#include "datasets/analytic_meshes.h"
#include "meshbound/cgal/lod_chain.h"
#include "meshbound/cgal/simplify_with_bound.h"
#include "meshbound/mesh_summary.h"
#include "reference/small_meshes.h"

namespace meshbound::cgal {
namespace {

SimplifyOptions within(double tolerance) {
  SimplifyOptions options;
  options.tolerance = tolerance;
  options.threads = 2;
  return options;
}

TriangleMesh sphere() { return datasets::icosphere(1, 5); }
TriangleMesh terrain() { return datasets::terrain(1, 80, 3); }

void expect_within(const TriangleMesh& original, const SimplifiedLevel& level) {
  EXPECT_EQ(level.verdict, Verdict::Within);
  EXPECT_EQ(check_symmetric(Bvh(original), Bvh(level.mesh), level.tolerance).verdict, Verdict::Within);
}

TEST(Parts, DependOnTheSizeOnly) {
  EXPECT_EQ(number_of_parts(9999), 1u);
  EXPECT_EQ(number_of_parts(10000), 2u);
  EXPECT_EQ(number_of_parts(100000), 4u);
  EXPECT_EQ(number_of_parts(5000000), 256u);
}

TEST(Parts, AreOfEqualSizeAndHoldEveryTriangleOnce) {
  TriangleMesh soup = sphere();
  for (std::size_t t = 0; t < soup.triangles.size(); t += 1000) {
    soup.triangles.push_back(soup.triangles[t]);
    soup.triangles.push_back({soup.triangles[t][0], soup.triangles[t][1], soup.triangles[t][1]});
  }
  const ManifoldPolygons whole = manifold_polygons(soup);
  const Cutting cutting(soup, whole, 5);
  std::vector<int> seen(soup.triangles.size(), 0);
  for (std::size_t i = 0; i < cutting.parts(); ++i) {
    const Part part = cutting.part(i);
    EXPECT_NEAR(static_cast<double>(part.copy.polygons.size()), static_cast<double>(whole.polygons.size()) / 5, 2);
    EXPECT_TRUE(is_oriented_manifold(part.copy.polygons, part.copy.points.size()));
    for (std::size_t t = 0; t < part.triangle_of.size(); ++t) {
      ++seen[part.triangle_of[t]];
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(part.original.vertices[part.original.triangles[t][k]],
                  soup.vertices[soup.triangles[part.triangle_of[t]][k]]);
    }
    // Duplicates and degenerate triangles are where their corners are: nothing must be kept for their sake.
    const std::set<std::uint32_t> own(part.copy.vertex_of_vertex.begin(), part.copy.vertex_of_vertex.end());
    for (std::size_t t = part.copy.triangle_of_face.size(); t < part.triangle_of.size(); ++t) {
      for (const std::uint32_t v : soup.triangles[part.triangle_of[t]]) EXPECT_TRUE(own.count(v));
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
}

TEST(Parts, SeamsAreTheEdgesBetweenParts) {
  const TriangleMesh soup = terrain();
  const ManifoldPolygons whole = manifold_polygons(soup);
  const Cutting cutting(soup, whole, 4);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::size_t>> parts_of_edge;
  for (std::size_t i = 0; i < cutting.parts(); ++i) {
    const Part part = cutting.part(i);
    for (const Polygon& corners : part.copy.polygons) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = part.whole_of[corners[k]], b = part.whole_of[corners[(k + 1) % 3]];
        parts_of_edge[std::minmax({a, b})].insert(i);
      }
    }
  }
  std::size_t edges = 0;
  for (const auto& [edge, parts] : parts_of_edge) {
    EXPECT_EQ(cutting.seams().has_edge(edge.first, edge.second), parts.size() > 1);
    if (parts.size() > 1) ++edges;
  }
  EXPECT_EQ(cutting.seams().edges.size(), edges);
  EXPECT_LT(edges, 80u * 8u);
}

/// A square that is its own proof, but for one triangle that the faces of both halves cover together.
TEST(Parts, FacesThatStandForATriangleTogetherStayAndKeepItsProof) {
  const TriangleMesh original = reference::unit_square(6);
  ProvenMesh mesh;
  mesh.polygons = manifold_polygons(original);
  mesh.locked.assign(original.vertices.size(), false);
  mesh.quadrics.resize(original.vertices.size());
  mesh.proof.tolerance = 0.1;
  const auto faces = static_cast<std::uint32_t>(original.triangles.size());
  const std::vector<std::uint32_t> part_of = cut(mesh.polygons.points, mesh.polygons.polygons, 2);
  const auto first_of = [&](std::uint32_t part) {
    return static_cast<std::uint32_t>(std::find(part_of.begin(), part_of.end(), part) - part_of.begin());
  };
  const std::uint32_t a = first_of(0), b = first_of(1);
  for (std::uint32_t t = 0; t < faces; ++t) {
    mesh.proof.nearest.push_back(t);
    mesh.proof.faces.push_back(t);
    if (t == a) mesh.proof.faces.push_back(b);
    mesh.proof.ends.push_back(mesh.proof.faces.size());
  }
  const ProvenCutting cutting(mesh, original, 2);
  std::vector<int> seen(faces, 0);
  std::vector<DeviationMonitor<SurfaceMesh>::Part> proofs(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const ProvenPart part = cutting.part(i);
    for (const std::uint32_t t : part.part.triangle_of) ++seen[t];
    EXPECT_EQ(part.proof.ends.size(), part.part.original.triangles.size());
    EXPECT_EQ(part.proof.nearest.size(), part.part.copy.polygons.size());
    for (std::uint32_t f = 0; f < part.part.copy.polygons.size(); ++f) proofs[i].face_of.push_back(100 * (i + 1) + f);
  }
  for (std::uint32_t t = 0; t < faces; ++t) EXPECT_EQ(seen[t], t == a ? 2 : 1) << t;
  for (const std::uint32_t f : {a, b}) {
    for (const std::size_t v : mesh.polygons.polygons[f]) EXPECT_TRUE(cutting.cutting().seams().has[v]) << v;
  }
  const DeviationMonitor<SurfaceMesh>::Part shared = cutting.shared_proof(proofs);
  EXPECT_EQ(shared.triangle_of, std::vector<std::uint32_t>{a});
  EXPECT_EQ(shared.proof.faces, (std::vector<std::uint32_t>{a, b}));
  EXPECT_EQ(shared.face_of[a], 100u);
  EXPECT_EQ(shared.face_of[b], 200u);
}

TEST(Parts, TheResultIsTheSameForAnyNumberOfThreads) {
  const TriangleMesh original = datasets::icosphere(1, 6);  // four parts
  std::vector<TriangleMesh> results;
  for (const int threads : {1, 2, 5}) {
    SimplifyOptions options = within(0.01);
    options.effort = Effort::Fast;
    options.threads = threads;
    options.measure = false;
    results.push_back(simplify_with_bound(original, options).last().mesh);
  }
  for (const TriangleMesh& result : results) {
    EXPECT_EQ(result.vertices, results.front().vertices);
    EXPECT_EQ(result.triangles, results.front().triangles);
  }
}

/// Were seams left as they are, hundreds of faces would stay at each.
TEST(Parts, LeaveAsFewFacesAsTheWholeWould) {
  for (const TriangleMesh& original : {sphere(), terrain(), datasets::cube(1, 30)}) {
    for (const Effort effort : {Effort::Fast, Effort::Normal}) {
      SimplifyOptions options = within(0.01);
      options.effort = effort;
      const SimplifyResult parts = simplify_with_bound(original, options);
      expect_within(original, parts.last());
      options.parts = false;
      const SimplifyResult whole = simplify_with_bound(original, options);
      EXPECT_NE(parts.last().mesh.vertices, whole.last().mesh.vertices);
      EXPECT_LE(static_cast<double>(parts.last().faces()), 1.05 * static_cast<double>(whole.last().faces()) + 4);
    }
  }
}

TEST(Parts, AChainIsDescribedBeforeItsFirstLevel) {
  const LodChain chain(sphere());
  EXPECT_EQ(chain.describe().stats.admitted, 0u);
}

TEST(Parts, AreJoinedToTheTopologyOfTheOriginal) {
  for (const TriangleMesh& original : {sphere(), terrain(), datasets::torus(1, 0.3, 120, 60)}) {
    const TriangleMesh result = simplify_with_bound(original, within(0.005)).last().mesh;
    EXPECT_NO_THROW((void)to_surface_mesh(result));
    EXPECT_EQ(summarise(result).closed, summarise(original).closed);
    const auto euler = [](const TriangleMesh& mesh) {
      std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
      for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax({t[k], t[(k + 1) % 3]}));
      }
      return static_cast<std::ptrdiff_t>(mesh.vertices.size() + mesh.triangles.size()) -
             static_cast<std::ptrdiff_t>(edges.size());
    };
    EXPECT_EQ(euler(result), euler(original));
  }
}

TEST(Parts, TheReportAddsUp) {
  const TriangleMesh original = sphere();
  const SimplifyResult result = simplify_with_bound(original, within(0.01));
  // A closed surface of genus 0 has 2 vertices less than half its faces, and loses one by each collapse.
  EXPECT_EQ(result.last().collapses_performed, (original.triangles.size() - result.last().faces()) / 2);
  EXPECT_GT(result.last().collapses_refused, 0u);
  EXPECT_EQ(result.stats.admitted + result.estimated.performed, result.last().collapses_performed);
  EXPECT_EQ(result.last().ended_by, EndedBy::NothingFits);
}

TEST(Parts, TakeSoupsThatAreNoManifolds) {
  TriangleMesh soup = sphere();
  const TriangleMesh other = reference::moved(sphere(), {0.5, 0, 0});
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (Triangle t : other.triangles) {
    for (std::uint32_t& v : t) v += first;
    soup.triangles.push_back(t);
  }
  for (std::uint32_t t = 0; t < 20000; t += 7) std::swap(soup.triangles[t][0], soup.triangles[t][1]);
  for (std::uint32_t t = 0; t < 20000; t += 100) {
    soup.triangles.push_back(soup.triangles[t]);
    const std::uint32_t a = soup.triangles[t][0], b = soup.triangles[t][1];
    soup.triangles.push_back({a, b, first + soup.triangles[t][2]});  // a third face at an edge
    soup.triangles.push_back({a, a, b});
  }
  SimplifyOptions options = within(0.01);
  const SimplifyResult parts = simplify_with_bound(soup, options);
  expect_within(soup, parts.last());
  EXPECT_TRUE(parts.split);
  options.parts = false;
  const SimplifyResult whole = simplify_with_bound(soup, options);
  expect_within(soup, whole.last());
  EXPECT_LT(static_cast<double>(parts.last().faces()), 1.02 * static_cast<double>(whole.last().faces()));
  EXPECT_EQ(parts.dropped_triangles + parts.kept_triangles, whole.dropped_triangles + whole.kept_triangles);
}

TEST(Parts, KeepTrianglesThatTheMeshHasNoFaceNear) {
  TriangleMesh soup = sphere();
  const auto far = static_cast<std::uint32_t>(soup.vertices.size());
  soup.vertices.emplace_back(3, 0, 0);
  soup.triangles.push_back({0, 0, far});
  const SimplifyResult result = simplify_with_bound(soup, within(0.01));
  expect_within(soup, result.last());
  EXPECT_EQ(result.kept_triangles, 1u);
  EXPECT_LT(result.last().faces(), soup.triangles.size() / 10);
}

TEST(Parts, KeepLocksFeaturesAndBordersOnBothSidesOfASeam) {
  const TriangleMesh original = terrain();
  SimplifyOptions options = within(0.01);
  options.locked_vertices.assign(original.vertices.size(), false);
  for (std::size_t v = 0; v < original.vertices.size(); v += 50) options.locked_vertices[v] = true;
  options.preserve_boundary = true;
  const SimplifyResult result = simplify_with_bound(original, options);
  expect_within(original, result.last());
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  const std::set<Eigen::Vector3d, decltype(less)> left(result.last().mesh.vertices.begin(),
                                                       result.last().mesh.vertices.end(), less);
  for (std::size_t v = 0; v < original.vertices.size(); ++v) {
    const auto is_end = [](double x) { return x == 0 || x == 1; };
    const bool on_border = is_end(original.vertices[v].x()) || is_end(original.vertices[v].y());
    EXPECT_TRUE(left.count(original.vertices[v]) > 0 || !(options.locked_vertices[v] || on_border))
        << original.vertices[v].transpose() << " locked " << options.locked_vertices[v];
  }
}

/// What lies nearest to a face may belong to another part: such originals are not cut, and tolerances hold at any face.
TEST(Parts, AreNotMadeWhereFacesHaveTolerancesOfTheirOwn) {
  const TriangleMesh original = sphere();
  SimplifyOptions options = within(0.03);
  options.effort = Effort::Fast;
  for (const Triangle& t : original.triangles)
    options.face_tolerances.push_back(original.vertices[t[0]].x() > 0.3 ? 0.003 : 0.03);
  const SimplifyResult result = simplify_with_bound(original, options);
  EXPECT_EQ(result.last().verdict, Verdict::Within);
  options.parts = false;
  EXPECT_EQ(simplify_with_bound(original, options).last().mesh.vertices, result.last().mesh.vertices);
}

TEST(Parts, EveryWayToRunEndsWithAProvenMesh) {
  const TriangleMesh original = terrain();
  SimplifyOptions options = within(0.01);
  options.levels = {0.001, 0.004};
  options.cost = CollapseCost::LindstromTurk;
  const SimplifyResult levels = simplify_with_bound(original, options);
  ASSERT_EQ(levels.levels.size(), 3u);
  for (const SimplifiedLevel& level : levels.levels) expect_within(original, level);
  EXPECT_LT(levels.levels[2].faces(), levels.levels[1].faces());
  EXPECT_LT(levels.levels[1].faces(), levels.levels[0].faces());
  options = within(0.01);
  const std::size_t normal = simplify_with_bound(original, options).last().faces();
  options.effort = Effort::High;
  const SimplifyResult high = simplify_with_bound(original, options);
  expect_within(original, high.last());
  EXPECT_LT(high.last().faces(), normal);
  LodChain chain(original, LodOptions());
  for (const double tolerance : {1e-300, 0.002, 0.01}) expect_within(original, chain.next(tolerance));
}

TEST(Parts, ATimeLimitOrACancellationLeavesAProvenMesh) {
  const TriangleMesh original = sphere();
  SimplifyOptions options = within(0.01);
  options.time_limit = 0;
  const SimplifyResult at_once = simplify_with_bound(original, options);
  expect_within(original, at_once.last());
  EXPECT_EQ(at_once.last().ended_by, EndedBy::TimeLimit);
  EXPECT_EQ(at_once.last().faces(), original.triangles.size());
  // In the middle: told so by the progress of the run itself.
  std::atomic<bool> cancel = false;
  options = within(0.01);
  options.threads = 1;
  options.cancel = &cancel;
  options.progress = [&](double fraction) { cancel = cancel || fraction > 0.3; };
  options.measure = false;
  const SimplifiedLevel level = simplify_with_bound(original, options).last();
  EXPECT_EQ(level.ended_by, EndedBy::Cancelled);
  EXPECT_LT(level.faces(), original.triangles.size() * 9 / 10);
  EXPECT_GT(level.faces(), original.triangles.size() / 10);
  EXPECT_EQ(check_symmetric(Bvh(original), Bvh(level.mesh), 0.01).verdict, Verdict::Within);
}

/// Where the estimate is far off, the parts are decimated one by one, each with an estimate of its own or without.
TEST(Parts, BeginAgainWhereTheProofOfTheWholeFails) {
  const TriangleMesh original = terrain();
  const SimplifyResult proven = simplify_with_bound(original, within(0.01));
  internal::estimate_fault = 30;
  const SimplifyResult restarted = simplify_with_bound(original, within(0.01));
  internal::estimate_fault = 1;
  EXPECT_EQ(proven.estimated.restarts, 0u);
  EXPECT_GT(proven.estimated.performed, 1000u);
  EXPECT_GT(restarted.estimated.restarts, 1u);
  expect_within(original, restarted.last());
  EXPECT_EQ(restarted.stats.admitted + restarted.estimated.performed, restarted.last().collapses_performed);
  EXPECT_LT(static_cast<double>(restarted.last().faces()), 1.05 * static_cast<double>(proven.last().faces()));
}

TEST(Parts, OneThatFailsEndsTheOthers) {
  SimplifyOptions options = within(0.01);
  options.threads = 1;
  int calls = 0;
  options.progress = [&](double) {
    ++calls;
    throw std::runtime_error("enough");
  };
  EXPECT_THROW((void)simplify_with_bound(datasets::icosphere(1, 6), options), std::runtime_error);
  EXPECT_EQ(calls, 1);
}

TEST(Parts, ShowTheirProgressInTheCallingThreadAndPassOnWhatItThrows) {
  SimplifyOptions options = within(0.01);
  double last = -1;
  const std::thread::id caller = std::this_thread::get_id();
  bool elsewhere = false;
  options.progress = [&](double fraction) {
    elsewhere = elsewhere || std::this_thread::get_id() != caller;
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    last = fraction;
  };
  (void)simplify_with_bound(sphere(), options);
  EXPECT_FALSE(elsewhere);
  EXPECT_EQ(last, 1);
  options.progress = [](double) { throw std::runtime_error("enough"); };
  EXPECT_THROW((void)simplify_with_bound(sphere(), options), std::runtime_error);
}

}  // namespace
}  // namespace meshbound::cgal
