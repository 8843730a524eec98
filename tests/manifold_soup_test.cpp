// SPDX-License-Identifier: MIT
#include "simplify/mesh/manifold_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "datasets/analytic_meshes.h"
#include "geometry/position_table.h"
#include "manifold_soup_cases.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/bvh.h"
#include "meshbound/error.h"
#include "numeric/no_index.h"
#include "reference/hard_meshes.h"
#include "reference/small_meshes.h"
#include "simplify/mesh/crowded_edge.h"

namespace manifold_soup_test {

using meshbound::InvalidInput;
using meshbound::manifold_soup;
using meshbound::ManifoldSoup;
using meshbound::no_index;
using meshbound::Triangle;
using meshbound::TriangleMesh;
using meshbound::Vec3;

using Coordinates = std::array<double, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

Coordinates coordinates(const TriangleMesh& soup, std::uint32_t v) {
  const Eigen::Vector3d& p = soup.vertices[v];
  return {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};  // -0 becomes 0
}

/// The coordinates of the corners in ascending order, so whatever the order of the corners.
std::array<Coordinates, 3> shape(const TriangleMesh& soup, const Triangle& corners) {
  std::array<Coordinates, 3> result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = coordinates(soup, corners[k]);
  std::sort(result.begin(), result.end());
  return result;
}

bool is_degenerate(const std::array<Coordinates, 3>& corners) {
  return corners[0] == corners[1] || corners[1] == corners[2];
}

Edge edge(const ManifoldSoup& soup, std::uint32_t corner) {
  const Triangle& face = soup.faces[corner / 3];
  return {face[corner % 3], face[(corner + 1) % 3]};
}

std::uint32_t twin(const ManifoldSoup& soup, std::uint32_t corner) { return soup.twin[corner / 3][corner % 3]; }

std::size_t borders(const ManifoldSoup& soup) {
  std::size_t count = 0;
  for (std::uint32_t c = 0; c < 3 * soup.faces.size(); ++c) count += twin(soup, c) == no_index;
  return count;
}

/// Twins are mutual, and exactly the pairs of opposite edges; no directed edge comes twice.
std::string edge_defect(const ManifoldSoup& soup) {
  std::map<Edge, std::uint32_t> corner_of;
  for (std::uint32_t c = 0; c < 3 * soup.faces.size(); ++c)
    if (!corner_of.emplace(edge(soup, c), c).second) return "directed edge twice at corner " + std::to_string(c);
  for (const auto& [ends, corner] : corner_of) {
    const auto opposite = corner_of.find({ends.second, ends.first});
    if (twin(soup, corner) != (opposite == corner_of.end() ? no_index : opposite->second))
      return "the twin of corner " + std::to_string(corner);
  }
  return {};
}

/// Every vertex has one fan or ring of faces: from any of its corners all are reached across twins.
std::string vertex_defect(const ManifoldSoup& soup) {
  std::vector<std::set<std::uint32_t>> corners_at(soup.vertex_of.size());
  for (std::uint32_t c = 0; c < 3 * soup.faces.size(); ++c) {
    const std::uint32_t v = edge(soup, c).first;
    if (v >= corners_at.size()) return "a corner without a vertex";
    corners_at[v].insert(c);
  }
  for (std::size_t v = 0; v < corners_at.size(); ++v) {
    if (corners_at[v].empty()) return "vertex without a face: " + std::to_string(v);
    std::vector<std::uint32_t> open = {*corners_at[v].begin()};
    corners_at[v].erase(open[0]);
    while (!open.empty()) {
      const std::uint32_t c = open.back(), face = c - c % 3;
      open.pop_back();
      const std::uint32_t leaving = twin(soup, c), entering = twin(soup, face + (c + 2) % 3);
      std::vector<std::uint32_t> beside;
      if (leaving != no_index) beside.push_back(leaving - leaving % 3 + (leaving + 1) % 3);
      if (entering != no_index) beside.push_back(entering);
      for (const std::uint32_t next : beside)
        if (corners_at[v].erase(next) != 0) open.push_back(next);
    }
    if (!corners_at[v].empty()) return "two fans at vertex " + std::to_string(v);
  }
  return {};
}

/// Faces are the triangles of the soup, each set of corners once, but for those with two equal corners.
std::string surface_defect(const ManifoldSoup& manifold, const TriangleMesh& soup) {
  if (manifold.triangle_of.size() != manifold.faces.size() || manifold.twin.size() != manifold.faces.size())
    return "sizes";
  if (std::adjacent_find(manifold.triangle_of.begin(), manifold.triangle_of.end(), std::greater_equal<>()) !=
      manifold.triangle_of.end())
    return "triangles are not in ascending order";
  if (manifold.dropped_triangles != soup.triangles.size() - manifold.faces.size()) return "number dropped";
  std::map<std::array<Coordinates, 3>, std::uint32_t> expected;  // the first triangle of each shape
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    if (const auto corners = shape(soup, soup.triangles[t]); !is_degenerate(corners)) expected.emplace(corners, t);
  for (std::size_t f = 0; f < manifold.faces.size(); ++f) {
    Triangle corners = manifold.faces[f];
    for (std::uint32_t& v : corners) v = manifold.vertex_of[v];
    const auto found = expected.find(shape(soup, corners));
    if (found == expected.end() || found->second != manifold.triangle_of[f]) return "face " + std::to_string(f);
    expected.erase(found);
  }
  for (const auto& [triangle, of] : manifold.repetitions) {
    const auto is_face = [&](std::uint32_t t) {
      return std::binary_search(manifold.triangle_of.begin(), manifold.triangle_of.end(), t);
    };
    if (is_face(triangle) || !is_face(of) || shape(soup, soup.triangles[triangle]) != shape(soup, soup.triangles[of]))
      return "triangle " + std::to_string(triangle) + " repeats triangle " + std::to_string(of);
  }
  const auto degenerate = std::count_if(soup.triangles.begin(), soup.triangles.end(),
                                        [&](const Triangle& t) { return is_degenerate(shape(soup, t)); });
  if (manifold.repetitions.size() + static_cast<std::size_t>(degenerate) != manifold.dropped_triangles)
    return "number of repetitions";
  return expected.empty() ? "" : "a triangle without a face: " + std::to_string(expected.begin()->second);
}

std::string defect(const ManifoldSoup& manifold, const TriangleMesh& soup) {
  for (std::string found : {surface_defect(manifold, soup), edge_defect(manifold), vertex_defect(manifold)})
    if (!found.empty()) return found;
  return {};
}

/// Triangles over vertices at distinct places.
TriangleMesh mesh_of(std::vector<Triangle> triangles) {
  TriangleMesh mesh;
  mesh.triangles = std::move(triangles);
  std::uint32_t vertices = 0;
  for (const Triangle& corners : mesh.triangles) vertices = std::max(vertices, 1 + *std::ranges::max_element(corners));
  for (std::uint32_t v = 0; v < vertices; ++v) mesh.vertices.emplace_back(v, v * v % 11, v % 3);
  return mesh;
}

std::vector<Triangle> tetrahedron(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  return {{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}};
}

TriangleMesh joined(std::vector<Triangle> a, const std::vector<Triangle>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return mesh_of(std::move(a));
}

ManifoldSoup checked(const TriangleMesh& soup) {
  ManifoldSoup result = manifold_soup(soup);
  EXPECT_EQ(defect(result, soup), "");
  return result;
}

TEST(ManifoldSoup, LeavesAnOrientedManifoldAsItIs) {
  const TriangleMesh sphere = meshbound::reference::icosphere(2);
  const ManifoldSoup result = checked(sphere);
  EXPECT_FALSE(result.split);
  EXPECT_EQ(result.dropped_triangles, 0U);
  EXPECT_EQ(borders(result), 0U);
  ASSERT_EQ(result.faces.size(), sphere.triangles.size());
  for (std::size_t f = 0; f < result.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(result.vertex_of[result.faces[f][k]], sphere.triangles[f][k]) << "face " << f;
}

TEST(ManifoldSoup, WeldsVerticesOfEqualCoordinates) {
  const TriangleMesh cube = meshbound::reference::cube(1);
  TriangleMesh soup;
  for (const Triangle& corners : cube.triangles) {
    for (const std::uint32_t v : corners) soup.vertices.push_back(cube.vertices[v]);
    const auto end = static_cast<std::uint32_t>(soup.vertices.size());
    soup.triangles.push_back({end - 3, end - 2, end - 1});
  }
  const ManifoldSoup result = checked(soup);
  EXPECT_EQ(result.vertex_of.size(), 8U);
  EXPECT_EQ(borders(result), 0U);
  EXPECT_FALSE(result.split) << "several vertices that become one are not a split";
}

TEST(ManifoldSoup, TakesMinusZeroForZero) {
  TriangleMesh soup = mesh_of({{0, 1, 2}, {4, 3, 5}});
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, -0.0, 0}, {1, -0.0, -0.0}, {0, -1, 0}};
  EXPECT_EQ(checked(soup).vertex_of, (std::vector<std::uint32_t>{0, 1, 2, 5}));
}

