// SPDX-License-Identifier: MIT
#include "tiles/tiled_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

#include "geometry/segment.h"
#include "meshbound/error.h"
#include "numeric/no_index.h"
#include "numeric/numbers_below.h"
#include "numeric/ranked_numbers.h"
#include "numeric/sort_unique.h"
#include "simplify/ended_by.h"
#include "tiles/equal_positions.h"
#include "tiles/tile_borders.h"

namespace meshbound {
namespace {

/// A vertex of a mesh that has been simplified takes as much memory in a tile as so many originals: each of its two
/// triangles takes 0.8 kB with what proves it, an original 0.26 kB.
constexpr std::uint32_t originals_of_vertex = 6;

/// An original below a triangle of a tile's own may be covered by one that stays, to which it is near: then it is about
/// this many tolerances away from what the two have in common, a tolerance to the side and one below.
constexpr double width_of_rim = 1.5;

std::uint32_t index_in(std::span<const std::uint32_t> ascending, std::uint32_t number) {
  return static_cast<std::uint32_t>(std::lower_bound(ascending.begin(), ascending.end(), number) - ascending.begin());
}

/// The first corner of each of some triangles of a mesh.
class FirstCorners {
 public:
  FirstCorners(const StoredMesh& mesh, std::span<const std::uint32_t> triangles) {
    for (const Triangle& corners :
         gathered<Triangle>(triangles, mesh.triangle_count(),
                            [&](std::size_t first, std::span<Triangle> to) { mesh.read_triangles(first, to); }))
      vertices_.push_back(corners[0]);
    ranked_.emplace(std::array{std::span<const std::uint32_t>(vertices_)});
    positions_ = gathered<Vec3>(ranked_->ascending(), mesh.vertex_count(),
                                [&](std::size_t first, std::span<Vec3> to) { mesh.read_vertices(first, to); });
  }
  [[nodiscard]] Vec3 operator[](std::size_t k) const { return positions_[ranked_->index_of(vertices_[k])]; }

 private:
  std::vector<std::uint32_t> vertices_;  ///< by triangle
  std::optional<RankedNumbers> ranked_;
  std::vector<Vec3> positions_;
};

template <class T>
void release(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

}  // namespace

TiledMesh::TiledMesh(const StoredMesh& original, const std::vector<bool>& locked)
    : original_(original), locked_(locked), cover_(original.space()) {}

/// The tiles of a pass as jobs.
class TiledMesh::Jobs : public TileJobs {
 public:
  Jobs(TiledMesh& mesh, const Pass& how) : mesh_(mesh), how_(how), tiles_(mesh.triangles_->size()) {}

  [[nodiscard]] std::size_t size() const override { return tiles_.size(); }
  [[nodiscard]] std::uint64_t weight(std::size_t job) const override {
    const std::size_t triangles = mesh_.triangles_->size_of(job);
    return mesh_.is_original_ ? triangles : std::max(triangles, mesh_.originals_->size_of(job));
  }
  void run(std::size_t job) override { (void)run(job, false); }
  [[nodiscard]] std::string run_packed(std::size_t job) override { return run(job, true); }
  void unpack(std::size_t job, std::string_view bytes) override {
    TileNumbers numbers;
    MeshPart part = mesh_.find_numbers(static_cast<std::uint32_t>(job), numbers);
    tiles_[job] = mesh_.take(numbers, unpacked_tile(bytes, start_of(std::move(part), numbers)));
  }
  [[nodiscard]] bool is_complete(std::size_t job) const override {
    const EndedBy ended_by = tiles_[job].output.ended_by;
    return ended_by != EndedBy::TimeLimit && ended_by != EndedBy::Cancelled;
  }
  void progress(double share) override {
    if (how_.progress) how_.progress(share);
  }

  [[nodiscard]] std::vector<TileResult>& tiles() { return tiles_; }

