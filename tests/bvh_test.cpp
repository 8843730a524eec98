// SPDX-License-Identifier: MIT
// The tree itself: what queries take for granted.
#include "meshbound/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <string>

#include "bvh/build.h"
#include "bvh/build_kernels.h"
#include "bvh/bvh_data.h"
#include "bvh/nearest.h"
#include "geometry/hilbert.h"
#include "meshbound/error.h"
#include "numeric/vector_code.h"
#include "reference/exact_distance.h"
#include "reference/small_meshes.h"
#include "setting.h"

namespace bvh_test {

using namespace meshbound;
using namespace meshbound::reference;
using Eigen::Vector3d;

/// Counts of triangles around which the number of blocks, levels or nodes of a level changes.
std::vector<std::uint32_t> telling_sizes() {
  std::vector<std::uint32_t> sizes(100);
  std::iota(sizes.begin(), sizes.end(), 1U);
  for (std::uint32_t power = 64; power <= 32768; power *= 8)
    for (const std::uint32_t n : {power - 1, power, power + 1, 4 * power - 1, 4 * power, 4 * power + 1})
      sizes.push_back(n);
  return sizes;
}

TriangleMesh soup_of(std::uint32_t n) { return random_soup(n, static_cast<int>(n), 0.05); }

/// First slot below a node or block, and the one after the last.
std::pair<std::uint64_t, std::uint64_t> slots_below(const Bvh::Data& data, std::uint32_t level, std::uint64_t index) {
  std::uint64_t size = block_width;
  for (std::uint32_t l = 0; l < level; ++l) size *= node_width;
  const std::uint64_t n = data.triangle_count();
  return {std::min(n, index * size), std::min(n, (index + 1) * size)};
}

/// Every child's box holds the double coordinates of all triangles below it; children that have none are empty.
void expect_boxes_hold_their_triangles(const Bvh::Data& data) {
  for (std::uint32_t level = 1; level < data.levels(); ++level) {
    for (std::uint32_t i = 0; i < data.level_begin[level + 1] - data.level_begin[level]; ++i) {
      const BvhNode& node = data.nodes[data.level_begin[level] + i];
      for (std::uint32_t k = 0; k < node_width; ++k) {
        const auto [begin, end] = slots_below(data, level - 1, std::uint64_t{i} * node_width + k);
        EXPECT_EQ(begin == end, node.lo[0][k] > node.hi[0][k]);
        for (std::uint64_t slot = begin; slot < end; ++slot) {
          for (const std::uint32_t v : data.corners[slot]) {
            const double p[3] = {data.vertices[v].x, data.vertices[v].y, data.vertices[v].z};
            for (int axis = 0; axis < 3; ++axis) {
              ASSERT_LE(double{node.lo[axis][k]}, p[axis]) << "level " << level << " node " << i;
              ASSERT_GE(double{node.hi[axis][k]}, p[axis]) << "level " << level << " node " << i;
            }
          }
        }
      }
    }
  }
}

TEST(Bvh, BoxesHoldTheDoubleCoordinatesOfTheirTriangles) {
  for (const std::uint32_t n : telling_sizes()) expect_boxes_hold_their_triangles(Bvh(soup_of(n)).data());
  expect_boxes_hold_their_triangles(Bvh(icosphere(5)).data());
  expect_boxes_hold_their_triangles(Bvh(moved(scaled(icosphere(3), 1e-7), {1, 2, 3})).data());
  expect_boxes_hold_their_triangles(Bvh(scaled(icosphere(3), 1e200)).data());
}

TEST(Bvh, BoxesAreNoLargerThanRoundingAsks) {
  const Bvh bvh(icosphere(4));
  const Bvh::Data& data = bvh.data();
  const Box root = node_box(data, data.levels() - 1, 0);
  EXPECT_LE(length(root.hi - root.lo), length(data.working_box.hi - data.working_box.lo) * (1 + 0x1p-21));
}

TEST(Bvh, HoldsEachTriangleInExactlyOneSlot) {
  for (const std::uint32_t n : telling_sizes()) {
    const TriangleMesh mesh = soup_of(n);
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    auto seen = data.triangle_of_slot;
    std::sort(seen.begin(), seen.end());
    ASSERT_EQ(seen.size(), n);
    for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(seen[i], i);
    for (std::uint32_t slot = 0; slot < n; ++slot) {
      Triangle from;
      for (std::size_t k = 0; k < 3; ++k) from[k] = data.source_vertex[data.corners[slot][k]];
      Triangle expected = mesh.triangles[data.triangle_of_slot[slot]];
      std::rotate(expected.begin(), std::find(expected.begin(), expected.end(), from[0]), expected.end());
      ASSERT_EQ(from, expected);
    }
  }
}

TEST(Bvh, StacksLevelsOfEightUpToOneRoot) {
  for (const std::uint32_t n : telling_sizes()) {
    const Bvh bvh(soup_of(n));
    const Bvh::Data& data = bvh.data();
    std::size_t below = (n + block_width - 1) / block_width;
    ASSERT_EQ(data.block_count(), below);
    for (std::uint32_t level = 1; level < data.levels(); ++level) {
      const std::size_t here = data.level_begin[level + 1] - data.level_begin[level];
      ASSERT_EQ(here, (below + node_width - 1) / node_width) << n;
      below = here;
    }
    ASSERT_EQ(below, 1U) << n;
    ASSERT_EQ(data.nodes.size(), data.level_begin.back());
    ASSERT_GE(data.levels(), 2U);
  }
}

TEST(Bvh, BlocksHoldTheTrianglesLaneByLaneAndRepeatTheLast) {
  for (const std::uint32_t n : {1U, 2U, 3U, 4U, 5U, 63U, 65U}) {
    const Bvh bvh(soup_of(n));
    const Bvh::Data& data = bvh.data();
    for (std::uint32_t i = 0; i < data.block_count() * block_width; ++i) {
      const CornerTriangle<Double4> block = triangles_of_block(data, i / block_width);
      const Triangle& t = data.corners[std::min(i, n - 1)];
      const Vec3 a = data.vertices[t[0]], ac = data.vertices[t[2]] - a;
      EXPECT_EQ(block.a.y[i % block_width], a.y);
      EXPECT_EQ(block.ac.z[i % block_width], ac.z);
    }
  }
}

TEST(Bvh, AdjacencyIsMutualOnManifoldEdgesAndEmptyOnBorders) {
  TriangleMesh mixed = icosphere(3);
  for (std::size_t i = 0; i < mixed.triangles.size(); i += 3) std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
  const std::pair<TriangleMesh, std::size_t> cases[] = {{icosphere(3), 3 * 1280},
                                                        {unit_square(9), 3 * 162 - 4 * 9},
                                                        {cube(1), 3 * 12},
                                                        {mixed, 3 * 1280},
                                                        {random_soup(1, 50, 0.5), 0}};
  for (const auto& [mesh, expected] : cases) {
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    std::size_t linked = 0;
    for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
      for (int k = 0; k < 3; ++k) {
        const Neighbour neighbour = data.neighbours[slot][k];
        if (neighbour.slot == no_slot) continue;
        ++linked;
        const std::uint32_t from = data.corners[slot][k], to = data.corners[slot][(k + 1) % 3];
        bool mutual = false;
        for (int back = 0; back < 3; ++back) {
          const std::uint32_t s = data.corners[neighbour.slot][back], e = data.corners[neighbour.slot][(back + 1) % 3];
          const bool same_way = s == from && e == to, other_way = s == to && e == from;
          if (!same_way && !other_way) continue;
          EXPECT_EQ(data.neighbours[neighbour.slot][back].slot, slot);
          EXPECT_EQ(neighbour.flipped, same_way ? 1U : 0U);
          mutual = true;
        }
        EXPECT_TRUE(mutual);
      }
    }
    EXPECT_EQ(linked, expected);
  }
}