TEST(ManifoldSoup, DropsRepeatedAndDegenerateTriangles) {
  const ManifoldSoup result = checked(mesh_of({{0, 0, 1}, {0, 1, 2}, {2, 1, 0}, {2, 1, 3}, {1, 2, 0}, {3, 2, 3}}));
  EXPECT_EQ(result.triangle_of, (std::vector<std::uint32_t>{1, 3}));
  EXPECT_EQ(result.dropped_triangles, 4U);
  EXPECT_EQ(borders(result), 4U);
  EXPECT_FALSE(result.split);
}

TEST(ManifoldSoup, TurnsOverTheFewerTrianglesOfAComponent) {
  TriangleMesh sphere = meshbound::reference::icosphere(1);
  for (std::size_t t = 0; t < sphere.triangles.size(); ++t)
    if (t % 3 == 0) std::swap(sphere.triangles[t][0], sphere.triangles[t][1]);
  const ManifoldSoup result = checked(sphere);
  EXPECT_EQ(borders(result), 0U);
  EXPECT_TRUE(result.split);
  EXPECT_EQ(result.vertex_of.size(), sphere.vertices.size());
  for (std::size_t f = 0; f < result.faces.size(); ++f) {
    const Triangle& before = sphere.triangles[f];
    const Triangle expected = f % 3 == 0 ? Triangle{before[0], before[2], before[1]} : before;
    for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(result.vertex_of[result.faces[f][k]], expected[k]) << "face " << f;
  }
}

