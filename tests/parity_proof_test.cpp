// SPDX-License-Identifier: MIT
// Proofs by parity, by patches that grow and by whole nodes of a tree: they say nothing that the distance engine
// denies.
#include "simplify/cover/parity_proof.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <string_view>

#include "datasets/analytic_meshes.h"
#include "geometry/boxes.h"
#include "meshbound/distance.h"
#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"
#include "reference/hard_meshes.h"
#include "reference/small_meshes.h"
#include "simplify/cover/original_clusters.h"
#include "simplify/cover/patch_cover.h"
#include "simplify/cover/slab_proof.h"
#include "simplify/cover/slab_tree.h"
#include "simplify/kernel/kernels.h"
#include "spatially_ordered.h"

namespace meshbound {
namespace parity_proof_test {

using Eigen::Vector3d;

struct Shape {
  const char* name;
  TriangleMesh mesh;
  double tolerance;
};

std::vector<Shape> shapes() {
  return {{"sphere", datasets::icosphere(1, 3), 0.05},
          {"open plane with spikes", datasets::spiked_plane(1, 0.2, 16, 4), 0.03},
          {"thin sheet, tolerance above its thickness", datasets::thin_sheet(1, 0.01, 12), 0.02},
          {"open terrain", datasets::terrain(1, 16, 7), 0.02},
          {"two spheres through each other",
           reference::both(datasets::icosphere(1, 2), reference::moved(datasets::icosphere(1, 2), {0.5, 0, 0})), 0.1}};
}

/// Random triangles near rough surfaces: the parity proof may fail where the bound holds, never the other way.
TEST(ParityProof, NeverCoversAFaceThatTheEngineFindsTooFar) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    std::vector<Vec3> vertices;
    for (const Vector3d& p : shape.mesh.vertices) vertices.push_back({p.x(), p.y(), p.z()});
    const auto neighbours = edge_neighbours(vertices, shape.mesh.triangles);
    const OriginalSoup soup{vertices, shape.mesh.triangles, neighbours};
    ParityProof parity;
    const Bvh original(shape.mesh);
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, 0.5 * shape.tolerance);
    int covered = 0;
    for (int i = 0; i < 4000; ++i) {
      const auto t = static_cast<std::uint32_t>(random() % shape.mesh.triangles.size());
      const Triangle& near = shape.mesh.triangles[t];
      TriangleMesh face{{}, {{0, 1, 2}}};
      const double size = 0.2 + 0.001 * static_cast<double>(i % 2000);
      const Vector3d first = shape.mesh.vertices[near[0]];
      for (const std::uint32_t v : near)
        face.vertices.push_back(first + size * (shape.mesh.vertices[v] - first) +
                                Vector3d(noise(random), noise(random), noise(random)));
      std::array<Vec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = {face.vertices[k].x(), face.vertices[k].y(), face.vertices[k].z()};
      if (!parity.covers(soup, corners, shape.tolerance, 2, t)) continue;
      ++covered;
      EXPECT_NE(check_one_sided_tolerance(Bvh(face), original, shape.tolerance).verdict, Verdict::Exceeds);
    }
    EXPECT_GT(covered, 100);
  }
}

std::vector<Vec3> positions(const TriangleMesh& mesh) {
  std::vector<Vec3> result;
  for (const Vector3d& p : mesh.vertices) result.push_back({p.x(), p.y(), p.z()});
  return result;
}

/// A mesh in the order of a curve, with what a proof by slabs asks of it.
struct SlabScene {
  explicit SlabScene(const TriangleMesh& unordered)
      : mesh(test::spatially_ordered(unordered)),
        vertices(positions(mesh)),
        neighbours(edge_neighbours(vertices, mesh.triangles)),
        soup{vertices, mesh.triangles, neighbours},
        clusters(mesh.triangles, vertices.size()),
        tree(soup, clusters),
        proof(soup, clusters, tree) {}