template <class Vector>
bool same_bytes(const Vector& a, const Vector& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

void expect_same(const Bvh::Data& a, const Bvh::Data& b) {
  EXPECT_TRUE(same_bytes(a.vertices, b.vertices));
  EXPECT_TRUE(same_bytes(a.source_vertex, b.source_vertex));
  EXPECT_TRUE(same_bytes(a.corners, b.corners));
  EXPECT_TRUE(same_bytes(a.neighbours, b.neighbours));
  EXPECT_TRUE(same_bytes(a.normals, b.normals));
  EXPECT_TRUE(same_bytes(a.triangle_of_slot, b.triangle_of_slot));
  EXPECT_TRUE(same_bytes(a.nodes, b.nodes));
  EXPECT_EQ(a.level_begin, b.level_begin);
  EXPECT_EQ(a.frame.error, b.frame.error);
}

/// Vertices and triangles in random order: neighbours are far apart in memory, as in the files of some scanners.
TriangleMesh scrambled(TriangleMesh mesh) {
  std::mt19937 random(11);
  std::vector<std::uint32_t> new_index(mesh.vertices.size());
  std::iota(new_index.begin(), new_index.end(), 0U);
  std::shuffle(new_index.begin(), new_index.end(), random);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  TriangleMesh result = mesh;
  for (std::size_t v = 0; v < new_index.size(); ++v) result.vertices[new_index[v]] = mesh.vertices[v];
  for (Triangle& t : result.triangles)
    for (std::uint32_t& v : t) v = new_index[v];
  return result;
}

/// Knots of four vertices, 16^3 of them, apart from each other: every fourth vertex has more edges to later ones than
/// are compared with each other, and the work that is shared out begins with such a one each time.
TriangleMesh knots() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> offset(0, 1e-3);
  std::uniform_int_distribution<std::uint32_t> corner(0, 3);
  TriangleMesh mesh;
  for (std::uint32_t knot = 0; knot < 16 * 16 * 16; ++knot) {
    const Vector3d new_index(knot % 16, knot / 16 % 16, knot / 256);
    for (int i = 0; i < 4; ++i)
      mesh.vertices.push_back(new_index + Vector3d(offset(random), offset(random), offset(random)));
    for (int i = 0; i < 64; ++i)
      mesh.triangles.push_back({4 * knot + corner(random), 4 * knot + corner(random), 4 * knot + corner(random)});
  }
  return mesh;
}

