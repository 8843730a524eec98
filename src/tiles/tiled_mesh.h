// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "mesh/stored_lists.h"
#include "mesh/stored_mesh.h"
#include "meshbound/simplify.h"
#include "simplify/proven_mesh.h"
#include "tiles/tile_bytes.h"
#include "tiles/tile_cut.h"
#include "tiles/tile_jobs.h"
#include "tiles/tile_run.h"

namespace meshbound {

/// A mesh that is simplified tile by tile: passes over tiles that are cut in different directions, each of which goes
/// on from the proof that the one before has left.
///
/// In a pass each vertex belongs to one tile or to none. A triangle whose vertices are all of one tile belongs to that
/// tile, and no other tile has it; every other triangle stays as it is, with its vertices. A tile gets the triangles
/// that stay as well, as far as it owns one of their vertices: so it knows all triangles around each of its vertices,
/// and whatever keeps the tile a manifold keeps the whole mesh one. Tiles may run at once and in any order.
class TiledMesh {
 public:
  /// Simplifies the tile. Called from several threads at once.
  using Simplify = std::function<TileOutput(const TileInput&)>;

  /// `original` must outlive this; arrays of its size are kept in its space. `locked`: by vertex of it, or empty.
  TiledMesh(const StoredMesh& original, const std::vector<bool>& locked);

  /// What came of the tiles of a pass, beside the mesh.
  struct PassFacts {
    std::size_t tiles = 0;
    EndedBy ended_by = EndedBy::Rounding;  ///< of all tiles (simplify/ended_by.h)
    CollapseCounts counts;
    std::size_t dropped_triangles = 0;  ///< as in `SimplifyResult`
    bool split = false;                 ///< as in `SimplifyResult`
  };

  /// How a pass is done.
  struct Pass {
    TileCut cut;
    std::size_t max_weight = 0;  ///< of a tile: originals, and later triangles as well
    int rings = 0;               ///< of triangles around the seams that a later pass goes over
    double tolerance = 0;        ///< what the tiles are simplified with
    Simplify simplify;
    std::function<void(double share)> progress;  ///< of the pass
  };

  /// Cuts the mesh as it is into tiles, has `runner` simplify each, and puts them together.
  PassFacts pass(const Pass& how, JobRunner& runner);

  /// The mesh as it is now, in the order of the triangles that its faces come from.
  void current_mesh(SimplifiedLevel& into) const;
  [[nodiscard]] std::size_t faces() const { return now_->triangle_count(); }
  [[nodiscard]] std::size_t kept_triangles() const { return kept_.size(); }

 private:
  /// What a tile starts from. All numbers are those of the whole mesh, but for `cover`.
  struct TileNumbers {
    std::vector<std::uint32_t> originals;  ///< by triangle of the tile's original
    std::vector<std::uint32_t> vertices;   ///< by vertex of the tile's start
    std::vector<std::uint32_t> triangles;  ///< by triangle of the tile's start
    std::vector<bool> is_own;              ///< by triangle of the tile's start: it does not stay
    NumberLists cover;  ///< by original: triangles of the tile that cover it, where the tile may cover it anew
  };
  /// What is left of a tile, without covers and triangles that stay. All numbers but corners are those of the whole
  /// mesh before the pass.
  struct TileResult {
    TileOutput output;
    std::size_t first_cover = 0;  ///< where its covers begin in `new_covers_`: one for each original covered anew
  };
  struct Joined;
  class Jobs;