  TriangleMesh mesh;
  std::vector<Vec3> vertices;
  std::vector<TriangleNeighbours> neighbours;
  OriginalSoup soup;
  OriginalClusters clusters;
  SlabTree tree;
  SlabProof proof;
};

/// What blocks say of a view holds of the triangles below them.
TEST(SlabTree, HoldsEachClusterInOneLeafAndItsTrianglesInAllNodesAbove) {
  const SlabScene scene(datasets::terrain(1, 48, 7));
  ASSERT_EQ(scene.tree.levels(), 3U);  // 4,608 triangles, 288 clusters, 36 blocks of them
  std::vector<int> found(scene.clusters.count(), 0);
  for (std::uint32_t leaf = 0; leaf < scene.clusters.count(); ++leaf) {
    const std::uint32_t cluster = scene.tree.cluster(leaf);
    ++found[cluster];
    bool is_closed = true;
    for (std::uint32_t t = 16 * cluster; t < 16 * (cluster + 1); ++t)
      for (const std::uint32_t across : scene.neighbours[t]) is_closed &= across != no_index;
    for (std::uint32_t level = 0, node = leaf; level < scene.tree.levels(); ++level, node /= 8) {
      const SlabTree::Block& block = scene.tree.block(level, node / 8);
      const std::uint32_t k = node % 8;
      const SlabBlock& slabs = block.slabs;
      const bool says_closed = (block.is_closed >> k & 1) != 0;
      EXPECT_TRUE(is_closed || !says_closed);
      EXPECT_TRUE(level > 0 || says_closed == is_closed);
      for (const std::uint32_t v : scene.clusters.vertices(cluster)) {
        const Vec3 offset = scene.vertices[v] - Vec3{slabs.x[k], slabs.y[k], slabs.z[k]};
        const Vec3 normal{slabs.normal_x[k], slabs.normal_y[k], slabs.normal_z[k]};
        EXPECT_LE(length(offset), slabs.radius[k] + 1e-12);
        EXPECT_LE(std::abs(dot(offset, normal)), slabs.half_thickness[k] + 1e-12);
      }
    }
  }
  EXPECT_EQ(found, std::vector<int>(scene.clusters.count(), 1));
}

/// Below 1e-154 squares are no normal numbers, and lengths off by up to a tenth: heights along such an axis would be,
/// too.
TEST(ParityView, HasNoAxesThatAreNotOfUnitLength) {
  const auto view_over = [](double height) {
    return ParityView::of({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.5, height, 0}}, 0.1, 1);
  };
  EXPECT_TRUE(view_over(1e-100).has_value());
  for (double height = 1e-100; height > 1e-170; height /= 3) {
    const std::optional<ParityView> view = view_over(height);
    if (!view) continue;
    EXPECT_NEAR(length(view->view.x_axis), 1, 1e-15);
    EXPECT_NEAR(length(view->view.y_axis), 1, 1e-15);
    EXPECT_NEAR(length(view->view.z_axis), 1, 1e-15);
  }
}

TEST(SlabTree, HasNoNormalsThatAreNotOfUnitLength) {
  for (double height = 1e-140; height > 1e-170; height /= 3) {
    TriangleMesh flat = reference::unit_square(12);
    for (Vector3d& p : flat.vertices) p.y() *= height;
    const SlabScene scene(flat);
    for (std::uint32_t node = 0; node < scene.clusters.count(); ++node) {
      const SlabBlock& slabs = scene.tree.block(0, node / 8).slabs;
      const Vec3 normal{slabs.normal_x[node % 8], slabs.normal_y[node % 8], slabs.normal_z[node % 8]};
      EXPECT_TRUE(length(normal) == 0 || std::abs(length(normal) - 1) < 1e-14) << height << ' ' << length(normal);
    }
  }
}

