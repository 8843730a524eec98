// SPDX-License-Identifier: MIT
// Meshes and lists that are kept in a folder: what is read is what was appended, and the files leave no names.
#include "mesh/stored_mesh.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "datasets.h"
#include "datasets/analytic_meshes.h"
#include "mesh/readers.h"
#include "mesh/stored_lists.h"
#include "meshbound/error.h"
#include "meshbound/mesh_view.h"
#include "numeric/numbers_below.h"
#include "numeric/ranked_numbers.h"
#include "tiles/decimate_in_tiles.h"
#include "tiles/equal_positions.h"
#include "tiles/measure_in_tiles.h"
#include "tiles/tile_cut.h"

namespace meshbound {
namespace stored_mesh_test {

/// A folder of its own, removed at the end.
class Stored : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "stored_XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    space_.folder = name;
  }
  void TearDown() override { std::filesystem::remove_all(space_.folder); }

  [[nodiscard]] MeshInSpace stored(const TriangleMesh& mesh) const { return MeshInSpace(space_, mesh); }
  [[nodiscard]] std::string file(const std::string& name) const { return space_.folder / name; }

  StoreSpace space_;
};

/// Numbers that are spread over [0, size).
std::vector<std::uint32_t> spread(std::size_t count, std::uint32_t size) {
  std::vector<std::uint32_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint32_t>(i * 2654435761u % size);
  return numbers;
}

TEST_F(Stored, ItemsAreReadAsTheyWereAppended) {
  for (const StoreSpace& space : {StoreSpace(), space_}) {
    ItemStore<std::uint64_t> items(space);
    const std::size_t count = 300000;  // several chunks, the last one in part
    for (std::uint64_t i = 0; i < count; ++i) items.append(i * i);
    ASSERT_EQ(items.size(), count);
    items.for_each([](std::size_t i, std::uint64_t item) { ASSERT_EQ(item, i * i); });
    std::vector<std::uint64_t> some(70000);
    for (const std::size_t first : {0, 32760, 100000, 230000}) {
      items.read(first, some);
      for (std::size_t i = 0; i < some.size(); ++i) ASSERT_EQ(some[i], (first + i) * (first + i)) << first;
    }
  }
}

TEST_F(Stored, ListsAreReadAsTheyWereAppended) {
  for (const StoreSpace& space : {StoreSpace(), space_}) {
    StoredLists lists(space);
    GrowingLists growing(space, 7);
    std::vector<std::vector<std::uint32_t>> expected(7);
    for (std::uint32_t k = 0; k < 5000; ++k) {
      lists.append(spread(k % 5, 1000 + k));
      growing.append(k * k % 7, k);
      expected[k * k % 7].push_back(k);
    }
    const std::vector<std::uint32_t> asked = spread(3000, 5000);
    const NumberLists some = lists.at(asked);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const auto list = some[i];
      ASSERT_EQ(std::vector<std::uint32_t>(list.begin(), list.end()), spread(asked[i] % 5, 1000 + asked[i]));
      ASSERT_EQ(lists.size_of(asked[i]), asked[i] % 5);
    }
    ListReader reader(lists, 250);
    for (std::uint32_t k = 250; k < 5000; ++k) {
      const auto list = reader.next();
      ASSERT_EQ(std::vector<std::uint32_t>(list.begin(), list.end()), spread(k % 5, 1000 + k));
    }
    for (std::size_t k = 0; k < 7; ++k) {
      EXPECT_EQ(growing[k], expected[k]);
      EXPECT_EQ(growing.size_of(k), expected[k].size());
    }
  }
}

TEST_F(Stored, FilesHaveNoNames) {
  ItemStore<int> items(space_);
  for (int i = 0; i < 1000000; ++i) items.append(i);
  EXPECT_TRUE(std::filesystem::is_empty(space_.folder));
}

TEST_F(Stored, AFolderThatIsNotThereIsNamed) {
  try {
    const ItemStore<int> items({file("not there")});
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("not there: cannot make a temporary file"), std::string::npos)
        << error.what();
  }
}

TEST_F(Stored, AFullDiskIsAnErrorThatNamesTheFolder) {
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1 << 20, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  ItemStore<std::uint64_t> items(space_);
  EXPECT_THROW(for (std::uint64_t i = 0; i < 300000; ++i) items.append(i), IoError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old);
}

TEST(RankedNumbers, AreSortedAndFindTheirIndices) {
  const RankedNumbers numbers(
      std::vector<std::vector<std::uint32_t>>{{70000, 64, 4095, 0}, {}, {4096, 63, 64, 4294967294, 70000, 1}});
  const std::vector<std::uint32_t> expected{0, 1, 63, 64, 4095, 4096, 70000, 4294967294};
  ASSERT_EQ(numbers.ascending(), expected);
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(numbers.index_of(expected[i]), i);
    EXPECT_TRUE(numbers.contains(expected[i]));
  }
  for (const std::uint32_t none : {2U, 65U, 5000U, 70001U, 4294967293U}) EXPECT_FALSE(numbers.contains(none));
  EXPECT_TRUE(RankedNumbers(std::vector<Triangle>()).ascending().empty());
}