 private:
  std::string run(std::size_t job, bool packs) {
    TileNumbers numbers;
    const auto tile = static_cast<std::uint32_t>(job);
    MeshPart part = mesh_.find_numbers(tile, numbers);
    TileOutput output = how_.simplify(mesh_.input_of(tile, part, numbers));
    std::string bytes;
    if (packs) bytes = packed_tile(output, start_of(std::move(part), numbers));
    tiles_[job] = mesh_.take(numbers, std::move(output));
    return bytes;
  }
  [[nodiscard]] TileStart start_of(MeshPart part, const TileNumbers& numbers) const {
    return {std::move(part.mesh), mesh_.near_of(numbers), numbers.cover};
  }

  TiledMesh& mesh_;
  const Pass& how_;
  std::vector<TileResult> tiles_;
};

TiledMesh::PassFacts TiledMesh::pass(const Pass& how, JobRunner& runner) {
  runner.do_together([&] {
    find_owners(how);
    find_triangles();
    find_what_stays();
    squared_rim_ = width_of_rim * how.tolerance * width_of_rim * how.tolerance;
    if (!is_original_) find_originals();
    new_covers_.emplace(original_.space());
  });
  Jobs jobs(*this, how);
  runner.run(jobs);
  PassFacts facts;
  facts.tiles = jobs.size();
  for (const TileResult& tile : jobs.tiles()) {
    facts.ended_by = joint_reason(facts.ended_by, tile.output.ended_by);
    facts.counts += tile.output.counts;
    facts.dropped_triangles += tile.output.dropped_triangles;
    facts.split = facts.split || tile.output.split;
  }
  runner.do_together([&] { join(jobs.tiles()); });
  return facts;
}

std::uint32_t TiledMesh::tile_of(const Triangle& corners) const {
  const auto& [a, b, c] = corners;
  return owner_[a] == owner_[b] && owner_[b] == owner_[c] ? owner_[a] : no_index;
}

template <class Use>
void TiledMesh::for_each_owner(const Triangle& corners, const Use& use) const {
  const auto& [a, b, c] = corners;
  const std::uint32_t i = owner_[a], j = owner_[b], k = owner_[c];
  if (i != no_index) use(i);
  if (j != no_index && j != i) use(j);
  if (k != no_index && k != i && k != j) use(k);
}

/// Whether a tile of a mesh that is not the original has the triangle, as its own or as one that stays.
bool TiledMesh::is_in(std::uint32_t tile, std::uint32_t triangle) const {
  const Triangle& corners = proven_.mesh.triangles[triangle];
  return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return owner_[v] == tile; });
}

/// The tile that may cover an original anew: it has all triangles of the cover, and some are its own.
std::uint32_t TiledMesh::tile_of_cover(std::span<const std::uint32_t> cover) const {
  for (const std::uint32_t f : cover) {
    const std::uint32_t tile = tile_of(proven_.mesh.triangles[f]);
    if (tile == no_index) continue;
    const bool has_all = std::all_of(cover.begin(), cover.end(), [&](std::uint32_t g) { return is_in(tile, g); });
    return has_all ? tile : no_index;
  }
  return no_index;
}

/// Calls use(original, its cover) for the originals of a mesh that is not the original itself.
template <class Use>
void TiledMesh::for_each_cover(const Use& use) const {
  ListReader covers(cover_);
  for (std::uint32_t t = 0; t < original_.triangle_count(); ++t) use(t, covers.next());
}

/// Marks the vertices that have stayed in all passes, and those within so many rings of triangles around them.
std::vector<std::uint8_t> TiledMesh::vertices_near_seams(int rings) const {
  std::vector<std::uint8_t> is_near = at_seam_;
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<std::uint8_t> inside = is_near;
    for (const Triangle& corners : proven_.mesh.triangles) {
      if (std::none_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return inside[v] != 0; })) continue;
      for (const std::uint32_t v : corners) is_near[v] = 1;
    }
  }
  spread(is_near);
  return is_near;
}