/// A face in the plane of a triangle, around its first corner, `size` times as large as an edge of it.
TriangleMesh face_along(const TriangleMesh& mesh, std::uint32_t t, double size, const std::function<double()>& noise) {
  const Triangle& v = mesh.triangles[t];
  const Vector3d at = mesh.vertices[v[0]], along = mesh.vertices[v[1]] - at;
  const Vector3d normal = along.cross(mesh.vertices[v[2]] - at).normalized(), across = normal.cross(along);
  TriangleMesh face{{}, {{0, 1, 2}}};
  for (const auto& [x, y] : {std::pair(-0.5, -0.4), std::pair(0.7, -0.3), std::pair(-0.2, 0.6)})
    face.vertices.emplace_back(at + size * (x * along + y * across) + noise() * normal);
  return face;
}

std::array<Vec3, 3> corners_of(const TriangleMesh& face) {
  const std::vector<Vec3> corners = positions(face);
  return {corners[0], corners[1], corners[2]};
}

/// Random faces over many originals: the proof may fail where the bound holds, never the other way.
TEST(SlabProof, NeverCoversAFaceThatTheEngineFindsTooFar) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const SlabScene scene(shape.mesh);
    const Bvh original(scene.mesh);
    ParityProof grown;
    std::mt19937 random(12);
    std::normal_distribution<double> noise(0, 0.4 * shape.tolerance);
    int covered = 0, missed = 0;
    for (int i = 0; i < 4000; ++i) {
      const auto t = static_cast<std::uint32_t>(random() % scene.mesh.triangles.size());
      const TriangleMesh face = face_along(scene.mesh, t, 0.5 + 0.002 * (i % 4000), [&] { return noise(random); });
      const std::array<Vec3, 3> corners = corners_of(face);
      std::uint32_t over = no_index;
      if (!scene.proof.covers(corners, shape.tolerance, 2, over)) {
        missed += grown.covers(scene.soup, corners, shape.tolerance, 2, t) ? 1 : 0;
        continue;
      }
      ++covered;
      EXPECT_NE(check_one_sided_tolerance(Bvh(face), original, shape.tolerance).verdict, Verdict::Exceeds);
      ASSERT_NE(over, no_index);
      const Vec3 middle = 0.35 * corners[0] + 0.34 * corners[1] + 0.31 * corners[2];
      EXPECT_LE(squared_distance(scene.soup.corners(over), middle), shape.tolerance * shape.tolerance);
    }
    if (std::string_view(shape.name).starts_with("thin")) continue;  // two sheets in the prism: even parity
    EXPECT_GT(covered, 100);
    EXPECT_LT(missed, covered) << "of what a patch that grows proves";
  }
}

/// A large face 0.01 above a square of 40 x 40 x 2 triangles, and what is wrong with the square.
TEST(SlabProof, SeesHolesWallsAndSecondSheetsInsideWholeNodes) {
  const std::array<Vec3, 3> face{Vec3{0.1, 0.1, 0.01}, Vec3{0.9, 0.12, 0.01}, Vec3{0.4, 0.9, 0.01}};
  const auto covers = [&](const TriangleMesh& mesh) {
    std::uint32_t over = no_index;
    return SlabScene(mesh).proof.covers(face, 0.02, 1, over);
  };
  const TriangleMesh square = reference::unit_square(40);
  EXPECT_TRUE(covers(square));
  EXPECT_TRUE(covers(reference::both(square, reference::moved(square, {0, 0, 0.2})))) << "a sheet beyond the prism";
  EXPECT_FALSE(covers(reference::both(square, reference::moved(square, {0, 0, 0.02})))) << "two sheets, even parity";
  EXPECT_TRUE(covers(reference::both(reference::both(square, reference::moved(square, {0, 0, 0.02})),
                                     reference::moved(square, {0, 0, 0.01}))))
      << "three sheets";
  for (const double x : {0.3, 0.45, 0.6}) {
    TriangleMesh holed = square;
    std::erase_if(holed.triangles, [&](const Triangle& t) {
      const Vector3d middle = (square.vertices[t[0]] + square.vertices[t[1]] + square.vertices[t[2]]) / 3;
      return std::abs(middle.x() - x) < 0.02 && std::abs(middle.y() - 0.35) < 0.02;
    });
    ASSERT_LT(holed.triangles.size(), square.triangles.size());
    EXPECT_FALSE(covers(holed)) << "a hole at " << x;
    TriangleMesh spiked = square;
    for (Vector3d& p : spiked.vertices)
      if ((p - Vector3d(x, 0.35, 0)).norm() < 0.02) p.z() = 0.05;
    EXPECT_FALSE(covers(spiked)) << "a spike at " << x;
  }
  TriangleMesh outside = square;
  for (Vector3d& p : outside.vertices)
    if (p.x() > 0.92 || p.x() < 0.08) p.z() = 0.05;
  EXPECT_TRUE(covers(outside)) << "what is beside the face does not count";
}

