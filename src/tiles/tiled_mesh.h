// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

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

  /// `original` must outlive this. `locked`: by vertex of it, or empty.
  TiledMesh(const TriangleMesh& original, const std::vector<bool>& locked);

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
    std::size_t max_triangles = 0;  ///< of the original, that a tile stands for
    Simplify simplify;
    std::function<void(double share)> progress;  ///< of the pass
  };

  /// Cuts the mesh as it is into tiles, has `runner` simplify each, and puts them together.
  PassFacts pass(const Pass& how, JobRunner& runner);

  /// The mesh as it is now, in the order of the triangles that its faces come from.
  void current_mesh(SimplifiedLevel& into) const;
  [[nodiscard]] std::size_t faces() const { return mesh().triangles.size(); }
  [[nodiscard]] std::size_t kept_triangles() const { return kept_.size(); }

 private:
  /// All numbers are those of the whole mesh.
  struct Tile {
    std::vector<std::uint32_t> originals;  ///< by triangle of the tile's original
    std::vector<std::uint32_t> vertices;   ///< by vertex of the tile's start
    std::vector<std::uint32_t> triangles;  ///< by triangle of the tile's start
    std::vector<std::uint32_t> now;        ///< by triangle of the output: its number in the mesh of all tiles
    TileOutput output;
  };
  struct Joined;
  class Jobs;

  [[nodiscard]] const TriangleMesh& mesh() const { return is_original_ ? original_ : proven_.mesh; }
  [[nodiscard]] std::uint32_t source_of(std::uint32_t vertex) const {
    return is_original_ ? vertex : source_vertex_[vertex];
  }
  /// Vertices of the original at one position are one.
  [[nodiscard]] std::uint32_t joined(std::uint32_t vertex) const { return is_original_ ? position_[vertex] : vertex; }
  /// The tile of a triangle, or `no_index` where it stays as it is.
  [[nodiscard]] std::uint32_t tile_of(std::uint32_t triangle) const;
  [[nodiscard]] bool is_in(std::uint32_t tile, std::uint32_t triangle) const;
  [[nodiscard]] std::uint32_t tile_of_cover(std::span<const std::uint32_t> cover) const;
  [[nodiscard]] std::vector<std::uint8_t> vertices_near_seams() const;
  [[nodiscard]] std::vector<std::uint32_t> weights() const;
  void find_owners(const TileCut& cut, std::size_t max_triangles);
  void find_triangles();
  void find_originals();
  void find_what_stays();
  void stay(std::uint32_t triangle, bool is_seam);
  MeshPart find_numbers(std::uint32_t tile, Tile& numbers) const;
  [[nodiscard]] TileInput input_of(std::uint32_t tile, Tile& numbers) const;
  [[nodiscard]] NumberLists cover_of(std::uint32_t tile, const Tile& numbers) const;
  [[nodiscard]] std::vector<bool> locked(const std::vector<std::uint32_t>& vertices) const;
  void join(std::vector<Tile>& tiles);
  void join_tile(Joined& into, Tile& tile);
  std::uint32_t join_vertex(Joined& into, std::uint32_t before, const Eigen::Vector3d& position) const;
  void join_triangle(Joined& into, std::uint32_t before, const Triangle& corners, std::uint32_t near) const;
  void join_covers(const std::vector<Tile>& tiles, Joined& into) const;
  template <class Use>
  void for_each_cover(const Use& use) const;

  const TriangleMesh& original_;
  const std::vector<bool>& locked_;
  bool is_original_ = true;                     ///< nothing has been simplified: the members below are empty
  ProvenMesh proven_;                           ///< against the whole original
  std::vector<std::uint32_t> source_vertex_;    ///< of the original, by vertex of `proven_.mesh`
  std::vector<std::uint32_t> source_triangle_;  ///< of the original, by triangle of `proven_.mesh`
  std::vector<std::uint32_t> kept_;             ///< originals that are part of the result as they are
  std::vector<std::uint8_t> at_seam_;           ///< by vertex: it stayed in the last pass, for the sake of other tiles

  // What the pass under way has found.
  std::vector<std::uint32_t> position_;  ///< by vertex of the original: the first one at its position
  std::vector<std::uint32_t> owner_;     ///< by vertex: its tile, or `no_index`
  NumberLists triangles_;                ///< by tile: those with a vertex that it owns, ascending
  NumberLists originals_;                ///< by tile of a mesh that is not the original, ascending
  std::vector<std::uint8_t> stays_;      ///< by vertex
};

}  // namespace meshbound