TEST_F(Stored, APartIsThatOfTheMeshInMemory) {
  const TriangleMesh mesh = datasets::terrain(1, 60, 7);
  const MeshInSpace all = stored(mesh);
  const auto asked = spread(900, static_cast<std::uint32_t>(mesh.triangles.size()));
  const MeshPart part = part_of(all, asked);
  ASSERT_EQ(part.mesh.triangles.size(), asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = part.mesh.triangles[i][k];
      EXPECT_EQ(part.vertices[v], mesh.triangles[asked[i]][k]);
      EXPECT_EQ(part.mesh.vertices[v], mesh.vertices[mesh.triangles[asked[i]][k]]);
    }
  }
  EXPECT_EQ(loaded(all).vertices, mesh.vertices);
  EXPECT_EQ(loaded(all).triangles, mesh.triangles);
}

TEST_F(Stored, SummariesAreThoseOfTheMeshInMemory) {
  TriangleMesh two = datasets::torus(1, 0.3, 200, 60);
  const auto add = [&](const TriangleMesh& other) {
    const auto first = static_cast<std::uint32_t>(two.vertices.size());
    two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& [a, b, c] : other.triangles) two.triangles.push_back({a + first, b + first, c + first});
  };
  add(datasets::cube(1, 3));
  TriangleMesh open = two;
  open.triangles.pop_back();
  TriangleMesh thick = two;
  for (int k = 0; k < 4; ++k) thick.triangles.push_back(two.triangles[11000]);
  for (const TriangleMesh& mesh : {two, open, thick}) {
    const MeshSummary expected = summarise(mesh), found = summarise(stored(mesh), 1000);
    EXPECT_EQ(found.vertices, expected.vertices);
    EXPECT_EQ(found.faces, expected.faces);
    EXPECT_EQ(found.components, 2u);
    EXPECT_EQ(found.components, expected.components);
    EXPECT_EQ(found.closed, expected.closed);
    EXPECT_EQ(found.bbox_diagonal, expected.bbox_diagonal);
  }
  EXPECT_TRUE(summarise(stored(two), 1000).closed);
  EXPECT_FALSE(summarise(stored(open), 1000).closed);
  EXPECT_FALSE(summarise(stored(thick), 1000).closed);
}

TEST_F(Stored, FilesAreReadAsIntoMemory) {
  const TriangleMesh mesh = datasets::terrain(1, 60, 7);
  for (const std::string name : {"m.ply", "m.stl", "m.obj", "m.off", "m.glb", "text.ply", "text.stl"}) {
    write_mesh(file(name), mesh, {.ascii = name.starts_with("text")});
    const MeshFile whole = read_mesh(file(name));
    MeshInSpace into(space_);
    std::string bytes;
    const MeshFile content = read_mesh_into(file(name), {}, into, [&](std::string_view some) { bytes += some; });
    EXPECT_EQ(loaded(into).vertices, whole.mesh.vertices) << name;
    EXPECT_EQ(loaded(into).triangles, whole.mesh.triangles) << name;
    EXPECT_EQ(content.dropped, whole.dropped) << name;
    std::ifstream stream(file(name), std::ios::binary);
    EXPECT_EQ(bytes, std::string(std::istreambuf_iterator<char>(stream), {})) << name;
  }
}

/// What reading throws.
template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(Stored, FilesAreRefusedAsIntoMemory) {
  TriangleMesh mesh = datasets::terrain(1, 300, 7);  // larger than what is read at once
  mesh.vertices[77000].x() = std::numeric_limits<double>::infinity();
  const auto expect_same_refusal = [&](const std::string& name) {
    const std::string whole = refusal([&] { (void)read_mesh(file(name)); });
    EXPECT_NE(whole, "");
    EXPECT_EQ(refusal([&] {
                MeshInSpace into(space_);
                (void)read_mesh_into(file(name), {}, into);
              }),
              whole);
  };
  {
    std::ofstream ply(file("infinite.ply"), std::ios::binary);
    ply << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices.size()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.triangles.size()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Eigen::Vector3d& p : mesh.vertices) ply.write(reinterpret_cast<const char*>(p.data()), 24);
    for (const Triangle& t : mesh.triangles) ply.put(3).write(reinterpret_cast<const char*>(t.data()), 12);
  }
  expect_same_refusal("infinite.ply");
  for (const std::size_t size : {100u, 2000000u, 4300001u}) {
    std::filesystem::copy_file(file("infinite.ply"), file("short.ply"),
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(file("short.ply"), size);
    expect_same_refusal("short.ply");
  }
  expect_same_refusal("not there.ply");
}