TEST(ManifoldSoup, KeepsTheOrientationOfTheFirstOfTwo) {
  const ManifoldSoup result = checked(mesh_of({{0, 1, 2}, {1, 2, 3}}));
  EXPECT_EQ(result.faces[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(result.faces[1], (Triangle{1, 3, 2}));
  EXPECT_EQ(result.twin[0][1], 5U);
}

/// The two may be some of many that close solids.
TEST(ManifoldSoup, TurnsNoTriangleOverAcrossAnEdgeAtTheRim) {
  const TriangleMesh soup = mesh_of({{0, 1, 2}, {0, 1, 3}, {4, 5, 6}, {5, 4, 7}});
  const auto with_rim = [&](const std::vector<bool>& at_rim) {
    return manifold_soup(soup, meshbound::first_at_position(meshbound::positions_of(soup)), {}, {}, {}, at_rim);
  };
  const ManifoldSoup result = with_rim({true, true, false, false, true, true, false, false});
  EXPECT_EQ(result.twin[0][0], meshbound::no_index);
  EXPECT_EQ(result.vertex_of[result.faces[1][1]], 1U);
  EXPECT_EQ(result.twin[2][0], 9U) << "opposite directions need no turn";
  for (const std::vector<bool>& at_rim : {std::vector<bool>(), {true, false, true, true, false, false, false, false}})
    EXPECT_EQ(with_rim(at_rim).twin[0][0], 5U);
}

TEST(ManifoldSoup, OrientsEachComponentByItself) {
  const ManifoldSoup result = checked(mesh_of({{0, 1, 2}, {1, 2, 3}, {1, 0, 4}, {5, 6, 7}, {7, 6, 8}}));
  EXPECT_EQ(result.faces[3], (Triangle{5, 6, 7}));
  EXPECT_EQ(borders(result), 9U);
}

TEST(ManifoldSoup, CutsAMoebiusStripAcross) {
  std::vector<Triangle> strip;
  for (std::uint32_t i = 0; i < 7; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1, c = i == 6 ? 1 : 2 * i + 2, d = i == 6 ? 0 : 2 * i + 3;
    strip.push_back({a, c, b});
    strip.push_back({b, c, d});
  }
  const ManifoldSoup result = checked(mesh_of(strip));
  EXPECT_TRUE(result.split);
  EXPECT_EQ(result.vertex_of.size(), 16U) << "the two vertices of one edge are duplicated";
  EXPECT_EQ(borders(result), 16U);
}

TEST(ManifoldSoup, CutsAnEdgeOfThreeTriangles) {
  const ManifoldSoup result = checked(mesh_of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  EXPECT_EQ(borders(result), 9U);
  EXPECT_EQ(result.vertex_of.size(), 9U);
  EXPECT_TRUE(result.split);
}

TEST(ManifoldSoup, TakesTwoSolidsThatShareAnEdgeApart) {
  const ManifoldSoup result = checked(joined(tetrahedron(0, 1, 2, 3), tetrahedron(0, 1, 4, 5)));
  EXPECT_EQ(borders(result), 0U);
  EXPECT_EQ(result.vertex_of.size(), 8U);
}

/// A box of unit cubes: the faces between full and empty ones.
TriangleMesh voxels(const std::function<bool(int, int, int)>& is_full, int size) {
  TriangleMesh mesh;
  const auto add = [&](const std::array<Eigen::Vector3d, 4>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  const auto full = [&](const Eigen::Vector3i& at) {
    return at.minCoeff() >= 0 && at.maxCoeff() < size && is_full(at.x(), at.y(), at.z());
  };
  for (int cell = 0; cell < size * size * size; ++cell) {
    const Eigen::Vector3i at(cell % size, cell / size % size, cell / size / size);
    if (!full(at)) continue;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3i along = Eigen::Vector3i::Unit(k), u = Eigen::Vector3i::Unit((k + 1) % 3),
                            v = Eigen::Vector3i::Unit((k + 2) % 3);
      const auto p = [&](const Eigen::Vector3i& corner) { return Eigen::Vector3d((at + corner).cast<double>()); };
      if (!full(at + along)) add({p(along), p(along + u), p(along + u + v), p(along + v)});
      if (!full(at - along)) add({p(v), p(u + v), p(u), p(Eigen::Vector3i::Zero())});
    }
  }
  return mesh;
}

TEST(ManifoldSoup, KeepsSolidsClosedThatTouchAlongEdges) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    const auto cells = static_cast<std::uint32_t>(random());
    const TriangleMesh soup =
        voxels([&](int x, int y, int z) { return (cells >> (9 * x + 3 * y + z) % 32 & 1) != 0; }, 3);
    if (soup.triangles.empty()) continue;
    EXPECT_EQ(borders(checked(soup)), 0U) << trial;
  }
}

TEST(ManifoldSoup, TakesCubesApartThatTouchAlongAnEdge) {
  const ManifoldSoup result = checked(voxels([](int x, int y, int z) { return x == y && z == 0; }, 2));
  EXPECT_EQ(borders(result), 0U);
  EXPECT_EQ(result.vertex_of.size(), 16U);
}

/// Two triangles that fold along an edge, and one without area that hangs on it.
TEST(ManifoldSoup, JoinsTheFacesOfAnEdgeThatASliverHangsOn) {
  TriangleMesh soup;
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 1}, {0.5, 1e-9, 0}};
  soup.triangles = {{0, 1, 2}, {0, 4, 1}, {1, 0, 3}};
  const ManifoldSoup result = checked(soup);
  EXPECT_EQ(twin(result, 0), 6U);
  EXPECT_EQ(borders(result), 7U);
}

