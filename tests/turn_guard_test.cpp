// SPDX-License-Identifier: MIT
#include "simplify/normals/turn_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "geometry/boxes.h"
#include "simplify/mesh/manifold_soup.h"
#include "simplify/mesh/nearest_triangle.h"
#include "simplify/propose.h"

namespace face_turns_test {

using meshbound::ArrayMesh;
using meshbound::Corner;
using meshbound::EdgeStar;
using meshbound::FacedTriangle;
using meshbound::FaceTurns;
using meshbound::NearestTriangle;
using meshbound::no_index;
using Rival = meshbound::Rivals::Rival;
using meshbound::SampleFace;
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

ArrayMesh array_mesh_of(const meshbound::TriangleMesh& mesh) {
  const meshbound::ManifoldSoup soup = meshbound::manifold_soup(mesh);
  std::vector<Vec3> points;
  for (const std::uint32_t v : soup.vertex_of) points.push_back(meshbound::to_vec3(mesh.vertices[v]));
  return {std::move(points), soup.faces, soup.twin};
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
  return array_mesh_of(mesh);
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

/// The faces that stay, as the guard is given them.
std::vector<SampleFace> faces_of(const ArrayMesh& mesh, const EdgeStar& star, Vec3 origin, Vec3 point) {
  std::vector<SampleFace> faces;
  for (const Corner c : star.moved)
    faces.emplace_back(point - origin, mesh.position(mesh.end(c)) - origin, mesh.position(mesh.apex(c)) - origin);
  return faces;
}

bool holds(TurnGuard& guard, const ArrayMesh& mesh, const EdgeStar& star, Vec3 point) {
  const std::vector<SampleFace> faces = faces_of(mesh, star, mesh.position(star.kept), point);
  return guard.holds_inside(point, faces) && guard.holds_around(faces);
}

void begin(TurnGuard& guard, const ArrayMesh& mesh, const EdgeStar& star) {
  guard.begin({star.moved, star.removed, mesh.position(star.kept)});
}

/// Takes the samples of the star away.
void clear(FaceTurns& turns, const EdgeStar& star) {
  for (const Corner c : star.moved) turns.clear(c / 3);
  for (const std::uint32_t f : star.removed) turns.clear(f);
}

FaceTurns turns_of(const ArrayMesh& mesh, double degrees) {
  return {mesh, std::vector<std::uint8_t>(mesh.face_count(), 0), {degrees, 1, 1}};
}

/// A face that moves comes nearer to the middle of one beside it, which has no sample of its own there, than the face
/// that the middle was nearest to: from the edge (3, 1), (3, 2) up to a point over (3.33, 1.67), beyond that edge, so
/// that the face looks down.
TEST(TurnGuard, LooksAtSamplesOfTheFacesAround) {
  const ArrayMesh mesh = flat_square();
  for (const double degrees : {30.0, 150.0}) {
    FaceTurns turns = turns_of(mesh, degrees);
    ArrayMesh lower = mesh;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) lower.move(v, mesh.position(v) - Vec3{0, 0, 0.3});
    const EdgeStar star = star_of(lower);
    ASSERT_GT(star.moved.size(), 4U);
    clear(turns, star);
    TurnGuard guard(turns, lower);
    begin(guard, lower, star);
    EXPECT_TRUE(holds(guard, lower, star, {2, 2, -0.3}));
    EXPECT_EQ(holds(guard, lower, star, {3 + 1.0 / 3, 1 + 2.0 / 3, 0.5}), degrees > 90);
    EXPECT_TRUE(holds(guard, lower, star, {2, 2, -0.3}));
  }
}

/// Whether each sample of the star, the middles of its faces, turns by at most so much, looked at one by one. The first
/// that turns more; absent if none does, or if it is not clear which face is nearest to one.
struct SlowGuard {
  std::optional<std::size_t> refused;
  bool is_clear = true;
};

SlowGuard slow_guard(const ArrayMesh& mesh, const EdgeStar& star, Vec3 point, double degrees) {
  std::vector<Corners> faces;
  for (const Corner c : star.moved) faces.push_back({point, mesh.position(mesh.end(c)), mesh.position(mesh.apex(c))});
  std::vector<std::uint32_t> numbers = star.removed;
  for (const Corner c : star.moved) numbers.push_back(c / 3);
  SlowGuard result;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Corners own = mesh.triangle(numbers[i]);
    const Vec3 middle = (1.0 / 3) * (own[0] + own[1] + own[2]);
    const std::size_t nearest = first_of_nearest(faces, middle);
    const double squared = squared_distance(faces[nearest], middle);
    for (std::size_t k = 0; k < faces.size(); ++k)
      if (k != nearest && squared_distance(faces[k], middle) <= 1.01 * squared + 1e-6) result.is_clear = false;
    const Vec3 normal = cross(faces[nearest][1] - faces[nearest][0], faces[nearest][2] - faces[nearest][0]);
    if (!result.refused && normal.z < std::cos(degrees * M_PI / 180) * length(normal)) result.refused = i;
  }
  return result;
}

