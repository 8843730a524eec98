// SPDX-License-Identifier: MIT
#include "simplify/mesh/array_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "datasets/analytic_meshes.h"
#include "numeric/no_index.h"
#include "simplify/mesh/manifold_soup.h"
#include "simplify/propose.h"

namespace array_mesh_test {

using meshbound::ArrayMesh;
using meshbound::Corner;
using meshbound::EdgeStar;
using meshbound::next_corner;
using meshbound::no_index;
using meshbound::previous_corner;
using meshbound::TriangleMesh;
using meshbound::Vec3;
namespace datasets = meshbound::datasets;

ArrayMesh array_mesh(const TriangleMesh& mesh) {
  const meshbound::ManifoldSoup soup = meshbound::manifold_soup(mesh);
  std::vector<Vec3> points;
  for (const std::uint32_t v : soup.vertex_of) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    points.push_back({p.x(), p.y(), p.z()});
  }
  return {std::move(points), soup.faces, soup.twin};
}

/// What undoing a change must restore: every array except the corner at which the walk around a vertex begins.
struct Arrays {
  std::vector<std::array<double, 3>> positions;
  std::vector<std::uint32_t> vertices, twins;
  std::vector<bool> removed, is_vertex;
  bool operator==(const Arrays&) const = default;

  explicit Arrays(const ArrayMesh& mesh) {
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3 p = mesh.position(v);
      positions.push_back({p.x, p.y, p.z});
      is_vertex.push_back(mesh.is_vertex(v));
    }
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) removed.push_back(mesh.is_removed(f));
    for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
      vertices.push_back(mesh.vertex(c));
      twins.push_back(mesh.twin(c));
    }
  }
};

/// Twins are mutual and opposite, no edge occurs twice in one direction, and the corners around each vertex are those
/// of the faces that have it, each visited once.
void expect_valid(const ArrayMesh& mesh) {
  std::vector<std::vector<Corner>> expected(mesh.vertex_count());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    if (mesh.is_removed(c / 3)) continue;
    expected[mesh.vertex(c)].push_back(c);
    edges.emplace_back(mesh.start(c), mesh.end(c));
    const Corner twin = mesh.twin(c);
    if (twin == no_index) continue;
    ASSERT_FALSE(mesh.is_removed(twin / 3));
    ASSERT_EQ(mesh.twin(twin), c);
    ASSERT_EQ(mesh.start(twin), mesh.end(c));
    ASSERT_EQ(mesh.end(twin), mesh.start(c));
  }
  std::sort(edges.begin(), edges.end());
  ASSERT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end());
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    ASSERT_EQ(mesh.is_vertex(v), !expected[v].empty());
    if (!mesh.is_vertex(v)) continue;
    std::vector<Corner> visited;
    bool at_border = false;
    ASSERT_TRUE(mesh.for_each_corner(v, [&](Corner c) {
      visited.push_back(c);
      at_border = at_border || mesh.twin(c) == no_index || mesh.twin(previous_corner(c)) == no_index;
      return visited.size() <= expected[v].size();
    }));
    std::sort(visited.begin(), visited.end());
    ASSERT_EQ(visited, expected[v]);
    ASSERT_EQ(mesh.is_border(v), at_border);
    std::vector<Corner> edges_there, once;
    for (const Corner c : visited)
      for (const Corner side : {c, previous_corner(c)}) edges_there.push_back(mesh.edge(side));
    std::sort(edges_there.begin(), edges_there.end());
    edges_there.erase(std::unique(edges_there.begin(), edges_there.end()), edges_there.end());
    mesh.for_each_edge(v, [&](Corner e) { once.push_back(e); });
    std::sort(once.begin(), once.end());
    ASSERT_EQ(once, edges_there);
  }
}

/// Random changes that keep the mesh a manifold, and their undoing.
class Changes {
 public:
  Changes(ArrayMesh& mesh, std::uint64_t seed) : mesh_(mesh), random_(seed) {}

  void make() {
    const auto edge = static_cast<Corner>(random_() % (3 * mesh_.face_count()));
    if (mesh_.is_removed(edge / 3)) return;
    const Change change{static_cast<int>(random_() % 3), edge, mesh_.position(mesh_.start(edge))};
    if (change.kind == 0 && star_.gather(mesh_, edge))
      mesh_.collapse(edge);
    else if (change.kind == 1 && can_flip(edge))
      mesh_.flip(edge);
    else if (change.kind != 2)
      return;
    mesh_.move(mesh_.start(edge), {uniform(), uniform(), uniform()});
    ++count[static_cast<std::size_t>(change.kind)];
    // What a flip moves is the start of the flipped edge: another vertex than before.
    made_.push_back(change);
    if (change.kind == 1) made_.back().position = flipped_from_;
  }
  void undo() {
    const Change& change = made_.back();
    mesh_.move(mesh_.start(change.edge), change.position);
    if (change.kind == 0) mesh_.undo_collapse(change.edge);
    if (change.kind == 1) mesh_.undo_flip(change.edge);
    made_.pop_back();
  }
  [[nodiscard]] bool empty() const { return made_.empty(); }