/// Marks all vertices at a position where one is marked.
void TiledMesh::spread(std::vector<std::uint8_t>& marks) const {
  for (std::uint32_t v = 0; v < position_.size(); ++v) marks[position_[v]] |= marks[v];
  for (std::uint32_t v = 0; v < position_.size(); ++v) marks[v] = marks[position_[v]];
}

/// By vertex, how many originals it stands for, and as many as take the memory of its triangles.
std::vector<std::uint32_t> TiledMesh::weights() const {
  std::vector<std::uint32_t> weights(now_->vertex_count(), is_original_ ? 0 : originals_of_vertex);
  if (is_original_) {
    original_.for_each_triangle([&](std::uint32_t, const Triangle& corners) { ++weights[joined(corners[0])]; });
  } else {
    for_each_cover([&](std::uint32_t, std::span<const std::uint32_t> cover) {
      if (!cover.empty()) ++weights[proven_.mesh.triangles[cover[0]][0]];
    });
  }
  return weights;
}

/// The tiles of the original: of the first vertex at each position.
void TiledMesh::cut_original(const Pass& how, std::span<const std::uint32_t> weights, const UseTile& use) const {
  ItemStore<CutItem> items(original_.space());
  original_.for_each_vertex([&](std::uint32_t v, const Eigen::Vector3d& p) {
    if (joined(v) == v) items.append({to_vec3(p), v, weights[v]});
  });
  cut_into_tiles(std::move(items), how.max_weight, how.cut, original_.space(), use);
}

void TiledMesh::cut_near_seams(const Pass& how, std::span<const std::uint32_t> weights, const UseTile& use) const {
  const std::vector<std::uint8_t> is_near = vertices_near_seams(how.rings);
  ItemStore<CutItem> items(original_.space());
  for (std::uint32_t v = 0; v < is_near.size(); ++v)
    if (is_near[v] != 0 && joined(v) == v) items.append({to_vec3(proven_.mesh.vertices[v]), v, weights[v]});
  cut_into_tiles(std::move(items), how.max_weight, how.cut, original_.space(), use);
}

/// Tiles join vertices at one position, and any of them may be the one that is locked.
void TiledMesh::spread_locks() {
  if (is_original_) {
    for (std::uint32_t v = 0; v < locked_.size(); ++v)
      if (locked_[v]) locked_[joined(v)] = true;
    for (std::uint32_t v = 0; v < locked_.size(); ++v) locked_[v] = locked_[joined(v)];
  } else if (!locked_.empty()) {
    for (std::uint32_t v = 0; v < position_.size(); ++v)
      if (locked_[source_vertex_[v]]) source_vertex_[position_[v]] = source_vertex_[v];
    for (std::uint32_t v = 0; v < position_.size(); ++v) source_vertex_[v] = source_vertex_[position_[v]];
  }
}

void TiledMesh::find_owners(const Pass& how) {
  position_ = first_at_positions(*now_);
  spread_locks();
  const std::vector<std::uint32_t> weights = this->weights();
  std::vector<std::uint32_t> owner;
  std::uint32_t tiles = 0;
  const auto own = [&](std::span<const std::uint32_t> vertices) {
    owner.resize(now_->vertex_count(), no_index);
    for (const std::uint32_t v : vertices) owner[v] = tiles;
    ++tiles;
  };
  if (is_original_)
    cut_original(how, weights, own);
  else
    cut_near_seams(how, weights, own);
  owner.resize(now_->vertex_count(), no_index);
  if (!is_original_) smooth_tile_borders(proven_.mesh.triangles, weights, how.max_weight, owner);
  owner_ = std::move(owner);
  for (std::uint32_t v = 0; v < position_.size(); ++v) owner_[v] = owner_[position_[v]];
  triangles_.emplace(original_.space(), tiles);
}

void TiledMesh::find_triangles() {
  now_->for_each_triangle([&](std::uint32_t t, const Triangle& corners) {
    for_each_owner(corners, [&](std::uint32_t tile) { triangles_->append(tile, t); });
  });
}