/// The samples are compared in blocks of eight.
TEST(TurnGuard, LooksAtEachSampleOfTheStar) {
  const ArrayMesh mesh = flat_square();
  const EdgeStar star = star_of(mesh);
  ASSERT_EQ(star.moved.size() + star.removed.size(), 10U);
  const FaceTurns turns = turns_of(mesh, 30);
  std::mt19937 random(1);
  int held = 0, refused_first = 0, refused_last = 0;
  for (int run = 0; run < 2000; ++run) {
    const Vec3 point = Vec3{1.5, 2, 0} + random_point(random);
    const SlowGuard expected = slow_guard(mesh, star, point, 30);
    if (!expected.is_clear) continue;
    TurnGuard guard(turns, mesh);
    begin(guard, mesh, star);
    const std::vector<SampleFace> faces = faces_of(mesh, star, mesh.position(star.kept), point);
    ASSERT_EQ(guard.holds_inside(point, faces), !expected.refused) << run;
    ++(!expected.refused ? held : *expected.refused < 8 ? refused_first : refused_last);
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(refused_first, 10);
  EXPECT_GT(refused_last, 10);
}

/// Without a face nearer than the own one, none counts.
TEST(TurnGuard, LeavesSamplesToTheirOwnFace) {
  const ArrayMesh mesh = flat_square();
  FaceTurns turns = turns_of(mesh, 30);
  const EdgeStar star = star_of(mesh);
  clear(turns, star);
  TurnGuard guard(turns, mesh);
  begin(guard, mesh, star);
  EXPECT_TRUE(holds(guard, mesh, star, {3 + 1.0 / 3, 1 + 2.0 / 3, 0.5}));
}

/// The more the face turns that a sample comes to, the larger the deviation: the top of a roof over the star.
TEST(TurnGuard, TellsHowMuchASampleTurned) {
  const ArrayMesh mesh = flat_square();
  const FaceTurns turns = turns_of(mesh, 10);
  const EdgeStar star = star_of(mesh);
  TurnGuard guard(turns, mesh);
  begin(guard, mesh, star);
  EXPECT_TRUE(holds(guard, mesh, star, {1.5, 2, 0.05}));
  float before = 1;
  for (const double height : {0.5, 1.0, 4.0}) {
    EXPECT_FALSE(holds(guard, mesh, star, {1.5, 2, height}));
    EXPECT_GT(guard.deviation(), before);
    before = guard.deviation();
  }
  EXPECT_LT(before, 9);  // a right angle
}

/// Two squares as above, one `apart` above the other, which looks down.
ArrayMesh sheets(double apart) {
  meshbound::TriangleMesh mesh;
  for (const double height : {0.0, apart})
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i) mesh.vertices.emplace_back(i, j, height);
  for (std::uint32_t j = 0; j < 4; ++j) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t v = 5 * j + i, w = v + 25;
      mesh.triangles.push_back({v, v + 1, v + 6});
      mesh.triangles.push_back({v, v + 6, v + 5});
      mesh.triangles.push_back({w, w + 6, w + 1});
      mesh.triangles.push_back({w, w + 5, w + 6});
    }
  }
  return array_mesh_of(mesh);
}

/// Once the faces around a vertex of the lower sheet rise, the upper sheet is nearer to the samples there.
TEST(TurnGuard, LooksForOtherSheetsAtItsSamples) {
  for (const double apart : {0.2, 0.9}) {
    const ArrayMesh mesh = sheets(apart);
    const EdgeStar star = star_of(mesh);
    ASSERT_EQ(mesh.position(star.kept).z, 0);
    const FaceTurns turns = turns_of(mesh, 80);
    TurnGuard guard(turns, mesh);
    begin(guard, mesh, star);
    EXPECT_TRUE(holds(guard, mesh, star, {1.5, 2, 0.1}));
    EXPECT_EQ(holds(guard, mesh, star, {1.5, 2, 1}), apart > 0.5);
    if (apart < 0.5) {
      EXPECT_FLOAT_EQ(guard.deviation(), 180.0F / 80);  // the other sheet looks down
    }
  }
}

