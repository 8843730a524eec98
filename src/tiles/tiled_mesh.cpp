// SPDX-License-Identifier: MIT
#include "tiles/tiled_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "mesh/weld.h"
#include "meshbound/error.h"
#include "numeric/no_index.h"
#include "numeric/numbers_below.h"
#include "simplify/ended_by.h"

namespace meshbound {
namespace {

/// Rings of triangles around a seam that a later pass works on. The triangles may be large; what lies further away was
/// simplified as far as possible.
constexpr int rings_around_seam = 4;

/// By vertex: the first one at its position.
std::vector<std::uint32_t> first_at_positions(const TriangleMesh& mesh) {
  Welder welder;
  std::vector<std::uint32_t> first, by_vertex;
  by_vertex.reserve(mesh.vertices.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::uint32_t position = welder.index_of(mesh.vertices[v]);
    if (position == first.size()) first.push_back(v);
    by_vertex.push_back(first[position]);
  }
  return by_vertex;
}

std::uint32_t index_in(std::span<const std::uint32_t> ascending, std::uint32_t number) {
  return static_cast<std::uint32_t>(std::lower_bound(ascending.begin(), ascending.end(), number) - ascending.begin());
}

/// The lists that `for_each(add)` makes by calling add(list, number), with numbers in the order of the calls.
template <class ForEach>
NumberLists lists_of(std::size_t lists, const ForEach& for_each) {
  NumberLists result;
  result.begin.assign(lists + 1, 0);
  for_each([&](std::uint32_t list, std::uint32_t) { ++result.begin[list + 1]; });
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  result.numbers.resize(result.begin.back());
  std::vector<std::uint32_t> next(result.begin.begin(), result.begin.end() - 1);
  for_each([&](std::uint32_t list, std::uint32_t number) { result.numbers[next[list]++] = number; });
  return result;
}

template <class T>
void release(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

}  // namespace

TiledMesh::TiledMesh(const TriangleMesh& original, const std::vector<bool>& locked)
    : original_(original), locked_(locked) {}

/// The tiles of a pass as jobs.
class TiledMesh::Jobs : public TileJobs {
 public:
  Jobs(const TiledMesh& mesh, const Pass& how) : mesh_(mesh), how_(how), tiles_(mesh.triangles_.size()) {}

  [[nodiscard]] std::size_t size() const override { return tiles_.size(); }
  [[nodiscard]] std::uint64_t weight(std::size_t job) const override {
    const auto triangles = mesh_.triangles_[job].size();
    return mesh_.is_original_ ? triangles : std::max(triangles, mesh_.originals_[job].size());
  }
  void run(std::size_t job) override {
    tiles_[job].output = how_.simplify(mesh_.input_of(static_cast<std::uint32_t>(job), tiles_[job]));
  }
  [[nodiscard]] std::string packed(std::size_t job) const override {
    const Tile& tile = tiles_[job];
    return packed_tile(tile.output, start_of(job, part_of(mesh_.mesh(), tile.triangles)));
  }
  void unpack(std::size_t job, std::string_view bytes) override {
    MeshPart part = mesh_.find_numbers(static_cast<std::uint32_t>(job), tiles_[job]);
    tiles_[job].output = unpacked_tile(bytes, start_of(job, std::move(part)));
  }
  [[nodiscard]] bool is_complete(std::size_t job) const override {
    const EndedBy ended_by = tiles_[job].output.ended_by;
    return ended_by != EndedBy::TimeLimit && ended_by != EndedBy::Cancelled;
  }
  void progress(double share) override {
    if (how_.progress) how_.progress(share);
  }

  [[nodiscard]] std::vector<Tile>& tiles() { return tiles_; }

 private:
  [[nodiscard]] TileStart start_of(std::size_t job, MeshPart part) const {
    return {std::move(part.mesh), mesh_.cover_of(static_cast<std::uint32_t>(job), tiles_[job]), mesh_.is_original_};
  }