  [[nodiscard]] std::uint32_t source_of(std::uint32_t vertex) const {
    return is_original_ ? vertex : source_vertex_[vertex];
  }
  /// Vertices at one position are one, also those that a pass before has split.
  [[nodiscard]] std::uint32_t joined(std::uint32_t vertex) const {
    return position_.empty() ? vertex : position_[vertex];
  }
  /// The tile of a triangle, or `no_index` where it stays as it is.
  [[nodiscard]] std::uint32_t tile_of(const Triangle& corners) const;
  /// Calls use(tile) for each tile that owns a corner, once.
  template <class Use>
  void for_each_owner(const Triangle& corners, const Use& use) const;
  [[nodiscard]] bool is_in(std::uint32_t tile, std::uint32_t triangle) const;
  [[nodiscard]] std::uint32_t tile_of_cover(std::span<const std::uint32_t> cover) const;
  [[nodiscard]] std::vector<std::uint8_t> vertices_near_seams(int rings) const;
  [[nodiscard]] std::vector<std::uint32_t> weights() const;
  void spread_locks();
  void spread(std::vector<std::uint8_t>& marks) const;
  void find_owners(const Pass& how);
  void cut_original(const Pass& how, std::span<const std::uint32_t> weights, const UseTile& use) const;
  void cut_near_seams(const Pass& how, std::span<const std::uint32_t> weights, const UseTile& use) const;
  void find_triangles();
  void find_originals();
  [[nodiscard]] bool is_at_rim(std::uint32_t tile, std::uint32_t triangle, Vec3 p) const;
  [[nodiscard]] std::vector<std::uint32_t> originals_at_rim(std::uint32_t tile) const;
  void find_what_stays();
  MeshPart find_numbers(std::uint32_t tile, TileNumbers& numbers) const;
  [[nodiscard]] NumberLists cover_of(std::uint32_t tile, const TileNumbers& numbers) const;
  [[nodiscard]] std::vector<std::uint32_t> near_of(const TileNumbers& numbers) const;
  [[nodiscard]] TileInput input_of(std::uint32_t tile, const MeshPart& part, const TileNumbers& numbers) const;
  [[nodiscard]] std::vector<bool> locked(const std::vector<std::uint32_t>& vertices) const;
  [[nodiscard]] TileResult take(const TileNumbers& numbers, TileOutput output);
  void join(std::vector<TileResult>& tiles);
  [[nodiscard]] Joined begin_join() const;
  void join_what_stays(Joined& into) const;
  void join_tile(Joined& into, TileResult& tile);
  std::uint32_t join_vertex(Joined& into, std::uint32_t before, const Eigen::Vector3d& position) const;
  void join_triangle(Joined& into, std::uint32_t before, const Triangle& corners, std::uint32_t near,
                     bool is_turned) const;
  [[nodiscard]] StoredLists join_covers(const std::vector<TileResult>& tiles, const Joined& into) const;
  template <class Use>
  void for_each_cover(const Use& use) const;

  const StoredMesh& original_;
  std::vector<bool> locked_;  ///< by vertex of the original: whether one at its position is locked; empty: none is
  bool is_original_ = true;   ///< nothing has been simplified: the members below are empty
  ProvenMesh proven_;         ///< against the whole original, without its cover
  const MeshInMemory proven_mesh_{proven_.mesh};
  const StoredMesh* now_ = &original_;          ///< the mesh as it is
  StoredLists cover_;                           ///< of `proven_`
  std::vector<std::uint32_t> source_vertex_;    ///< of the original, by vertex of `proven_.mesh`
  std::vector<std::uint32_t> source_triangle_;  ///< of the original, by triangle of `proven_.mesh`
  std::vector<bool> is_turned_;        ///< by triangle of `proven_.mesh`: it faces the other way than its source
  std::vector<std::uint32_t> kept_;    ///< originals that are part of the result as they are
  std::vector<std::uint8_t> at_seam_;  ///< by vertex: it has stayed in all passes

  // What the pass under way has found.
  std::vector<std::uint32_t> position_;    ///< by vertex: the first one at its position; empty where all are different
  std::vector<std::uint32_t> owner_;       ///< by vertex: its tile, or `no_index`
  std::optional<GrowingLists> triangles_;  ///< by tile: those with a vertex that it owns, ascending
  std::optional<GrowingLists> originals_;  ///< by tile of a mesh that is not the original
  /// By such a tile: the originals that triangles which stay cover, of those with a vertex that the tile owns.
  std::optional<GrowingLists> beside_;
  double squared_rim_ = 0;                 ///< square of the width of a rim
  std::vector<std::uint8_t> stays_;        ///< by vertex
  std::optional<StoredLists> new_covers_;  ///< of the tiles, as triangles before the pass that have stayed
  std::mutex taking_;                      ///< for `new_covers_`
};

}  // namespace meshbound