TEST(CrowdedEdge, OrdersFacesByTheirAnglesAtAnySize) {
  for (const double size : {1e-300, 1e-9, 1.0, 1e9, 1e300}) {
    const auto at = [&](double x, double y) { return Eigen::Vector3d(size * Eigen::Vector3d(x, y, 0.3)); };
    const meshbound::AngleAroundEdge angle(size * Eigen::Vector3d(0, 0, -0.5), size * Eigen::Vector3d(0, 0, 0.5),
                                           at(1, 0.1));
    double before = -1;
    for (const auto& corner : {at(1, 0.1), at(1, 1), at(-0.2, 1), at(-1, 0.3), at(-1, -1), at(0.5, -1), at(1, -0.1)}) {
      const std::optional<double> found = angle.of(corner);
      ASSERT_TRUE(found);
      EXPECT_GT(*found, before) << size;
      before = *found;
    }
    EXPECT_LT(before, 4);
    EXPECT_FALSE(angle.of(at(1e-8, 1e-8)));
  }
}

TEST(CrowdedEdge, PairsFacesAroundMaterialOrAroundWhatIsEmpty) {
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  const std::vector<std::uint8_t> four = {1, 0, 1, 0};  // solids between 1 and 2, and between 3 and 0
  EXPECT_EQ(meshbound::pairs_around_edge(four, true), (Pairs{{1, 2}, {3, 0}}));
  EXPECT_EQ(meshbound::pairs_around_edge(four, false), (Pairs{{0, 1}, {2, 3}}));
  const std::vector<std::uint8_t> nested = {0, 0, 1, 1};
  EXPECT_EQ(meshbound::pairs_around_edge(nested, true), (Pairs{{1, 2}, {0, 3}}));
  EXPECT_EQ(meshbound::pairs_around_edge(nested, false), (Pairs{{3, 0}, {2, 1}}));
  EXPECT_TRUE(meshbound::pairs_around_edge(std::vector<std::uint8_t>{1, 1, 0, 1}, true).empty());
}