  const TiledMesh& mesh_;
  const Pass& how_;
  std::vector<Tile> tiles_;
};

TiledMesh::PassFacts TiledMesh::pass(const Pass& how, JobRunner& runner) {
  find_owners(how.cut, how.max_triangles);
  find_triangles();
  find_what_stays();
  if (!is_original_) find_originals();
  Jobs jobs(*this, how);
  runner.run(jobs);
  PassFacts facts;
  facts.tiles = jobs.size();
  for (const Tile& tile : jobs.tiles()) {
    facts.ended_by = joint_reason(facts.ended_by, tile.output.ended_by);
    facts.counts += tile.output.counts;
    facts.dropped_triangles += tile.output.dropped_triangles;
    facts.split = facts.split || tile.output.split;
  }
  join(jobs.tiles());
  return facts;
}

std::uint32_t TiledMesh::tile_of(std::uint32_t triangle) const {
  const auto& [a, b, c] = mesh().triangles[triangle];
  return owner_[a] == owner_[b] && owner_[b] == owner_[c] ? owner_[a] : no_index;
}

/// Whether a tile has the triangle, as its own or as one that stays.
bool TiledMesh::is_in(std::uint32_t tile, std::uint32_t triangle) const {
  const auto& corners = mesh().triangles[triangle];
  return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return owner_[v] == tile; });
}

/// The tile that may cover an original anew: it has all triangles of the cover, and some are its own.
std::uint32_t TiledMesh::tile_of_cover(std::span<const std::uint32_t> cover) const {
  for (const std::uint32_t f : cover) {
    const std::uint32_t tile = tile_of(f);
    if (tile == no_index) continue;
    const bool has_all = std::all_of(cover.begin(), cover.end(), [&](std::uint32_t g) { return is_in(tile, g); });
    return has_all ? tile : no_index;
  }
  return no_index;
}

/// Calls use(original, its cover).
template <class Use>
void TiledMesh::for_each_cover(const Use& use) const {
  if (is_original_) {
    for (std::uint32_t t = 0; t < original_.triangles.size(); ++t) use(t, std::span(&t, 1));
  } else {
    for (std::uint32_t t = 0; t < proven_.cover.size(); ++t) use(t, proven_.cover[t]);
  }
}

/// Marks the vertices around those that stayed in the pass before.
std::vector<std::uint8_t> TiledMesh::vertices_near_seams() const {
  std::vector<std::uint8_t> is_near = at_seam_;
  for (int ring = 0; ring < rings_around_seam; ++ring) {
    const std::vector<std::uint8_t> inside = is_near;
    for (const Triangle& corners : mesh().triangles) {
      if (std::none_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return inside[v] != 0; })) continue;
      for (const std::uint32_t v : corners) is_near[v] = 1;
    }
  }
  return is_near;
}

/// By vertex, how many originals it stands for, and 1 for itself.
std::vector<std::uint32_t> TiledMesh::weights() const {
  std::vector<std::uint32_t> weights(mesh().vertices.size(), is_original_ ? 0 : 1);
  for_each_cover([&](std::uint32_t, std::span<const std::uint32_t> cover) {
    if (!cover.empty()) ++weights[joined(mesh().triangles[cover[0]][0])];
  });
  return weights;
}

void TiledMesh::find_owners(const TileCut& cut, std::size_t max_triangles) {
  if (is_original_) position_ = first_at_positions(original_);
  const std::size_t count = mesh().vertices.size();
  std::vector<std::uint32_t> items;
  if (is_original_) {
    for (std::uint32_t v = 0; v < count; ++v)
      if (position_[v] == v) items.push_back(v);
  } else {
    const std::vector<std::uint8_t> is_near = vertices_near_seams();
    for (std::uint32_t v = 0; v < count; ++v)
      if (is_near[v] != 0) items.push_back(v);
  }
  const auto position = [&](std::uint32_t v) { return mesh().vertices[v]; };
  const NumberLists tiles = cut_into_tiles(std::move(items), position, weights(), max_triangles, cut);
  owner_.assign(count, no_index);
  for (std::uint32_t tile = 0; tile < tiles.size(); ++tile)
    for (const std::uint32_t v : tiles[tile]) owner_[v] = tile;
  if (is_original_)
    for (std::uint32_t v = 0; v < count; ++v) owner_[v] = owner_[position_[v]];
  triangles_.begin.assign(tiles.size() + 1, 0);
}