  std::array<int, 3> count = {};  ///< collapses, flips, moves

 private:
  struct Change {
    int kind;
    Corner edge;
    Vec3 position;
  };
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  bool can_flip(Corner edge) {
    const Corner other = mesh_.twin(edge);
    if (other == no_index || mesh_.apex(edge) == mesh_.apex(other)) return false;
    for (const std::uint32_t v : {mesh_.start(edge), mesh_.end(edge)}) {
      std::size_t faces = 0;
      mesh_.for_each_corner(v, [&](Corner) { return ++faces < 4; });
      if (faces < 4) return false;
    }
    flipped_from_ = mesh_.position(mesh_.apex(edge));
    return mesh_.for_each_corner(mesh_.apex(edge), [&](Corner c) {
      return mesh_.end(c) != mesh_.apex(other) && mesh_.apex(c) != mesh_.apex(other);
    });
  }

  ArrayMesh& mesh_;
  std::mt19937_64 random_;
  EdgeStar star_;
  std::vector<Change> made_;
  Vec3 flipped_from_;  ///< where the start of the flipped edge is
};

struct Case {
  std::string name;
  TriangleMesh mesh;
};
std::vector<Case> cases() {
  return {{"sphere", datasets::icosphere(1, 2)},         {"torus", datasets::torus(2, 1, 12, 8)},
          {"open grid", datasets::terrain(1, 9, 3)},     {"caps with hubs", datasets::cylinder(1, 2, 20)},
          {"tetrahedron", datasets::uv_sphere(1, 2, 3)}, {"thin sheet", datasets::thin_sheet(1, 0.1, 4)}};
}

TEST(ArrayMesh, StaysAManifoldUnderRandomChanges) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    std::array<int, 3> made = {};
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      ArrayMesh mesh = array_mesh(c.mesh);
      expect_valid(mesh);
      Changes changes(mesh, seed);
      for (std::size_t k = 0; k < 3 * c.mesh.triangles.size(); ++k) {
        changes.make();
        if (k % 16 == 0) expect_valid(mesh);
        if (HasFatalFailure()) return;
      }
      expect_valid(mesh);
      for (std::size_t kind = 0; kind < made.size(); ++kind) made[kind] += changes.count[kind];
    }
    EXPECT_GT(made[0], 0) << "no collapse";
    EXPECT_GT(made[1], 0) << "no edge was flipped";
    EXPECT_GT(made[2], 0) << "no vertex was moved";
  }
}

TEST(ArrayMesh, UndoingInReverseOrderGivesBackEveryArray) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    std::array<int, 3> undone = {};
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      ArrayMesh mesh = array_mesh(c.mesh);
      const Arrays start(mesh);
      Changes changes(mesh, seed);
      for (std::size_t k = 0; k < c.mesh.triangles.size(); ++k) changes.make();
      const Arrays middle(mesh);
      Changes more(mesh, seed + 100);
      for (std::size_t k = 0; k < c.mesh.triangles.size(); ++k) more.make();
      for (std::size_t kind = 0; kind < undone.size(); ++kind) undone[kind] += changes.count[kind] + more.count[kind];
      while (!more.empty()) more.undo();
      ASSERT_EQ(Arrays(mesh), middle);
      expect_valid(mesh);
      while (!changes.empty()) changes.undo();
      ASSERT_EQ(Arrays(mesh), start);
      expect_valid(mesh);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(undone[0], 0) << "no collapse";
    EXPECT_GT(undone[1], 0) << "no edge was flipped";
    EXPECT_GT(undone[2], 0) << "no vertex was moved";
  }
}

TEST(ArrayMesh, EdgesHaveOneNumberFromBothSides) {
  const ArrayMesh mesh = array_mesh(datasets::terrain(1, 5, 1));
  for (Corner c = 0; c < 3 * mesh.face_count(); ++c) {
    EXPECT_TRUE(mesh.edge(c) == c || mesh.edge(c) == mesh.twin(c));
    if (mesh.twin(c) != no_index) {
      EXPECT_EQ(mesh.edge(c), mesh.edge(mesh.twin(c)));
    }
  }
}

TEST(EdgeStar, RefusesWhatWouldNotLeaveAManifold) {
  EdgeStar star;
  const ArrayMesh tetrahedron =
      array_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}});
  for (Corner c = 0; c < 12; ++c) EXPECT_FALSE(star.gather(tetrahedron, c));
  // Two triangles: the inner edge joins two borders, and the faces at an outer one hang on by one edge only.
  const ArrayMesh two = array_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}}});
  for (Corner c = 0; c < 6; ++c) {
    if (two.twin(c) != no_index) {
      EXPECT_FALSE(star.gather(two, c));
    }
  }
}

}  // namespace array_mesh_test