/// Triangles that are no tile's own stay with their vertices, and so does what covers an original together with
/// triangles that the tile does not have: so the cover holds. What has stayed in all passes is a seam, which later
/// passes go over.
void TiledMesh::find_what_stays() {
  stays_.assign(now_->vertex_count(), 0);
  const auto stay = [&](const Triangle& corners) {
    for (const std::uint32_t v : corners) stays_[joined(v)] = 1;
  };
  now_->for_each_triangle([&](std::uint32_t, const Triangle& corners) {
    if (tile_of(corners) == no_index) stay(corners);
  });
  if (!is_original_) {
    for_each_cover([&](std::uint32_t, std::span<const std::uint32_t> cover) {
      if (cover.size() < 2 || tile_of_cover(cover) != no_index) return;
      for (const std::uint32_t f : cover) stay(proven_.mesh.triangles[f]);
    });
  }
  spread(stays_);
  at_seam_.resize(now_->vertex_count(), 1);
  for (std::uint32_t v = 0; v < stays_.size(); ++v) at_seam_[v] &= stays_[v];
  spread(at_seam_);
}

/// The originals of a tile: those that its own triangles cover, also in part, and those that its triangles are near.
/// Some that other triangles cover are added later (`originals_at_rim`).
void TiledMesh::find_originals() {
  originals_.emplace(original_.space(), triangles_->size());
  beside_.emplace(original_.space(), triangles_->size());
  for_each_cover([&](std::uint32_t t, std::span<const std::uint32_t> cover) {
    for (const std::uint32_t f : cover) {
      const Triangle& corners = proven_.mesh.triangles[f];
      GrowingLists& lists = tile_of(corners) != no_index ? *originals_ : *beside_;
      for_each_owner(corners, [&](std::uint32_t tile) { lists.append(tile, t); });
    }
  });
  for (std::uint32_t tile = 0; tile < triangles_->size(); ++tile)
    for (const std::uint32_t f : (*triangles_)[tile]) originals_->append(tile, proven_.near[f]);
}

/// Whether a point is near the corner or the edge that a triangle has in common with what a tile owns.
bool TiledMesh::is_at_rim(std::uint32_t tile, std::uint32_t triangle, Vec3 p) const {
  std::array<Vec3, 3> common;
  std::size_t count = 0;
  for (const std::uint32_t v : proven_.mesh.triangles[triangle])
    if (owner_[v] == tile) common[count++] = to_vec3(proven_.mesh.vertices[v]);
  if (count == 0 || count == 3) return false;
  return squared_distance_to_segment(p, common[0], common[count - 1]) <= squared_rim_;
}

/// The originals below the rim of what is the tile's own that triangles which stay cover: without them its triangles
/// would hang over the edge of what the tile knows of the original, and be harder to prove near it. Those with their
/// first corner there are enough for that.
std::vector<std::uint32_t> TiledMesh::originals_at_rim(std::uint32_t tile) const {
  std::vector<std::uint32_t> beside = (*beside_)[tile];
  sort_unique(beside);
  const NumberLists covers = cover_.at(beside);
  const FirstCorners corners(original_, beside);
  std::size_t count = 0;
  for (std::size_t k = 0; k < beside.size(); ++k) {
    const auto is_near = [&](std::uint32_t f) { return is_at_rim(tile, f, corners[k]); };
    if (std::any_of(covers[k].begin(), covers[k].end(), is_near)) beside[count++] = beside[k];
  }
  beside.resize(count);
  return beside;
}