void TiledMesh::find_triangles() {
  triangles_ = lists_of(triangles_.size(), [&](const auto& add) {
    for (std::uint32_t t = 0; t < mesh().triangles.size(); ++t) {
      const auto& [a, b, c] = mesh().triangles[t];
      const std::uint32_t i = owner_[a], j = owner_[b], k = owner_[c];
      if (i != no_index) add(i, t);
      if (j != no_index && j != i) add(j, t);
      if (k != no_index && k != i && k != j) add(k, t);
    }
  });
}

/// Makes the vertices of a triangle stay where they are. `is_seam`: because another tile has them, too.
void TiledMesh::stay(std::uint32_t triangle, bool is_seam) {
  for (const std::uint32_t v : mesh().triangles[triangle]) {
    stays_[joined(v)] = 1;
    if (is_seam) at_seam_[joined(v)] = 1;
  }
}

/// Triangles that are no tile's own stay, and so does what covers an original together with triangles that the tile
/// does not have: so the cover holds. Where several tiles meet is the seam that later passes go over.
void TiledMesh::find_what_stays() {
  stays_.assign(mesh().vertices.size(), 0);
  at_seam_.assign(mesh().vertices.size(), 0);
  for (std::uint32_t t = 0; t < mesh().triangles.size(); ++t) {
    if (tile_of(t) != no_index) continue;
    const auto& corners = mesh().triangles[t];
    stay(t, std::none_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return owner_[v] == no_index; }));
  }
  for_each_cover([&](std::uint32_t, std::span<const std::uint32_t> cover) {
    if (cover.size() < 2 || tile_of_cover(cover) != no_index) return;
    const bool is_seam = std::none_of(cover.begin(), cover.end(), [&](std::uint32_t f) {
      const auto& corners = mesh().triangles[f];
      return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return owner_[v] == no_index; });
    });
    for (const std::uint32_t f : cover) stay(f, is_seam);
  });
  if (!is_original_) return;
  for (std::uint32_t v = 0; v < stays_.size(); ++v) {
    stays_[v] = stays_[position_[v]];
    at_seam_[v] = at_seam_[position_[v]];
  }
}

/// The originals of a tile: those that its own triangles cover, also in part, and those that its triangles are near.
void TiledMesh::find_originals() {
  originals_ = lists_of(triangles_.size(), [&](const auto& add) {
    for_each_cover([&](std::uint32_t t, std::span<const std::uint32_t> cover) {
      for (const std::uint32_t f : cover)
        if (const std::uint32_t tile = tile_of(f); tile != no_index) add(tile, t);
    });
    for (std::uint32_t tile = 0; tile < triangles_.size(); ++tile)
      for (const std::uint32_t f : triangles_[tile]) add(tile, proven_.near[f]);
  });
}