/// Six triangles meet at each edge.
TriangleMesh threefold(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  for (int copy = 0; copy < 2; ++copy)
    result.triangles.insert(result.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  return result;
}

/// Edges of six triangles that lie far apart.
TriangleMesh books() {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> offset(-0.1, 0.1);
  TriangleMesh mesh;
  for (std::uint32_t book = 0; book < 12000; ++book) {
    for (std::uint32_t i = 0; i < 8; ++i)
      mesh.vertices.emplace_back(offset(random) + i / 2, offset(random), offset(random));
    for (std::uint32_t page = 2; page < 8; ++page) mesh.triangles.push_back({8 * book, 8 * book + 1, 8 * book + page});
  }
  return mesh;
}

/// With a quarter of a million triangles several chunks meet in each run of a build.
TEST(Bvh, TrianglesAtAnEdgeFormARingInTheOrderOfTheirSlots) {
  for (const TriangleMesh& mesh : {threefold(icosphere(6)), scrambled(icosphere(6)), books()}) {
    for (const int threads : {1, 2, 5}) {
      const Bvh bvh(mesh, {.threads = threads});
      const Bvh::Data& data = bvh.data();
      std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> at_edge;
      for (std::uint32_t c = 0; c < 3 * data.triangle_count(); ++c) {
        const std::uint32_t u = data.corners[c / 3][c % 3], v = data.corners[c / 3][(c + 1) % 3];
        at_edge[std::minmax(u, v)].push_back(c);
      }
      for (const auto& [edge, corners] : at_edge) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
          const std::uint32_t c = corners[i], next = corners[(i + 1) % corners.size()];
          const Neighbour across = data.neighbours[c / 3][c % 3];
          ASSERT_EQ(across.slot, next == c ? no_slot : next / 3);
          ASSERT_EQ(across.flipped == 1, next != c && data.corners[c / 3][c % 3] == data.corners[next / 3][next % 3]);
        }
      }
    }
  }
}

TEST(Bvh, IsTheSameForAnyNumberOfThreads) {
  for (const TriangleMesh& mesh : {icosphere(6), scrambled(icosphere(5)), random_soup(3, 20000, 0.1), unit_square(64),
                                   fan(20000), knots(), threefold(icosphere(6)), books()}) {
    const Bvh one(mesh, {.threads = 1});
    for (const int threads : {2, 3, 20}) {
      SCOPED_TRACE(threads);
      expect_same(one.data(), Bvh(mesh, {.threads = threads}).data());
    }
  }
}