TEST(EdgeNeighbours, OfATreeAreThoseWithoutOne) {
  for (const Shape& shape : shapes()) {
    for (const TriangleMesh& mesh : {shape.mesh, reference::unwelded(shape.mesh)}) {
      const std::vector<Vec3> vertices = positions(mesh);
      EXPECT_EQ(edge_neighbours(Bvh(mesh), vertices, mesh.triangles), edge_neighbours(vertices, mesh.triangles));
    }
  }
}

/// Triangles between few points, each of which several vertices stand at: edges of many triangles, triangles twice,
/// and triangles without area.
TriangleMesh crowd_of_triangles(unsigned seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh;
  for (int v = 0; v < 16; ++v) mesh.vertices.emplace_back(random() % 2, random() % 3, random() % 2);
  for (int t = 0; t < 40; ++t) {
    Triangle& corners = mesh.triangles.emplace_back();
    for (std::uint32_t& v : corners) v = static_cast<std::uint32_t>(random() % 16);
  }
  return mesh;
}

TEST(EdgeNeighbours, OfATreeComeInPairs) {
  std::size_t pairs = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const TriangleMesh mesh = crowd_of_triangles(seed);
    const auto neighbours = edge_neighbours(Bvh(mesh), positions(mesh), mesh.triangles);
    const auto edge = [&](std::size_t t, std::size_t k) {
      const Vector3d &p = mesh.vertices[mesh.triangles[t][k]], &q = mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
      return is_before(p, q) ? std::pair(p, q) : std::pair(q, p);
    };
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t across = neighbours[t][k];
        if (across == no_index) continue;
        ASSERT_NE(across, t);
        int partners = 0;
        for (std::size_t j = 0; j < 3; ++j) partners += edge(across, j) == edge(t, k) && neighbours[across][j] == t;
        ASSERT_EQ(partners, 1) << "seed " << seed << ", triangle " << t << ", edge " << k;
        ASSERT_NE(edge(t, k).first, edge(t, k).second);
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 1000U);
}

/// Points spread over a triangle, by their barycentric coordinates; the corners are among them.
std::vector<Vector3d> points_of(const std::array<Vec3, 3>& corners) {
  constexpr int steps = 12;
  std::vector<Vector3d> points;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const double share_0 = i / double{steps}, share_1 = j / double{steps};
      const Vec3 p = share_0 * corners[0] + share_1 * corners[1] + (1 - share_0 - share_1) * corners[2];
      points.emplace_back(p.x, p.y, p.z);
    }
  }
  return points;
}

/// What a `PatchCover` has made of a triangle, with the mesh as its soup: from any triangle that lies above or below
/// it, or from one.
struct PatchResult {
  PatchResult(const TriangleMesh& mesh, const std::array<Vec3, 3>& corners, double tolerance,
              std::optional<std::uint32_t> seed = std::nullopt, int max_strips = 1) {
    const std::vector<Vec3> vertices = positions(mesh);
    const auto neighbours = edge_neighbours(vertices, mesh.triangles);
    const OriginalSoup soup{vertices, mesh.triangles, neighbours};
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    PatchCover patches;
    if (seed)
      patches.cover(
          soup, {corners, 0}, tolerance, 2, [&](const std::array<Vec3, 3>&) { return *seed; }, max_strips, open);
    else
      patches.cover(soup, {corners, 0}, tolerance, 2, all, faces, open);
  }
  std::vector<std::uint32_t> faces;
  std::vector<PatchCover::Part> open;
};