std::vector<bool> TiledMesh::locked(const std::vector<std::uint32_t>& vertices) const {
  std::vector<bool> locked(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    locked[i] = stays_[vertices[i]] != 0 || (!locked_.empty() && locked_[source_of(vertices[i])]);
  return locked;
}

/// Finds which vertices, triangles and originals a tile has; returns the tile as a mesh.
MeshPart TiledMesh::find_numbers(std::uint32_t tile, TileNumbers& numbers) const {
  numbers.triangles = (*triangles_)[tile];
  MeshPart part = part_of(*now_, numbers.triangles);
  numbers.vertices = std::move(part.vertices);
  for (const auto& [a, b, c] : part.mesh.triangles)
    numbers.is_own.push_back(tile_of({numbers.vertices[a], numbers.vertices[b], numbers.vertices[c]}) != no_index);
  if (is_original_) {
    numbers.originals = numbers.triangles;
  } else {
    numbers.originals = RankedNumbers(std::array{(*originals_)[tile], originals_at_rim(tile)}).ascending();
  }
  numbers.cover = cover_of(tile, numbers);
  return part;
}

/// By original of a tile: the triangles of the tile that cover it, where the tile may cover it anew. All numbers are
/// those of the tile.
NumberLists TiledMesh::cover_of(std::uint32_t tile, const TileNumbers& numbers) const {
  NumberLists lists, covers;
  if (!is_original_) covers = cover_.at(numbers.originals);
  for (std::uint32_t k = 0; k < numbers.originals.size(); ++k) {
    if (is_original_) {
      if (numbers.is_own[k]) lists.numbers.push_back(k);
    } else if (tile_of_cover(covers[k]) == tile) {
      for (const std::uint32_t f : covers[k]) lists.numbers.push_back(index_in(numbers.triangles, f));
    }
    lists.end_list();
  }
  return lists;
}

/// By triangle of a tile: an original of the tile near it.
std::vector<std::uint32_t> TiledMesh::near_of(const TileNumbers& numbers) const {
  if (is_original_) return numbers_below(numbers.triangles.size());
  std::vector<std::uint32_t> near;
  for (const std::uint32_t f : numbers.triangles) near.push_back(index_in(numbers.originals, proven_.near[f]));
  return near;
}

TileInput TiledMesh::input_of(std::uint32_t tile, const MeshPart& part, const TileNumbers& numbers) const {
  std::vector<bool> at_rim;
  for (const std::uint32_t v : numbers.vertices) at_rim.push_back(owner_[v] != tile);
  if (is_original_) return {part.mesh, std::nullopt, locked(numbers.vertices), std::move(at_rim)};
  TileInput input{part_of(original_, numbers.originals).mesh, ProvenMesh(), locked(numbers.vertices),
                  std::move(at_rim)};
  ProvenMesh& start = *input.start;
  start.mesh = part.mesh;
  start.cover = numbers.cover;
  start.near = near_of(numbers);
  for (std::size_t k = 0; k < numbers.originals.size(); ++k) start.is_covered.push_back(numbers.cover[k].empty());
  return input;
}

/// Stores the covers of a tile's output and leaves out what stays, which is in the mesh already. Several threads may
/// call this at once.
TiledMesh::TileResult TiledMesh::take(const TileNumbers& numbers, TileOutput output) {
  TileResult result;
  const auto with_numbers_of = [](const std::vector<std::uint32_t>& whole, std::vector<std::uint32_t>& of_tile) {
    for (std::uint32_t& n : of_tile) n = whole[n];
  };
  {
    const NumberLists& cover = output.proven.cover;
    std::vector<std::uint32_t> before;
    const std::lock_guard lock(taking_);
    result.first_cover = new_covers_->size();
    for (std::size_t k = 0; k < numbers.cover.size(); ++k) {
      if (numbers.cover[k].empty()) continue;
      before.clear();
      for (const std::uint32_t f : cover[k]) before.push_back(numbers.triangles[output.source_triangle[f]]);
      new_covers_->append(before);
    }
  }
  output.proven.cover = {};
  if (is_original_) std::erase_if(output.kept, [&](std::uint32_t t) { return !numbers.is_own[t]; });
  const std::vector<std::uint32_t> turned = std::exchange(output.turned, {});
  std::uint32_t own = 0;
  for (std::size_t i = 0; i < output.source_triangle.size(); ++i) {
    if (!numbers.is_own[output.source_triangle[i]]) continue;
    if (std::binary_search(turned.begin(), turned.end(), i)) output.turned.push_back(own);
    output.proven.mesh.triangles[own] = output.proven.mesh.triangles[i];
    output.proven.near[own] = output.proven.near[i];
    output.source_triangle[own++] = output.source_triangle[i];
  }
  output.proven.mesh.triangles.resize(own);
  output.proven.near.resize(own);
  output.source_triangle.resize(own);
  with_numbers_of(numbers.originals, output.kept);
  with_numbers_of(numbers.originals, output.proven.near);
  with_numbers_of(numbers.triangles, output.source_triangle);
  with_numbers_of(numbers.vertices, output.source_vertex);
  result.output = std::move(output);
  return result;
}

/// The mesh that tiles are joined into.
struct TiledMesh::Joined {
  ProvenMesh whole;
  std::vector<std::uint32_t> source_vertex, source_triangle;
  std::vector<bool> is_turned;
  std::vector<std::uint8_t> at_seam;
  std::vector<std::uint32_t> staying;      ///< vertices before that stay, ascending
  std::vector<std::uint32_t> staying_now;  ///< by these: the number now; `no_index` until it is met
  std::vector<std::uint32_t> before;       ///< by triangle now: its number before
  std::optional<RankedNumbers> ranked;     ///< of `before`
  std::vector<std::uint32_t> by_before;    ///< triangles now, in the order of `before`

  void sort() {
    ranked.emplace(std::array{std::span<const std::uint32_t>(before)});
    by_before.resize(before.size());
    for (std::uint32_t i = 0; i < before.size(); ++i) by_before[ranked->index_of(before[i])] = i;
  }
  [[nodiscard]] std::uint32_t triangle_now(std::uint32_t f) const {
    if (!ranked->contains(f)) throw Error("internal error: a tile changed a triangle that another tile relies on");
    return by_before[ranked->index_of(f)];
  }
};

TiledMesh::Joined TiledMesh::begin_join() const {
  Joined into;
  for (std::uint32_t v = 0; v < stays_.size(); ++v)
    if (stays_[v] != 0 && joined(v) == v) into.staying.push_back(v);
  into.staying_now.assign(into.staying.size(), no_index);
  return into;
}

/// The number in the joined mesh of a vertex that comes from vertex `before` and stands at `position`. A vertex that
/// stays is one vertex for all tiles.
std::uint32_t TiledMesh::join_vertex(Joined& into, std::uint32_t before, const Eigen::Vector3d& position) const {
  std::uint32_t* const now = stays_[before] != 0 ? &into.staying_now[index_in(into.staying, joined(before))] : nullptr;
  if (now != nullptr && *now != no_index) return *now;
  const auto number = static_cast<std::uint32_t>(into.whole.mesh.vertices.size());
  into.whole.mesh.vertices.push_back(position);
  into.source_vertex.push_back(source_of(before));
  into.at_seam.push_back(at_seam_[before]);
  if (now != nullptr) *now = number;
  return number;
}

/// `is_turned`: it faces the other way than triangle `before`.
void TiledMesh::join_triangle(Joined& into, std::uint32_t before, const Triangle& corners, std::uint32_t near,
                              bool is_turned) const {
  into.before.push_back(before);
  into.whole.mesh.triangles.push_back(corners);
  into.source_triangle.push_back(is_original_ ? before : source_triangle_[before]);
  into.is_turned.push_back(is_turned != (!is_original_ && is_turned_[before]));
  into.whole.near.push_back(near);
}

/// Adds the triangles that are no tile's own.
void TiledMesh::join_what_stays(Joined& into) const {
  std::vector<std::uint32_t> staying;
  now_->for_each_triangle([&](std::uint32_t f, const Triangle& corners) {
    if (tile_of(corners) == no_index) staying.push_back(f);
  });
  const MeshPart part = part_of(*now_, staying);
  for (std::size_t i = 0; i < staying.size(); ++i) {
    Triangle corners = part.mesh.triangles[i];
    for (std::uint32_t& v : corners) v = join_vertex(into, part.vertices[v], part.mesh.vertices[v]);
    join_triangle(into, staying[i], corners, is_original_ ? staying[i] : proven_.near[staying[i]], false);
  }
}

/// Adds the triangles of a tile with their vertices. Others of its vertices have only triangles that stay, which have
/// come with vertices of their own.
void TiledMesh::join_tile(Joined& into, TileResult& tile) {
  const TileOutput& output = tile.output;
  std::vector<std::uint32_t> number(output.source_vertex.size(), no_index);
  for (const Triangle& corners : output.proven.mesh.triangles)
    for (const std::uint32_t v : corners) number[v] = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] != no_index) number[v] = join_vertex(into, output.source_vertex[v], output.proven.mesh.vertices[v]);
  for (std::uint32_t i = 0; i < output.source_triangle.size(); ++i) {
    const auto& [a, b, c] = output.proven.mesh.triangles[i];
    join_triangle(into, output.source_triangle[i], {number[a], number[b], number[c]}, output.proven.near[i],
                  std::binary_search(output.turned.begin(), output.turned.end(), i));
  }
  kept_.insert(kept_.end(), output.kept.begin(), output.kept.end());
  tile.output = {};
}