/// Coordinates of either sign around zero, zeros of both signs and triangles without area among them.
TriangleMesh soup_around_zero() {
  const double values[] = {-1, -1e-3, -1e-300, -0.0, 0.0, 1e-300, 1e-3, 1};
  std::mt19937 random(13);
  const auto value = [&] { return values[random() % 8]; };
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 300; ++i) {
    for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(value(), value(), value());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TEST(Bvh, IsTheSameWithAndWithoutVectorCode) {
  if (!uses_avx2()) GTEST_SKIP() << "this machine has no AVX2";
  std::vector<TriangleMesh> meshes{icosphere(5), scaled(icosphere(3), 1e200), fan(5000), soup_around_zero()};
  for (std::uint32_t n = 1; n < 70; ++n) meshes.push_back(soup_of(n));
  for (const TriangleMesh& mesh : meshes) {
    const Bvh with_vectors(mesh);
    const test::Setting portable(internal::portable_kernels, true);
    expect_same(with_vectors.data(), Bvh(mesh).data());
  }
}

TEST(Bvh, ItsNormalsAreUnitVectorsAcrossTheTrianglesOrZero) {
  for (const TriangleMesh& mesh : {icosphere(3), soup_of(101), soup_around_zero()}) {
    const Bvh bvh(mesh);
    const Bvh::Data& data = bvh.data();
    expect_boxes_hold_their_triangles(data);
    ASSERT_EQ(data.normals.size(), data.triangle_count());
    for (std::uint32_t slot = 0; slot < data.triangle_count(); ++slot) {
      const auto t = triangle_at(data, slot);
      const Vec3 normal = cross(t.ab, t.ac);
      const double scale = length(normal) > 0 ? 1 / length(normal) : 0;
      EXPECT_EQ(data.normals[slot][0], static_cast<float>(normal.x * scale));
      EXPECT_EQ(data.normals[slot][1], static_cast<float>(normal.y * scale));
      EXPECT_EQ(data.normals[slot][2], static_cast<float>(normal.z * scale));
    }
  }
}

TEST(HilbertIndex, GoesThroughEachCellOnceAndFromEachToOneBesideIt) {
  for (const int bits : {1, 2, 3, 4, 5}) {
    const std::uint32_t side = 1U << bits, cells = side * side * side;
    std::vector<std::array<int, 3>> way(cells, {-1, -1, -1});
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
      const std::uint32_t x = cell % side, y = cell / side % side, z = cell / side / side;
      const std::uint64_t index = hilbert_index(x, y, z, bits);
      ASSERT_LT(index, cells);
      ASSERT_EQ(way[index][0], -1);
      way[index] = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
      for (const int more : {1, 2, 8, 16})  // the curve of a finer grid goes through these cells in the same order
        ASSERT_EQ(hilbert_index(x << more, y << more, z << more, bits + more) >> 3 * more, index);
    }
    for (std::uint32_t i = 1; i < cells; ++i) {
      int apart = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) apart += std::abs(way[i][axis] - way[i - 1][axis]);
      ASSERT_EQ(apart, 1) << bits << " bits, cell " << i;
    }
  }
}

TEST(HilbertIndex, OfManyCellsIsThatOfEachByEveryInstructionSet) {
  std::mt19937 random(7);
  for (int bits = 1; bits <= 21; ++bits) {
    Cells cells;
    for (Batch<std::uint32_t>* const along : {&cells.x, &cells.y, &cells.z})
      for (std::uint32_t& cell : *along) cell = static_cast<std::uint32_t>(random()) >> (32 - bits);
    for (const BuildKernels& kernels : all_build_kernels()) {
      Batch<std::uint64_t> indices{};
      kernels.hilbert_indices(cells, bits, indices);
      for (std::size_t i = 0; i < indices.size(); ++i)
        ASSERT_EQ(indices[i], hilbert_index(cells.x[i], cells.y[i], cells.z[i], bits)) << bits << " bits, cell " << i;
    }
  }
}

