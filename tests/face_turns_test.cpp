// SPDX-License-Identifier: MIT
#include "simplify/mesh/face_turns.h"

#include <gtest/gtest.h>

#include <random>

#include "simplify/mesh/face_box.h"
#include "simplify/mesh/manifold_soup.h"
#include "simplify/mesh/nearest_triangle.h"
#include "simplify/propose.h"

namespace face_turns_test {

using meshbound::ArrayMesh;
using meshbound::Corner;
using meshbound::EdgeStar;
using meshbound::FaceTurns;
using meshbound::NearestTriangle;
using meshbound::no_index;
using meshbound::squared_distance;
using meshbound::Triangle;
using meshbound::TurnGuard;
using meshbound::Vec3;

using Corners = std::array<Vec3, 3>;

Vec3 random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
  return {x, y, z};
}

/// As `NearestTriangle`, by looking at all.
std::size_t first_of_nearest(const std::vector<Corners>& triangles, Vec3 p) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < triangles.size(); ++i)
    if (squared_distance(triangles[i], p) < squared_distance(triangles[nearest], p)) nearest = i;
  return nearest;
}

TEST(NearestTriangle, IsTheFirstOfThoseThatAreNearest) {
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    std::vector<Corners> triangles;
    const Vec3 hub = random_point(random);
    for (int i = 0; i < 9; ++i) triangles.push_back({hub, random_point(random), random_point(random)});
    triangles.push_back(triangles[3]);  // never the first
    NearestTriangle nearest;
    for (const Corners& corners : triangles) nearest.add(corners);
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = i % 20 == 0 ? hub : random_point(random);  // the hub is equally near to all
      ASSERT_EQ(nearest(p), first_of_nearest(triangles, p));
    }
  }
}

/// A square of 5 x 5 vertices one apart, at height 0; vertex 5 j + i is at (i, j).
ArrayMesh flat_square() {
  meshbound::TriangleMesh mesh;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i) mesh.vertices.emplace_back(i, j, 0);
  for (std::uint32_t j = 0; j < 4; ++j) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t v = 5 * j + i;
      mesh.triangles.push_back({v, v + 1, v + 6});
      mesh.triangles.push_back({v, v + 6, v + 5});
    }
  }
  const meshbound::ManifoldSoup soup = meshbound::manifold_soup(mesh);
  std::vector<Vec3> points;
  for (const std::uint32_t v : soup.vertex_of) points.push_back(meshbound::to_vec3(mesh.vertices[v]));
  return {std::move(points), soup.faces, soup.twin};
}

std::uint32_t vertex_at(const ArrayMesh& mesh, double x, double y) {
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.position(v).x == x && mesh.position(v).y == y) return v;
  return no_index;
}

/// The edge from (1, 2) to (2, 2), whose collapse moves the faces around both.
EdgeStar star_of(const ArrayMesh& mesh) {
  const std::uint32_t from = vertex_at(mesh, 1, 2), to = vertex_at(mesh, 2, 2);
  EdgeStar star;
  mesh.for_each_corner(from, [&](Corner c) { return mesh.end(c) != to || !star.gather(mesh, mesh.edge(c)); });
  return star;
}

/// A face that moves comes nearer to the middle of one beside it, which has no sample of its own there, than the face
/// that the middle was nearest to: from the edge (3, 1), (3, 2) up to a point over (3.33, 1.67), beyond that edge, so
/// that the face looks down.
TEST(TurnGuard, LooksAtSamplesOfTheFacesAround) {
  ArrayMesh mesh = flat_square();
  for (const double degrees : {30.0, 150.0}) {
    FaceTurns turns(mesh, std::vector<std::uint8_t>(mesh.face_count(), 0), degrees);
    ArrayMesh lower = mesh;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) lower.move(v, mesh.position(v) - Vec3{0, 0, 0.3});
    const EdgeStar star = star_of(lower);
    ASSERT_GT(star.moved.size(), 4U);
    for (const Corner c : star.moved) turns.lists.clear(c / 3);
    for (const std::uint32_t f : star.removed) turns.lists.clear(f);
    TurnGuard guard(turns, lower);
    guard.begin(star.moved, star.removed, 1);
    EXPECT_TRUE(guard.holds({2, 2, -0.3}));
    EXPECT_EQ(guard.holds({3 + 1.0 / 3, 1 + 2.0 / 3, 0.5}), degrees > 90);
    EXPECT_TRUE(guard.holds({2, 2, -0.3}));
  }
}

/// Without a face nearer than the own one, none counts.
TEST(TurnGuard, LeavesSamplesToTheirOwnFace) {
  const ArrayMesh mesh = flat_square();
  FaceTurns turns(mesh, std::vector<std::uint8_t>(mesh.face_count(), 0), 30);
  const EdgeStar star = star_of(mesh);
  for (const Corner c : star.moved) turns.lists.clear(c / 3);
  for (const std::uint32_t f : star.removed) turns.lists.clear(f);
  TurnGuard guard(turns, mesh);
  guard.begin(star.moved, star.removed, 1);
  EXPECT_TRUE(guard.holds({3 + 1.0 / 3, 1 + 2.0 / 3, 0.5}));
}

}  // namespace face_turns_test