void TiledMesh::join(std::vector<TileResult>& tiles) {
  Joined into = begin_join();
  join_what_stays(into);
  for (TileResult& tile : tiles) join_tile(into, tile);
  into.sort();
  cover_ = join_covers(tiles, into);
  proven_ = std::move(into.whole);
  now_ = &proven_mesh_;
  source_vertex_ = std::move(into.source_vertex);
  source_triangle_ = std::move(into.source_triangle);
  is_turned_ = std::move(into.is_turned);
  at_seam_ = std::move(into.at_seam);
  is_original_ = false;
  triangles_.reset(), originals_.reset(), beside_.reset(), new_covers_.reset();
  release(owner_), release(stays_), release(position_);
}

/// The covers of all originals by triangles of the joined mesh: from the tile that covers an original anew, or as
/// before.
StoredLists TiledMesh::join_covers(const std::vector<TileResult>& tiles, const Joined& into) const {
  std::vector<ListReader> of_tile;
  for (const TileResult& tile : tiles) of_tile.emplace_back(*new_covers_, tile.first_cover);
  StoredLists covers(original_.space());
  std::vector<std::uint32_t> now;
  const auto add = [&](std::span<const std::uint32_t> before) {
    now.clear();
    for (const std::uint32_t f : before) now.push_back(into.triangle_now(f));
    covers.append(now);
  };
  const auto add_cover = [&](std::uint32_t tile, std::span<const std::uint32_t> before) {
    add(tile == no_index ? before : of_tile[tile].next());
  };
  if (is_original_)
    original_.for_each_triangle(
        [&](std::uint32_t t, const Triangle& corners) { add_cover(tile_of(corners), std::span(&t, 1)); });
  else
    for_each_cover(
        [&](std::uint32_t, std::span<const std::uint32_t> cover) { add_cover(tile_of_cover(cover), cover); });
  return covers;
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
    into.mesh.vertices.push_back(proven_.mesh.vertices[v]);
    into.source_vertex.push_back(source_vertex_[v]);
  }
  for (const std::uint32_t t : ordered_by(source_triangle_)) {
    const auto& [a, b, c] = proven_.mesh.triangles[t];
    into.mesh.triangles.push_back({number[a], number[b], number[c]});
    into.source_triangle.push_back(source_triangle_[t]);
  }
  into.turned_faces = static_cast<std::size_t>(std::count(is_turned_.begin(), is_turned_.end(), true));
  const MeshPart kept = part_of(original_, kept_);
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(into.mesh.vertices.size());
    for (const std::uint32_t v : kept.mesh.triangles[i]) {
      into.mesh.vertices.push_back(kept.mesh.vertices[v]);
      into.source_vertex.push_back(kept.vertices[v]);
    }
    into.mesh.triangles.push_back({first, first + 1, first + 2});
    into.source_triangle.push_back(kept_[i]);
  }
}

}  // namespace meshbound