/// Items in a folder are cut as in memory, for any number of them in memory at once.
void expect_tiles_of_items_in_memory(const std::vector<CutItem>& all, const StoreSpace& space) {
  for (const TileCut& cut : {TileCut{0, 0.5}, TileCut{1, 1.0 / 3}, TileCut{2, 0.999}}) {
    for (const std::uint64_t max_weight : {40u, 3000u, 1000000u}) {
      using Tiles = std::vector<std::vector<std::uint32_t>>;
      Tiles expected;
      cut_into_tiles(all, max_weight, cut,
                     [&](std::span<const std::uint32_t> tile) { expected.emplace_back(tile.begin(), tile.end()); });
      for (const std::size_t max_in_memory : {256, 1000, 1000000}) {
        ItemStore<CutItem> items(space);
        items.append(all);
        Tiles tiles;
        cut_into_tiles(
            std::move(items), max_weight, cut, space,
            [&](std::span<const std::uint32_t> tile) { tiles.emplace_back(tile.begin(), tile.end()); }, max_in_memory);
        EXPECT_EQ(tiles, expected);
      }
    }
  }
}

TEST_F(Stored, ItemsAreCutIntoTheTilesOfItemsInMemory) {
  const TriangleMesh mesh = datasets::terrain(1, 80, 7);
  std::vector<CutItem> items;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) items.push_back({to_vec3(mesh.vertices[v]), v, 1 + v % 5});
  expect_tiles_of_items_in_memory(items, space_);
}

TEST_F(Stored, ItemsAreCutIntoTheTilesOfItemsInMemoryWhereSamplesMislead) {
  std::vector<CutItem> items;  // one of eight lies elsewhere, and samples take one of a power of two
  for (std::uint32_t v = 0; v < 5000; ++v) items.push_back({{v % 8 == 0 ? 0.001 * v : v % 3 * 10.0, 0, 0}, v, 1});
  expect_tiles_of_items_in_memory(items, space_);
  for (CutItem& item : items) item.position = {1, 1, 1};
  expect_tiles_of_items_in_memory(items, space_);
}

TEST_F(Stored, EqualPositionsAreFoundBucketByBucket) {
  TriangleMesh mesh = datasets::torus(1, 0.3, 60, 24);
  EXPECT_TRUE(first_at_positions(stored(mesh), 100).empty());
  const std::size_t half = mesh.vertices.size();
  for (std::size_t v = 0; v < half; v += 3) mesh.vertices.push_back(mesh.vertices[v]);
  const std::vector<std::uint32_t> first = first_at_positions(stored(mesh), 100);
  ASSERT_EQ(first.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < first.size(); ++v) EXPECT_EQ(first[v], v < half ? v : 3 * (v - half));
}

TEST_F(Stored, TilesOfAStoredMeshGiveTheBitsOfOneInMemory) {
  TriangleMesh terrain = datasets::terrain(1, 60, 7);
  terrain.vertices.push_back(terrain.vertices[17]);  // a position of two vertices
  terrain.triangles.back()[0] = static_cast<std::uint32_t>(terrain.vertices.size() - 1);
  const MeshInSpace mesh = stored(terrain);
  SimplifyOptions options;
  options.tolerance = 0.001;
  ThreadRunner threads(2);
  const SimplifiedLevel in_folder = decimate_in_tiles(mesh, options, {700}, threads).last();
  const SimplifiedLevel in_memory = decimate_in_tiles(MeshInMemory(terrain), options, {700}, threads).last();
  EXPECT_LT(in_folder.mesh.triangles.size(), terrain.triangles.size());
  EXPECT_EQ(in_folder.mesh.vertices, in_memory.mesh.vertices);
  EXPECT_EQ(in_folder.mesh.triangles, in_memory.mesh.triangles);
  EXPECT_EQ(in_folder.source_triangle, in_memory.source_triangle);

  const HausdorffDistance distance = measure_in_tiles(mesh, MeshInMemory(in_folder.mesh), {}, {700}, threads);
  const HausdorffDistance expected = hausdorff_distance_in_tiles(terrain, in_folder.mesh, {}, {700});
  EXPECT_EQ(distance.bounds.lower, expected.bounds.lower);
  EXPECT_EQ(distance.bounds.upper, expected.bounds.upper);
  EXPECT_EQ(distance.a_to_b.witness.from.position, expected.a_to_b.witness.from.position);
  EXPECT_EQ(distance.b_to_a.witness.nearest.triangle, expected.b_to_a.witness.nearest.triangle);
}

}  // namespace stored_mesh_test
}  // namespace meshbound