/// The upper sheet has risen from its samples; the faces of the star come nearer to them.
TEST(TurnGuard, LooksAtSamplesOfOtherSheets) {
  for (const double apart : {0.2, 0.9}) {
    ArrayMesh mesh = sheets(apart);
    const FaceTurns turns = turns_of(mesh, 80);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.position(v).z > 0) mesh.move(v, mesh.position(v) + Vec3{0, 0, 0.15});
    const EdgeStar star = star_of(mesh);
    TurnGuard guard(turns, mesh);
    begin(guard, mesh, star);
    EXPECT_TRUE(holds(guard, mesh, star, {1.5, 2, -0.1}));
    EXPECT_EQ(holds(guard, mesh, star, {1.5, 2, 0.35}), apart > 0.5);
  }
}

/// Faces of another region may change at any time; those between regions stay as they are.
TEST(TurnGuard, LeavesOtherRegionsAlone) {
  const ArrayMesh mesh = sheets(0.2);
  const EdgeStar star = star_of(mesh);
  const FaceTurns turns = turns_of(mesh, 80);
  TurnGuard guard(turns, mesh);
  for (const std::uint32_t of_upper : {0U, 1U, no_index}) {
    std::vector<std::uint32_t> region_of_face;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
      region_of_face.push_back(mesh.triangle(f)[0].z > 0 ? of_upper : 0);
    guard.enter(region_of_face, 0);
    begin(guard, mesh, star);
    EXPECT_EQ(holds(guard, mesh, star, {1.5, 2, 1}), of_upper == 1);
  }
}

/// The sample on the edge from (1, 1) to the vertex, which two faces share: only one of them is flat.
TEST(TurnGuard, GivesASampleOnAnEdgeToTheFaceThatItTurnsLittleFrom) {
  const ArrayMesh flat = flat_square();
  for (const double x : {0.0, 2.0}) {
    ArrayMesh mesh = flat;
    mesh.move(vertex_at(mesh, x, 1), {x, 1, 2});
    FaceTurns turns = turns_of(flat, 30);
    const EdgeStar star = star_of(mesh);
    clear(turns, star);
    std::uint32_t sample = 0;
    while (squared_length(turns.sample(sample).at - Vec3{5.0 / 3, 4.0 / 3, 0}) > 1e-20) ++sample;
    turns.give_to(sample, star.moved[0] / 3);
    TurnGuard guard(turns, mesh);
    begin(guard, mesh, star);
    ASSERT_TRUE(holds(guard, mesh, star, {2.2, 1.6, 0}));
    guard.give_samples(turns);
    for (const Corner c : star.moved)
      if (c / 3 == turns.face_of(sample)) {
        EXPECT_EQ(mesh.position(mesh.end(c)).z + mesh.position(mesh.apex(c)).z, 0);
      }
  }
}

/// Two triangles that share an edge face down from above the square: one lies over the star, the other beyond reach.
/// Once the other one holds the sample of the first, only a look at faces beside it finds the first.
TEST(TurnGuard, LooksBesideFacesThatHoldRivals) {
  meshbound::TriangleMesh both;
  const ArrayMesh flat = flat_square();
  for (std::uint32_t v = 0; v < flat.vertex_count(); ++v) {
    const Vec3 p = flat.position(v);
    both.vertices.emplace_back(p.x, p.y, p.z);
  }
  for (std::uint32_t f = 0; f < flat.face_count(); ++f)
    both.triangles.push_back({flat.start(3 * f), flat.start(3 * f + 1), flat.start(3 * f + 2)});
  for (const auto& [x, y] : {std::pair(-2, -1), {4, -1}, {2, 20}, {10, 10}}) both.vertices.emplace_back(x, y, 0.2);
  both.triangles.insert(both.triangles.end(), {{25, 27, 26}, {26, 27, 28}});
  const ArrayMesh mesh = array_mesh_of(both);
  const auto near = static_cast<std::uint32_t>(flat.face_count()), far = near + 1;
  for (const bool is_given : {false, true}) {
    FaceTurns turns = turns_of(mesh, 80);
    if (is_given) {
      turns.clear(near);
      turns.give_to(near, far);
    }
    const EdgeStar star = star_of(mesh);
    TurnGuard guard(turns, mesh);
    begin(guard, mesh, star);
    EXPECT_TRUE(holds(guard, mesh, star, {1.5, 2, 0.05}));
    EXPECT_EQ(guard.holds_inside({1.5, 2, 1}, faces_of(mesh, star, mesh.position(star.kept), {1.5, 2, 1})), is_given);
    EXPECT_FALSE(holds(guard, mesh, star, {1.5, 2, 1}));
  }
}