/// Random half-edges in buckets of up to 70. One bucket in four has at most two of each edge, the others have pairs,
/// borders, and edges of many triangles.
struct RandomHalfEdges {
  std::vector<std::uint32_t> far, id, end;
  std::vector<std::uint8_t> upward;

  explicit RandomHalfEdges(unsigned seed) {
    std::mt19937 random(seed);
    for (std::uint32_t bucket = 0; bucket < 200; ++bucket) {
      const std::uint32_t most = bucket % 2 == 0 ? 12 : 70, size = static_cast<std::uint32_t>(random()) % most;
      std::vector<std::uint32_t> ends(size);
      for (std::uint32_t i = 0; i < size; ++i)
        ends[i] = bucket % 4 == 0 ? i / 2 : static_cast<std::uint32_t>(random()) % (1 + size / 2);
      std::shuffle(ends.begin(), ends.end(), random);
      for (const std::uint32_t at : ends) {
        id.push_back(static_cast<std::uint32_t>(4 * (far.size() / 3) + far.size() % 3));
        far.push_back(at);
        upward.push_back(static_cast<std::uint8_t>(random() % 2));
      }
      end.push_back(static_cast<std::uint32_t>(far.size()));
    }
    far.resize(far.size() + compared_at_once);
    id.resize(far.size());
    upward.resize(far.size());
  }
};

TEST(HalfEdges, AreRingsInTheOrderOfTheirIdsByEveryInstructionSet) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RandomHalfEdges edges(seed);
    for (const BuildKernels& kernels : all_build_kernels()) {
      std::vector<EdgeNeighbours> neighbours(edges.far.size() / 3 + 1);
      kernels.match_half_edges({edges.far.data(), edges.id.data(), edges.upward.data()}, edges.end.data(), 0,
                               edges.end.size(), neighbours.data());
      for (std::size_t bucket = 0; bucket < edges.end.size(); ++bucket) {
        const std::uint32_t begin = bucket == 0 ? 0 : edges.end[bucket - 1], end = edges.end[bucket];
        if (end - begin > max_compared) continue;
        for (std::uint32_t i = begin; i < end; ++i) {
          std::uint32_t next = i;
          do {
            next = next + 1 == end ? begin : next + 1;
          } while (edges.far[next] != edges.far[i]);
          const Neighbour across = neighbours[i / 3][i % 3];
          ASSERT_EQ(across.slot, next == i ? no_slot : next / 3) << "seed " << seed << ", half-edge " << i;
          ASSERT_EQ(across.flipped, next != i && edges.upward[i] == edges.upward[next] ? 1U : 0U);
        }
      }
    }
  }
}

TEST(Bvh, ItsErrorIsTheLargestRoundingOfItsVertices) {
  TriangleMesh mesh = scaled(icosphere(5), 1000);
  mesh.vertices[700].x() = 3e-308;  // denormal in the working frame
  for (const int threads : {1, 3}) {
    const Bvh bvh(mesh, {.threads = threads});
    const Bvh::Data& data = bvh.data();
    double largest = 0;
    for (const Vector3d& v : mesh.vertices) largest = std::max(largest, data.frame.rounding_of({v.x(), v.y(), v.z()}));
    EXPECT_GT(largest, 0);
    EXPECT_EQ(data.frame.error, largest);
  }
}

TEST(FrameMap, GivesTheRoundingsOfItsFrame) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double size : {1e-310, 1e-300, 1e-3, 1.0, 3e7, 1e300}) {
    for (const double offset : {0.0, 1e9}) {
      const Vec3 middle{offset * size, 0, 0}, half{size, size, size};
      const Frame frame = frame_for_box(middle - half, middle + half);
      const FrameMap map(frame);
      for (int i = 0; i < 1000; ++i) {
        Vec3 p = middle + Vec3{size * unit(random), size * unit(random), 0};
        if (i % 3 == 0) p.y = std::ldexp(unit(random), -1050 - i % 30) * (i % 2 == 0 ? 1 : size);
        ASSERT_EQ(map.rounding_of(p), frame.rounding_of(p)) << size << ' ' << offset << ' ' << p.y;
      }
    }
  }
}