TEST(ManifoldSoup, DuplicatesAVertexWhereTwoConesMeet) {
  const ManifoldSoup result = checked(joined(tetrahedron(0, 1, 2, 3), tetrahedron(0, 4, 5, 6)));
  EXPECT_EQ(borders(result), 0U);
  EXPECT_EQ(result.vertex_of.size(), 8U);
  EXPECT_EQ(std::count(result.vertex_of.begin(), result.vertex_of.end(), 0U), 2);
  EXPECT_TRUE(result.split);
}

TEST(ManifoldSoup, HasNoFacesWhereNoTriangleHasThreeCorners) {
  const ManifoldSoup result = manifold_soup(mesh_of({{0, 0, 1}, {1, 2, 2}}));
  EXPECT_EQ(result.faces.size() + result.twin.size() + result.vertex_of.size() + result.triangle_of.size(), 0U);
  EXPECT_EQ(result.dropped_triangles, 2U);
}

/// A square of two triangles, and once more: as a decal that looks different, and as a mere repetition.
TEST(ManifoldSoup, KeepsRepetitionsThatLookDifferentOnSheetsOfTheirOwn) {
  const TriangleMesh soup = mesh_of({{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}});
  const std::vector<std::uint32_t> decal = {0, 0, 7, 7}, repeated = {4, 5, 4, 5};
  const ManifoldSoup both = manifold_soup(soup, decal);
  EXPECT_EQ(both.dropped_triangles, 0U);
  EXPECT_EQ(both.triangle_of, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(both.vertex_of.size(), 8U);
  for (std::uint32_t f = 0; f < 4; ++f)
    for (const std::uint32_t twin : both.twin[f])
      EXPECT_TRUE(twin == no_index || twin / 3 / 2 == f / 2) << "faces of two sheets are joined";
  EXPECT_EQ(std::count(both.twin[2].begin(), both.twin[2].end(), no_index), 2);
  const ManifoldSoup one = manifold_soup(soup, repeated);
  EXPECT_EQ(one.dropped_triangles, 2U);
  EXPECT_EQ(one.vertex_of.size(), 4U);
}

TEST(ManifoldSoup, KeepsTheBackOfATriangleWhereLooksCount) {
  const TriangleMesh soup = mesh_of({{0, 1, 2}, {2, 1, 0}, {1, 2, 0}});
  EXPECT_EQ(manifold_soup(soup, std::vector<std::uint32_t>{3, 3, 3}).triangle_of, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(manifold_soup(soup).triangle_of, (std::vector<std::uint32_t>{0}));
}

/// A square whose triangles lie on their backs: the front of one comes first, the back of the other; the caller had
/// both fronts first.
TEST(ManifoldSoup, NumbersSheetsInTheOrderOfTheCaller) {
  const TriangleMesh soup = mesh_of({{0, 1, 2}, {2, 1, 0}, {3, 2, 0}, {0, 2, 3}});
  const std::vector<std::uint32_t> look = {0, 1, 1, 0}, number = {0, 2, 3, 1};
  const ManifoldSoup result =
      manifold_soup(soup, meshbound::first_at_position(meshbound::positions_of(soup)), {}, look, number);
  EXPECT_EQ(result.dropped_triangles, 0U);
  EXPECT_EQ(result.twin[0][2], 9U) << "the fronts have a common edge";
  EXPECT_EQ(result.twin[1][2], 7U) << "and so have the backs";
  for (std::uint32_t f = 0; f < 4; ++f)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(result.vertex_of[result.faces[f][k]], soup.triangles[f][k]) << "none is turned over";
  const std::vector<std::uint32_t> last_first = {1, 0};
  const TriangleMesh twice = mesh_of({{0, 1, 2}, {1, 2, 0}});
  EXPECT_EQ(manifold_soup(twice, {0, 1, 2}, {}, {}, last_first).triangle_of, std::vector<std::uint32_t>{1});
}

TEST(ManifoldSoup, RefusesTooManyTriangles) {
  const double position[3] = {0, 0, 0};
  const std::uint32_t indices[3] = {0, 0, 0};
  const meshbound::MeshView huge(position, 1, sizeof(position), indices, 0x55555556);
  EXPECT_THROW(static_cast<void>(manifold_soup(huge)), InvalidInput);
}

TEST(ManifoldSoup, IsAManifoldForAnyTriangles) {
  int split = 0, whole = 0;
  for (std::uint32_t seed = 0; seed < 3000; ++seed) {
    const TriangleMesh soup = meshbound::test::tangled_soup(seed);
    if (soup.triangles.size() == 1) continue;
    const ManifoldSoup result = manifold_soup(soup);
    ASSERT_EQ(defect(result, soup), "") << "seed " << seed;
    ++(result.split ? split : whole);
  }
  EXPECT_GT(split, 500);
  EXPECT_GT(whole, 20);
}

/// What differs from the result without neighbours; `look` as for `manifold_soup`.
std::string difference_with_neighbours(const TriangleMesh& soup, const std::vector<std::uint32_t>& look, int threads) {
  const std::vector<Vec3> positions = meshbound::positions_of(soup);
  const auto neighbours = meshbound::edge_neighbours(meshbound::Bvh(soup), positions, soup.triangles, threads);
  const ManifoldSoup with = manifold_soup(soup, meshbound::first_at_position(positions), neighbours, look);
  const ManifoldSoup without = manifold_soup(soup, look);
  if (with.faces != without.faces) return "faces";
  if (with.twin != without.twin) return "twins";
  if (with.vertex_of != without.vertex_of || with.triangle_of != without.triangle_of) return "sources";
  if (!std::ranges::equal(with.repetitions, without.repetitions,
                          [](const auto& a, const auto& b) { return a.triangle == b.triangle && a.of == b.of; }))
    return "repetitions";
  if (with.dropped_triangles != without.dropped_triangles) return "dropped triangles";
  return with.split != without.split ? "split" : "";
}

TEST(ManifoldSoup, IsTheSameWithNeighbours) {
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    TriangleMesh soup = meshbound::test::tangled_soup(seed);
    std::vector<std::uint32_t> look;
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) look.push_back(t % 2);
    ASSERT_EQ(difference_with_neighbours(soup, {}, 1), "") << "seed " << seed;
    ASSERT_EQ(difference_with_neighbours(soup, look, 2), "") << "seed " << seed;
    soup.triangles.push_back(soup.triangles.front());  // twice, then the back of another, then without area
    soup.triangles.push_back({soup.triangles[1 % soup.triangles.size()]});
    std::swap(soup.triangles.back()[0], soup.triangles.back()[1]);
    soup.triangles.push_back({soup.triangles[0][0], soup.triangles[0][1], soup.triangles[0][1]});
    look.insert(look.end(), {0, 1, 0});
    ASSERT_EQ(difference_with_neighbours(soup, {}, 1), "") << "seed " << seed;
    ASSERT_EQ(difference_with_neighbours(soup, look, 1), "") << "seed " << seed;
  }
}