double area(const std::array<Vec3, 3>& c) { return 0.5 * length(cross(c[1] - c[0], c[2] - c[0])); }

/// Over the corner (0, 0, 0) of a box: the top ends at x = 0.8 with a wall. The triangle reaches 0.01 beyond the top.
TEST(PatchCover, CutsOffAStripWhereTheSurfaceTurnsAway) {
  const TriangleMesh box{{{-1, -1, 0}, {0.8, -1, 0}, {0.8, 1, 0}, {-1, 1, 0}, {0.8, -1, -1}, {0.8, 1, -1}},
                         {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}};
  const std::array<Vec3, 3> sliver{Vec3{-0.5, 0.03, 0.005}, Vec3{0.81, -0.1, 0.005}, Vec3{0.81, 0.1, 0.005}};
  constexpr double tolerance = 0.02;
  const PatchResult result(box, sliver, tolerance);
  EXPECT_EQ(std::set<std::uint32_t>(result.faces.begin(), result.faces.end()), (std::set<std::uint32_t>{0, 1}));
  for (const PatchResult& cut : {result, PatchResult(box, sliver, tolerance, 0)}) {
    ASSERT_EQ(cut.open.size(), 2U);
    double open_area = 0;
    for (const PatchCover::Part& part : cut.open) {
      open_area += area(part.corners);
      for (const Vec3 p : part.corners) EXPECT_GT(p.x, 0.8 - tolerance);
      EXPECT_GT(part.cuts, 0);
    }
    EXPECT_LT(open_area, 0.05 * area(sliver));
    EXPECT_GT(open_area, 0.01 / 1.31 * area(sliver));  // at least what lies beyond the top
  }
}

/// As above with two walls: one strip does not free the triangle of both.
TEST(PatchCover, FromOneTriangleLeavesAllOpenWhereOneStripIsNotEnough) {
  const TriangleMesh box{
      {{-1, -1, 0}, {0.8, -1, 0}, {0.8, 1, 0}, {-1, 1, 0}, {0.8, -1, -1}, {0.8, 1, -1}, {-1, -1, -1}},
      {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}, {0, 6, 4}, {0, 4, 1}}};
  const std::array<Vec3, 3> corner{Vec3{0.81, -1.01, 0.005}, Vec3{0.81, 0.5, 0.005}, Vec3{-0.5, -1.01, 0.005}};
  const PatchResult result(box, corner, 0.02, 0);
  ASSERT_EQ(result.open.size(), 1U);
  EXPECT_EQ(result.open[0].cuts, 0);
  EXPECT_EQ(area(result.open[0].corners), area(corner));
}

/// The points of a triangle that are not left open.
std::vector<Vector3d> proven_points(const std::array<Vec3, 3>& corners, const PatchResult& result) {
  std::vector<Vector3d> points = points_of(corners);
  if (result.open.empty()) return points;
  TriangleMesh open;
  for (const PatchCover::Part& part : result.open) {
    for (const Vec3 p : part.corners) open.vertices.emplace_back(p.x, p.y, p.z);
    const auto end = static_cast<std::uint32_t>(open.vertices.size());
    open.triangles.push_back({end - 3, end - 2, end - 1});
  }
  const Bvh left(open);
  std::erase_if(points, [&](const Vector3d& p) { return closest_point(left, p).distance.lower <= 1e-9; });
  return points;
}