TEST(Bvh, TwoBuiltAtOnceAreThoseBuiltOneByOne) {
  const TriangleMesh large = scrambled(icosphere(6)), like = fan(70000), small = icosphere(5), tiny = unit_square(1);
  const std::pair<const TriangleMesh*, const TriangleMesh*> pairs[] = {
      {&large, &large}, {&large, &like}, {&small, &large}, {&large, &tiny}, {&tiny, &tiny}};
  for (const auto& [a, b] : pairs) {
    const Bvh one_a(*a, {.threads = 1}), one_b(*b, {.threads = 1});
    for (const int threads : {1, 2, 3, 20}) {
      SCOPED_TRACE(std::to_string(a->triangles.size()) + " and " + std::to_string(b->triangles.size()) +
                   " triangles by " + std::to_string(threads) + " threads");
      const auto [tree_a, tree_b] = build_trees(*a, *b, {.threads = threads});
      expect_same(one_a.data(), tree_a.data());
      expect_same(one_b.data(), tree_b.data());
      EXPECT_NE(tree_a.data().serial, tree_b.data().serial);
    }
  }
}

TEST(Bvh, IsNotBuiltOnceItIsTooLate) {
  const TriangleMesh mesh = icosphere(3);
  const std::atomic<bool> cancel = true;
  const auto now = StopToken::Clock::now();
  const std::uint64_t before = Bvh(mesh).data().serial;
  for (const StopToken& stop : {StopToken{.cancel = &cancel}, StopToken{.deadline = now}}) {
    for (const int threads : {1, 2}) {
      EXPECT_THROW(Bvh(mesh, {threads, stop}), Stopped);
      EXPECT_THROW(static_cast<void>(build_trees(mesh, mesh, {threads, stop})), Stopped);
    }
  }
  EXPECT_EQ(Bvh(mesh, {1, {.deadline = now + std::chrono::hours(1)}}).data().serial, before + 1);
}

std::string refusal_of(const TriangleMesh& a, const TriangleMesh& b, int threads) {
  try {
    static_cast<void>(build_trees(a, b, {.threads = threads}));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Bvh, TwoBuiltAtOnceRefuseWhatOneRefusesTheFirstMeshFirst) {
  const TriangleMesh good = icosphere(5);
  TriangleMesh infinite = good, dangling = good;
  infinite.vertices[17].x() = std::numeric_limits<double>::infinity();
  dangling.triangles.back()[1] = 1000000;
  for (const int threads : {1, 2, 3}) {
    EXPECT_EQ(refusal_of(good, good, threads), "");
    EXPECT_NE(refusal_of(infinite, good, threads), "");
    EXPECT_NE(refusal_of(infinite, dangling, threads), refusal_of(dangling, infinite, threads));
    EXPECT_EQ(refusal_of(infinite, dangling, threads), refusal_of(infinite, good, threads));
    EXPECT_EQ(refusal_of(dangling, infinite, threads), refusal_of(good, dangling, threads));
  }
}

TEST(Bvh, ItsBoxIsThatOfTheVerticesThatTrianglesUse) {
  for (const int threads : {1, 2}) {
    TriangleMesh mesh = icosphere(5);
    const Eigen::AlignedBox3d box = Bvh(mesh, {.threads = threads}).bounding_box();
    for (const double x : {3.0, -3.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
      mesh.vertices.emplace_back(x, 0, x);
      const Bvh bvh(mesh, {.threads = threads});
      EXPECT_EQ(bvh.bounding_box().min(), box.min()) << x;
      EXPECT_EQ(bvh.bounding_box().max(), box.max()) << x;
    }
  }
}

TEST(Bvh, NearestIsThatOfTestingEveryTriangle) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  for (const std::uint32_t n : {1U, 3U, 31U, 33U, 200U, 500U}) {
    const TriangleMesh mesh = random_soup(n, static_cast<int>(n), n % 2 == 0 ? 0.02 : 0.3);
    const Bvh bvh(mesh);
    for (int i = 0; i < 30; ++i) {
      const double reach = i % 3 == 0 ? 1000 : 1;
      const Vector3d query(uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach));
      const ExactLength truth = exact_distance(query, mesh);
      const ClosestPoint found = closest_point(bvh, query);
      EXPECT_GE(truth.compare(found.distance.lower), 0);
      EXPECT_LE(truth.compare(found.distance.upper), 0);
      EXPECT_LE(found.distance.upper - found.distance.lower, 1e-12 * reach);
      EXPECT_LE((found.point.position - query).norm(), found.distance.upper * (1 + 1e-12) + 1e-12);
      EXPECT_LE(exact_distance(query, corners(mesh, found.point.triangle)).compare(found.distance.upper + 1e-12), 0);
    }
  }
}