std::vector<bool> TiledMesh::locked(const std::vector<std::uint32_t>& vertices) const {
  std::vector<bool> locked(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    locked[i] = stays_[vertices[i]] != 0 || (!locked_.empty() && locked_[source_of(vertices[i])]);
  return locked;
}

/// Finds which vertices, triangles and originals a tile has; returns the tile as a mesh.
MeshPart TiledMesh::find_numbers(std::uint32_t tile, Tile& numbers) const {
  const auto own = triangles_[tile];
  numbers.triangles.assign(own.begin(), own.end());
  MeshPart part = part_of(mesh(), numbers.triangles);
  numbers.vertices = std::move(part.vertices);
  if (is_original_) {
    numbers.originals = numbers.triangles;
    return part;
  }
  numbers.originals.assign(originals_[tile].begin(), originals_[tile].end());
  std::sort(numbers.originals.begin(), numbers.originals.end());
  numbers.originals.erase(std::unique(numbers.originals.begin(), numbers.originals.end()), numbers.originals.end());
  return part;
}

TileInput TiledMesh::input_of(std::uint32_t tile, Tile& numbers) const {
  MeshPart part = find_numbers(tile, numbers);
  if (is_original_) return {std::move(part.mesh), std::nullopt, locked(numbers.vertices)};
  TileInput input{part_of(original_, numbers.originals).mesh, ProvenMesh(), locked(numbers.vertices)};
  ProvenMesh& start = *input.start;
  start.mesh = std::move(part.mesh);
  start.cover = cover_of(tile, numbers);
  for (const std::uint32_t f : numbers.triangles) start.near.push_back(index_in(numbers.originals, proven_.near[f]));
  for (std::size_t k = 0; k < numbers.originals.size(); ++k)
    start.is_covered.push_back(tile_of_cover(proven_.cover[numbers.originals[k]]) != tile);
  return input;
}

/// By original of a tile: the triangles of the tile that cover it, where the tile may cover it anew. All numbers are
/// those of the tile.
NumberLists TiledMesh::cover_of(std::uint32_t tile, const Tile& numbers) const {
  NumberLists lists;
  for (std::uint32_t k = 0; k < numbers.originals.size(); ++k) {
    const std::uint32_t t = numbers.originals[k];
    if (is_original_) {
      if (tile_of(t) == tile) lists.numbers.push_back(k);
    } else if (tile_of_cover(proven_.cover[t]) == tile) {
      for (const std::uint32_t f : proven_.cover[t]) lists.numbers.push_back(index_in(numbers.triangles, f));
    }
    lists.end_list();
  }
  return lists;
}

/// The mesh that tiles are joined into.
struct TiledMesh::Joined {
  ProvenMesh whole;
  std::vector<std::uint32_t> source_vertex, source_triangle;
  std::vector<std::uint8_t> at_seam;
  std::vector<std::uint32_t> vertex_now;    ///< by vertex before that stays; `no_index` until it is met
  std::vector<std::uint32_t> triangle_now;  ///< by triangle before; `no_index` where it has gone
};

/// The number in the joined mesh of a vertex that comes from vertex `before` and stands at `position`. A vertex that
/// stays is one vertex for all tiles.
std::uint32_t TiledMesh::join_vertex(Joined& into, std::uint32_t before, const Eigen::Vector3d& position) const {
  std::uint32_t* const now = stays_[before] != 0 ? &into.vertex_now[joined(before)] : nullptr;
  if (now != nullptr && *now != no_index) return *now;
  const auto number = static_cast<std::uint32_t>(into.whole.mesh.vertices.size());
  into.whole.mesh.vertices.push_back(position);
  into.source_vertex.push_back(source_of(before));
  into.at_seam.push_back(at_seam_[before]);
  if (now != nullptr) *now = number;
  return number;
}

void TiledMesh::join_triangle(Joined& into, std::uint32_t before, const Triangle& corners, std::uint32_t near) const {
  into.triangle_now[before] = static_cast<std::uint32_t>(into.whole.mesh.triangles.size());
  into.whole.mesh.triangles.push_back(corners);
  into.source_triangle.push_back(is_original_ ? before : source_triangle_[before]);
  into.whole.near.push_back(near);
}

/// Adds the triangles of a tile, except those that stay, which are there already.
void TiledMesh::join_tile(Joined& into, Tile& tile) {
  TileOutput& output = tile.output;
  std::vector<std::uint32_t> number;
  for (std::size_t v = 0; v < output.source_vertex.size(); ++v)
    number.push_back(join_vertex(into, tile.vertices[output.source_vertex[v]], output.proven.mesh.vertices[v]));
  for (std::size_t i = 0; i < output.source_triangle.size(); ++i) {
    const std::uint32_t before = tile.triangles[output.source_triangle[i]];
    if (tile_of(before) != no_index) {
      const auto& [a, b, c] = output.proven.mesh.triangles[i];
      join_triangle(into, before, {number[a], number[b], number[c]}, tile.originals[output.proven.near[i]]);
    }
    tile.now.push_back(into.triangle_now[before]);
  }
  for (const std::uint32_t t : output.kept)
    if (!is_original_ || tile_of(tile.originals[t]) != no_index) kept_.push_back(tile.originals[t]);
  output.proven.mesh = {};
  release(output.proven.near);
}

void TiledMesh::join(std::vector<Tile>& tiles) {
  Joined into;
  into.vertex_now.assign(mesh().vertices.size(), no_index);
  into.triangle_now.assign(mesh().triangles.size(), no_index);
  for (std::uint32_t f = 0; f < mesh().triangles.size(); ++f) {
    if (tile_of(f) != no_index) continue;
    Triangle corners = mesh().triangles[f];
    for (std::uint32_t& v : corners) v = join_vertex(into, v, mesh().vertices[v]);
    join_triangle(into, f, corners, is_original_ ? f : proven_.near[f]);
  }
  for (Tile& tile : tiles) join_tile(into, tile);
  join_covers(tiles, into);
  proven_ = std::move(into.whole);
  source_vertex_ = std::move(into.source_vertex);
  source_triangle_ = std::move(into.source_triangle);
  at_seam_ = std::move(into.at_seam);
  is_original_ = false;
  triangles_ = originals_ = {};
  release(owner_), release(stays_), release(position_);
}

void TiledMesh::join_covers(const std::vector<Tile>& tiles, Joined& into) const {
  const auto for_each = [&](const auto& add) {
    for_each_cover([&](std::uint32_t t, std::span<const std::uint32_t> cover) {
      if (tile_of_cover(cover) != no_index) return;
      for (const std::uint32_t f : cover) {
        if (into.triangle_now[f] == no_index)
          throw Error("internal error: a tile changed a triangle that another tile relies on");
        add(t, into.triangle_now[f]);
      }
    });
    for (std::uint32_t i = 0; i < tiles.size(); ++i) {
      const Tile& tile = tiles[i];
      for (std::uint32_t k = 0; k < tile.originals.size(); ++k) {
        const std::uint32_t t = tile.originals[k];
        const std::uint32_t owner = is_original_ ? tile_of(t) : tile_of_cover(proven_.cover[t]);
        if (owner == i)
          for (const std::uint32_t f : tile.output.proven.cover[k]) add(t, tile.now[f]);
      }
    }
  };
  into.whole.cover = lists_of(original_.triangles.size(), for_each);
}

void TiledMesh::current_mesh(SimplifiedLevel& into) const {
  const auto ordered_by = [](const std::vector<std::uint32_t>& source) {
    std::vector<std::uint32_t> order = numbers_below(source.size());
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t i, std::uint32_t j) { return source[i] < source[j]; });
    return order;
  };
  std::vector<std::uint32_t> number(source_vertex_.size());
  for (const std::uint32_t v : ordered_by(source_vertex_)) {
    number[v] = static_cast<std::uint32_t>(into.mesh.vertices.size());
    into.mesh.vertices.push_back(mesh().vertices[v]);
    into.source_vertex.push_back(source_vertex_[v]);
  }
  for (const std::uint32_t t : ordered_by(source_triangle_)) {
    const auto& [a, b, c] = mesh().triangles[t];
    into.mesh.triangles.push_back({number[a], number[b], number[c]});
    into.source_triangle.push_back(source_triangle_[t]);
  }
  for (const std::uint32_t t : kept_) {
    const auto first = static_cast<std::uint32_t>(into.mesh.vertices.size());
    for (const std::uint32_t v : original_.triangles[t]) {
      into.mesh.vertices.push_back(original_.vertices[v]);
      into.source_vertex.push_back(v);
    }
    into.mesh.triangles.push_back({first, first + 1, first + 2});
    into.source_triangle.push_back(t);
  }
}

}  // namespace meshbound