FacedTriangle triangle_at(Vec3 at, double looks) {
  return {{at, at + Vec3{1, 0, 0}, at + Vec3{0, 1, 0}}, {0, 0, looks}};
}

std::vector<std::uint32_t> rivals_of(const meshbound::Rivals& rivals, std::uint32_t triangle) {
  std::vector<std::uint32_t> numbers;
  for (const Rival& rival : rivals.of(triangle)) numbers.push_back(rival.triangle);
  return numbers;
}

/// Rivals look elsewhere and are near: within twice the square root of twice the area, here 2.
TEST(Rivals, AreTheNearestThatLookElsewhere) {
  std::vector<FacedTriangle> triangles{triangle_at({0, 0, 0}, 1), triangle_at({0, 0, 0.1}, 1)};
  for (const double height : {0.45, 0.6, 0.2, 0.3, 0.35, 0.4, 2.05})
    triangles.push_back(triangle_at({0, 0, height}, -1));
  const meshbound::Rivals rivals(triangles, {10, 0.5, 1});
  using Numbers = std::vector<std::uint32_t>;
  EXPECT_EQ(rivals_of(rivals, 0), (Numbers{4, 5, 6, 7}));
  EXPECT_EQ(rivals_of(rivals, 3), (Numbers{1, 0}));
  EXPECT_EQ(rivals_of(rivals, 8), (Numbers{1}));
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t other = 0; other < triangles.size(); ++other) {
      const std::vector<std::uint32_t> of = rivals_of(rivals, t);
      const auto with = rivals.with(other);
      EXPECT_EQ(std::count(of.begin(), of.end(), other), std::count(with.begin(), with.end(), t));
    }
  const meshbound::Rivals near(triangles, {0.3, 0.5, 1});
  EXPECT_EQ(rivals_of(near, 0), (Numbers{4, 5}));
}

/// Triangles in a cube of 0.4, with two edges of up to these lengths or a little more.
std::vector<FacedTriangle> random_triangles(std::size_t count, double length_of_one = 0.1,
                                            double length_of_next = 0.1) {
  std::mt19937 random(3);
  std::vector<FacedTriangle> triangles;
  while (triangles.size() < count) {
    const Vec3 at = 0.2 * random_point(random), u = length_of_one * random_point(random),
               v = length_of_next * random_point(random);
    const Vec3 normal = cross(u, v);
    triangles.push_back({{at, at + u, at + v}, (1 / length(normal)) * normal});
  }
  return triangles;
}

/// By looking at all, with few and with many within half the reach, and with needles, which are searched in slices.
TEST(Rivals, AreThoseThatALookAtAllFinds) {
  struct Case {
    std::size_t size;
    double length_of_one, length_of_next;
  };
  for (const auto& [size, of_one, of_next] :
       {Case{50, 0.1, 0.1}, {1000, 0.1, 0.1}, {1000, 0.1, 1e-3}, {1000, 2, 0.01}, {1000, 2, 1e-3}}) {
    const std::vector<FacedTriangle> triangles = random_triangles(size, of_one, of_next);
    const meshbound::Rivals rivals(triangles, {1, 0.5, 1});
    for (std::uint32_t t = 0; t < size; ++t) {
      const auto& [a, b, c] = triangles[t].corners;
      const double reach = 2 * std::sqrt(length(cross(b - a, c - a)));
      std::vector<std::pair<double, std::uint32_t>> all;
      for (std::uint32_t other = 0; other < size; ++other) {
        const double squared = squared_distance(triangles[other].corners, triangles[t].middle());
        if (dot(triangles[t].normal, triangles[other].normal) < 0.5 && squared <= reach * reach)
          all.emplace_back(squared, other);
      }
      std::sort(all.begin(), all.end());
      all.resize(std::min(all.size(), meshbound::Rivals::max_rivals));
      const auto found = rivals.of(t);
      ASSERT_EQ(found.size(), all.size());
      for (std::size_t k = 0; k < all.size(); ++k) {
        EXPECT_EQ(found[k].triangle, all[k].second);
        EXPECT_FLOAT_EQ(found[k].squared, static_cast<float>(all[k].first));
      }
    }
  }
}

TEST(Rivals, AreTheSameForEveryNumberOfThreads) {
  const std::vector<FacedTriangle> triangles = random_triangles(3000);
  const meshbound::Rivals one(triangles, {1, 0.5, 1}), four(triangles, {1, 0.5, 4});
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    EXPECT_EQ(rivals_of(one, t), rivals_of(four, t));
    EXPECT_TRUE(std::ranges::equal(one.with(t), four.with(t)));
    count += one.of(t).size();
  }
  EXPECT_GT(count, 1000U);
}

}  // namespace face_turns_test
