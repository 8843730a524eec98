// SPDX-License-Identifier: MIT
// Nodes that are said to be apart hold no triangles that meet, decided exactly; around hubs and among needles most are.
#include "penetration/nodes_apart.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "model_data.h"
#include "penetration/contact.h"
#include "reference/small_meshes.h"

namespace nodes_apart_test {

using namespace meshbound;
using namespace meshbound::reference;
using test::model_data;

/// Numbers from -1 to 1 with 33 bits.
class Uniform {
 public:
  double operator()() { return static_cast<double>(random_()) / 2147483648.0 - 1; }
  Eigen::Vector3d anywhere() {
    const double x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }

 private:
  std::mt19937 random_{7};
};

/// Triangles in all directions around one vertex, long and short ones; many meet elsewhere too.
TriangleMesh tangled_hub(std::uint32_t triangles, double width, double short_length) {
  Uniform uniform;
  TriangleMesh mesh{{{0.1, 0.2, 0.3}}, {}};
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Eigen::Vector3d way = (i % 3 == 0 ? short_length : 1.0) * uniform.anywhere();
    const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(mesh.vertices[0] + way);
    mesh.vertices.push_back(mesh.vertices[0] + way + width * way.norm() * uniform.anywhere());
    mesh.triangles.push_back({0, next, next + 1});
  }
  return mesh;
}

/// Triangles that reach from two hubs into one region: four of a hub at each place, so that blocks are fans, but nodes
/// are not.
TriangleMesh two_hubs(std::uint32_t places) {
  Uniform uniform;
  TriangleMesh mesh{{{0, 0, 0}, {0.7, 0.2, 0.4}}, {}};
  for (std::uint32_t i = 0; i < places; ++i) {
    const Eigen::Vector3d place = uniform.anywhere() + Eigen::Vector3d(2, 3, 1), across = 0.7 * uniform.anywhere();
    for (std::uint32_t k = 0; k < block_width; ++k) {
      const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(place + across + 1e-4 * uniform.anywhere());
      mesh.vertices.push_back(place - across + 1e-4 * uniform.anywhere());
      mesh.triangles.push_back({i % 2, next, next + 1});
    }
  }
  return mesh;
}

/// Needles around the origin in pairs, on both sides of a ray that both have an edge on, to a third of the other's.
TriangleMesh touching_hub(std::uint32_t pairs) {
  Uniform uniform;
  TriangleMesh mesh{{{0, 0, 0}}, {}};
  for (std::uint32_t i = 0; i < pairs; ++i) {
    const Eigen::Vector3d way = uniform.anywhere(), aside = 1e-9 * uniform.anywhere();
    const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3d& p : {way, Eigen::Vector3d(way + aside), Eigen::Vector3d(3 * way)})
      mesh.vertices.push_back(p);
    mesh.vertices.emplace_back(3 * (way - aside));
    mesh.triangles.push_back({0, next, next + 1});
    mesh.triangles.push_back({0, next + 3, next + 2});
  }
  return mesh;
}

/// Two tubes of needles, the one through the other.
TriangleMesh crossing_needles() {
  TriangleMesh other = needles(300);
  for (Eigen::Vector3d& p : other.vertices) p = Eigen::Quaterniond(20, 1, 0, 2).normalized() * p;
  return both(needles(300), other);
}

/// Two cones of n triangles each, base to base, askew to the axes.
TriangleMesh double_cone(std::uint32_t n) {
  TriangleMesh mesh = fan(n);
  mesh.vertices[n].z() = 3;
  for (std::uint32_t i = 0; i < n; ++i) mesh.triangles.push_back({n + 1, (i + 1) % n, i});
  mesh.vertices.emplace_back(0, 0, -3);
  for (Eigen::Vector3d& p : mesh.vertices) p = Eigen::Quaterniond(4, 1, 3, 2).normalized() * p;
  return mesh;
}

/// Pairs of triangles that meet beyond what they share, and those of them that some pair of nodes above rules out.
struct Meeting {
  std::size_t pairs = 0, lost = 0;
};

Meeting meeting_in(const TriangleMesh& mesh) {
  const ClosedModel::Data model = model_data(mesh);
  const Bvh::Data& tree = model.tree.data();
  const NodesApart are_apart(model);
  PlacedPair pair;
  pair.place(model, Eigen::Isometry3d::Identity(), model, Eigen::Isometry3d::Identity());
  const auto is_ruled_out = [&](std::uint32_t i, std::uint32_t j) {
    i /= block_width, j /= block_width;
    for (std::uint32_t level = 0; level < tree.levels(); ++level, i /= node_width, j /= node_width)
      if (are_apart({level, i, level, j}) ||
          (level + 1 < tree.levels() && are_apart({level, i, level + 1, j / node_width})))
        return true;
    return false;
  };
  Meeting meeting;
  for (std::uint32_t i = 0; i < tree.triangle_count(); ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      const std::uint32_t s = tree.triangle_of_slot[i], t = tree.triangle_of_slot[j];
      if (!triangles_cross(pair, model.triangles[s], model.triangles[t])) continue;
      ++meeting.pairs;
      if (is_ruled_out(i, j)) ++meeting.lost;
    }
  }
  return meeting;
}

TEST(NodesApart, KeepTrianglesThatMeet) {
  const TriangleMesh narrow = tangled_hub(900, 0.2, 1e-9), wide = tangled_hub(300, 2, 1e-9);
  for (const TriangleMesh& mesh :
       {narrow, wide, scaled(narrow, 1e-120), scaled(wide, 1e120), moved(tangled_hub(900, 0.2, 0.1), {1e6, -2e6, 3e6}),
        both(wide, moved(wide, {0.3, 0.1, 0.2})), two_hubs(150), touching_hub(500), crossing_needles(),
        moved(crossing_needles(), {1e7, 0, 0})}) {
    const Meeting meeting = meeting_in(mesh);
    EXPECT_GT(meeting.pairs, 100U);
    EXPECT_EQ(meeting.lost, 0U) << meeting.pairs;
  }
}

/// Pairs of triangles that are looked at where a mesh is compared with itself.
template <class AreApart>
std::uint64_t pairs_looked_at(const ClosedModel::Data& model, const AreApart& are_apart) {
  PlacedPair pair;
  pair.place(model, Eigen::Isometry3d::Identity(), model, Eigen::Isometry3d::Identity());
  BoxPairMemory memory;
  PairCounters counters;
  visit_triangle_pairs(pair, true, are_apart, memory, counters, [](std::uint32_t, std::uint32_t) { return true; });
  return counters.triangle_pairs;
}

TEST(NodesApart, SpareNearlyAllPairsOfNeedlesAndAroundHubs) {
  for (const TriangleMesh& mesh : {needles(1500), fan(3000), double_cone(1500)}) {
    const ClosedModel::Data model = model_data(mesh);
    const auto none = [](const NodePair&) { return false; };
    EXPECT_GT(pairs_looked_at(model, none), 3000 * 3000 / 20);
    EXPECT_LT(pairs_looked_at(model, NodesApart(model)), 3000 * 60);
  }
}

}  // namespace nodes_apart_test