/// A mesh and a copy of it with vertices of its own: by these, triangles have other neighbours than by positions.
TriangleMesh twice(TriangleMesh mesh) {
  const auto vertices = static_cast<std::uint32_t>(mesh.vertices.size());
  const std::vector<Triangle> triangles = mesh.triangles;
  const std::vector<Eigen::Vector3d> points = mesh.vertices;
  mesh.vertices.insert(mesh.vertices.end(), points.begin(), points.end());
  for (const auto& [a, b, c] : triangles) mesh.triangles.push_back({a + vertices, b + vertices, c + vertices});
  return mesh;
}

/// Large enough for several threads.
TEST(ManifoldSoup, OfAWholeMeshIsTheSameWithNeighbours) {
  TriangleMesh torus = meshbound::datasets::torus(1, 0.3, 160, 60);
  EXPECT_EQ(difference_with_neighbours(torus, {}, 3), "");
  EXPECT_EQ(manifold_soup(torus).dropped_triangles, 0U);
  EXPECT_EQ(difference_with_neighbours(twice(torus), {}, 3), "");
  EXPECT_EQ(manifold_soup(twice(torus)).dropped_triangles, torus.triangles.size());
  torus.triangles.push_back(torus.triangles[7]);
  EXPECT_EQ(difference_with_neighbours(torus, {}, 3), "");
  EXPECT_EQ(difference_with_neighbours(meshbound::reference::unwelded(torus), {}, 3), "");
}

TEST(ManifoldSoup, IsAManifoldForTheSharedMeshes) {
  const auto meshes = meshbound::test::readable_meshes({"broken", "../cases"});
  if (meshes.empty()) GTEST_SKIP() << "no datasets folder with broken/ (set MESHBOUND_DATASETS)";
  for (const auto& [path, soup] : meshes) {
    EXPECT_EQ(defect(manifold_soup(soup), soup), "") << path;
  }
}

}  // namespace manifold_soup_test