/// The slots of the triangles that `slot` leads to, ascending.
std::vector<std::uint32_t> around(const Bvh::Data& data, std::uint32_t slot) {
  std::vector<std::uint32_t> found;
  for (const Neighbour& across : data.neighbours[slot])
    if (across.slot != no_slot) found.push_back(across.slot);
  std::sort(found.begin(), found.end());
  return found;
}

/// Triangles that are segments have no other triangle across an edge: a walk goes on at their ends.
TEST(Bvh, SegmentsOfAChainLeadToThoseBeforeAndAfterThem) {
  constexpr std::uint32_t count = 20;
  for (const bool welded : {true, false}) {
    TriangleMesh chain;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto first = static_cast<std::uint32_t>(chain.vertices.size());
      chain.vertices.emplace_back(i, 0, 0);
      if (!welded || i + 1 == count) chain.vertices.emplace_back(i + 1, 0, 0);
      // The doubled corner is the first, the second or the third one, at the near or the far end.
      Triangle t{first, first + 1, first + i % 2};
      std::rotate(t.begin(), t.begin() + i % 3, t.end());
      chain.triangles.push_back(t);
    }
    const Bvh bvh(chain);
    const Bvh::Data& data = bvh.data();
    for (std::uint32_t slot = 0; slot < count; ++slot) {
      const std::uint32_t i = data.triangle_of_slot[slot];
      std::vector<std::uint32_t> expected;
      for (std::uint32_t other = 0; other < count; ++other)
        if (data.triangle_of_slot[other] + 1 == i || data.triangle_of_slot[other] == i + 1) expected.push_back(other);
      EXPECT_EQ(around(data, slot), expected) << "segment " << i;
    }
  }
}

/// Where a segment lies along an edge of a triangle, both lead to each other as before.
TEST(Bvh, ASegmentOnAnEdgeLeadsToTheTriangleThere) {
  TriangleMesh mesh = single_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.triangles.push_back({0, 1, 1});
  const Bvh bvh(mesh);
  const Bvh::Data& data = bvh.data();
  for (std::uint32_t slot = 0; slot < 2; ++slot) {
    const std::vector<std::uint32_t> found = around(data, slot);
    EXPECT_NE(std::find(found.begin(), found.end(), 1 - slot), found.end());
  }
}

/// Work per triangle of a fan must not grow with the number of triangles around its hub: with 1e5 of them an adjacency
/// that is quadratic in the valence takes minutes and meets the tests' time limit.
TEST(Bvh, BuildsAFanOfAHundredThousandTriangles) {
  constexpr std::uint32_t n = 100000;
  const Bvh bvh(fan(n), {.threads = 2});
  const Bvh::Data& data = bvh.data();
  std::size_t linked = 0;
  for (const auto& neighbours : data.neighbours)
    for (const Neighbour& neighbour : neighbours) linked += neighbour.slot != no_slot ? 1 : 0;
  EXPECT_EQ(linked, 2 * std::size_t{n});
  EXPECT_NEAR(closest_point(bvh, {0.5, 0.2, 3}).distance.upper, 3, 1e-9);
}

TEST(Bvh, KeepsDegenerateAndSingleTriangles) {
  for (const TriangleMesh& mesh :
       {single_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), single_triangle({0, 0, 0}, {0, 0, 0}, {0, 1, 0}),
        single_triangle({2, 2, 2}, {2, 2, 2}, {2, 2, 2})}) {
    const Bvh bvh(mesh);
    EXPECT_EQ(bvh.triangle_count(), 1U);
    const ClosestPoint found = closest_point(bvh, {0, 3, 0});
    const ExactLength truth = exact_distance({0, 3, 0}, mesh);
    EXPECT_GE(truth.compare(found.distance.lower), 0);
    EXPECT_LE(truth.compare(found.distance.upper), 0);
    EXPECT_NEAR(found.distance.lower, truth.approximate(), 1e-12);
  }
}

}  // namespace bvh_test