/// A triangle in a disc, with its corners a little outside: a strip frees it of two of them, and another one of the
/// third.
TEST(PatchCover, FromOneTriangleCutsOffTheCornersBeyondABorderAllAround) {
  const TriangleMesh disc = reference::fan(5000);
  constexpr double tolerance = 0.02, radius = 1 + 0.5 * tolerance;
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const double angle = 0.3 + 2.1 * static_cast<double>(k);
    corners[k] = {radius * std::cos(angle), radius * std::sin(angle), 0};
  }
  const PatchResult one_strip(disc, corners, tolerance, 0, 1);
  ASSERT_EQ(one_strip.open.size(), 1U);
  EXPECT_EQ(area(one_strip.open[0].corners), area(corners));
  const PatchResult two_strips(disc, corners, tolerance, 0, 2);
  ASSERT_EQ(two_strips.open.size(), 4U);
  double open_area = 0;
  for (const PatchCover::Part& part : two_strips.open) open_area += area(part.corners);
  EXPECT_LT(open_area, 0.1 * area(corners));
  EXPECT_FALSE(proven_points(corners, two_strips).empty());
  for (const Vector3d& p : proven_points(corners, two_strips)) EXPECT_LT(p.norm(), 1);
}

TEST(PatchCover, LeavesATriangleOpenThatItKnowsNothingOf) {
  const TriangleMesh square = reference::unit_square(4);
  const std::array<Vec3, 3> above{Vec3{0.2, 0.2, 0.5}, Vec3{0.7, 0.2, 0.5}, Vec3{0.2, 0.7, 0.5}};
  const PatchResult result(square, above, 0.1);
  EXPECT_TRUE(result.faces.empty());
  ASSERT_EQ(result.open.size(), 1U);
  EXPECT_EQ(result.open[0].cuts, 0);
  EXPECT_EQ(area(result.open[0].corners), area(above));
}

/// A triangle of a shape made larger and moved a little.
std::array<Vec3, 3> large_triangle(const Shape& shape, std::uint32_t t, double size, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.3 * shape.tolerance);
  const Vector3d first = shape.mesh.vertices[shape.mesh.triangles[t][0]];
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d p = first + size * (shape.mesh.vertices[shape.mesh.triangles[t][k]] - first);
    corners[k] = {p.x() + noise(random), p.y() + noise(random), p.z() + noise(random)};
  }
  return corners;
}

/// Random large triangles near rough surfaces: whatever is not left open is near the faces that are said to cover it.
TEST(PatchCover, SaysNothingThatTheEngineDenies) {
  int proven = 0, in_parts = 0;
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    std::mt19937 random(12);
    for (int i = 0; i < 1500; ++i) {
      const auto t = static_cast<std::uint32_t>(random() % shape.mesh.triangles.size());
      const std::array<Vec3, 3> corners = large_triangle(shape, t, 1 + 0.002 * i, random);
      const PatchResult result(shape.mesh, corners, shape.tolerance);
      if (result.faces.empty()) continue;
      ++proven;
      in_parts += result.open.empty() ? 0 : 1;
      TriangleMesh cover{shape.mesh.vertices, {}};
      for (const std::uint32_t f : result.faces) cover.triangles.push_back(shape.mesh.triangles[f]);
      const Bvh covering(cover);
      for (const Vector3d& p : proven_points(corners, result))
        EXPECT_LE(closest_point(covering, p).distance.lower, shape.tolerance);
    }
  }
  EXPECT_GT(proven, 300);
  EXPECT_GT(in_parts, 30);
}

TEST(PatchCover, FromOneTriangleSaysNothingThatTheEngineDenies) {
  int proven = 0, in_parts = 0;
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    std::mt19937 random(13);
    const Bvh mesh(shape.mesh);
    for (int i = 0; i < 1500; ++i) {
      const auto t = static_cast<std::uint32_t>(random() % shape.mesh.triangles.size());
      const std::array<Vec3, 3> corners = large_triangle(shape, t, 1 + 0.002 * i, random);
      const PatchResult result(shape.mesh, corners, shape.tolerance, t, 1 + i % 2);
      const std::vector<Vector3d> points = proven_points(corners, result);
      if (points.empty()) continue;
      ++proven;
      in_parts += result.open.empty() ? 0 : 1;
      for (const Vector3d& p : points) EXPECT_LE(closest_point(mesh, p).distance.lower, shape.tolerance);
    }
  }
  EXPECT_GT(proven, 300);
  EXPECT_GT(in_parts, 10);
}

}  // namespace parity_proof_test
}  // namespace meshbound
